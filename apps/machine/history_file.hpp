#pragma once
// Where the alarm history of a machine is kept.

#include <string>
#include <string_view>

#include "hmi_bridge/hmi_config.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::apps {

/// Of that machine in that folder: <machine>.alarms.sqlite, its name as a file's.
[[nodiscard]] std::string history_path(const std::string& folder, std::string_view machine);

struct HistoryPlace {
    std::string path;
    std::string remark;  ///< what a person should know of it; may be empty
};
/// The configured folder; else, of a real machine, $STATE_DIRECTORY (systemd's) or /var/lib/taktwerk where it may be written; else beside its socket,
/// which a simulated machine always does: its alarms are none of the real one's.
[[nodiscard]] HistoryPlace history_place(const hmi::HistoryConfig& config, const runtime::MachineLayout& layout, const std::string& socket);

}  // namespace taktwerk::apps
