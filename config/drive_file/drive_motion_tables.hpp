#pragma once
// The keys of a drive file that say what the drive means to an axis: modes, timing, ways of stopping, quirks.

#include "axes/port/drive_profile.hpp"
#include "config/reading/field_table.hpp"

namespace taktwerk::config {

[[nodiscard]] Codec<axes::DriveMode> drive_mode();
[[nodiscard]] Codec<axes::Quirk> quirk();
[[nodiscard]] Table<axes::DriveProfile> motion_table();
[[nodiscard]] Table<axes::StopOption> stop_option_table();

}  // namespace taktwerk::config
