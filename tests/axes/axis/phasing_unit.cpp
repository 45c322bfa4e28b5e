// MC_PhasingAbsolute, MC_PhasingRelative: the master's position as the slave sees it.

#include "tests/axes/axis/coupling_rig.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr auto absolutely = CommandKind::phasing_absolute, relatively = CommandKind::phasing_relative;

struct PhasedRig : CouplingRig {
    PhasedRig() : CouplingRig(2) {
        start();
        accept(0, at_velocity(20));
        run(100);
        gear = accept(1, gear_in(0, 2, 1));
        EXPECT_TRUE(run_to_sync(1, gear));
        offset = view(1).set_position - 2 * view(0).set_position;
    }
    CommandId gear = 0;
    double offset = 0;
    /// slave = 2 * (master + shift) + offset
    [[nodiscard]] double shift() const { return (view(1).set_position - offset) / 2 - view(0).set_position; }
};

// 5 u at 25 u/s and 400 u/s2 (twice of it is what the slave can): 62.5 ms up, 137.5 ms, 62.5 ms down; the coupling stays active beside it.
// P1-290, P1-291, P1-292, P1-294, P1-295, P1-297
TEST(Phasing, AbsoluteShiftsToTheValueAndStays) {
    PhasedRig rig;
    auto command = phasing(absolutely, 5, 25);
    command.acceleration = command.deceleration = 400;
    const auto phase = rig.accept(1, command);
    int cycles = 0;
    while (rig.status(1, phase) == CommandStatus::active && cycles < 1000) {
        rig.step();
        ++cycles;
        ASSERT_NEAR(rig.shift(), rig.view(1).phase_shift, 1e-9);
        ASSERT_NEAR(rig.view(1).phase_shift, rig.view(1).phase_covered, 1e-12);
        ASSERT_LE(rig.view(1).set_velocity, 2 * (20 + 25) + 1e-9);
        ASSERT_EQ(rig.status(1, rig.gear), CommandStatus::in_target);
        ASSERT_EQ(rig.view(1).state, AxisState::SynchronizedMotion);
    }
    EXPECT_EQ(rig.status(1, phase), CommandStatus::done);
    EXPECT_NEAR(cycles, 263, 1);
    for (int i = 0; i < 1000; ++i) {
        rig.step();
        ASSERT_NEAR(rig.shift(), 5, 1e-9);
    }
    rig.accept(1, command);
    for (int i = 0; i < 100; ++i) {
        rig.step();
        ASSERT_NEAR(rig.shift(), 5, 1e-9);
    }
}

// Velocity and ramps are the master's units, so the master's limits hold, not those of a slower slave: 10 u with 1000 u/s2 take 2 * sqrt(10 / 1000) s
// and reach its 100 u/s just so. The slave, at most 30 u/s, falls behind meanwhile.
TEST(Phasing, ItsLimitsAreThoseOfTheMaster) {
    auto slow = plain_slave();
    slow.limits.velocity = 30;
    CouplingRig rig({plain_slave(), slow});
    rig.start();
    const auto gear = rig.accept(1, gear_in(0));
    ASSERT_TRUE(rig.run_to_sync(1, gear));
    const auto phase = rig.accept(1, phasing(absolutely, 10, 0));
    int cycles = 0;
    for (; rig.status(1, phase) == CommandStatus::active && cycles < 1000; ++cycles) rig.step();
    EXPECT_EQ(rig.status(1, phase), CommandStatus::done);
    EXPECT_NEAR(cycles, 200, 2);
    rig.expect_no_jump();
}

// P1-293, P1-295
TEST(Phasing, RelativeAddsToTheShift) {
    PhasedRig rig;
    rig.accept(1, phasing(relatively, 4, 25));
    rig.run(400);
    rig.accept(1, phasing(relatively, -1.5, 25));
    rig.run(10);
    EXPECT_LT(rig.view(1).phase_covered, 0);
    rig.run(400);
    EXPECT_NEAR(rig.shift(), 2.5, 1e-9);
    EXPECT_NEAR(rig.view(1).phase_covered, -1.5, 1e-9);
    rig.expect_no_jump();
}

// The slave's limit of 1000 u/s2 would be 2000 with the ratio 2: the phasing asks for what the slave can. A buffered one: waiting_coupling_unit.
TEST(Phasing, ANewOneTakesOverFromWhereTheFirstIs) {
    PhasedRig rig;
    auto gentle = phasing(relatively, 10, 20);
    gentle.acceleration = gentle.deceleration = 400;
    const auto first = rig.accept(1, gentle);
    rig.run(50);
    gentle.position = -3;
    const auto second = rig.accept(1, gentle);  // from where the first one is
    EXPECT_EQ(rig.status(1, first), CommandStatus::aborted);
    const double there = rig.view(1).phase_shift;
    double farthest = there;
    ASSERT_TRUE(rig.run_until([&] {
        farthest = std::max(farthest, rig.view(1).phase_shift);
        return rig.status(1, second) == CommandStatus::done;
    }));
    EXPECT_NEAR(rig.shift(), there - 3, 1e-9);
    EXPECT_GT(farthest, there);
    rig.expect_no_jump();
}

