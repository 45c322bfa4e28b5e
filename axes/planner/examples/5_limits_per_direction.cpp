// Limits that differ by direction: a lift that falls faster than it climbs.

#include <cstdio>
#include <limits>

#include "axes/planner/plan.hpp"

using namespace taktwerk::axes;

int main() {
    constexpr double no_limit = std::numeric_limits<double>::infinity();
    // What points up: climbing at 100 mm/s, 500 mm/s2 from the motor, also to brake what falls. What points down has gravity's help.
    const SignLimits up{.velocity = 100, .speeding_up = 500, .slowing_down = 500, .jerk = no_limit};
    const SignLimits down{.velocity = 200, .speeding_up = 2000, .slowing_down = 2000, .jerk = no_limit};
    const SignedLimits limits{up, down};

    std::printf("up:   %.3f s\n", plan_to_position({}, 100, limits).profile.duration());
    std::printf("down: %.3f s\n", plan_to_position({}, -100, limits).profile.duration());
}
