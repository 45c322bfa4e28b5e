#include "axes/sim/alarm_display.hpp"

namespace taktwerk::axes::sim {

void AlarmDisplay::power_on() noexcept {
    shown_ = hidden_ = {};
    common_ = false;
}

void AlarmDisplay::start(Instant now) noexcept {
    warnings_.clear();
    started_ = now;
}

AlarmCode AlarmDisplay::answer(const AlarmCode* battery) const noexcept {
    if (shown_.code != 0) return shown_;
    if (warnings_.any()) return warnings_.shown();
    return battery != nullptr ? *battery : shown_;
}

void AlarmDisplay::show(const AlarmCode& alarm, Instant now, double speed) noexcept {
    shown_ = alarm;
    remember(alarm, now, speed);
}

void AlarmDisplay::warn(const AlarmCode& alarm) noexcept {
    warning_ = true;
    shown_.code = alarm.code;
    shown_.detail = alarm.detail;
}

void AlarmDisplay::end_warning() noexcept {
    if (!warning_) return;
    warning_ = false;
    shown_.code = 0;
    shown_.detail = 0;
}

void AlarmDisplay::warn_at_limit(std::uint16_t code) noexcept {
    warning_ = true;
    shown_.code = code;
}

void AlarmDisplay::set_warning(const AlarmCode& alarm, Instant now, double speed) noexcept {
    if (warnings_.set(alarm)) remember(alarm, now, speed);
}

void AlarmDisplay::cover(const AlarmCode& alarm) noexcept {
    if (common_) return;  // the first one is the one shown
    if (!shows(alarm)) {  // else it found it out by itself
        hidden_ = shown_;
        shown_ = alarm;
    }
    common_ = true;
}

bool AlarmDisplay::clear_fault() noexcept {
    shown_.code = 0;
    shown_.detail = 0;
    common_ = false;
    if (hidden_.code == 0) return false;
    shown_ = hidden_;
    hidden_ = {};
    return true;
}

void AlarmDisplay::remember(const AlarmCode& alarm, Instant now, double speed) noexcept {
    history_.remember({alarm.detail ? alarm.detail : alarm.code, now - started_, speed});
}

}  // namespace taktwerk::axes::sim
