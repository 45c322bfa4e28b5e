// ContinuousUpdate of MC_PositionProfile, MC_VelocityProfile, MC_AccelerationProfile: the rest of the table with other scales, from where the
// axis is. PLCopen Part 1 v2.0, 2.4.6, and 3.14 to 3.16, which give these blocks the pin.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

struct ProfileUpdateRig {
    ProfileUpdateRig(CommandKind of, std::vector<TimePoint> rows) : kind(of) {
        table = tables.add_time_table(rows, 16);
        rig.axis.bind({&rig.axis, 1, &tables, {}});
        rig.power_on();
        id = rig.accept(command());
    }
    [[nodiscard]] AxisCommand command(double time = 1, double value = 1, double offset = 0) const {
        return {.kind = kind, .details = TimeProfileDetails{table, time, value, offset}};
    }
    ErrorId update(double time, double value, double offset = 0) {
        return rig.axis.update(id, command(time, value, offset), rig.view().owner);
    }
    [[nodiscard]] const AxisView& view() const { return rig.view(); }

    CommandKind kind;
    MotionTables tables;
    TimeTableRef table;
    Rig rig{plain_axis()};
    CommandId id = 0;
};

// From 0 to 10 u/s in 1 s, then kept. At 0.5 s it has 5 u/s: with twice the time the other half takes a second more.
TEST(VelocityProfileUpdate, AnotherTimeScaleStretchesWhatIsLeft) {
    ProfileUpdateRig p(CommandKind::velocity_profile, {{1s, 10.0}});
    p.rig.run(500);
    ASSERT_NEAR(p.view().set_velocity, 5, 1e-9);
    EXPECT_EQ(p.update(2, 1), ErrorId::none);
    p.rig.run(500);
    EXPECT_NEAR(p.view().set_velocity, 7.5, 1e-9);
    EXPECT_EQ(p.rig.status(p.id), CommandStatus::active);
    // In the middle of that, back: a quarter of the table is left, 0.25 s.
    EXPECT_EQ(p.update(1, 1), ErrorId::none);
    p.rig.run(250);
    EXPECT_NEAR(p.view().set_velocity, 10, 1e-9);
    EXPECT_EQ(p.rig.status(p.id), CommandStatus::in_target);
    p.rig.expect_no_jump();
}

// 5 u/s at 0.5 s; scaled by 0.3 the row at 1 s asks for 3 u/s, with an offset of 1 for 4 u/s.
TEST(VelocityProfileUpdate, OtherValuesAreReachedByTheNextRow) {
    ProfileUpdateRig p(CommandKind::velocity_profile, {{1s, 10.0}, {1s, 20.0}});
    p.rig.run(500);
    EXPECT_EQ(p.update(1, 0.3, 1), ErrorId::none);
    p.rig.run(250);
    EXPECT_NEAR(p.view().set_velocity, 4.5, 1e-9);
    p.rig.run(250);
    EXPECT_NEAR(p.view().set_velocity, 4, 1e-9);
    p.rig.run(1000);
    EXPECT_NEAR(p.view().set_velocity, 7, 1e-9);
    EXPECT_EQ(p.rig.status(p.id), CommandStatus::in_target);
}

// A table that runs keeps what it was checked for when it began; its rest, looked at again, is refused as a new table would be.
TEST(VelocityProfileUpdate, ALimitLoweredMeanwhileHoldsForTheNextTableOnly) {
    ProfileUpdateRig p(CommandKind::velocity_profile, {{1s, 60.0}, {1s, 60.0}, {1s, 20.0}});
    p.rig.run(500);
    ASSERT_EQ(p.rig.axis.set(WriteParameter{velocity_of_application, 40}, Owner::program), ErrorId::none);
    p.rig.run(1000);
    EXPECT_NEAR(p.view().set_velocity, 60, 1e-9);
    EXPECT_EQ(p.update(2, 1), ErrorId::invalid_velocity);
    EXPECT_EQ(p.rig.refuse(p.command()), ErrorId::invalid_velocity);
    p.rig.run(1500);
    EXPECT_NEAR(p.view().set_velocity, 20, 1e-9);
    EXPECT_EQ(p.rig.status(p.id), CommandStatus::in_target);
}

