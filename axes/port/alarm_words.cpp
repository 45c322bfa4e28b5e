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

void name(AlarmWords& out, const DriveAlarmText& row) {
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
    out.reset = cleared_by(row);
}

void name_all(AlarmWords& out, const DriveProfile& profile, const ShownAlarm& alarm) {
    std::vector<std::string_view> panels;
    bool any = false, all = true;
    for_each_candidate(profile, alarm, [&](const DriveAlarmText& row) {
        panels.push_back(row.panel);
        any = any || row.resettable || row.warning;
        all = all && (row.resettable || row.warning);
    });
    out.english += ", panel " + listed(panels, " or ", " others");
    out.chinese += ",面板 " + listed(panels, " 或 ", " 个其他");
    out.reset = all   ? "MC_Reset clears it once its cause is gone"
                : any ? "MC_Reset clears some of these, others only switching the drive off and on"
                      : "MC_Reset cannot clear it: switch the drive off and on";
}

}  // namespace

std::string_view cleared_by(const DriveAlarmText& alarm) noexcept {
    if (alarm.warning) return "goes with its cause";
    if (alarm.clears_itself) return "the drive clears it with its cause, MC_Reset then the axis";
    return alarm.resettable ? "MC_Reset clears it once its cause is gone" : "MC_Reset cannot clear it: switch the drive off and on";
}

AlarmWords words(const DriveProfile& profile, const ShownAlarm& alarm) {
    AlarmWords out;
    if (alarm.code == 0) {  // some drives show the fault first
        out.english = "without a number";
        out.chinese = "无代码";
        out.reset = "MC_Reset tries to clear it";
        return out;
    }
    out.english = out.chinese = number_of(profile, alarm);
    const auto found = find_alarm(profile, alarm);
    if (found.row) {
        name(out, *found.row);
    } else if (found.candidates > 0) {
        name_all(out, profile, alarm);
    } else {
        out.english += ", not in the drive's alarm list";
        out.chinese += ",不在驱动器报警表中";
        out.reset = "MC_Reset tries to clear it; the drive's list does not name this number";
    }
    if (alarm.as == ShownAlarm::As::warning) out.reset = "goes with its cause";
    return out;
}

}  // namespace taktwerk::axes
