#include "axes/port/alarm_words.hpp"

#include <vector>

#include <fmt/format.h>

namespace taktwerk::axes {

namespace {

/// The code, and the detail where the code alone does not tell: so an alarm whose code says all has the same words before and after its
/// detail is read.
std::string number_of(const DriveProfile& profile, const ShownAlarm& alarm) {
    if (alarm.detail.value_or(0) == 0) return fmt::format("{:04X}h", alarm.code);
    const auto* row = find_alarm(profile, {alarm.code, std::nullopt, alarm.as}).row;
    if (row && row->detail == *alarm.detail) return fmt::format("{:04X}h", alarm.code);
    return fmt::format("{:04X}h/{:X}h", alarm.code, *alarm.detail);
}

/// "E.011, E.012 or E.013"; "E.018, E.411, E.412 or 4 others".
std::string listed(const std::vector<std::string_view>& panels, std::string_view last, std::string_view others) {
    constexpr std::size_t most = 5;
    const auto shown = panels.size() <= most ? panels.size() : most - 2;
    std::string out;
    for (std::size_t i = 0; i < shown; ++i) {
        if (i > 0) out += i + 1 == panels.size() ? last : ", ";
        out += panels[i];
    }
    if (shown < panels.size()) out += fmt::format("{}{}{}", last, panels.size() - shown, others);
    return out;
}

/// At the machine first: whoever reads an alarm mostly stands there, and has no program before him.
std::string reset_it(std::string_view command) { return fmt::format("press reset or `{}`, in a program MC_Reset", command); }

constexpr std::string_view switch_off_and_on = "switch the drive off and on", cause_gone = "once its cause is gone: ";

std::string after_switching(std::string_view command) {
    return fmt::format("no reset clears it: {}, then {}", switch_off_and_on, reset_it(command));
}

void name(AlarmWords& out, const DriveAlarmText& row, std::string_view command) {
    if (!row.panel.empty()) {
        out.english += fmt::format(", panel {}", row.panel);
        out.chinese += fmt::format(",面板 {}", row.panel);
    }
    out.english += ": " + row.english;
    out.chinese += ":" + row.chinese;
    if (row.whole_drive) {
        out.english += " (all axes of the drive)";
        out.chinese += "(该驱动器的所有轴)";
    }
    out.cause = row.cause;
    out.remedy = row.remedy;
    out.section = row.section;
    out.reset = cleared_by(row, command);
}

void name_all(AlarmWords& out, const DriveProfile& profile, const ShownAlarm& alarm, std::string_view command) {
    std::vector<std::string_view> panels;
    bool any = false, all = true;
    for_each_candidate(profile, alarm, [&](const DriveAlarmText& row) {
        panels.push_back(row.panel);
        any = any || row.resettable || row.warning;
        all = all && (row.resettable || row.warning);
    });
    out.english += ", panel " + listed(panels, " or ", " others");
    out.chinese += ",面板 " + listed(panels, " 或 ", " 个其他");
    if (!any) out.reset = after_switching(command);
    else out.reset = fmt::format("{}{}{}", cause_gone, reset_it(command), all ? "" : "; if it stays, " + std::string(switch_off_and_on));
}

}  // namespace

std::string cleared_by(const DriveAlarmText& alarm, std::string_view command) {
    if (alarm.warning) return "goes with its cause";
    if (alarm.clears_itself) return "the drive clears it with its cause; then the axis: " + reset_it(command);
    return alarm.resettable ? std::string(cause_gone) + reset_it(command) : after_switching(command);
}

AlarmWords words(const DriveProfile& profile, const ShownAlarm& alarm, std::string_view command) {
    AlarmWords out;
    if (alarm.code == 0) {  // some drives show the fault first
        out.english = "without a number";
        out.chinese = "无代码";
        out.reset = "to try: " + reset_it(command);
        return out;
    }
    out.english = out.chinese = number_of(profile, alarm);
    const auto found = find_alarm(profile, alarm);
    if (found.row) {
        name(out, *found.row, command);
    } else if (found.candidates > 0) {
        name_all(out, profile, alarm, command);
    } else {
        out.english += ", not in the drive's alarm list";
        out.chinese += ",不在驱动器报警表中";
        out.reset = fmt::format("to try: {}; the drive's list does not name this number", reset_it(command));
    }
    if (alarm.as == ShownAlarm::As::warning) out.reset = "goes with its cause";
    return out;
}

}  // namespace taktwerk::axes
