// An addition that was given up in motion, while the motion below it goes on: when that comes to rest too, both are one motion, which turns nothing
// round. Each with its own ramp they would: 30 u/s that brake with 1000 u/s2 are gone before -20 u/s that brake with 100 are.

#include "tests/axes/axis/coupling_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisCommand gentle_addition() { return {.kind = CommandKind::move_superimposed, .position = -20, .velocity = 20, .deceleration = 100}; }
AxisCommand waiting_gear() { return gear_in_pos(0, 100, 0, 30); }

/// A slave at 30 u/s with -20 on top.
struct Laden : CouplingRig {
    explicit Laden(const AxisCommand& base) : CouplingRig(std::vector<AxisConfig>(2, plain_axis())) {
        start();
        from = view(1).set_position;
        accept(1, base);
        run(200);
        accept(1, gentle_addition());
        EXPECT_TRUE(run_until([&] { return view(1).set_velocity < 10.001; }, 300));
    }
    void give_up() { accept(1, waiting_gear()); }
    void override_velocity(double factor) {
        EXPECT_EQ(axes[1].set(Override{.velocity = factor, .acceleration = 1, .jerk = 1}, Owner::program), ErrorId::none);
    }
    void watch(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            step();
            lowest = std::min(lowest, view(1).set_velocity);
            highest = std::max(highest, view(1).set_velocity);
        }
    }
    double from = 0, lowest = 1e9, highest = -1e9;
};

AxisCommand far_away() { return relative(100, 30); }

// P1-281: the former motion goes on and its override with it; at 0 it comes to rest.
TEST(AbandonedAddition, StopsWithItsBaseAtOverrideZero) {
    for (const bool to_position : {false, true}) {
        SCOPED_TRACE(to_position);
        Laden rig(to_position ? far_away() : at_velocity(30));
        rig.give_up();
        rig.override_velocity(0);
        const double covered = rig.view(1).superimposed_covered;
        rig.watch(500);
        EXPECT_EQ(rig.view(1).state, AxisState::SynchronizedMotion);
        EXPECT_EQ(rig.lowest, 0);
        EXPECT_LT(rig.highest, 10.001);
        EXPECT_EQ(rig.view(1).set_velocity, 0);

        // It goes on as it did. A way is the one commanded, with what the addition had covered.
        rig.override_velocity(1);
        rig.watch(200);
        EXPECT_NEAR(rig.view(1).set_velocity, 30, 1e-9);
        if (!to_position) continue;
        rig.watch(5000);
        EXPECT_EQ(rig.view(1).set_velocity, 0);
        EXPECT_NEAR(rig.view(1).set_position, rig.from + 100 + covered, 1e-9);
    }
}

// The base brakes already when the addition is given up.
TEST(AbandonedAddition, IsGivenUpOnAStop) {
    Laden rig(at_velocity(30));
    rig.override_velocity(0);
    rig.run(2);
    ASSERT_GT(rig.view(1).set_velocity, 5);
    rig.give_up();
    rig.watch(500);
    EXPECT_EQ(rig.lowest, 0);
    EXPECT_EQ(rig.view(1).set_velocity, 0);
}

// Without a stop nothing changes: the addition ends along its own ramp, the base keeps its velocity.
TEST(AbandonedAddition, EndsByItselfOnABaseThatGoesOn) {
    Laden rig(at_velocity(30));
    rig.give_up();
    rig.watch(100);
    EXPECT_LT(rig.highest, 21);  // 100 u/s2
    rig.watch(200);
    EXPECT_NEAR(rig.highest, 30, 1e-9);
    EXPECT_EQ(rig.view(1).set_velocity, 30);
}

// In front of a profile of the drive the axis stops along its own ramp; what is buffered does not end the addition before.
TEST(AbandonedAddition, StopsWithItsBaseForAProfileOfTheDrive) {
    Rig rig(plain_axis(), [](FakeDrive& drive) {
        drive.caps.profile_buffer = 1;
        drive.caps.velocity_limit = true;
    });
    rig.power_on();
    rig.accept(at_velocity(30));
    rig.run(200);
    rig.accept(gentle_addition());
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity < 10.001; }, 300));
    rig.accept({.kind = CommandKind::drive_move_velocity, .buffer_mode = mcBuffered, .velocity = -25});
    double lowest = 1e9;
    ASSERT_TRUE(rig.run_until(
        [&] {
            lowest = std::min(lowest, rig.view().set_velocity);
            return rig.view().drive_mode == DriveMode::profile_velocity;
        },
        600));
    EXPECT_EQ(lowest, 0);
}

}  // namespace
}  // namespace taktwerk::axes::test
