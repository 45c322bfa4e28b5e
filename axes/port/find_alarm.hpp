#pragma once
// Which row of a drive's alarm table a drive means: by its code (603Fh), and by the further object (4000h, P21.08) where several alarms share
// a code. Whoever looks up an alarm of a drive does it here, so that the cycle, the machine's texts and the command line say the same.
// Real-time safe; linear in the table, which has at most a few hundred rows.

#include <cstddef>
#include <cstdint>
#include <optional>

#include "axes/port/drive_profile.hpp"

namespace taktwerk::axes {

/// An alarm as a drive shows it.
struct ShownAlarm {
    enum class As : std::uint8_t { unknown, fault, warning };
    std::uint16_t code = 0;               ///< 603Fh, or the drive's own number
    std::optional<std::uint32_t> detail;  ///< the further object; nothing: not read (yet), or the drive has none
    As as = As::unknown;                  ///< by the status word: one code may be both (SV33-E 3130h: fault E.217, warning A.222)
};

/// What the table says of it.
struct FoundAlarm {
    const DriveAlarmText* row = nullptr;          ///< nullptr: not listed, or one of several
    std::size_t candidates = 0;                   ///< rows that it can be: 1 with `row`, 0 when it is not listed
    bool resettable = true;                       ///< at least one of them is, or it is not listed: a reset is worth the attempt
    bool whole_drive = false;                     ///< at least one of them is
    DriveAlarmKind kind = DriveAlarmKind::other;  ///< of all of them; `other` where they differ
};

/// Calls `take` with each row that the alarm can be: the one with its code and detail; else, without a detail or with a code that only one
/// row has, those of the code that are of its sort (fault, warning) if there are any; else those of the code. A detail that no row has makes
/// an alarm that several rows could be an unlisted one, unless a row of that code has no detail.
template <typename Take>
void for_each_candidate(const DriveProfile& profile, const ShownAlarm& alarm, Take take) {
    const auto of_its_sort = [&](const DriveAlarmText& row) {
        return alarm.as == ShownAlarm::As::unknown || row.warning == (alarm.as == ShownAlarm::As::warning);
    };
    std::size_t of_code = 0, of_sort = 0, exact = 0;
    for (const auto& row : profile.alarms) {
        if (row.code != alarm.code) continue;
        ++of_code;
        if (of_its_sort(row)) ++of_sort;
        if (alarm.detail && row.detail == *alarm.detail) ++exact;
    }
    for (const auto& row : profile.alarms) {
        if (row.code != alarm.code) continue;
        const bool fits = exact > 0                     ? row.detail == *alarm.detail
                          : alarm.detail && of_code > 1 ? row.detail == 0
                                                        : of_sort == 0 || of_its_sort(row);
        if (fits) take(row);
    }
}

[[nodiscard]] inline FoundAlarm find_alarm(const DriveProfile& profile, const ShownAlarm& alarm) noexcept {
    FoundAlarm found;
    for_each_candidate(profile, alarm, [&](const DriveAlarmText& row) {
        const bool first = ++found.candidates == 1;
        found.row = first ? &row : nullptr;
        found.resettable = row.resettable || (!first && found.resettable);
        found.whole_drive = found.whole_drive || row.whole_drive;
        found.kind = first || found.kind == row.kind ? row.kind : DriveAlarmKind::other;
    });
    return found;
}

}  // namespace taktwerk::axes
