#pragma once
// A drive's alarm as a person reads it, in the words of its manual: on the machine's log, on the monitor, over LCM and from
// `taktwerk drive alarms`. Not real-time.

#include <string>
#include <string_view>

#include "axes/port/find_alarm.hpp"

namespace taktwerk::axes {

struct AlarmWords {
    /// Number, what the panel shows, name: "7500h/13h, panel E.013: internal interrupt timeout", without the detail where the code says all.
    /// As long as it can be several alarms: "7500h, panel E.011, E.012 or E.013"; not listed: "1234h, not in the drive's alarm list".
    std::string english, chinese;
    std::string cause, remedy;  ///< empty where it is not known which alarm it is, or the manual says nothing
    std::string section;        ///< of the manual; empty where it is not known which alarm it is, or nobody noted it
    std::string reset;          ///< what a person does to clear it, and the block for a program
};
/// `command`: what the operator types to reset this axis or drive, such as "taktwerk reset x".
[[nodiscard]] AlarmWords words(const DriveProfile& profile, const ShownAlarm& alarm, std::string_view command);

/// What clears an alarm of the table, as a sentence.
[[nodiscard]] std::string cleared_by(const DriveAlarmText& alarm, std::string_view command);

}  // namespace taktwerk::axes
