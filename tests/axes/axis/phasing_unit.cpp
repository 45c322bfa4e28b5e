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

}  // namespace
}  // namespace taktwerk::axes::test
