#pragma once
// A drive by Modbus RTU (XP200) on a serial line that this command drives itself: a port of this PC, or the simulated lines of a machine file.

#include <string>
#include <vector>

#include "apps/drive/access.hpp"

namespace taktwerk::apps {

/// --line says so, or the machine file has a drive of this name on a serial line.
[[nodiscard]] bool is_on_line(const DriveOptions& options);
/// Names of the drives on serial lines of the machine file; none where it cannot be read.
[[nodiscard]] std::vector<std::string> drives_on_lines(const DriveOptions& options);
/// Refuses while another program has the port. Forces nothing on and enables nothing: what would move the motor cannot be written, and storing
/// and resetting want it disabled.
int with_drive_over_line(const DriveOptions& options, const std::function<int(DriveAccess&)>& work);

/// A drive on a line of the machine file, or of --line, and how it answered when it was asked who it is.
struct LineDrive {
    std::string subject, says, profile;
};
/// The one that is meant, else all of the machine file. Error: the file, or a port, cannot be opened.
[[nodiscard]] Result<std::vector<LineDrive>> identify_on_lines(const DriveOptions& options);

}  // namespace taktwerk::apps
