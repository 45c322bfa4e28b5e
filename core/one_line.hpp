#pragma once
// Foreign words on one line of a terminal: names out of EEPROMs, XML files, answers of devices. Any bytes in. Not real-time.

#include <cstddef>
#include <string>
#include <string_view>

namespace taktwerk {

/// Bytes of the well-formed UTF-8 character at `at`; 0: there is none.
[[nodiscard]] std::size_t utf8_length(std::string_view text, std::size_t at) noexcept;

/// Words as people read them on one line: control characters and line separators are blanks, what is no UTF-8 character is left out.
[[nodiscard]] std::string on_one_line(std::string_view utf8);

}  // namespace taktwerk
