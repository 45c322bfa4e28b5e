// MC_MoveSuperimposed and MC_HaltSuperimposed. PLCopen Part 1 v2.0, sections 3.8 and 3.9.

#include "tests/axes/axis/coupling_rig.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::test {
namespace {

AxisCommand superimposed(double distance, double velocity = 20) {
    return {.kind = CommandKind::move_superimposed, .position = distance, .velocity = velocity};
}
AxisCommand halt_superimposed() { return {.kind = CommandKind::halt_superimposed}; }

// P1-150, P1-155, P1-156, P1-157: the underlying move keeps its command and its time, the set-point is the sum in each cycle; a twin without the
// addition says what the base is.
TEST(Superimposed, AddsToTheBaseAndLeavesItAlone) {
    Rig rig(trapezoids()), twin(trapezoids());
    rig.power_on();
    twin.power_on();
    const auto base = rig.accept(absolute(100, 50));
    twin.accept(absolute(100, 50));
    rig.run(500);
    twin.run(500);
    const auto extra = rig.accept(superimposed(10));
    EXPECT_EQ(rig.status(base), CommandStatus::active);
    EXPECT_EQ(rig.status(extra), CommandStatus::active);
    double covered = 0;
    bool done = false;
    for (Patience patience; patience.lasts(twin.view().state != AxisState::Standstill);) {
        rig.step();
        twin.step();
        ASSERT_GE(rig.view().superimposed_covered, covered);
        covered = rig.view().superimposed_covered;
        ASSERT_NEAR(rig.view().set_position, twin.view().set_position + covered, 1e-9);
        done = done || rig.status(extra) == CommandStatus::done;
    }
    EXPECT_TRUE(done);
    EXPECT_EQ(rig.status(base), CommandStatus::done);  // in the same cycle as the twin's
    EXPECT_EQ(covered, 10);
    EXPECT_DOUBLE_EQ(rig.view().set_position, 110);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
}

// A halt of an addition that came in the same scan: it takes over what moved before, which was just turning round and needs more than its jerk to end
// there (docs/motion/decisions.md: MC_HaltSuperimposed never reverses). Nothing has been covered since.
TEST(Superimposed, AHaltInTheScanOfItsAdditionEndsWhatMovedBefore) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(20));
    rig.run(200);
    rig.accept(superimposed(10));
    rig.run(200);
    ASSERT_NEAR(rig.view().set_velocity, 40, 1e-9);
    rig.accept(superimposed(-10));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity < 21.5; }));
    ASSERT_GT(rig.view().set_velocity, 20);
    ASSERT_LT(rig.view().set_acceleration, -300);  // a^2 / (2 v) is more than the 20000 u/s3 of each
    rig.accept(superimposed(5));
    const auto id = rig.accept(halt_superimposed());
    for (Patience patience; patience.lasts(rig.status(id) != CommandStatus::done);) {
        rig.step();
        ASSERT_GE(rig.view().set_velocity, 20 - 1e-9);
        ASSERT_EQ(rig.view().superimposed_covered, 0);
    }
    EXPECT_NEAR(rig.view().set_velocity, 20, 1e-9);
}

// On a base that is at standstill: what moves is not in position, and the jerk limit is written at standstill only.
TEST(Superimposed, AnAxisThatOnlyTheAdditionMovesIsNotInPosition) {
    auto config = trapezoids();
    config.windows.in_position = 1;
    Rig rig(config);
    rig.power_on();
    rig.run(100);
    ASSERT_TRUE(rig.view().in_position);
    const auto extra = rig.accept(superimposed(10));
    rig.run(200);  // of some 540 cycles, at 20 u/s: the motor follows some hundredths behind
    ASSERT_NEAR(rig.view().set_velocity, 20, 1e-9);
    ASSERT_LT(std::abs(rig.view().set_position - rig.view().actual_position), rig.axis.config().windows.in_position);
    EXPECT_FALSE(rig.view().in_position);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(extra) == CommandStatus::done; }));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().in_position; }));
}

