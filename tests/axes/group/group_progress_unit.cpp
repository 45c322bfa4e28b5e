// How far a command is said to be: never back, also where a curve cuts its end off; and the velocity along the path is that of the tool's point.

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

struct CornerCase {
    MC_TransitionMode mode;
    double parameter;
};

// G-027
TEST(GroupProgress, NeverGoesBackThroughRoundedCorners) {
    for (const auto& one : {CornerCase{mcTMNone, 0}, CornerCase{mcTMCornerDistance, 3}, CornerCase{mcTMCornerDistance, 15},
                            CornerCase{mcTMMaxCornerDeviation, 1}, CornerCase{mcTMStartVelocity, 1}}) {
        GroupRig rig(3, cartesian_arm());
        rig.enable();
        std::vector<CommandId> ids;
        rig.step([&] {
            for (const JointVector& to : {JointVector{40, 0, 0}, {40, 30, 0}, {10, 30, 0}, {10, 30, 20}}) {
                auto command = line(to, 60, mcBlendingHigh);
                command.frame = mcMCS;
                command.transition = one.mode;
                command.transition_parameter = one.parameter;
                ids.push_back(rig.submit(command).id);
            }
        });
        CommandId active = 0;
        double progress = 0, left = 0;
        std::vector<double> first(ids.back() + 1, -1), last(ids.back() + 1, -1);
        const auto done = [&] {
            const auto& v = rig.view();
            if (v.active != 0 && v.state == GroupState::GroupMoving) {
                EXPECT_GE(v.progress, 0);
                EXPECT_LE(v.progress, 1);
                if (v.active == active) {
                    EXPECT_GE(v.progress, progress - 1e-12) << "command " << active;
                    if (left > 0) {
                        EXPECT_LE(v.remaining_distance, left + 1e-12) << "command " << active;
                    }
                } else if (v.path_velocity > 0) {
                    first[v.active] = v.progress;
                }
                if (v.path_velocity > 0) last[v.active] = v.progress;
                active = v.path_velocity > 0 ? v.active : 0;
                progress = v.progress;
                left = v.remaining_distance;
                const auto& tool = v.tool_velocity;
                EXPECT_NEAR(std::hypot(tool[0], tool[1], tool[2]), v.path_velocity, 1e-9 * 60);
            }
            return rig.status(ids.back()) == CommandStatus::done;
        };
        ASSERT_TRUE(rig.until(done, 20000)) << static_cast<int>(one.mode);
        // By half of each corner: what a curve of 15 u leaves out of 30 u is little.
        for (const auto id : ids) {
            EXPECT_GE(first[id], 0) << id;
            EXPECT_LE(first[id], 0.15) << id;
            EXPECT_GE(last[id], 0.6) << id;
        }
        EXPECT_GE(last[ids.back()], 0.999);
    }
}

}  // namespace
}  // namespace taktwerk::axes::test