// 10 u/s2 for 1 s of the 2 s, then 20 u/s2 for the second that is left: 10 + 20 u/s.
TEST(AccelerationProfileUpdate, TheRestOfARowHasTheNewValue) {
    ProfileUpdateRig p(CommandKind::acceleration_profile, {{2s, 10.0}});
    p.rig.run(1000);
    EXPECT_EQ(p.update(1, 2), ErrorId::none);
    p.rig.run(1000);
    EXPECT_NEAR(p.view().set_velocity, 30, 1e-9);
    p.rig.run(100);
    EXPECT_NEAR(p.view().set_velocity, 30, 1e-9);
}

// At 10 u, at 1 s, the last row lies 1 s and 10 u ahead: at twice the time and 1.5 times the place it is at 30 u at 3 s.
TEST(PositionProfileUpdate, TheRowsAheadAreReachedAtTheirNewTimesAndPlaces) {
    ProfileUpdateRig p(CommandKind::position_profile, {{1s, 10.0}, {1s, 20.0}});
    p.rig.run(1000);
    ASSERT_NEAR(p.view().set_position, 10, 1e-9);
    const double velocity = p.view().set_velocity;
    p.rig.largest_acceleration = 0;
    EXPECT_EQ(p.update(2, 1.5), ErrorId::none);
    p.rig.step();
    EXPECT_NEAR(p.view().set_velocity, velocity, 0.1) << "smoothly";
    EXPECT_LE(p.rig.largest_acceleration, 1000);
    p.rig.run(1998);
    EXPECT_EQ(p.rig.status(p.id), CommandStatus::active);
    p.rig.step();
    EXPECT_EQ(p.view().set_position, 30);
    EXPECT_EQ(p.rig.status(p.id), CommandStatus::done);
    p.rig.expect_no_jump();
}

// 1 ms before a row an offset of 5 u would be a jump: refused, and the profile goes on as it was.
TEST(PositionProfileUpdate, AJumpIsRefusedAndTheProfileGoesOn) {
    ProfileUpdateRig p(CommandKind::position_profile, {{1s, 10.0}, {1s, 20.0}});
    p.rig.run(999);
    EXPECT_EQ(p.update(1, 1, 5), ErrorId::invalid_velocity);
    EXPECT_EQ(p.update(0, 1), ErrorId::invalid_parameter);
    p.rig.run(1001);
    EXPECT_EQ(p.view().set_position, 20);
    EXPECT_EQ(p.rig.status(p.id), CommandStatus::done);
}

TEST(VelocityProfileUpdate, BehindTheLastRowNothingIsLeftToUpdate) {
    ProfileUpdateRig p(CommandKind::velocity_profile, {{1s, 10.0}});
    p.rig.run(1000);
    ASSERT_EQ(p.rig.status(p.id), CommandStatus::in_target);
    EXPECT_EQ(p.update(1, 2), ErrorId::update_not_possible);
    p.rig.run(10);
    EXPECT_EQ(p.view().set_velocity, 10);
}

// A table waits for nothing: what is superimposed takes what the fastest row that is to come leaves of the axis' 100 u/s, from its first cycle
// on, and other scales that would not leave it that are refused until it is done.
TEST(VelocityProfileUpdate, LeavesWhatIsSuperimposedItsVelocity) {
    ProfileUpdateRig p(CommandKind::velocity_profile, {{500ms, 30.0}, {1s, 60.0}});
    const auto beside = p.rig.accept({.kind = CommandKind::move_superimposed, .position = 60, .velocity = 80});
    p.rig.run(500);
    EXPECT_NEAR(p.view().set_velocity, 30 + 40, 1e-6);
    EXPECT_EQ(p.update(1, 1.1), ErrorId::invalid_velocity);
    p.rig.run(999);
    EXPECT_NEAR(p.view().set_velocity, 100, 0.1);
    ASSERT_EQ(p.rig.status(beside), CommandStatus::active);
    p.rig.run(1000);
    EXPECT_EQ(p.rig.status(beside), CommandStatus::done);
    EXPECT_NEAR(p.view().set_velocity, 60, 1e-9);
    p.rig.expect_no_jump();
}

}  // namespace
}  // namespace taktwerk::axes::test
