// Alarms with a cause outside of the drive: somebody opens the STO circuit, a battery is empty, a parameter waits for a restart.
// The cause lasts until it is released; a fault can be reset only without it, a warning goes with it (SV33-E 5.2, 5.3, 5.6).

#include <algorithm>

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

bool Cia402Axis::provoke(std::string_view panel) noexcept {
    const auto& rows = profile_->alarms;
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const DriveAlarmText& r) { return r.panel == panel; });
    if (row == rows.end()) return false;
    begin_cause(static_cast<std::size_t>(row - rows.begin()));
    return true;
}

void Cia402Axis::release(std::string_view panel) noexcept {
    for (std::size_t i = 0; i < causes_.size(); ++i)
        if (profile_->alarms[i].panel == panel) end_cause(i);
}

void Cia402Axis::cause(DriveAlarmKind kind, bool present) noexcept {
    for (std::size_t i = 0; i < causes_.size(); ++i) {
        if (profile_->alarms[i].kind != kind) continue;
        if (!present && causes_[i]) end_cause(i);
        if (!present) continue;
        if (!causes_[i]) begin_cause(i);
        return;  // the first row of a kind is the drive's own
    }
}

void Cia402Axis::begin_cause(std::size_t i) noexcept {
    causes_[i] = true;
    if (state_ != State::not_ready) show_cause(profile_->alarms[i]);
}

void Cia402Axis::show_cause(const DriveAlarmText& row) noexcept {
    const AlarmCode alarm = alarm_code(row);
    if (row.warning) {
        alarms_.set_warning(alarm, now_, plant().velocity());
        return;
    }
    if (row.whole_drive) raise_common(alarm);
    else raise(alarm);
    // Safe torque off means what it says, whatever the drive does at other faults.
    if (row.kind == DriveAlarmKind::safe_torque_off && state_ == State::fault_reaction) enter(State::fault);
}

void Cia402Axis::end_cause(std::size_t i) noexcept {
    causes_[i] = false;
    const auto& row = profile_->alarms[i];
    if (row.warning) alarms_.clear_warning(alarm_code(row));
    else if (row.clears_itself && state_ == State::fault && alarms_.shows(alarm_code(row))) clear_fault();
}

void Cia402Axis::show_causes() noexcept {
    for (std::size_t i = 0; i < causes_.size(); ++i)
        if (causes_[i]) show_cause(profile_->alarms[i]);
}

bool Cia402Axis::cause_lasts() const noexcept {
    for (std::size_t i = 0; i < causes_.size(); ++i)
        if (causes_[i] && alarms_.shows(alarm_code(profile_->alarms[i]))) return true;
    if (origin_.battery_stops() && alarms_.shows(codes_[DriveAlarmKind::battery_low])) return true;
    return origin_.complains() || (!supply_.main_power && alarms_.code() == codes_[DriveAlarmKind::undervoltage].code);
}

void Cia402Axis::clear_fault() noexcept {
    if (!alarms_.clear_fault()) enter(State::disabled);
}

void Cia402Axis::reset_alarm() noexcept {
    if (state_ == State::fault && alarms_.shown().resettable && !cause_lasts()) clear_fault();
}

}  // namespace taktwerk::axes::sim
