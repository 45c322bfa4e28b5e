// MC_SyncAxisToGroup on a group and a fourth axis, scan by scan.

#include <gtest/gtest.h>

#include "tests/axes/group/track_rig.hpp"
#include "tests/fb_library/groups/group_plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::test::cartesian_arm;
using axes::test::GroupRig;

struct PumpPlc : GroupPlc {
    PumpPlc()
        : GroupPlc(axes::test::TrackRig::with(GroupRig::named(3), axes::test::belt_axis()),
                   GroupRig::all_of(GroupRig::named(3), cartesian_arm())) {
        MC_GroupEnable enable;
        EXPECT_EQ(carry_out(enable), ErrorId::none);
        sync.AxesGroup = group;
        sync.SlaveAxis = pump;
        sync.Execute = true;
        program = [this](const MotionContext& ctx) { sync(ctx); };
    }
    axes::CommandId go(const axes::JointVector& to, double velocity, axes::MC_BufferMode mode = axes::mcBuffered) {
        auto move = axes::test::line(to, velocity, mode);
        move.dynamics = {velocity, 100, 100, 1000};  // what 3 : 2 makes of it the pump's 250 u/s2 and 2500 u/s3 can do
        const auto answer = rig.submit(move);
        EXPECT_EQ(answer.error, ErrorId::none);
        return answer.id;
    }
    bool over(axes::CommandId id) {
        return until([&] { return rig.status(id) == axes::CommandStatus::done; }, 5000);
    }
    static constexpr AxisRef pump{3};
    [[nodiscard]] double pumped() const { return rig.axis(3).set_position; }
    MC_SyncAxisToGroup sync;
};

// G-092: 3 : 2, from rest: it is in sync before the path begins, so that nothing is lost. (30, 40, 0) is 50 u of path: 75; back by (0, 40, 0): 40 and 60 more, since length
// counts forwards. In each cycle velocity and place agree with the path's.
TEST(GroupSyncBlocks, AnAxisFollowsTheLengthOfThePath) {
    PumpPlc plc;
    plc.sync.RatioNumerator = 3;
    plc.sync.RatioDenominator = 2;
    plc.run(5);
    EXPECT_TRUE(plc.sync.Active);
    EXPECT_TRUE(plc.sync.InSync);
    const double began = plc.pumped();
    const auto first = plc.go({30, 40, 0}, 20), second = plc.go({30, 0, 0}, 30);
    for (int i = 0; i < 5000 && plc.rig.status(second) != axes::CommandStatus::done; ++i) {
        plc.scan();
        ASSERT_TRUE(plc.sync.InSync);
        ASSERT_NEAR(plc.pumped() - began, 1.5 * plc.rig.view().path_gone, 1e-9);
        ASSERT_NEAR(plc.rig.axis(3).set_velocity, 1.5 * plc.rig.view().path_velocity, 1e-9);
    }
    EXPECT_EQ(plc.rig.status(first), axes::CommandStatus::done);
    EXPECT_NEAR(plc.pumped() - began, 75 + 60, 1e-9);
    EXPECT_NEAR(plc.rig.view().path_gone, 90, 1e-9);
}

// G-092: coupled on the way it comes up to the path's velocity, inside its own 250 u/s2, and is locked from then on. A command of its own ends it.
TEST(GroupSyncBlocks, CoupledOnTheWayItCatchesUpAndItsOwnCommandEndsIt) {
    PumpPlc plc;
    plc.sync.Execute = false;
    (void)plc.go({90, 0, 0}, 20);
    plc.run(700);
    ASSERT_NEAR(plc.rig.view().path_velocity, 20, 0.05);
    plc.sync.RatioNumerator = -1;
    plc.sync.Execute = true;
    plc.scan();
    EXPECT_FALSE(plc.sync.InSync);
    ASSERT_TRUE(plc.until([&] { return plc.sync.InSync; }, 400));
    const double apart = plc.pumped() + plc.rig.view().path_gone;
    for (int i = 0; i < 200; ++i) {
        plc.scan();
        ASSERT_NEAR(plc.pumped() + plc.rig.view().path_gone, apart, 1e-9);
        ASSERT_NEAR(plc.rig.axis(3).set_velocity, -plc.rig.view().path_velocity, 1e-9);
    }
    plc.rig.step([&] { (void)plc.rig.axes[3].submit({.kind = axes::CommandKind::halt}, axes::Owner::program); });
    plc.scan();
    plc.scan();
    EXPECT_TRUE(plc.sync.CommandAborted);
    EXPECT_FALSE(plc.sync.InSync);
    EXPECT_FALSE(plc.sync.Busy);
}

// G-095: both relations at once: the tool goes with a belt of 20 u/s, and the path on the object is 5 u long, whatever the belt does meanwhile.
TEST(GroupSyncBlocks, ABeltIsNoneOfTheLength) {
    axes::test::TrackRig rig(GroupRig::named(3), cartesian_arm());
    rig.drive_belt(20);
    rig.run(500);
    ASSERT_EQ(rig.track({}, {}).error, ErrorId::none);
    const auto there = rig.give(axes::test::on_product(axes::test::line({0, 0, 0}, 20)));
    ASSERT_TRUE(rig.done(there.id));
    const double before = rig.view().path_gone;
    const auto on = rig.give(axes::test::on_product(axes::test::line({0, 3, 4}, 20)));
    ASSERT_TRUE(rig.done(on.id));
    EXPECT_NEAR(rig.view().path_gone - before, 5, 1e-9);
    EXPECT_NEAR(rig.view().set_velocity[0], 20, 1e-9);
}

TEST(GroupSyncBlocks, WhatCannotFollowIsRefused) {
    PumpPlc plc;
    const auto outcome = [&] {
        plc.sync.Execute = false;
        plc.scan();
        plc.sync.Execute = true;
        plc.scan();
        return plc.sync.ErrorID;
    };
    plc.sync.SlaveAxis = AxisRef{1};
    EXPECT_EQ(outcome(), ErrorId::invalid_axis);
    plc.sync.SlaveAxis = AxisRef{};
    EXPECT_EQ(outcome(), ErrorId::invalid_axis);
    plc.sync.SlaveAxis = PumpPlc::pump;
    plc.sync.RatioDenominator = 0;
    EXPECT_EQ(outcome(), ErrorId::invalid_parameter);
    plc.sync.RatioDenominator = 1;
    plc.sync.BufferMode = mcBuffered;
    EXPECT_EQ(outcome(), ErrorId::buffer_mode_not_supported);
    plc.sync.BufferMode = mcAborting;
    EXPECT_EQ(outcome(), ErrorId::none);
}

}  // namespace
}  // namespace taktwerk::fb
