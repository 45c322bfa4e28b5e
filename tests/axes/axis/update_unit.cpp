// ContinuousUpdate on the side of the axis. PLCopen Part 1 v2.0, section 2.4.6.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

struct UpdateRig : Rig {
    explicit UpdateRig(const AxisConfig& config = trapezoids()) : Rig(config) { power_on(); }
    ErrorId update(CommandId id, const AxisCommand& command) { return axis.update(id, command, view().owner); }
};

// P1-110, P1-108: from 0, Distance 100 at 10; at 50 Distance 130 at 20. It speeds up to 20 and stops at 130; later values are ignored.
TEST(AxisUpdate, RelativeMoveRefersToItsStart) {
    UpdateRig rig;
    const auto id = rig.accept(relative(100, 10));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_position >= 50; }));
    EXPECT_EQ(rig.update(id, relative(130, 20)), ErrorId::none);
    EXPECT_EQ(rig.status(id), CommandStatus::active);  // P1-106
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
    rig.run(100);
    EXPECT_EQ(rig.view().set_velocity, 20);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 130);
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_LE(rig.largest_velocity, 20 * (1 + 1e-12));

    EXPECT_EQ(rig.update(id, relative(200, 20)), ErrorId::none);  // P1-105: it is over
    rig.run(100);
    EXPECT_EQ(rig.view().set_position, 130);
}

// P1-053: each input of each kind; the way goes on from where the axis is, without a jump.
TEST(AxisUpdate, AbsoluteMoveTakesAnotherTargetAndOtherRamps) {
    UpdateRig rig;
    const auto id = rig.accept(absolute(100, 50));
    rig.run(1000);
    EXPECT_EQ(rig.update(id, absolute(20, 80)), ErrorId::none);  // behind it: it turns
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 20);
    EXPECT_LE(rig.largest_step, 0.0801);

    const auto second = rig.accept(absolute(120, 50));
    rig.run(10);
    auto gentle = absolute(120, 50);
    gentle.acceleration = 100;
    EXPECT_EQ(rig.update(second, gentle), ErrorId::none);
    rig.run(10);
    EXPECT_NEAR(rig.view().set_velocity, 10 + 1, 1e-9);  // 10 ms with 1000 u/s2, then 10 ms with 100
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 120);
}

// The same inputs again, in each scan, change nothing: not a bit of the trajectory.
TEST(AxisUpdate, UnchangedInputsChangeNothing) {
    UpdateRig rig, twin;
    const auto id = rig.accept(absolute(100, 50));
    twin.accept(absolute(100, 50));
    rig.program = [&] { EXPECT_EQ(rig.update(id, absolute(100, 50)), ErrorId::none); };
    for (int i = 0; i < 2200; ++i) {
        rig.step();
        twin.step();
        ASSERT_EQ(rig.view().set_position, twin.view().set_position) << i;
    }
}

TEST(AxisUpdate, VelocityFollows) {
    UpdateRig rig;
    const auto id = rig.accept(at_velocity(50));
    rig.run(100);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
    EXPECT_EQ(rig.update(id, at_velocity(-30)), ErrorId::none);
    rig.step();
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    rig.run(100);
    EXPECT_EQ(rig.view().set_velocity, -30);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
}

// mcCurrentDirection is that of the start: the motion that the update makes does not count.
TEST(AxisUpdate, CurrentDirectionIsThatOfTheStart) {
    UpdateRig rig;
    rig.accept(at_velocity(-20));
    rig.run(100);
    AxisCommand current{.kind = CommandKind::move_velocity, .direction = mcCurrentDirection, .velocity = -40};
    const auto id = rig.accept(current);  // negative times backwards: forwards
    rig.run(200);
    EXPECT_EQ(rig.view().set_velocity, 40);
    current.velocity = -60;
    EXPECT_EQ(rig.update(id, current), ErrorId::none);
    rig.run(100);
    EXPECT_EQ(rig.view().set_velocity, 60);
}

// P1-108: an additive move keeps what it was added to.
TEST(AxisUpdate, AdditiveMoveKeepsWhatItWasAddedTo) {
    UpdateRig rig;
    rig.accept(absolute(50));
    rig.run(100);
    AxisCommand more{.kind = CommandKind::move_additive, .position = 20, .velocity = 100};
    const auto id = rig.accept(more);
    rig.run(100);
    more.position = 35;
    EXPECT_EQ(rig.update(id, more), ErrorId::none);
    rig.run(10);
    more.position = 30;
    EXPECT_EQ(rig.update(id, more), ErrorId::none);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_DOUBLE_EQ(rig.view().set_position, 80);
}

// Before and after its target: the end velocity alone, then another target.
TEST(AxisUpdate, ContinuousMoveTakesAnotherEndVelocityAndTarget) {
    UpdateRig rig;
    AxisCommand passing{.kind = CommandKind::move_continuous_relative, .position = 50, .velocity = 50, .end_velocity = 10};
    const auto id = rig.accept(passing);
    rig.run(100);
    passing.end_velocity = 20;
    EXPECT_EQ(rig.update(id, passing), ErrorId::none);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::in_target; }));
    EXPECT_EQ(rig.view().set_velocity, 20);
    EXPECT_NEAR(rig.view().set_position, 50, 0.021);
    passing.end_velocity = 30;
    EXPECT_EQ(rig.update(id, passing), ErrorId::none);
    rig.run(20);
    EXPECT_EQ(rig.view().set_velocity, 30);
    passing.position = 100;
    EXPECT_EQ(rig.update(id, passing), ErrorId::none);
    rig.step();
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::in_target; }));
    EXPECT_NEAR(rig.view().set_position, 100, 0.031);
    EXPECT_EQ(rig.view().set_velocity, 30);
}

