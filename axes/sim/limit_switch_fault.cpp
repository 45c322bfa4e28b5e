#include "axes/sim/limit_switch_fault.hpp"

namespace taktwerk::axes::sim {

LimitSwitchFault::LimitSwitchFault(const DriveProfile& profile)
    : is_one_(profile.has(Quirk::limit_stop_is_fault)),
      negative_(first_alarm(profile, DriveAlarmKind::negative_limit, {0x5444})),
      positive_(first_alarm(profile, DriveAlarmKind::positive_limit, {0x5443})) {}

void LimitSwitchFault::watch(const AxisInputs& in, const PositionTargets& targets, Cia402Axis& axis) noexcept {
    if (!is_one_) return;
    const bool negative = axis.plant().negative_limit(), positive = axis.plant().positive_limit();
    const bool of_position = in.mode == mode::cyclic_position || in.mode == mode::profile_position;
    if (axis.state() == Cia402Axis::State::enabled && of_position) {
        const bool cyclic = in.mode == mode::cyclic_position && targets.following();
        if (positive && (!at_positive_ || (cyclic && in.target_position > targets.demand()))) axis.raise(positive_);
        else if (negative && (!at_negative_ || (cyclic && in.target_position < targets.demand()))) axis.raise(negative_);
    }
    at_negative_ = negative;
    at_positive_ = positive;
}

}  // namespace taktwerk::axes::sim
