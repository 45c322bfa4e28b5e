// MC_GearIn, MC_GearOut, MC_CombineAxes: a slave on one or two masters.

#include "tests/axes/axis/coupling_rig.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::test {
namespace {

// Slaves that are planned before their masters would follow last cycle's set-point; here slave 0 follows master 1.
// P1-019, P1-274, P1-275
TEST(Gear, TheSlaveRampsToTheRatioAndLocks) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(1, at_velocity(40));
    rig.run(200);
    const auto id = rig.accept(0, gear_in(1));
    EXPECT_EQ(rig.view(0).state, AxisState::SynchronizedMotion);
    const double master = rig.view(1).set_position, slave = rig.view(0).set_position;
    // 40 u/s at 1000 u/s2: 40 cycles, in which the slave falls back by 0.8.
    rig.run(39);
    EXPECT_EQ(rig.status(0, id), CommandStatus::active);
    rig.run(1);
    EXPECT_EQ(rig.status(0, id), CommandStatus::in_target);
    for (int i = 0; i < 500; ++i) {
        rig.step();
        ASSERT_NEAR(rig.view(0).set_position - slave, rig.view(1).set_position - master - 0.8, 1e-9);
        ASSERT_NEAR(rig.view(0).set_velocity, 40, 1e-9);
    }
    EXPECT_EQ(rig.view(1).state, AxisState::ContinuousMotion);
    EXPECT_EQ(rig.view(0).master, CouplingRig::ref(1));
    rig.expect_no_jump();
}

// P1-274
TEST(Gear, RatiosMayBeNegativeButNotInfinite) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(30));
    rig.run(100);
    EXPECT_EQ(rig.refuse(1, gear_in(0, 1, 0)), ErrorId::invalid_ratio);
    ASSERT_TRUE(rig.run_to_sync(1, rig.accept(1, gear_in(0, -1, 2)), 200));
    EXPECT_NEAR(rig.view(1).set_velocity, -15, 1e-9);
    ASSERT_TRUE(rig.run_to_sync(1, rig.accept(1, gear_in(0, 2, 1)), 200));
    EXPECT_NEAR(rig.view(1).set_velocity, 60, 1e-9);
    rig.expect_no_jump();
}

// Figure 43: the second GearIn takes over without GearOut.
// P1-020, P1-276, P1-279
TEST(Gear, AnotherRatioTakesOver) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(20));
    rig.run(100);
    auto one = gear_in(0), two = gear_in(0, 2, 1);
    one.acceleration = one.deceleration = two.acceleration = two.deceleration = 100;
    one.jerk = two.jerk = 5000;
    const auto first = rig.accept(1, one);
    EXPECT_NEAR(rig.view(1).set_velocity, 0, 1e-9);
    ASSERT_TRUE(rig.run_to_sync(1, first));
    EXPECT_NEAR(rig.view(1).set_velocity, 20, 1e-9);
    rig.run(300);
    EXPECT_EQ(rig.status(1, first), CommandStatus::in_target);
    const auto second = rig.accept(1, two);
    EXPECT_EQ(rig.status(1, first), CommandStatus::aborted);
    EXPECT_EQ(rig.status(1, second), CommandStatus::active);
    int cycles = 0;
    while (rig.status(1, second) != CommandStatus::in_target && cycles < 2000) {
        rig.step();
        ++cycles;
        ASSERT_LE(std::abs(rig.view(1).set_acceleration), 100 + 1e-6);
    }
    // 20 u/s at 100 u/s2 and 5000 u/s3: 0.2 s + 0.02 s.
    EXPECT_EQ(cycles, 220);
    EXPECT_NEAR(rig.view(1).set_velocity, 40, 1e-9);
    rig.expect_no_jump();
}

// P1-031, P1-271, P1-272
TEST(Gear, GearOutKeepsTheVelocity) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(20));
    const auto in = rig.accept(1, gear_in(0, 3, 2));
    ASSERT_TRUE(rig.run_to_sync(1, in));
    rig.run(50);
    const auto out = rig.accept(1, gear_out());
    EXPECT_EQ(rig.status(1, in), CommandStatus::aborted);
    rig.step();
    EXPECT_EQ(rig.status(1, out), CommandStatus::done);
    EXPECT_EQ(rig.view(1).state, AxisState::ContinuousMotion);
    EXPECT_EQ(rig.view(1).active, 0u);
    EXPECT_FALSE(rig.view(1).master.valid());
    rig.accept(0, halt());
    for (int i = 0; i < 1000; ++i) {
        rig.step();
        ASSERT_NEAR(rig.view(1).set_velocity, 30, 1e-9);
    }
    rig.expect_no_jump();
}

