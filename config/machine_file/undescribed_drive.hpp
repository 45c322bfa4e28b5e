#pragma once
// What a machine file states of a drive whose file leaves it open (config/drives/cia402.yaml), and what its axes need of such a drive.

#include <optional>
#include <string>
#include <vector>

#include "config/drive_file/drive_loader.hpp"
#include "config/reading/reader.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::config {

struct StatedDrive {
    std::shared_ptr<const ecat::DeviceDescription> device;
    std::shared_ptr<const axes::DriveProfile> profile;
};

/// The drive with what the slave at `here` ("bus.slaves.0") says of it; assumptions that it settles are gone. Error config.drive_stated: its
/// drive file says it already.
[[nodiscard]] StatedDrive with_statements(const LoadedDrive& drive, Reader& reader, const std::string& here,
                                          const std::optional<ecat::Identity>& identity, const std::vector<axes::DriveMode>& modes);

/// Of a drive whose process data is assumed: what it must carry for its axis. One that is moved by velocities needs 60FFh and no 607Ah, one
/// that only measures neither.
void suit_to_axes(ecat::SlaveConfig& slave, const std::vector<runtime::AxisBinding>& axes);

}  // namespace taktwerk::config
