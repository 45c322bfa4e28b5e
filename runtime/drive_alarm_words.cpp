#include "runtime/drive_alarm_words.hpp"

#include <string>

#include <fmt/format.h>

namespace taktwerk::runtime {

namespace {

const axes::DriveAlarmText* find_row(const axes::DriveProfile& profile, const ReportedAlarm& alarm) {
    const axes::DriveAlarmText* found = nullptr;
    for (const auto& row : profile.alarms) {
        if (row.code != alarm.code) continue;
        if (row.detail == alarm.detail) return &row;
        if (!found) found = &row;
    }
    return found;
}

std::string number_of(const ReportedAlarm& alarm) {
    return alarm.detail == 0 ? fmt::format("{:04X}h", alarm.code) : fmt::format("{:04X}h/{:X}h", alarm.code, alarm.detail);
}

std::string drive_of(const AxisBinding& axis) {
    return axis.slave.empty() ? axis.profile->name : fmt::format("{} '{}'", axis.profile->name, axis.slave);
}

std::string reset_of(const ReportedAlarm& alarm, const axes::DriveAlarmText* row) {
    if (alarm.kind == ReportedAlarm::Kind::warning) return "goes with its cause";
    if (!row) return "MC_Reset tries to clear it; the drive's list does not name this number";
    return row->resettable ? "MC_Reset clears it once its cause is gone" : "MC_Reset cannot clear it: switch the drive off and on";
}

}  // namespace

void tell_drive_alarm(AlarmText& text, const AxisBinding& axis, const ReportedAlarm& alarm) {
    if (!axis.profile) return;
    const auto* row = find_row(*axis.profile, alarm);
    const bool fault = alarm.kind == ReportedAlarm::Kind::fault;
    const auto drive = drive_of(axis), number = number_of(alarm);
    text.english = fmt::format("{} reports {} {}", drive, fault ? "fault" : "warning", number);
    text.chinese = fmt::format("{} 报告{} {}", drive, fault ? "故障" : "警告", number);
    text.reset = reset_of(alarm, row);
    if (!row) return;
    if (!row->panel.empty()) {
        text.english += fmt::format(", panel {}", row->panel);
        text.chinese += fmt::format(",面板 {}", row->panel);
    }
    text.english += ": " + row->english;
    text.chinese += ":" + row->chinese;
    if (row->whole_drive) {
        text.english += " (all axes of the drive)";
        text.chinese += "(该驱动器的所有轴)";
    }
    if (!row->cause.empty()) text.cause = row->cause;
    if (!row->remedy.empty()) text.remedy = row->remedy;
}

}  // namespace taktwerk::runtime
