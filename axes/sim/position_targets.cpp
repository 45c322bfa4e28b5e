#include "axes/sim/position_targets.hpp"

namespace taktwerk::axes::sim {

void PositionTargets::power_on(ecat::sim::ObjectDictionary& dictionary) {
    absolute_.power_on(dictionary);
    lost_cycles_.power_on(dictionary);
    following_ = false;
}

void PositionTargets::obey(AxisInputs& in, const Cia402Axis& axis, const CommunicationWatch& communication) noexcept {
    if (!absolute_.present() && !lost_cycles_.present()) return;
    const bool follows = axis.state() == Cia402Axis::State::enabled && in.mode == mode::cyclic_position;
    const bool increments = absolute_.present() && absolute_.get() == 0;
    if (!follows) {
        following_ = false;
        return;
    }
    if (!following_) {
        following_ = true;
        increments_ = demand_;
        targets_.restart(increments ? increments_ : in.target_position);
    }
    const bool fresh = communication.fresh(), sync0 = communication.sync0();
    if (increments) {
        if (fresh) increments_ += in.target_position;
        in.target_position = increments_;
    }
    // Without SYNC0 there is a cycle only where there are data.
    in.target_position = targets_.target(in.target_position, fresh || !sync0, sync0 ? lost_cycles_.get() : 0);
}

}  // namespace taktwerk::axes::sim
