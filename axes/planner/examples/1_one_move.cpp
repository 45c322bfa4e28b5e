// From rest to rest: the fastest move within the limits.

#include <cstdio>

#include "axes/planner/plan.hpp"

using namespace taktwerk::axes;

int main() {
    const MotionLimits limits{.velocity = 100, .acceleration = 1000, .deceleration = 1000, .jerk = 10000};  // mm, s

    const Plan plan = plan_to_position({}, 100, limits);  // from rest at 0

    if (plan.error != PlanError::none) return 1;
    std::printf("%.3f s\n", plan.profile.duration());
    for (const double t : {0.0, 0.1, 0.2, 0.6, plan.profile.duration()}) {
        const MotionState state = plan.profile.at(t);
        std::printf("%.1f s: %7.3f mm %7.3f mm/s %6.0f mm/s2\n", t, state.position, state.velocity, state.acceleration);
    }
}
