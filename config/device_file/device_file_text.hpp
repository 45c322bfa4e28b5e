#pragma once
// A device file as it is written: the other direction of load_device(). Not real-time.

#include <string>

#include "config/device_file/device_file_tables.hpp"

namespace taktwerk::config {

/// YAML that load_device() reads as the same device. `heading` stands above it as a comment.
[[nodiscard]] std::string device_file_text(const DeviceFile& file, const std::string& heading);

/// A text as a double-quoted YAML scalar; control characters are left out.
[[nodiscard]] std::string quoted_yaml(const std::string& text);

}  // namespace taktwerk::config
