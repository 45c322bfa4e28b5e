#pragma once
// What a simulated drive shows of its alarms: the one that stands, the axis' own behind one of the whole drive, warnings, and those of the past.
// Which of them stops the motor, and what ends it, is the axis' business.

#include <cstdint>

#include "axes/sim/alarm_history.hpp"
#include "axes/sim/drive_alarm_codes.hpp"
#include "axes/sim/warning_list.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::sim {

class AlarmDisplay {
public:
    /// Nothing is shown; warnings stay until the drive has started.
    void power_on() noexcept;
    void start(Instant now) noexcept;

    /// 603Fh and what tells it apart; code 0: none.
    [[nodiscard]] std::uint16_t code() const noexcept { return shown_.code; }
    [[nodiscard]] const AlarmCode& shown() const noexcept { return shown_; }
    [[nodiscard]] bool shows(const AlarmCode& alarm) const noexcept { return shown_.code == alarm.code && shown_.detail == alarm.detail; }
    [[nodiscard]] bool stands() const noexcept { return shown_.code != 0 || warnings_.any(); }
    /// Status word bit 7, as far as a warning is shown.
    [[nodiscard]] bool warns() const noexcept { return warning_ || warnings_.any(); }
    /// 603Fh with the warnings of causes, and with `battery` where it is not null.
    [[nodiscard]] AlarmCode answer(const AlarmCode* battery) const noexcept;

    /// A fault, at `speed` counts/s.
    void show(const AlarmCode& alarm, Instant now, double speed) noexcept;
    /// A warning of what the drive does just now; the next thing it does ends it.
    void warn(const AlarmCode& alarm) noexcept;
    void end_warning() noexcept;
    /// The same at a limit switch in CSP, anew with each target.
    void warn_at_limit(std::uint16_t code) noexcept;
    void leave_limit() noexcept { shown_.code = 0; }
    void lower_warning() noexcept { warning_ = false; }

    /// The alarm of a cause that lasts; it ends with it.
    void set_warning(const AlarmCode& alarm, Instant now, double speed) noexcept;
    void clear_warning(const AlarmCode& alarm) noexcept { warnings_.clear(alarm); }

    /// In a fault an alarm of the whole drive goes before the axis' own, which shows again once the other is reset (TSVM 7.1).
    void cover(const AlarmCode& alarm) noexcept;
    /// The fault shown is the whole drive's.
    void belongs_to_all() noexcept { common_ = true; }
    /// The fault shown was reset. True: the axis' own stood behind it and is shown now.
    bool clear_fault() noexcept;

    [[nodiscard]] const AlarmHistory& history() const noexcept { return history_; }

private:
    void remember(const AlarmCode& alarm, Instant now, double speed) noexcept;

    AlarmCode shown_, hidden_;  ///< code 0: none
    bool warning_ = false;
    bool common_ = false;  ///< the alarm shown is the whole drive's
    WarningList warnings_;
    AlarmHistory history_;
    Instant started_{};
};

}  // namespace taktwerk::axes::sim
