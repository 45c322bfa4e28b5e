// In a given time: no faster than it has to be.

#include <cstdio>

#include "axes/planner/plan.hpp"

using namespace taktwerk::axes;

int main() {
    const MotionLimits limits{.velocity = 100, .acceleration = 1000, .deceleration = 1000, .jerk = 10000};
    const MotionState target{.position = 100, .velocity = 0, .acceleration = 0};

    const Plan calm = plan_in_time({}, target, 4.1, limits);
    std::printf("%.3f s at %.3f mm/s\n", calm.profile.duration(), calm.profile.max_speed());

    const Plan hasty = plan_in_time({}, target, 1.1, limits);  // the fastest takes 1.2 s
    std::printf("in 1.1 s: %s\n", hasty.error == PlanError::no_solution ? "no solution" : "a solution");
}