// P1-160 (figure 23): the addition outlasts the underlying motion, which is done at its usual time; the end is 60. The axis stays in
// DiscreteMotion until nothing moves (U-08).
TEST(Superimposed, GoesOnAfterTheBaseHasEnded) {
    Rig rig(trapezoids()), twin(trapezoids());
    rig.power_on();
    twin.power_on();
    const auto base = rig.accept(absolute(50, 50));
    const auto same = twin.accept(absolute(50, 50));
    rig.run(800);
    twin.run(800);
    const auto extra = rig.accept(superimposed(10));
    for (Patience patience; patience.lasts(twin.status(same) != CommandStatus::done);) {
        rig.step();
        twin.step();
    }
    EXPECT_EQ(rig.status(base), CommandStatus::done);
    EXPECT_EQ(rig.status(extra), CommandStatus::active);
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(extra), CommandStatus::done);
    EXPECT_DOUBLE_EQ(rig.view().set_position, 60);
}

// Table 4: Done of the base starts what is buffered, nothing is buffered behind a superimposed motion: a move begins beside it whether it was
// given before the base was done or after (U-08), and goes on beside it (P1-151).
TEST(Superimposed, ABufferedMoveBeginsBesideItWhenTheBaseIsDone) {
    for (const bool after : {false, true}) {
        Rig rig(trapezoids());
        rig.power_on();
        const auto base = rig.accept(absolute(20, 50));
        rig.run(100);
        const auto extra = rig.accept(superimposed(30, 20));
        CommandId next = after ? 0 : rig.accept(relative(10, 10, mcBuffered));
        ASSERT_TRUE(rig.run_until([&] { return rig.status(base) == CommandStatus::done; }));
        if (after) {
            rig.run(20);
            next = rig.accept(relative(10, 10, mcBuffered));
        }
        EXPECT_EQ(rig.status(next), CommandStatus::active);
        EXPECT_EQ(rig.status(extra), CommandStatus::active);
        ASSERT_TRUE(rig.run_to(AxisState::Standstill));
        EXPECT_EQ(rig.status(next), CommandStatus::done);
        EXPECT_EQ(rig.status(extra), CommandStatus::done);
        EXPECT_NEAR(rig.view().set_position, 60, 1e-9);
        rig.expect_no_jump();
    }
}

// The same behind a motion whose command has ended: what is buffered is not left behind.
TEST(Superimposed, ABufferedMoveBesideAVelocityThatWasKeptBegins) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(20));
    ASSERT_TRUE(rig.run_to_sync(1, rig.accept(1, gear_in(0))));
    rig.accept(1, gear_out());
    rig.run(10);
    rig.accept(1, superimposed(5, 20));
    rig.run(10);
    const auto next = rig.accept(1, absolute(200, 50, mcBuffered));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(1, next) == CommandStatus::done; }));
}

// P1-154, P1-030: from Standstill it is a relative move, cycle by cycle.
TEST(Superimposed, InStandstillActsAsRelativeMove) {
    Rig rig(plain_axis()), twin(plain_axis());
    rig.power_on();
    twin.power_on();
    rig.accept(absolute(5));
    twin.accept(absolute(5));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    ASSERT_TRUE(twin.run_to(AxisState::Standstill));
    rig.accept(superimposed(-7, 30));
    twin.accept(relative(-7, 30));
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
    for (int i = 0; i < 400; ++i) {
        rig.step();
        twin.step();
        ASSERT_NEAR(rig.view().set_position, twin.view().set_position, 1e-12) << i;
        ASSERT_EQ(rig.view().state, twin.view().state) << i;
    }
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
}

