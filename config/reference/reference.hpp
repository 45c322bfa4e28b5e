#pragma once
// What the field tables give besides the loader: JSON Schemas for editors and the reference page for people. The committed
// files are compared with this in tests/config; TAKTWERK_REGENERATE=1 in its environment makes that test write them.

#include <string>

namespace taktwerk::config {

[[nodiscard]] std::string machine_schema();  ///< config/schema/machine.schema.json
[[nodiscard]] std::string drive_schema();    ///< config/schema/drive.schema.json
[[nodiscard]] std::string device_schema();   ///< config/schema/device.schema.json
[[nodiscard]] std::string reference_page();  ///< docs/configuration.md

}  // namespace taktwerk::config