// P1-273
TEST(Gear, AfterGearOutAnyCommandIsTaken) {
    struct Next {
        AxisCommand command;
        CommandStatus ends;
        AxisState state;
        double velocity;
    };
    const Next commands[] = {
        {stop(), CommandStatus::done, AxisState::Stopping, 0},  // P1-020: until its Execute falls
        {halt(), CommandStatus::done, AxisState::Standstill, 0},
        {gear_in(0), CommandStatus::in_target, AxisState::SynchronizedMotion, 20},
        {absolute(50), CommandStatus::done, AxisState::Standstill, 0},
        {at_velocity(-10), CommandStatus::in_target, AxisState::ContinuousMotion, -10},
    };
    for (const auto& next : commands) {
        SCOPED_TRACE(static_cast<int>(next.command.kind));
        CouplingRig rig(2);
        rig.start();
        rig.accept(0, at_velocity(20));
        ASSERT_TRUE(rig.run_to_sync(1, rig.accept(1, gear_in(0))));
        rig.run(100);  // the master has come to its speed
        rig.accept(1, gear_out());
        rig.run(10);
        ASSERT_NEAR(rig.view(1).set_velocity, 20, 1e-9);
        const auto id = rig.accept(1, next.command);
        EXPECT_EQ(rig.status(1, id), CommandStatus::active) << "at once";
        rig.run(3000);
        EXPECT_EQ(rig.status(1, id), next.ends);
        EXPECT_EQ(rig.view(1).state, next.state);
        EXPECT_NEAR(rig.view(1).set_velocity, next.velocity, 1e-9);
        if (next.command.kind == CommandKind::move_absolute) {
            EXPECT_NEAR(rig.view(1).set_position, 50, 1e-9);
        }
        rig.expect_no_jump();
    }
}

// P1-031
TEST(Gear, GearOutNeedsACoupling) {
    CouplingRig rig(2);
    rig.start();
    EXPECT_EQ(rig.refuse(1, gear_out()), ErrorId::not_coupled);
    rig.accept(1, at_velocity(20));
    EXPECT_EQ(rig.refuse(1, cam_out()), ErrorId::not_coupled);
    rig.accept(1, absolute(5));
    EXPECT_EQ(rig.refuse(1, gear_out()), ErrorId::not_coupled);
    auto buffered = gear_out();
    buffered.buffer_mode = mcBuffered;
    EXPECT_EQ(rig.refuse(1, buffered), ErrorId::buffer_mode_not_supported);
}

// Whatever may end a coupling takes the slave over as it moves.
TEST(Gear, OtherCommandsTakeTheSlaveOverSmoothly) {
    for (const auto& next : {stop(), halt(), absolute(-5), at_velocity(-30), jog(10)}) {
        CouplingRig rig(2);
        rig.start();
        rig.accept(0, at_velocity(50));
        ASSERT_TRUE(rig.run_to_sync(1, rig.accept(1, gear_in(0))));
        rig.accept(1, next);
        EXPECT_NE(rig.view(1).state, AxisState::SynchronizedMotion);
        rig.run(100);
        EXPECT_FALSE(rig.view(1).master.valid());
        rig.expect_no_jump();
    }
}

TEST(Gear, MastersThatCannotBeOnesAreRefused) {
    CouplingRig rig(3);
    rig.start();
    EXPECT_EQ(rig.refuse(1, gear_in(1)), ErrorId::invalid_master);  // itself
    EXPECT_EQ(rig.refuse(1, gear_in(7)), ErrorId::invalid_master);
    auto commanded = gear_in(0);
    std::get<GearDetails>(commanded.details).source = mcCommandedValue;
    EXPECT_EQ(rig.refuse(1, commanded), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.refuse(1, {.kind = CommandKind::gear_in}), ErrorId::invalid_parameter);
    Rig alone;
    alone.power_on();
    EXPECT_EQ(alone.refuse(gear_in(0)), ErrorId::invalid_master);  // bound to no scene
}

