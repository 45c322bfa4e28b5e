#pragma once
// Where recordings around alarms are kept when nobody says where.

#include <string>

#include "runtime/machine_config.hpp"

namespace taktwerk::apps {

/// Of a real machine the state folder of its service ($STATE_DIRECTORY of systemd), else /var/lib/taktwerk; where this user may write in
/// neither, and for a simulated machine, that of the command socket, which may be gone after a restart of the computer. Empty: nowhere.
/// Makes the folder.
[[nodiscard]] std::string usual_recordings(const runtime::MachineConfig& machine);

}  // namespace taktwerk::apps