// P1-151: an aborting command ends both, and goes on from the sum without a jump; a waiting one ends neither.
TEST(Superimposed, AbortingCommandEndsBothAWaitingOneNeither) {
    for (const auto mode : {mcAborting, mcBuffered}) {
        Rig rig(trapezoids());
        rig.power_on();
        const auto base = rig.accept(absolute(100, 50));
        rig.run(200);
        const auto extra = rig.accept(superimposed(30));
        rig.run(200);
        ASSERT_NEAR(rig.view().set_velocity, 70, 1e-9);
        const auto next = rig.accept(absolute(200, 50, mode));
        if (mode == mcAborting) {
            EXPECT_EQ(rig.status(base), CommandStatus::aborted);
            EXPECT_EQ(rig.status(extra), CommandStatus::aborted);
            rig.step();
            EXPECT_NEAR(rig.view().set_velocity, 69, 1e-9);  // 1000 u/s2 down to the new command's 50
        } else {
            EXPECT_EQ(rig.status(base), CommandStatus::active);
            EXPECT_EQ(rig.status(extra), CommandStatus::active);
            EXPECT_EQ(rig.status(next), CommandStatus::queued);
        }
        ASSERT_TRUE(rig.run_to(AxisState::Standstill));
        EXPECT_DOUBLE_EQ(rig.view().set_position, 200);  // an absolute target, begun after the addition was complete
        EXPECT_LE(rig.largest_step, 0.0701);
    }
}

// Two ramps that became one are taken away as hard as both together. An addition that comes then waits for that: three jerks and
// accelerations on top of each other are asked of nobody (what two may be: the rig's oracle).
TEST(Superimposed, WaitsWhileTheRampsOfTwoAreTakenAway) {
    for (int later = 0; later < 60; ++later) {
        Rig rig;
        rig.power_on();
        rig.accept(absolute(-7.2, 60));
        rig.accept(superimposed(-9.6, 100));
        rig.run(53);
        rig.accept(absolute(-1.6, 34));
        rig.run(later);
        const auto extra = rig.accept(superimposed(7.5, 33));
        ASSERT_TRUE(rig.run_until([&] { return rig.status(extra) == CommandStatus::done; })) << later;
        ASSERT_TRUE(rig.run_to(AxisState::Standstill));
        ASSERT_NEAR(rig.view().set_position, -1.6 + 7.5, 1e-9);
        ASSERT_TRUE(rig.oracle.clean()) << later << rig.oracle.report();
    }
}

// P1-152: a second one replaces the first only, and goes on from its velocity: nothing of the first's rest is made up.
TEST(Superimposed, SecondReplacesOnlyTheFirst) {
    Rig rig(trapezoids());
    rig.power_on();
    const auto base = rig.accept(absolute(100, 50));
    rig.run(200);
    const auto first = rig.accept(superimposed(10));
    rig.run(300);
    const double covered = rig.view().superimposed_covered;
    ASSERT_GT(covered, 1);
    ASSERT_LT(covered, 9);
    const auto second = rig.accept(superimposed(4));
    EXPECT_EQ(rig.status(first), CommandStatus::aborted);
    EXPECT_EQ(rig.status(second), CommandStatus::active);
    EXPECT_EQ(rig.status(base), CommandStatus::active);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_DOUBLE_EQ(rig.view().superimposed_covered, 4);
    EXPECT_NEAR(rig.view().set_position, 100 + covered + 4, 1e-9);
}

// P1-161: halting ends the addition, the base goes on; done when the added velocity is zero.
TEST(Superimposed, HaltEndsTheAdditionOnly) {
    Rig rig(trapezoids());
    rig.power_on();
    const auto base = rig.accept(at_velocity(50));
    rig.run(200);
    const auto extra = rig.accept(superimposed(100));
    rig.run(200);
    auto gentle = halt_superimposed();
    gentle.deceleration = 100;
    const auto halted = rig.accept(gentle);
    EXPECT_EQ(rig.status(extra), CommandStatus::aborted);
    EXPECT_EQ(rig.status(halted), CommandStatus::active);
    EXPECT_EQ(rig.status(base), CommandStatus::in_target);
    rig.run(199);
    EXPECT_EQ(rig.status(halted), CommandStatus::active);  // 20 u/s with 100 u/s2: 0.2 s
    rig.run(2);
    EXPECT_EQ(rig.status(halted), CommandStatus::done);
    EXPECT_NEAR(rig.view().set_velocity, 50, 1e-12);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    // Nothing runs: done at once (U-24).
    EXPECT_EQ(rig.status(rig.accept(halt_superimposed())), CommandStatus::done);
}