// A ring is refused where it would close, whether the others run or wait.
TEST(Gear, ARingIsRefused) {
    CouplingRig rig(4);
    rig.start();
    rig.accept(1, gear_in(0));
    rig.accept(2, gear_in(1));
    EXPECT_EQ(rig.refuse(0, gear_in(2)), ErrorId::coupling_loop);
    EXPECT_EQ(rig.refuse(1, gear_in(2)), ErrorId::coupling_loop);
    rig.accept(0, relative(30));
    rig.accept(0, gear_in(3, 1, 1, mcBuffered));  // waits
    EXPECT_EQ(rig.refuse(3, gear_in(2)), ErrorId::coupling_loop);
    EXPECT_EQ(rig.refuse(3, combine(1, 2)), ErrorId::coupling_loop);
    rig.accept(0, halt());  // the waiting one is gone
    rig.accept(3, gear_in(2));
    rig.run(10);
    EXPECT_EQ(rig.refuse(0, gear_in(3)), ErrorId::coupling_loop);
}

// P1-018
TEST(Gear, AMasterDoesNotNoticeItsSlaves) {
    CouplingRig with(3), without(3);
    with.start();
    without.start();
    for (int i = 0; i < 1500; ++i) {
        for (auto* rig : {&with, &without}) {
            if (i == 10) rig->accept(1, at_velocity(37));
            if (i == 500) rig->accept(1, absolute(-12.5, 80));
            if (i == 800) rig->accept(1, relative(33.3, 15, mcBuffered));
        }
        if (i == 100) with.accept(0, gear_in(1, 5, 3));
        if (i == 300) with.accept(2, gear_in(1, -1, 3));
        if (i == 900) with.accept(0, phasing(CommandKind::phasing_relative, 4, 10));
        with.step();
        without.step();
        const auto& a = with.view(1);
        const auto& b = without.view(1);
        ASSERT_EQ(a.set_position, b.set_position) << i;
        ASSERT_EQ(a.set_velocity, b.set_velocity) << i;
        ASSERT_EQ(a.set_acceleration, b.set_acceleration) << i;
        ASSERT_EQ(a.state, b.state) << i;
        ASSERT_EQ(with.axes[1].drive_command().position, without.axes[1].drive_command().position) << i;
    }
    with.expect_no_jump();
}

// A chain of slaves, wired against the order of the axes: each follows this cycle's set-point of its master.
TEST(Gear, AChainHasNoDeadTimeWhateverTheOrder) {
    CouplingRig rig(5);
    rig.start();
    for (std::size_t i = 0; i < 4; ++i) rig.accept(i, gear_in(i + 1));
    rig.run(5);
    std::vector<double> start;
    for (std::size_t i = 0; i < 5; ++i) start.push_back(rig.view(i).set_position);
    auto gentle = at_velocity(50);
    gentle.acceleration = 500;
    rig.accept(4, gentle);
    for (int i = 0; i < 300; ++i) {
        rig.step();
        for (std::size_t k = 0; k < 4; ++k)
            ASSERT_NEAR(rig.view(k).set_position - start[k], rig.view(4).set_position - start[4], 1e-9) << "axis " << k << " cycle " << i;
    }
}

// P1-092
TEST(Gear, ABufferedCommandStartsOnInGear) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(30));
    rig.run(100);
    const auto gear = rig.accept(1, gear_in(0));
    const auto next = rig.accept(1, relative(20, 50, mcBuffered));
    ASSERT_TRUE(rig.run_to_sync(1, gear));
    EXPECT_EQ(rig.status(1, next), CommandStatus::queued);
    rig.step();
    EXPECT_EQ(rig.status(1, gear), CommandStatus::aborted);
    EXPECT_EQ(rig.status(1, next), CommandStatus::active);
    EXPECT_EQ(rig.view(1).state, AxisState::DiscreteMotion);
    // And behind a motion: on Done.
    const auto again = rig.accept(1, gear_in(0, 1, 2, mcBuffered));
    ASSERT_TRUE(rig.run_to_sync(1, again));
    EXPECT_EQ(rig.status(1, next), CommandStatus::done);
    EXPECT_NEAR(rig.view(1).set_velocity, 15, 1e-9);
    rig.expect_no_jump();
}

