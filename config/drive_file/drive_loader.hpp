#pragma once
// Drive types: one file fills what the bus and what the axis need to know of a drive.

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "core/result.hpp"
#include "ecat/bus_config.hpp"

namespace taktwerk::config {

struct LoadedDrive {
    std::shared_ptr<const ecat::DeviceDescription> device;  ///< nullptr: on a serial line
    std::shared_ptr<const axes::DriveProfile> profile;
    ecat::PdoSelection rx, tx;                     ///< the runtime's own mapping
    std::vector<ecat::StartupSdo> startup;         ///< before those of the machine
    std::vector<ecat::ModuleSelection> modules{};  ///< of a modular drive, one in each slot
    std::string source{},
        checked{};  ///< where its facts come from, and against what they were checked; empty: the manual that its head names
    std::vector<std::string> files{};  ///< paths of what was read: itself, what it is based on, its objects, its alarms
};

/// All problems at once, each with file, line and column. `folders`: where the file that it is based on may stand, besides beside it.
[[nodiscard]] std::variant<LoadedDrive, std::vector<Error>> load_drive(const std::string& path,
                                                                       const std::vector<std::string>& folders = {});

}  // namespace taktwerk::config
