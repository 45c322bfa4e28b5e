// A stop with any ramp out of any state of a run: it is planned, keeps every limit (the rig looks in each cycle) and stands.

#include <random>

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

TEST(GroupStopAnywhere, StandsAndKeepsEveryLimit) {
    std::mt19937_64 random(5);
    const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
    for (int run = 0; run < 12; ++run) {
        GroupRig rig(3, cartesian_arm());
        rig.enable();
        const double size = std::exp(draw(std::log(2.), std::log(60.)));
        const auto rounded = [&](const JointVector& to, MC_BufferMode mode) {
            auto command = line(to, draw(20, 100), mode);
            command.frame = mcMCS;
            command.transition = mcTMCornerDistance;
            command.transition_parameter = size / 3;
            return command;
        };
        rig.step([&] {
            (void)rig.submit(rounded({size, 0, 0}, mcAborting));
            if (run % 3 == 0) return;
            (void)rig.submit(rounded({size, size, 0}, mcBlendingHigh));
            (void)rig.submit(rounded({0, size, 0}, mcBlendingLow));
        });
        rig.run(static_cast<int>(draw(5, 60 + size * 20)));
        if (rig.view().state != GroupState::GroupMoving) continue;
        const double deceleration = std::exp(draw(std::log(100.), std::log(1000.)));
        const double jerk = std::exp(draw(std::log(1500.), std::log(10000.)));
        (void)rig.give(simply(GroupCommandKind::stop, {.deceleration = deceleration, .jerk = jerk}));
        EXPECT_TRUE(rig.until([&] { return rig.view().path_velocity == 0; }, 20000)) << run;
    }
}

}  // namespace
}  // namespace taktwerk::axes::test