// MC_GearIn.Jerk below that of the axes, in the middle of the master's ramp: the slave goes up to its master's velocity, and nowhere else.
// P1-275
TEST(Gear, ALowJerkInTheMastersRampTakesTheSlaveUpAndNowhereElse) {
    for (const double jerk : {1000.0, 3000.0, 8000.0})
        for (int begin = 5; begin < 120; begin += 23) {
            CouplingRig rig({plain_axis(), plain_axis()});
            rig.start();
            rig.accept(0, at_velocity(80));
            rig.run(begin);
            auto command = gear_in(0);
            command.jerk = jerk;
            const auto gear = rig.accept(1, command);
            for (int i = 0; i < 1500; ++i) {
                const double before = rig.view(1).set_velocity;
                rig.step();
                ASSERT_GE(rig.view(1).set_velocity, before - 1e-9) << jerk << ' ' << begin << ' ' << i;
                ASSERT_LE(rig.view(1).set_velocity, 80 + 1e-9) << jerk << ' ' << begin << ' ' << i;
            }
            EXPECT_EQ(rig.status(1, gear), CommandStatus::in_target);
            rig.expect_no_jump();
        }
}

// InGear: the slave's limit forbids it, then allows it.
// P1-070
TEST(Gear, InGearFallsWhileTheSlaveCannotFollow) {
    CouplingRig rig(2);
    rig.start();
    auto slow = at_velocity(30);
    rig.accept(0, slow);
    const auto gear = rig.accept(1, gear_in(0, 2, 1));
    ASSERT_TRUE(rig.run_to_sync(1, gear));
    rig.accept(0, at_velocity(70));  // 140 u/s for the slave
    rig.run(200);
    EXPECT_EQ(rig.status(1, gear), CommandStatus::active);
    EXPECT_NEAR(rig.view(1).set_velocity, 100, 1e-6);
    EXPECT_EQ(rig.view(1).limiter, VelocityLimiter::axis_limit);
    rig.accept(0, at_velocity(40));
    ASSERT_TRUE(rig.run_to_sync(1, gear));
    EXPECT_NEAR(rig.view(1).set_velocity, 80, 1e-9);
    rig.expect_no_jump();
}

// What is superimposed uses all of the slave's velocity: from standstill the slave may then set off against it, and not with it.
TEST(Gear, BesideAnAdditionAtTheLimitTheSlaveSetsOffOnlyAgainstIt) {
    for (const double sense : {1.0, -1.0}) {
        CouplingRig rig(2);
        rig.start();
        const auto gear = rig.accept(1, gear_in(0));
        ASSERT_TRUE(rig.run_to_sync(1, gear));
        const auto beside = rig.accept(1, {.kind = CommandKind::move_superimposed, .position = 40, .velocity = 100});
        ASSERT_TRUE(rig.run_until([&] { return rig.view(1).set_velocity > 100 - 1e-9; }, 200));
        auto start = at_velocity(50);
        start.direction = sense > 0 ? mcPositiveDirection : mcNegativeDirection;
        rig.accept(0, start);
        rig.run(100);
        EXPECT_EQ(rig.status(1, beside), CommandStatus::active);
        EXPECT_NEAR(rig.view(1).set_velocity, sense > 0 ? 100 : 50, 1e-6);
        ASSERT_TRUE(rig.run_until([&] { return rig.status(1, beside) == CommandStatus::done; }, 2000));
        ASSERT_TRUE(rig.run_to_sync(1, gear));
        EXPECT_NEAR(rig.view(1).set_velocity, sense * 50, 1e-6);
        rig.expect_no_jump();
    }
}