TEST(Phasing, NeedsACoupling) {
    CouplingRig rig(2);
    rig.start();
    EXPECT_EQ(rig.refuse(1, phasing(absolutely, 1, 10)), ErrorId::not_coupled);
    rig.accept(1, at_velocity(10));
    EXPECT_EQ(rig.refuse(1, phasing(absolutely, 1, 10)), ErrorId::not_coupled);
    rig.accept(1, gear_in(0));
    EXPECT_EQ(rig.refuse(1, phasing(absolutely, std::nan(""), 10)), ErrorId::invalid_position);
    EXPECT_EQ(rig.refuse(1, phasing(absolutely, 1, -1)), ErrorId::invalid_velocity);
}

// The end of the coupling is the end of its phasing; the next coupling sees the master as it is. Another ratio keeps the shift.
TEST(Phasing, EndsWithTheCoupling) {
    PhasedRig rig;
    rig.accept(1, phasing(absolutely, 3, 25));
    rig.run(300);
    const auto other = rig.accept(1, gear_in(0, 1, 1));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(1, other) == CommandStatus::in_target; }));
    EXPECT_EQ(rig.view(1).phase_shift, 3);
    const auto late = rig.accept(1, phasing(relatively, 3, 5));
    rig.run(20);
    rig.accept(1, halt());
    rig.run(2);
    EXPECT_EQ(rig.status(1, late), CommandStatus::aborted);
    EXPECT_EQ(rig.view(1).phase_shift, 0);
    rig.expect_no_jump();
}

/// A cam of humps of 4 over 20, entered absolutely, the master at 15 u/s.
struct HumpRig : CouplingRig {
    HumpRig() : CouplingRig(2) {
        const auto table =
            tables.add_cam(std::vector<CamPoint>{{.master = 0, .slave = 0}, {.master = 10, .slave = 4}, {.master = 20, .slave = 0}});
        start();
        EXPECT_EQ(axes[1].set(SelectCam{table, true}, Owner::program), ErrorId::none);
        cam = view(1).selected_cam;
        accept(0, at_velocity(15));
        coupled = accept(1, cam_in(0, cam));
        run(300);
    }
    /// What the table says for a master `shift` further on.
    [[nodiscard]] CamValue hump(double shift = 0) const { return tables.prepared(cam)->at(std::fmod(view(0).set_position + shift, 20)); }
    CamId cam;
    CommandId coupled = 0;
};

// With a cam, phasing moves the curve in time: slave(t) = f(master + shift), position and velocity.
// P1-296, P1-299
TEST(Phasing, ShiftsACamAlongTheMaster) {
    HumpRig rig;
    const auto phase = rig.accept(1, phasing(absolutely, 7, 20));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(1, phase) == CommandStatus::done; }));
    rig.run(300);
    for (int i = 0; i < 3000; ++i) {
        rig.step();
        ASSERT_NEAR(rig.view(1).set_position, rig.hump(7).position, 1e-9);
        ASSERT_NEAR(rig.view(1).set_velocity, rig.hump(7).first * 15, 1e-9);
    }
    rig.expect_no_jump();
}

// The other half: a superimposed motion of as much moves the same curve in place, and not in time: slave(t) = f(master) + distance.
// P1-296
TEST(Phasing, WhereASuperimposedMotionShiftsTheSlave) {
    HumpRig rig;
    const AxisCommand extra{
        .kind = CommandKind::move_superimposed, .position = 7, .velocity = 20, .acceleration = 200, .deceleration = 200};
    const auto added = rig.accept(1, extra);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(1, added) == CommandStatus::done; }));
    rig.run(300);
    for (int i = 0; i < 3000; ++i) {
        rig.step();
        ASSERT_NEAR(rig.view(1).set_position, rig.hump().position + 7, 1e-9);
        ASSERT_NEAR(rig.view(1).set_velocity, rig.hump().first * 15, 1e-9);
        ASSERT_EQ(rig.view(1).phase_shift, 0);
        ASSERT_EQ(rig.status(1, rig.coupled), CommandStatus::in_target);
    }
    rig.expect_no_jump();
}

