// A stop right behind an override that was lowered: who goes slower does not stop later. G-063, G-070.

#include <algorithm>
#include <cstdio>

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr double stop_deceleration = 600, stop_jerk = 6000;

struct StoppedAfterOverride {
    double way = 0;
    int cycles = 0;
};

/// Lowered so many cycles before the stop, which comes in this cycle of a way of one line, or of two with a rounded corner. 0: not lowered.
StoppedAfterOverride stopped_after_override(int cycle, int before, bool corner) {
    GroupRig rig(3, cartesian_arm());
    rig.served_every = 5;
    rig.enable();
    const auto in_space = [](GroupCommand command) {
        command.frame = mcMCS;
        command.transition = mcTMCornerDistance;
        command.transition_parameter = 5;
        return command;
    };
    (void)rig.give(in_space(line({60, 20, 0}, 80)));
    if (corner) (void)rig.give(in_space(line({60, 60, 10}, 80, mcBlendingHigh)));
    for (int i = 0; i < cycle; ++i) {
        if (before > 0 && i == cycle - before) {
            EXPECT_EQ(rig.set(Override{.velocity = 0.7}), ErrorId::none);
        }
        rig.step();
    }
    const double gone = rig.view().path_gone;
    EXPECT_GT(rig.view().path_velocity, 10);
    (void)rig.give(simply(GroupCommandKind::stop, {.deceleration = stop_deceleration, .jerk = stop_jerk}));
    StoppedAfterOverride stop;
    for (; rig.view().path_velocity != 0 && stop.cycles < 5000; ++stop.cycles) rig.step();
    stop.way = rig.view().path_gone - gone;
    return stop;
}

// Disabled: 26.9 u in 609 ms instead of 16.3 u in 343 ms on the line, 28.5 u in 589 ms instead of 14.9 u in 311 ms with the corner. The tool is accelerating when both come: the
// velocity to which what is left of its acceleration takes it is above the lowered factor, under which the halt is planned too, and from ten borders none is found.
TEST(GroupStopAfterOverride, DISABLED_IsNoLongerThanWithoutIt) {
    int looked = 0;
    for (const bool corner : {false, true})
        for (int cycle = 80; cycle < 300; cycle += 15)
            for (const int before : {4, 12, 27}) {
                const StoppedAfterOverride without = stopped_after_override(cycle, 0, corner),
                                           with = stopped_after_override(cycle, before, corner);
                EXPECT_LE(with.way, 1.1 * without.way + 0.5) << "corner " << corner << ", stop in cycle " << cycle << ", lowered " << before
                                                             << " before: " << with.cycles << " cycles instead of " << without.cycles;
                ++looked;
            }
    EXPECT_EQ(looked, 90);
}

}  // namespace
}  // namespace taktwerk::axes::test