// P1-166: InVelocity looks at the command's own part.
TEST(Superimposed, InVelocityIsTheBasesOwn) {
    Rig rig(trapezoids());
    rig.power_on();
    const auto base = rig.accept(at_velocity(50));
    rig.run(200);
    rig.accept(superimposed(10));
    for (int i = 0; i < 700; ++i) {
        rig.step();
        ASSERT_EQ(rig.status(base), CommandStatus::in_target) << i;
    }
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);  // P1-153
}

// P1-158 (figure 21, ways scaled by 1/10, the third given before the second has ended): the end lies between two and three additions, at
// the base plus what was covered.
TEST(Superimposed, ThreeTimesTheLastBeforeTheSecondEnded) {
    Rig rig(trapezoids());
    rig.power_on();
    rig.accept(relative(1000, 300));
    rig.run(500);
    const auto first = rig.accept(superimposed(100, 100));
    rig.run(1200);
    EXPECT_EQ(rig.status(first), CommandStatus::done);
    rig.accept(superimposed(100, 100));
    rig.run(500);
    const double covered = rig.view().superimposed_covered;
    rig.accept(superimposed(100, 100));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_NEAR(rig.view().set_position, 1000 + 100 + covered + 100, 1e-9);
    EXPECT_GT(rig.view().set_position, 1200);
    EXPECT_LT(rig.view().set_position, 1300);
}

// The axis' velocity limit holds for the sum: 990 of 1000 u/s used by the base leave 10; where it uses all, the addition waits for its end.
TEST(Superimposed, VelocityIsWhatTheLimitLeaves) {
    for (const double speed : {990.0, 1000.0}) {
        Rig rig(trapezoids());
        rig.power_on();
        const auto base = rig.accept(absolute(3000, speed));
        rig.run(1500);
        const auto extra = rig.accept(superimposed(5, 50));
        double fastest = 0;
        ASSERT_TRUE(rig.run_until([&] {
            fastest = std::max(fastest, rig.view().set_velocity);
            return rig.view().state == AxisState::Standstill;
        }));
        EXPECT_LE(fastest, 1000 * (1 + 1e-12));
        EXPECT_EQ(rig.status(base), CommandStatus::done);
        EXPECT_EQ(rig.status(extra), CommandStatus::done);
        EXPECT_DOUBLE_EQ(rig.view().set_position, 3005);
    }
}

// 600 of 1000 u/s and 400 on top; then the base is to go to 900. The addition gives way to 100 first, with its own 200 u/s2, and only then the
// base goes there: with both ramps side by side it would have been at 900 after 0.3 s, and the addition still at 340.
TEST(Superimposed, ABaseThatGetsFasterWaitsForTheAdditionToSlowDown) {
    for (const double sense : {1.0, -1.0}) {
        Rig rig(trapezoids());
        rig.power_on();
        const auto base = rig.accept(at_velocity(sense * 600));
        rig.run(1000);
        auto addition = superimposed(sense * 1500, 400);
        addition.deceleration = 200;
        const auto extra = rig.accept(addition);
        rig.run(500);
        ASSERT_DOUBLE_EQ(rig.view().set_velocity, sense * 1000);

        ASSERT_EQ(rig.axis.update(base, at_velocity(sense * 900), rig.view().owner), ErrorId::none);
        double fastest = 0;
        const auto watching = [&](const std::function<bool()>& until) {
            return rig.run_until([&] {
                fastest = std::max(fastest, sense * rig.view().set_velocity);
                return until();
            });
        };
        rig.step();
        EXPECT_EQ(rig.status(base), CommandStatus::active) << "not at its velocity while it waits";
        ASSERT_TRUE(watching([&] { return rig.status(base) == CommandStatus::in_target; }));
        EXPECT_NEAR(sense * rig.view().set_velocity, 1000, 1e-6) << "900 and 100 on top";
        EXPECT_EQ(rig.status(extra), CommandStatus::active);
        ASSERT_TRUE(watching([&] { return rig.status(extra) == CommandStatus::done; }));
        EXPECT_NEAR(sense * rig.view().set_velocity, 900, 1e-6);
        EXPECT_NEAR(rig.view().superimposed_covered, sense * 1500, 1e-9);
        EXPECT_LE(fastest, 1000 * (1 + 1e-9));
    }
}