// Figure 48: both modulo 360, gear 1:1, the master at 200 u/s; a shift of 90 at 50 u/s and 100 u/s2: 0.5 s up, 1.3 s, 0.5 s down.
// P1-298
TEST(Phasing, Figure48AShiftOverTheWrap) {
    auto rotary = plain_slave();
    rotary.gearing = {.counts_per_revolution = 36000, .motor_revolutions = 1, .load_revolutions = 1, .feed = 360};
    rotary.modulo = 360;
    rotary.limits = {.velocity = 1000, .acceleration = 1000, .deceleration = 1000, .jerk = std::numeric_limits<double>::infinity()};
    CouplingRig rig({rotary, rotary});
    rig.start();
    rig.accept(0, at_velocity(200));
    rig.run(300);
    const auto gear = rig.accept(1, gear_in(0));
    ASSERT_TRUE(rig.run_to_sync(1, gear));
    const auto apart = [&] {
        const double way = rig.view(1).set_position - rig.view(0).set_position;
        return way - 360 * std::floor(way / 360);
    };
    const double before = apart();
    auto command = phasing(absolutely, 90, 50);
    command.acceleration = command.deceleration = 100;
    const auto phase = rig.accept(1, command);
    for (int i = 1; i <= 2300; ++i) {
        ASSERT_EQ(rig.status(1, phase), CommandStatus::active) << i;
        rig.step();
        const double trapezoid = i <= 500 ? 0.1 * i : i <= 1800 ? 50 : 0.1 * (2300 - i);
        ASSERT_NEAR(rig.view(1).set_velocity, 200 + trapezoid, 1e-6) << i;
        ASSERT_NEAR(rig.view(0).set_velocity, 200, 1e-9);
    }
    rig.step();
    EXPECT_EQ(rig.status(1, phase), CommandStatus::done);
    const auto turns = rig.view(0).turns;
    for (int i = 0; i < 10000; ++i) {
        rig.step();
        double shift = apart() - before - 90;
        shift -= 360 * std::round(shift / 360);
        ASSERT_NEAR(shift, 0, 1e-9) << i;
        ASSERT_NEAR(rig.view(1).set_velocity, 200, 1e-9);
    }
    EXPECT_GE(rig.view(0).turns, turns + 5);
    rig.expect_no_jump();
}

// A shift faster than the slave may follow: the slave comes later, and then it is shifted by what was asked, without having gone back.
// P1-290, P1-291
TEST(Phasing, ASlaveHeldAtItsLimitsIsShiftedByWhatWasAskedAllTheSame) {
    for (const std::int32_t ratio : {1, 2}) {
        CouplingRig rig({plain_axis(), plain_axis()});
        rig.start();
        const auto gear = rig.accept(1, gear_in(0, ratio, 1));
        ASSERT_TRUE(rig.run_to_sync(1, gear));
        rig.accept(0, at_velocity(30));
        rig.run(600);
        const auto apart = [&] { return rig.view(1).set_position - ratio * rig.view(0).set_position; };
        const double before = apart();
        const auto phase = rig.accept(1, phasing(relatively, 10));
        bool held = false;
        for (int i = 0; i < 2000; ++i) {
            rig.step();
            held = held || rig.status(1, gear) == CommandStatus::active;
            ASSERT_GT(rig.view(1).set_velocity, 0) << i;
            ASSERT_LE(apart() - before, 10 * ratio * 1.05) << i;
        }
        EXPECT_TRUE(held);
        EXPECT_EQ(rig.status(1, phase), CommandStatus::done);
        EXPECT_EQ(rig.status(1, gear), CommandStatus::in_target);
        EXPECT_NEAR(apart() - before, 10 * ratio, 1e-9);
        rig.expect_no_jump();
    }
}

AxisCommand halt_phasing(double deceleration = 0, double jerk = 0) {
    return {.kind = CommandKind::halt_phasing, .deceleration = deceleration, .jerk = jerk};
}

// 25 u/s after 62.5 ms with 400 u/s2; after 150 ms 0.78125 + 25 * 0.0875 = 2.96875 u are shifted. The halt with 250 u/s2 takes 100 ms and adds
// 25^2 / 500 = 1.25 u.
TEST(HaltPhasing, EndsItAndKeepsTheShiftThatIsReached) {
    for (const auto kind : {absolutely, relatively}) {
        PhasedRig rig;
        auto command = phasing(kind, 10, 25);
        command.acceleration = command.deceleration = 400;
        const auto phase = rig.accept(1, command);
        rig.run(150);
        ASSERT_NEAR(rig.view(1).phase_shift, 2.96875, 1e-9);
        const auto halt = rig.accept(1, halt_phasing(250));
        EXPECT_EQ(rig.status(1, phase), CommandStatus::aborted);
        int cycles = 0;
        for (; rig.status(1, halt) == CommandStatus::active && cycles < 1000; ++cycles) {
            rig.step();
            ASSERT_NEAR(rig.shift(), rig.view(1).phase_shift, 1e-9);
            ASSERT_EQ(rig.status(1, rig.gear), CommandStatus::in_target);
        }
        EXPECT_EQ(rig.status(1, halt), CommandStatus::done);
        EXPECT_NEAR(cycles, 100, 1);
        rig.run(500);
        EXPECT_NEAR(rig.shift(), 4.21875, 1e-9);
        EXPECT_NEAR(rig.view(1).phase_covered, 4.21875, 1e-9);
        EXPECT_EQ(rig.view(1).state, AxisState::SynchronizedMotion);
        rig.accept(1, phasing(relatively, 1, 25));  // from there on
        rig.run(500);
        EXPECT_NEAR(rig.shift(), 5.21875, 1e-9);
        rig.expect_no_jump();
    }
}

