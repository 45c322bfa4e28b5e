#pragma once
// The machine's state as lines of a terminal: what `taktwerk monitor` shows. Pure: state and size in, lines out.

#include <cstddef>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace taktwerk::apps {

struct ScreenSize {
    std::size_t columns = 80;
    std::size_t rows = 24;  ///< 0: as many as it takes
    bool colours = false;
};

/// `state` and `layout` as the runtime gives them (hmi_bridge/socket/json_state.hpp). What does not fit is left out from the least
/// important on: details of the axes, further alarms, I/O; a line says so.
[[nodiscard]] std::vector<std::string> monitor_screen(const nlohmann::ordered_json& state, const nlohmann::ordered_json& layout,
                                                      const ScreenSize& size);

}  // namespace taktwerk::apps
