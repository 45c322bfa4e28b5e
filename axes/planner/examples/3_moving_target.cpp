// To a target that moves: arriving with its velocity, and catching up with it.

#include <cstdio>

#include "axes/planner/plan.hpp"

using namespace taktwerk::axes;

int main() {
    const MotionLimits limits{.velocity = 100, .acceleration = 1000, .deceleration = 1000, .jerk = 10000};

    // Passes 100 mm at 50 mm/s, and as soon as can be.
    const Plan passing = plan_to_state({}, {.position = 100, .velocity = 50, .acceleration = 0}, limits);
    std::printf("passes 100 mm at %.0f mm/s after %.3f s\n", passing.profile.end().velocity, passing.profile.duration());

    // A product on a belt at 50 mm/s, 100 mm ahead now. Seen from the belt it rests, and who stands beside the belt moves at -50 mm/s;
    // the velocities that are allowed are less by 50 mm/s one way and more the other way.
    constexpr double belt = 50, ahead = 100;
    SignedLimits seen_from_belt{limits};
    seen_from_belt.positive.velocity -= belt;
    seen_from_belt.negative.velocity += belt;
    const Plan chase = plan_to_position({.position = -ahead, .velocity = -belt, .acceleration = 0}, 0, seen_from_belt);
    const double time = chase.profile.duration();
    std::printf("on the product after %.3f s, at %.2f mm\n", time, ahead + belt * time);
}
