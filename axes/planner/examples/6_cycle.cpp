// In a cycle: planned when something changes, sampled in between. The next plan begins in the state that the last one is in, so nothing jumps.

#include <cstdio>

#include "axes/planner/plan.hpp"

using namespace taktwerk::axes;

int main() {
    const MotionLimits limits{.velocity = 100, .acceleration = 1000, .deceleration = 1000, .jerk = 10000};
    constexpr double period = 0.001;

    Plan plan = plan_to_position({}, 100, limits);
    int since = 0, piece = 0;  // cycles since the plan was made; where in it the last sample was found
    for (int cycle = 0; cycle <= 600; ++cycle, ++since) {
        auto sample = plan.profile.sample(since * period, piece);
        piece = sample.piece;
        if (cycle == 300) {  // another target, on the way: nearer
            plan = plan_to_position(sample.state, 40, limits);
            since = piece = 0;
        }
        if (cycle % 100 == 0) std::printf("%.1f s: %7.3f mm %7.3f mm/s\n", cycle * period, sample.state.position, sample.state.velocity);
    }
}
