#pragma once
// The command, and the machines that its tests use.

#include <filesystem>
#include <string>

namespace taktwerk::apps {

inline const std::string taktwerk = std::string(TAKTWERK_BINARY_DIR) + "/taktwerk";
inline const std::filesystem::path source = TAKTWERK_SOURCE_DIR;

/// SV33-E 'x_drive' and 'y_drive', SE-808X 'z_drive', terminal 'io'.
inline const std::string demo = std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/demo.yaml";
/// One of each.
inline const std::string five = std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/five-drives.yaml";
/// One axis on a serial line; no program.
inline const std::string serial_axis = std::string(TAKTWERK_SOURCE_DIR) + "/config/machines/serial-axis.yaml";

}  // namespace taktwerk::apps
