#pragma once
// What is wrong with `views:` in one machine, each at its place in the file. Not real-time.

#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "hmi_bridge/view_config.hpp"
#include "hmi_bridge/views/view_values.hpp"

namespace taktwerk::hmi {

/// Names that are not there, widgets that write what nobody may write, ranges, pictures. Without programs all but what they decide; with them
/// that alone.
[[nodiscard]] std::vector<Error> check(const std::vector<View>& views, const ViewValues& values);

/// The key of the machine file: "value", "lamp", "switch", ...
[[nodiscard]] std::string_view word(ViewWidget::Kind kind) noexcept;
/// "3 rows, 12 widgets, 2 of them write".
[[nodiscard]] std::string summary_of(const View& view);

}  // namespace taktwerk::hmi
