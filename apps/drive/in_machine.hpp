#pragma once
// A drive through the machine that runs: over its local socket, beside its cycle, by its rules (hmi_bridge/gateway/drive_requests.hpp). Nobody has to
// stop a machine to read a parameter.

#include <string>
#include <vector>

#include "apps/drive/access.hpp"

namespace taktwerk::apps {

/// The machine of --socket, or the only one that runs.
int with_drive_in_machine(const DriveOptions& options, const std::function<int(DriveAccess&)>& work);

struct MachineDrive {
    std::string axis, drive, profile;
    int drive_axis = 1;  ///< of that drive, from 1
};
struct MachineDrives {
    std::string machine;
    std::vector<MachineDrive> drives;  ///< in the order of the machine's axes
    std::vector<std::string> slaves;   ///< by position
};
/// What the running machine drives. Errors: socket.*, state.*.
[[nodiscard]] Result<MachineDrives> drives_of_machine(const std::string& socket);
/// By name of axis or drive, or by the position of its slave; `axis` of a drive with several, from 1. Error drive.no_drive.
[[nodiscard]] Result<MachineDrive> find_drive(const MachineDrives& machine, const std::string& word, int axis);

}  // namespace taktwerk::apps
