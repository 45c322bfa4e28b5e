#pragma once
// The keys of drive files that warn people: alarms, where earlier ones are shown, hazards.

#include "axes/port/drive_hazard.hpp"
#include "axes/port/drive_profile.hpp"
#include "config/reading/field_table.hpp"

namespace taktwerk::config {

[[nodiscard]] Table<axes::DriveAlarmText> alarm_row_table();
[[nodiscard]] Table<axes::AlarmHistoryObjects> alarm_history_table();
[[nodiscard]] Table<axes::DriveHazard> hazard_table();

}  // namespace taktwerk::config
