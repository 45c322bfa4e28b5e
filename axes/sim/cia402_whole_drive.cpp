// Alarms that stand above those of one axis: of the whole drive, and that the master left OP.

#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

void Cia402Axis::raise_common(const AlarmCode& alarm) noexcept {
    const bool faulted = state_ == State::fault || state_ == State::fault_reaction;
    if (faulted && common_alarm_) return;  // the first one is the one shown
    if (faulted && shows(alarm)) {         // it found it out by itself
        common_alarm_ = true;
        return;
    }
    if (faulted) {
        hidden_alarm_ = {error_code_, error_resettable_, error_detail_};
        error_code_ = alarm.code;
        error_detail_ = alarm.detail;
        error_resettable_ = alarm.resettable;
    } else {
        raise(alarm);
    }
    common_alarm_ = true;
}

/// The alarm shown was reset. True: the axis' own stood behind it and is shown now.
bool Cia402Axis::uncover_alarm() noexcept {
    common_alarm_ = false;
    if (hidden_alarm_.code == 0) return false;
    error_code_ = hidden_alarm_.code;
    error_detail_ = hidden_alarm_.detail;
    error_resettable_ = hidden_alarm_.resettable;
    hidden_alarm_ = {};
    return true;
}

void Cia402Axis::left_operational() noexcept {
    const bool powered = state_ == State::enabled || state_ == State::quick_stop;
    if (powered && codes_[DriveAlarmKind::left_operational].code) raise(codes_[DriveAlarmKind::left_operational]);
    communication_lost();
}

}  // namespace taktwerk::axes::sim
