#pragma once
// Serial lines of a machine and the drives on them, as plain data. What is wrong with them: check_serial (serial_check.cpp).

#include <string>
#include <vector>

#include "axes/drives/xp200/drive_config.hpp"
#include "modbus/line/line_settings.hpp"

namespace taktwerk::runtime {

/// A drive that goes on when its line dies needs something that stops it then, or somebody who answers for it.
enum class UnsupervisedLine : std::uint8_t { refused, accepted };

struct SerialDriveConfig {
    axes::xp200::DriveConfig drive;  ///< without `counts_per_turn` and `has_watchdog_output`: these follow
    /// Output of the machine that is on while the line is heard. On an EtherCAT terminal it also falls when the PC is dead: by the terminal's own
    /// SM watchdog. Wired to an input of the drive with function -15.
    std::string watchdog_output;
    UnsupervisedLine unsupervised_line = UnsupervisedLine::refused;
};

struct SerialLineConfig {
    std::string name;
    std::string device;  ///< "/dev/ttyUSB0"; empty: simulated
    modbus::LineSettings settings;
    std::vector<SerialDriveConfig> drives;
};

}  // namespace taktwerk::runtime