// P1-096: blended moves and an addition: the set-point is the sum of both in each cycle.
TEST(Superimposed, SumsWithBlendedMoves) {
    Rig rig(trapezoids()), twin(trapezoids());
    for (auto* one : {&rig, &twin}) {
        one->power_on();
        one->accept(relative(50, 50));
        one->accept(relative(50, 80, mcBlendingHigh));
        one->run(600);
    }
    rig.accept(superimposed(20, 20));
    for (int i = 0; i < 2000; ++i) {
        rig.step();
        twin.step();
        ASSERT_NEAR(rig.view().set_position, twin.view().set_position + rig.view().superimposed_covered, 1e-9) << i;
    }
    EXPECT_NEAR(rig.view().set_position, 120, 1e-9);
}

// No sum passes a software limit: what is known to end behind it is refused, what comes there is stopped on it.
TEST(Superimposed, SumStopsOnTheSoftwareLimit) {
    auto config = trapezoids();
    config.limits.position_min = -10;
    config.limits.position_max = 100;
    config.homing.kind = HomingKind::set_here;
    Rig rig(config);
    rig.power_on();
    rig.accept(home(0));
    rig.run(3);
    rig.accept(absolute(95, 50));
    EXPECT_EQ(rig.status(rig.accept(superimposed(5))), CommandStatus::active);
    rig.run(1);
    EXPECT_EQ(rig.refuse(superimposed(6)), ErrorId::beyond_software_limit);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_DOUBLE_EQ(rig.view().set_position, 100);

    rig.accept(absolute(0, 50));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.accept(at_velocity(50));
    rig.run(500);
    const auto extra = rig.accept(superimposed(200, 30));
    double farthest = 0;
    ASSERT_TRUE(rig.run_until([&] {
        farthest = std::max(farthest, rig.view().set_position);
        return rig.view().state == AxisState::ErrorStop && rig.view().set_velocity == 0;
    }));
    EXPECT_DOUBLE_EQ(rig.view().set_position, 100);
    EXPECT_LE(farthest, 100 * (1 + 1e-15));
    EXPECT_EQ(rig.status(extra), CommandStatus::error);
}

TEST(Superimposed, StatesAndNumbersThatForbidIt) {
    Rig rig;
    EXPECT_EQ(rig.refuse(superimposed(1)), ErrorId::not_powered);
    rig.power_on();
    EXPECT_EQ(rig.refuse(superimposed(std::nan(""))), ErrorId::invalid_position);
    EXPECT_EQ(rig.refuse(superimposed(1, -1)), ErrorId::invalid_velocity);
    auto buffered = superimposed(1);
    buffered.buffer_mode = mcBuffered;
    EXPECT_EQ(rig.refuse(buffered), ErrorId::buffer_mode_not_supported);  // P1-092
    const auto locked = rig.accept(stop());
    EXPECT_EQ(rig.refuse(superimposed(1)), ErrorId::state_forbids);
    rig.run(2);
    rig.axis.release_stop(locked, Owner::program);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    // MC_Stop and power off end it too.
    const auto extra = rig.accept(superimposed(50));
    rig.run(100);
    rig.enable = false;
    rig.step();
    EXPECT_EQ(rig.status(extra), CommandStatus::aborted);
    ASSERT_TRUE(rig.run_to(AxisState::Disabled));
    rig.expect_no_jump();
}

}  // namespace
}  // namespace taktwerk::axes::test
