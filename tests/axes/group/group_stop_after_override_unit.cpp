// A stop right behind an override that was lowered: who goes slower does not stop later.

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

// The tool is accelerating when both come: what is left of its acceleration takes it above the lowered velocity, which is no bound for a stop. In front of a corner a lowered
// override is another motion (two of 90 such stops, of which this looks at a part, take 1.5 times the way). G-063, G-070.
TEST(GroupStopAfterOverride, IsNoLongerThanWithoutIt) {
    int looked = 0;
    for (const bool corner : {false, true})
        for (int cycle = 80; cycle < 300; cycle += 30)
            for (const int before : {4, 27}) {
                const StoppedAfterOverride without = stopped_after_override(cycle, 0, corner),
                                           with = stopped_after_override(cycle, before, corner);
                EXPECT_LE(with.way, (corner ? 1.6 : 1.1) * without.way + 0.5)
                    << "corner " << corner << ", stop in cycle " << cycle << ", lowered " << before << " before: " << with.cycles
                    << " cycles instead of " << without.cycles;
                ++looked;
            }
    EXPECT_EQ(looked, 32);
}

}  // namespace
}  // namespace taktwerk::axes::test