// ContinuousUpdate: another ratio in the same command.
TEST(Gear, AnUpdateChangesTheRatio) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(20));
    const auto gear = rig.accept(1, gear_in(0));
    ASSERT_TRUE(rig.run_to_sync(1, gear));
    EXPECT_EQ(rig.axes[1].update(gear, gear_in(0, 1, 0), Owner::program), ErrorId::invalid_ratio);
    rig.run(3);
    EXPECT_EQ(rig.status(1, gear), CommandStatus::in_target);  // goes on with the last good values
    EXPECT_EQ(rig.axes[1].update(gear, gear_in(0, 3, 1), Owner::program), ErrorId::none);
    rig.step();
    EXPECT_EQ(rig.status(1, gear), CommandStatus::active);
    ASSERT_TRUE(rig.run_to_sync(1, gear));
    EXPECT_NEAR(rig.view(1).set_velocity, 60, 1e-9);
    EXPECT_EQ(rig.view(1).state, AxisState::SynchronizedMotion);
    rig.expect_no_jump();
}

// What has not begun, given in the same scan or waiting, is held to what it would have been held to, had it come with those inputs: it goes on with the
// last good ones, and no ring closes behind the back of others.
TEST(Gear, AnUpdateOfWhatHasNotBegunIsJudgedAsANewOne) {
    CouplingRig rig(3);
    rig.start();
    rig.accept(0, at_velocity(20));
    rig.run(100);
    const auto update = [&](CommandId id, const AxisCommand& command) { return rig.axes[1].update(id, command, Owner::program); };
    const auto gear = rig.accept(1, gear_in(0));
    EXPECT_EQ(update(gear, gear_in(0, 1, 0)), ErrorId::invalid_ratio);
    EXPECT_EQ(update(gear, gear_in(1)), ErrorId::invalid_master);
    EXPECT_EQ(update(gear, gear_in(0, 2, 1)), ErrorId::none);
    ASSERT_TRUE(rig.run_to_sync(1, gear));
    EXPECT_NEAR(rig.view(1).set_velocity, 40, 1e-9);

    rig.accept(1, relative(30, 10));
    const auto waiting = rig.accept(1, gear_in(0, 1, 1, mcBuffered));
    rig.accept(2, gear_in(1));
    rig.run(5);
    EXPECT_EQ(update(waiting, gear_in(2, 1, 1, mcBuffered)), ErrorId::coupling_loop);
    EXPECT_EQ(update(waiting, gear_in(0, 1, 0, mcBuffered)), ErrorId::invalid_ratio);
    ASSERT_EQ(rig.status(1, waiting), CommandStatus::queued);
    ASSERT_TRUE(rig.run_to_sync(1, waiting));
    EXPECT_NEAR(rig.view(1).set_velocity, 20, 1e-9);
}

// A slave whose software limit comes stops before it, in error.
TEST(Gear, ASlaveStopsAtItsSoftwareLimit) {
    auto limited = plain_slave();
    limited.limits.position_max = 30;
    limited.homing.kind = HomingKind::set_here;
    CouplingRig rig({plain_slave(), limited});
    rig.start();
    rig.accept(1, home(0));
    rig.run(3);
    rig.accept(0, at_velocity(40));
    rig.accept(1, gear_in(0));
    ASSERT_TRUE(rig.run_until([&] { return rig.view(1).state == AxisState::ErrorStop; }, 2000));
    rig.run(200);
    EXPECT_TRUE(rig.raised(1, AxisAlarm::software_limit_reached));
    EXPECT_LE(rig.view(1).set_position, 30 + 1e-9);
    EXPECT_GT(rig.view(1).set_position, 29);
    rig.expect_no_jump();
}

// P1-300, P1-301
TEST(Combine, TheSlaveMovesWithBothMasters) {
    for (const auto mode : {mcAddAxes, mcSubAxes}) {
        CouplingRig rig(3);
        rig.start();
        rig.accept(0, at_velocity(10));
        rig.accept(1, at_velocity(30));
        rig.run(100);
        const auto id = rig.accept(2, combine(0, 1, mode, {2, 1}, {1, 2}));
        EXPECT_EQ(rig.view(2).state, AxisState::SynchronizedMotion);
        const double one = rig.view(0).set_position, two = rig.view(1).set_position, slave = rig.view(2).set_position;
        ASSERT_TRUE(rig.run_to_sync(2, id));
        auto back = relative(-7, 40);
        back.acceleration = back.deceleration = 400;  // twice of it is what the slave can
        for (int i = 0; i < 600; ++i) {
            if (i == 100) rig.accept(0, back);
            if (i == 450) rig.accept(1, halt());
            rig.step();
            const double sign = mode == mcAddAxes ? 1 : -1;
            ASSERT_NEAR(rig.view(2).set_position - slave,
                        2 * (rig.view(0).set_position - one) + sign * (rig.view(1).set_position - two) / 2, 1e-9)
                << i;
            ASSERT_EQ(rig.status(2, id), CommandStatus::in_target);
        }
        EXPECT_EQ(rig.view(2).state, AxisState::SynchronizedMotion);
        rig.accept(2, halt());
        rig.run(200);
        EXPECT_EQ(rig.view(2).state, AxisState::Standstill);
        rig.expect_no_jump();
    }
}

