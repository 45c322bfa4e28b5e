// From motion to rest: what moves already is planned from where it is and how it moves.

#include <cstdio>

#include "axes/planner/plan.hpp"

using namespace taktwerk::axes;

int main() {
    const MotionLimits limits{.velocity = 100, .acceleration = 1000, .deceleration = 1000, .jerk = 10000};
    const MotionState now{.position = 0, .velocity = 100, .acceleration = 0};

    std::printf("stops within %.3f mm\n", stopping_distance(now, limits));

    const Plan beyond = plan_to_position(now, 30, limits);
    std::printf("to 30 mm: %.3f s\n", beyond.profile.duration());

    const Plan nearer = plan_to_position(now, 5, limits);  // cannot stop there any more: passes it and comes back
    std::printf("to 5 mm: passes it %s, ends at %.3f mm with %.3f mm/s\n", nearer.profile.top_velocity(-1) > 0 ? "and comes back" : "never",
                nearer.profile.end().position, nearer.profile.end().velocity);
}