// As every stop: with however little jerk, the shift neither turns round nor becomes faster than its acceleration makes it without the halt.
TEST(HaltPhasing, NeverTurnsRoundAndAddsNoSpeed) {
    for (const bool speeds_up : {true, false})
        for (const double jerk : {20'000.0, 5'000.0, 500.0}) {
            CouplingRig rig({plain_axis(), plain_axis()});
            rig.start();
            const auto gear = rig.accept(1, gear_in(0));
            ASSERT_TRUE(rig.run_to_sync(1, gear));
            rig.accept(1, phasing(relatively, 10, 25));
            double place = 0, v = 0, a = 0;
            const auto step = [&] {
                rig.step();
                const double velocity = (rig.view(1).phase_shift - place) * 1000;
                a = (velocity - v) * 1000;
                v = velocity;
                place = rig.view(1).phase_shift;
            };
            for (int i = 0; i < 5000 && !(speeds_up ? v > 8 && a > 500 : v > 0 && v < 8 && a < -500); ++i) step();
            ASSERT_GT(std::abs(a), 500);
            ASSERT_LT(v, 13);
            const double most = speeds_up ? v + a * a / (2 * 20'000) + 1 : v;
            const auto halt = rig.accept(1, halt_phasing(0, jerk));
            for (int i = 0; i < 2000; ++i) {
                step();
                ASSERT_GE(v, -1e-9) << i << " with " << jerk;
                ASSERT_LE(v, most + 1e-9) << i << " with " << jerk;
            }
            EXPECT_EQ(rig.status(1, halt), CommandStatus::done);
            EXPECT_EQ(v, 0);
        }
}

TEST(HaltPhasing, WhatItMeets) {
    PhasedRig rig;
    const auto nothing = rig.accept(1, halt_phasing());
    EXPECT_EQ(rig.status(1, nothing), CommandStatus::done) << "there is nothing to halt";
    EXPECT_EQ(rig.refuse(1, halt_phasing(-1)), ErrorId::invalid_dynamics);
    EXPECT_EQ(rig.refuse(0, halt_phasing()), ErrorId::not_coupled);

    auto gentle = phasing(relatively, 10, 20);
    gentle.acceleration = gentle.deceleration = 400;
    rig.accept(1, gentle);
    rig.run(100);
    const auto first = rig.accept(1, halt_phasing(100));
    rig.run(10);
    const auto harder = rig.accept(1, halt_phasing(400));
    EXPECT_EQ(rig.status(1, first), CommandStatus::aborted);
    rig.run(10);
    const auto on = rig.accept(1, gentle);
    EXPECT_EQ(rig.status(1, harder), CommandStatus::aborted);
    const double there = rig.view(1).phase_shift;
    ASSERT_TRUE(rig.run_until([&] { return rig.status(1, on) == CommandStatus::done; }));
    EXPECT_NEAR(rig.shift(), there + 10, 1e-9);

    rig.accept(1, gentle);
    rig.run(100);
    const auto late = rig.accept(1, halt_phasing(100));
    rig.run(10);
    rig.accept(1, halt());
    rig.run(2);
    EXPECT_EQ(rig.status(1, late), CommandStatus::aborted) << "the coupling is over, and the shift with it";
    EXPECT_EQ(rig.view(1).phase_shift, 0);
    rig.expect_no_jump();
}

// As MC_Halt it ends what waits, too: a phasing behind a coupling that is not in sync yet does not begin afterwards.
TEST(HaltPhasing, EndsOneThatWaits) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(50));
    rig.run(100);
    const auto gear = rig.accept(1, gear_in(0));
    const auto waits = rig.accept(1, phasing(relatively, 5, 20, mcBuffered));
    rig.run(5);
    ASSERT_EQ(rig.status(1, waits), CommandStatus::queued);
    const auto halt = rig.accept(1, halt_phasing());
    EXPECT_EQ(rig.status(1, halt), CommandStatus::done);
    EXPECT_EQ(rig.status(1, waits), CommandStatus::aborted);
    ASSERT_TRUE(rig.run_to_sync(1, gear));
    rig.run(500);
    EXPECT_EQ(rig.view(1).phase_shift, 0);
}

}  // namespace
}  // namespace taktwerk::axes::test