// A sum as the master of another: the third axis meets its sync point on it. Axes wired against their order.
// P1-302
TEST(Combine, TheSumIsAMasterItself) {
    CouplingRig rig(4);  // follower, sum, two masters
    rig.start();
    rig.accept(2, at_velocity(15));
    rig.accept(3, at_velocity(-5));
    const auto sum = rig.accept(1, combine(2, 3, mcAddAxes, {2, 1}, {1, 1}));  // 25 u/s
    const auto id = rig.accept(0, gear_in_pos(1, 30, 12, 20));
    for (Patience patience; patience.lasts(rig.view(1).set_position < 60);) {
        rig.step();
        const double master = rig.view(1).set_position;
        if (master < 10) {
            ASSERT_EQ(rig.view(0).set_position, 0);
        }
        ASSERT_EQ(rig.status(0, id) == CommandStatus::in_target, master >= 30) << master;
        if (master >= 30) {
            ASSERT_NEAR(rig.view(0).set_position, 12 + master - 30, 1e-9);
            ASSERT_NEAR(rig.view(0).set_velocity, 25, 1e-9);
        }
    }
    EXPECT_EQ(rig.status(1, sum), CommandStatus::in_target);
    EXPECT_EQ(rig.view(0).state, AxisState::SynchronizedMotion);
    EXPECT_EQ(rig.view(1).state, AxisState::SynchronizedMotion);
    rig.expect_no_jump();
}

// Each master has a source of its own: the noise of a master's measurement comes with its own actual source only.
// P1-302
TEST(Combine, EachMasterHasItsOwnSource) {
    for (const std::size_t measured : {0u, 1u})
        for (const std::size_t noisy : {0u, 1u}) {
            CouplingRig rig(3);
            rig.start();
            rig.accept(0, at_velocity(10));
            rig.accept(1, at_velocity(20));
            rig.run(100);
            auto command = combine(0, 1);
            auto& details = std::get<CombineDetails>(command.details);
            (measured == 0 ? details.source1 : details.source2) = mcActualValue;
            const auto id = rig.accept(2, command);
            ASSERT_TRUE(rig.run_to_sync(2, id, 1000));
            rig.run(200);
            double least = 1e9, most = -1e9;
            for (int i = 0; i < 1000; ++i) {
                rig.drives[noisy]->lag = i * 7919 % 5 - 2;  // counts
                rig.step();
                least = std::min(least, rig.view(2).set_velocity);
                most = std::max(most, rig.view(2).set_velocity);
            }
            EXPECT_NEAR((least + most) / 2, 30, 0.5);
            if (measured == noisy) {
                EXPECT_GT(most - least, 1e-3);
            } else {
                EXPECT_LT(most - least, 1e-5);
            }
            rig.expect_no_jump();
        }
}

TEST(Combine, EachMasterAndRatioIsChecked) {
    CouplingRig rig(3);
    rig.start();
    EXPECT_EQ(rig.refuse(2, combine(0, 2)), ErrorId::invalid_master);
    EXPECT_EQ(rig.refuse(2, combine(5, 1)), ErrorId::invalid_master);
    EXPECT_EQ(rig.refuse(2, combine(0, 1, mcAddAxes, {1, 1}, {1, 0})), ErrorId::invalid_ratio);
    rig.accept(2, combine(0, 0));  // twice the same is twice as much
    rig.accept(0, at_velocity(10));
    rig.run(200);
    EXPECT_NEAR(rig.view(2).set_velocity, 20, 1e-9);
}

}  // namespace
}  // namespace taktwerk::axes::test
