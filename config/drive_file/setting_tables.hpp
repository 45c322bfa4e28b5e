#pragma once
// The keys of a drive file about objects that change the drive's behaviour: `required_settings`, `units`, `behaviour`
// (axes/port/drive_setting.hpp).

#include "axes/port/drive_setting.hpp"
#include "config/reading/field_table.hpp"

namespace taktwerk::config {

/// An object, or a register by its number.
[[nodiscard]] Codec<axes::ParameterAddress> parameter_address();
[[nodiscard]] Table<axes::RequiredSetting> required_setting_table();
[[nodiscard]] Table<axes::DriveUnits> units_table();
[[nodiscard]] Table<axes::ScaleObjects> scale_table();
[[nodiscard]] Table<axes::BehaviourObjects> behaviour_table();

}  // namespace taktwerk::config