TEST(AxisUpdate, SuperimposedDistanceCountsFromItsStart) {
    UpdateRig rig;
    rig.accept(absolute(100, 50));
    rig.run(200);
    AxisCommand extra{.kind = CommandKind::move_superimposed, .position = 10, .velocity = 20};
    const auto id = rig.accept(extra);
    rig.run(200);
    extra.position = 14;
    extra.velocity = 40;
    EXPECT_EQ(rig.update(id, extra), ErrorId::none);
    rig.run(100);
    EXPECT_NEAR(rig.view().set_velocity, 90, 1e-9);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_NEAR(rig.view().set_position, 114, 1e-9);
    EXPECT_NEAR(rig.view().superimposed_covered, 14, 1e-9);
}

// A waiting command takes its inputs too, and the joint before it with them: 20 instead of 80 at 50.
TEST(AxisUpdate, WaitingCommandTakesItsInputs) {
    UpdateRig rig;
    const auto first = rig.accept(absolute(50, 50));
    const auto second = rig.accept(absolute(100, 80, mcBlendingNext));
    rig.run(300);
    EXPECT_EQ(rig.update(second, absolute(90, 20, mcBlendingNext)), ErrorId::none);
    EXPECT_EQ(rig.status(second), CommandStatus::queued);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(first) == CommandStatus::done; }));
    EXPECT_NEAR(rig.view().set_velocity, 20, 1e-9);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 90);
}

// What cannot be: an error, and the command goes on as it was.
TEST(AxisUpdate, ImpossibleInputsLeaveTheMotionAlone) {
    auto config = trapezoids();
    config.limits.position_min = -10;
    config.limits.position_max = 120;
    config.homing.kind = HomingKind::set_here;
    UpdateRig rig(config);
    rig.accept(home(0));
    rig.run(3);
    const auto id = rig.accept(absolute(100, 50));
    rig.run(500);
    EXPECT_EQ(rig.update(id, absolute(121, 50)), ErrorId::beyond_software_limit);
    EXPECT_EQ(rig.update(id, absolute(std::nan(""), 50)), ErrorId::invalid_position);
    EXPECT_EQ(rig.update(id, absolute(100, 0)), ErrorId::invalid_velocity);
    EXPECT_EQ(rig.update(id, relative(10)), ErrorId::update_not_possible);
    EXPECT_EQ(rig.axis.update(id, absolute(50, 50), Owner::commissioning), ErrorId::owned_by_other);
    EXPECT_EQ(rig.update(id + 5, absolute(50, 50)), ErrorId::none);  // never heard of: over
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 100);
}

// P1-109: another BufferMode while the command runs changes nothing.
TEST(AxisUpdate, BufferModeOfARunningCommandHasNoEffect) {
    UpdateRig rig, twin;
    const auto id = rig.accept(absolute(100, 50));
    twin.accept(absolute(100, 50));
    rig.run(500);
    twin.run(500);
    EXPECT_EQ(rig.update(id, absolute(100, 50, mcBlendingHigh)), ErrorId::none);
    for (int i = 0; i < 2000; ++i) {
        rig.step();
        twin.step();
        ASSERT_NEAR(rig.view().set_position, twin.view().set_position, 1e-12);
    }
    EXPECT_EQ(rig.status(id), CommandStatus::done);
}

// Values that no plan can be made of are not taken, and the motion goes on as if they had never come: running, waiting or superimposed.
TEST(AxisUpdate, AbsurdValuesAreNotTakenAndTheMotionGoesOn) {
    struct Absurd {
        AxisCommand values;
        ErrorId error;
    };
    auto gentle = relative(100, 10);
    gentle.jerk = 1e-300;
    auto lazy = relative(100, 10);
    lazy.deceleration = 1e-300;
    for (const auto& absurd :
         {Absurd{relative(100, 1e-300), ErrorId::invalid_velocity}, Absurd{relative(1e300, 10), ErrorId::invalid_position},
          Absurd{gentle, ErrorId::invalid_dynamics}, Absurd{lazy, ErrorId::invalid_dynamics}}) {
        UpdateRig rig;
        EXPECT_EQ(rig.refuse(absurd.values), absurd.error) << "as if it were new";
        const auto id = rig.accept(relative(100, 10));
        auto waiting = absurd.values;
        waiting.buffer_mode = mcBuffered;
        const auto behind = rig.accept(relative(5, 10, mcBuffered));
        rig.run(500);
        EXPECT_EQ(rig.update(id, absurd.values), absurd.error);
        EXPECT_EQ(rig.update(behind, waiting), absurd.error);
        ASSERT_TRUE(rig.run_to(AxisState::Standstill));
        EXPECT_EQ(rig.status(id), CommandStatus::done);
        EXPECT_EQ(rig.status(behind), CommandStatus::done);
        EXPECT_EQ(rig.view().set_position, 105);
    }
}

}  // namespace
}  // namespace taktwerk::axes::test
