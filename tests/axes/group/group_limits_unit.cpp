// Limits of members that somebody narrows while their group moves them, or while it is interrupted.

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

ErrorId write(GroupRig& rig, std::int32_t number, double value) { return rig.axes[0].set(WriteParameter{number, value}, Owner::program); }

struct Narrower {
    std::int32_t number;
    double value, wider;
};
constexpr std::array<Narrower, 6> of_a_member{{{velocity_of_application, 40, 100},
                                               {acceleration_of_application, 400, 1000},
                                               {deceleration_of_application, 400, 1000},
                                               {jerk_of_application, 4000, 10000},
                                               {software_limit_positive, 50, 5000},
                                               {software_limit_negative, -1, -5000}}};

std::vector<AxisConfig> limited() {
    std::vector<AxisConfig> configs{group_axis("x"), group_axis("y")};
    for (auto& config : configs) {
        config.homing.kind = HomingKind::set_here;
        config.limits.position_min = -5000;
        config.limits.position_max = 5000;
    }
    return configs;
}

void home(GroupRig& rig) {
    for (auto& axis : rig.axes) ASSERT_EQ(axis.submit({.kind = CommandKind::home}, Owner::program).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis(0).homed && rig.axis(1).homed; }, 200)) << "or software limits do not hold";
    rig.run(5);
}

// Before, the next set-point was refused by the axis, and the group fell to GroupErrorStop.
TEST(GroupLimits, AreNotNarrowedWhileTheGroupMoves) {
    GroupRig rig(limited());
    home(rig);
    rig.enable();
    const auto move = rig.give(line({100, 50}, 90));
    rig.run(400);
    ASSERT_GT(rig.axis(0).set_velocity, 50);
    for (const auto& one : of_a_member) {
        EXPECT_EQ(write(rig, one.number, one.value), ErrorId::axis_grouped) << one.number;
        rig.run(2);
    }
    EXPECT_EQ(write(rig, enable_lag_monitoring, 0), ErrorId::none) << "what is no limit of a path is written";
    // A wait between two moves, at rest: what is behind it may be planned already.
    const auto wait = rig.give({.kind = GroupCommandKind::wait, .buffer_mode = mcBuffered, .duration = 300ms});
    const auto next = rig.give(line({0, 0}, 90, mcBuffered));
    ASSERT_TRUE(rig.until([&] { return rig.status(wait.id) == CommandStatus::active; }, 3000));
    rig.run(20);
    ASSERT_EQ(rig.axis(0).set_velocity, 0);
    for (const auto& one : of_a_member) EXPECT_EQ(write(rig, one.number, one.value), ErrorId::axis_grouped) << one.number;
    ASSERT_TRUE(rig.until([&] { return rig.status(next.id) == CommandStatus::done; }, 4000));
    EXPECT_EQ(rig.status(move.id), CommandStatus::done);
    rig.run(3);
    ASSERT_EQ(rig.view().state, GroupState::GroupStandby);
    // The next path keeps them: the rig looks at every set-point.
    for (const auto& one : of_a_member) EXPECT_EQ(write(rig, one.number, one.value), ErrorId::none) << one.number;
    double fastest = 0;
    const auto slow = rig.give(line({45, 0}, 90));
    ASSERT_TRUE(rig.until(
        [&] {
            fastest = std::max(fastest, std::abs(rig.axis(0).set_velocity));
            return rig.status(slow.id) == CommandStatus::done;
        },
        4000));
    EXPECT_LE(fastest, 40);
    EXPECT_GT(fastest, 39);
}

TEST(GroupLimits, NarrowedDuringAnInterruptionTheWayIsNotGoneOnWith) {
    for (const auto& one : of_a_member) {
        GroupRig rig(limited());
        home(rig);
        rig.enable();
        const auto move = rig.give(line({100, 50}, 90));
        rig.run(400);
        const auto interrupt = rig.give(simply(GroupCommandKind::interrupt));
        ASSERT_TRUE(rig.until([&] { return rig.status(interrupt.id) == CommandStatus::done; }, 1000));
        const double before = rig.axis(0).parameters[static_cast<std::size_t>(one.number)];
        ASSERT_EQ(write(rig, one.number, one.value), ErrorId::none) << one.number;
        const auto refused = rig.give(simply(GroupCommandKind::resume));
        EXPECT_EQ(refused.error, ErrorId::path_not_planned) << one.number;
        EXPECT_EQ(rig.view().state, GroupState::GroupStandby) << one.number;
        ASSERT_EQ(write(rig, one.number, before), ErrorId::none) << one.number;
        EXPECT_EQ(rig.give(simply(GroupCommandKind::resume)).error, ErrorId::none) << "as they were: on " << one.number;
        EXPECT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 3000)) << one.number;
    }
}

}  // namespace
}  // namespace taktwerk::axes::test
