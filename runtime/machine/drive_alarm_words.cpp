#include "runtime/machine/drive_alarm_words.hpp"

#include <string>

#include <fmt/format.h>

#include "axes/port/alarm_words.hpp"

namespace taktwerk::runtime {

namespace {

std::string drive_of(const AxisBinding& axis) {
    const auto& name = axis.slave.empty() ? axis.drive : axis.slave;
    return name.empty() ? axis.profile->name : fmt::format("{} '{}'", axis.profile->name, name);
}

}  // namespace

void tell_drive_alarm(AlarmText& text, const AxisBinding& axis, const axes::ShownAlarm& alarm) {
    if (!axis.profile) return;
    const auto drive = drive_of(axis);
    const bool warning = alarm.as == axes::ShownAlarm::As::warning;
    auto words = axes::words(*axis.profile, alarm, "taktwerk reset " + axis.axis.name);
    text.english = fmt::format("{} reports {} {}", drive, warning ? "warning" : "fault", words.english);
    text.chinese = fmt::format("{} 报告{} {}", drive, warning ? "警告" : "故障", words.chinese);
    if (!words.cause.empty()) text.cause = std::move(words.cause);
    if (!words.remedy.empty()) text.remedy = std::move(words.remedy);
    text.reset = std::move(words.reset);
    if (!words.section.empty()) text.manual = fmt::format("{} {}", axis.profile->name, words.section);
}

}  // namespace taktwerk::runtime
