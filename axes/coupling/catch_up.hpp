#pragma once
// How the slave of a gear comes to its master's velocity, before it is in gear: distance does not count yet. Real-time safe.
//
// Planned anew in each cycle, from the velocity and acceleration that the slave has, to where the gear's velocity will be if it goes on as it
// does; but it counts on nothing that the master cannot mean:
//   * a master that brakes comes to rest; beyond that nothing is foreseen
//   * the slave never has more acceleration against its velocity than its jerk can take away before the velocity is 0, nor more with it than
//     can be taken away before the limit
//   * a measured master that stops seems to turn round for a moment, because its filter's place goes too far: its trend tells
// An acceleration that the master gave up itself the slave may give up with it, at once, where that keeps it from passing the master.

#include "axes/coupling/demand_unrest.hpp"
#include "axes/coupling/follower_limits.hpp"

namespace taktwerk::axes {

class CatchUp {
public:
    void begin() noexcept { unrest_.forget(); }

    struct Step {
        MotionState state;    ///< on its way
        bool caught = false;  ///< instead, the slave may go over to velocity and acceleration of the gear in this cycle, at `place`
        double place = 0;
        bool held_back = false;  ///< the limits do not allow what the gear asks for
    };
    /// `before`: the slave one period [s] ago.
    [[nodiscard]] Step next(const MotionState& before, const GearDemand& gear, const FollowerLimits& limits, double period) noexcept;

private:
    DemandUnrest unrest_;
};

}  // namespace taktwerk::axes
