#pragma once
// Text by the columns it takes on a terminal: UTF-8, Chinese characters two columns wide.

#include <cstddef>
#include <string>
#include <string_view>

namespace taktwerk::apps {

/// Columns of a UTF-8 text without control characters.
[[nodiscard]] std::size_t columns(std::string_view text);
/// At most `width` columns; what was cut ends with "…".
[[nodiscard]] std::string cut(std::string_view text, std::size_t width);
/// Exactly `width` columns.
[[nodiscard]] std::string left(std::string_view text, std::size_t width);
[[nodiscard]] std::string right(std::string_view text, std::size_t width);

}  // namespace taktwerk::apps
