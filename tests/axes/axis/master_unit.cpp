// Masters: measured ones, encoders, and those that get lost.

#include "tests/axes/axis/coupling_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisConfig encoder() {
    auto config = plain_slave();
    config.encoder = true;
    return config;
}

AxisCommand measured(AxisCommand command) {
    std::get<GearDetails>(command.details).source = mcActualValue;
    return command;
}

TEST(Encoder, IsNeverPoweredAndTakesNoMotion) {
    CouplingRig rig({encoder()});
    rig.start();
    EXPECT_EQ(rig.axes[0].power(true, true, true, Owner::program), ErrorId::not_supported);
    rig.run(10);
    EXPECT_EQ(rig.view(0).state, AxisState::Disabled);
    EXPECT_EQ(rig.axes[0].drive_command().power, PowerRequest::off);
    for (const auto& command : {absolute(1), at_velocity(1), halt(), stop(), jog(1), home(0)})
        EXPECT_EQ(rig.refuse(0, command), ErrorId::not_supported);
    rig.drives[0]->position = 1234;
    rig.run(5);
    EXPECT_NEAR(rig.view(0).actual_position, 1.234, 1e-9);
}

// An encoder that turns steadily: 20 counts a cycle are 20 u/s. The slave's set-point is where the encoder is when the slave's drive
// acts on it: one cycle from latch to arrival, one from sending to effect.
// P1-278
TEST(Encoder, IsFollowedAtTheInstantOfTheSlavesSetPoint) {
    CouplingRig rig({encoder(), plain_slave()});
    rig.start();
    rig.drives[0]->coasting = 20;
    rig.run(300);
    const auto id = rig.accept(1, measured(gear_in(0)));
    ASSERT_TRUE(rig.run_to_sync(1, id, 500));
    EXPECT_NEAR(rig.view(1).set_velocity, 20, 1e-6);
    // The lost distance is settled at the start; from then on both go the same way.
    const double apart = rig.view(1).set_position - rig.view(0).actual_position;
    for (int i = 0; i < 2000; ++i) {
        rig.step();
        ASSERT_NEAR(rig.view(1).set_position - rig.view(0).actual_position, apart, 1e-6);
        ASSERT_EQ(rig.status(1, id), CommandStatus::in_target);
    }
    rig.expect_no_jump();
}

// Extrapolation, seen where it cannot hide in an offset: a cam is a matter of places. A hump of 10 over 20, entered absolutely.
// P1-252
TEST(Encoder, DeadTimeIsMadeUp) {
    CouplingRig rig({encoder(), plain_slave()});
    const auto table =
        rig.tables.add_cam(std::vector<CamPoint>{{.master = 0, .slave = 0}, {.master = 10, .slave = 3}, {.master = 20, .slave = 0}});
    rig.start();
    ASSERT_EQ(rig.axes[1].set(SelectCam{table, true}, Owner::program), ErrorId::none);
    const auto id = rig.view(1).selected_cam;
    rig.drives[0]->coasting = 20;
    rig.run(300);
    auto command = cam_in(0, id);
    std::get<CamDetails>(command.details).source = mcActualValue;
    const auto cam = rig.accept(1, command);
    ASSERT_TRUE(rig.run_to_sync(1, cam, 2000));
    rig.run(300);
    for (int i = 0; i < 2000; ++i) {
        rig.step();
        // The motor's place now is latched as one cycle old; the set-point acts one cycle later: two cycles of 20 u/s.
        const double then = rig.view(0).actual_position + 20 * 0.002;
        ASSERT_NEAR(rig.view(1).set_position, rig.tables.prepared(id)->at(std::fmod(then, 20)).position, 1e-5) << i;
    }
    rig.expect_no_jump();
}

// Noise of the measurement reaches the slave with the actual source only.
// P1-278
TEST(Encoder, NoiseComesWithTheActualSourceOnly) {
    for (const auto source : {mcSetValue, mcActualValue}) {
        CouplingRig rig(2);
        rig.start();
        rig.accept(0, at_velocity(20));
        rig.run(100);
        auto command = gear_in(0);
        std::get<GearDetails>(command.details).source = source;
        const auto id = rig.accept(1, command);
        ASSERT_TRUE(rig.run_to_sync(1, id, 1000));
        rig.run(200);
        double least = 1e9, most = -1e9;
        for (int i = 0; i < 1000; ++i) {
            rig.drives[0]->lag = i * 7919 % 5 - 2;  // counts
            rig.step();
            least = std::min(least, rig.view(1).set_velocity);
            most = std::max(most, rig.view(1).set_velocity);
        }
        if (source == mcSetValue) {
            EXPECT_NEAR(most - least, 0, 1e-9);
        } else {
            EXPECT_GT(most - least, 1e-3);
        }
        EXPECT_LT(most - least, 2);  // raw, 4 counts in a cycle would be 4 u/s
        rig.expect_no_jump();
    }
}

// A slave with a jerk of its own on a measured master: it goes as the master goes, and no faster than the master and what the filter makes up.
// P1-275, P1-278
TEST(Master, ASlaveOfAMeasuredMasterIsNoFasterThanItsMaster) {
    CouplingRig rig({plain_axis(), plain_axis(), plain_axis(), plain_axis()});
    rig.start();
    const auto gear = rig.accept(1, measured(gear_in(0)));
    auto sum = combine(0, 2);
    std::get<CombineDetails>(sum.details).source1 = std::get<CombineDetails>(sum.details).source2 = mcActualValue;
    const auto both = rig.accept(3, sum);
    rig.run(50);
    for (const double velocity : {5.0, 60.0}) {
        auto gently = at_velocity(velocity);
        gently.acceleration = 100;
        rig.accept(0, gently);
        const double before = rig.view(0).set_velocity;
        for (int i = 0; i < 2000; ++i) {
            rig.step();
            for (const std::size_t slave : {1, 3}) {
                ASSERT_GE(rig.view(slave).set_velocity, before - 0.5) << slave << ' ' << i;
                ASSERT_LE(rig.view(slave).set_velocity, velocity + 0.5) << slave << ' ' << i;
            }
        }
        EXPECT_EQ(rig.status(1, gear), CommandStatus::in_target);
        EXPECT_EQ(rig.status(3, both), CommandStatus::in_target);
        EXPECT_NEAR(rig.view(1).set_position, rig.view(0).set_position, 1e-3);
        EXPECT_NEAR(rig.view(3).set_position, rig.view(0).set_position, 1e-3);
    }
    rig.expect_no_jump();
}

// A belt that never runs steadily: its slave stays in gear and where the belt is.
// P1-275, P1-278
TEST(Encoder, AnUnsteadyBeltIsFollowedInGear) {
    for (const double swing : {1.0, 5.0})
        for (const double frequency : {0.5, 2.0, 10.0}) {
            auto belt = plain_axis();
            belt.encoder = true;
            CouplingRig rig({belt, plain_axis()});
            rig.start();
            rig.drives[0]->coasting = 50;  // counts per cycle: u/s
            const auto gear = rig.accept(1, measured(gear_in(0)));
            ASSERT_TRUE(rig.run_to_sync(1, gear, 1000));
            rig.run(200);
            const auto apart = [&] { return rig.view(1).set_position - rig.view(0).actual_position; };
            const double before = apart();
            for (int i = 0; i < 3000; ++i) {
                rig.drives[0]->coasting = 50 + swing * std::sin(2 * 3.14159265358979 * frequency * i * 1e-3);
                rig.step();
                ASSERT_EQ(rig.status(1, gear), CommandStatus::in_target) << swing << ' ' << frequency << ' ' << i;
                ASSERT_NEAR(rig.view(1).set_velocity, 50, 1.2 * swing + 0.5) << swing << ' ' << frequency << ' ' << i;
                // The dead time of two cycles, and what the filter is late while the belt speeds up.
                ASSERT_NEAR(apart(), before, 0.005 * swing + 0.003) << swing << ' ' << frequency << ' ' << i;
            }
            rig.expect_no_jump();
        }
}

// An encoder so coarse that one count is more than the slave can follow in a cycle: the slave rounds the steps, about as fast as the belt, and
// once it has been in gear it loses no way.
// P1-275, P1-278
TEST(Encoder, TheStepsOfACoarseEncoderAreRoundedAndNoWayIsLost) {
    auto belt = plain_axis();
    belt.encoder = true;
    belt.gearing.counts_per_revolution = 200;  // 0.05 u
    CouplingRig rig({belt, plain_axis()});
    rig.start();
    rig.drives[0]->coasting = 0.3;  // 15 u/s
    const auto gear = rig.accept(1, measured(gear_in(0)));
    ASSERT_TRUE(rig.run_to_sync(1, gear, 3000));
    rig.run(500);
    const auto apart = [&] { return rig.view(1).set_position - rig.view(0).actual_position; };
    const double before = apart();
    for (int i = 0; i < 10000; ++i) {
        rig.step();
        ASSERT_NEAR(rig.view(1).set_velocity, 15, 5) << i;
        ASSERT_NEAR(apart(), before, 0.15) << i;
    }
    rig.expect_no_jump();
}

// A belt that is stopped at once while its slave catches up: what the filter makes of that reaches as far as the slave's place in gear, not before.
// P1-275, P1-278
TEST(Encoder, ABeltThatIsStoppedTurnsNoSlaveRoundThatCatchesUp) {
    for (const double jerk : {0.0, 10'000.0})  // 0: none
        for (const int stop : {5, 20, 40, 60}) {
            CouplingRig rig({encoder(), plain_slave()});
            rig.start();
            rig.drives[0]->coasting = 80;  // counts per cycle: u/s
            rig.run(300);
            auto command = measured(gear_in(0));
            command.jerk = jerk;
            const auto gear = rig.accept(1, command);
            rig.run(stop);
            rig.drives[0]->coasting = 0;
            bool in_gear = false;
            for (int i = 0; i < 2000 && !in_gear; ++i) {
                rig.step();
                in_gear = rig.status(1, gear) == CommandStatus::in_target;
                ASSERT_TRUE(in_gear || rig.view(1).set_velocity >= -0.2) << jerk << ' ' << stop << ' ' << i;  // a count's share of noise
            }
            EXPECT_TRUE(in_gear) << jerk << ' ' << stop;
            rig.expect_no_jump();
        }
}

// A measured master whose feedback stops: a short gap is bridged, a long one ends the coupling in an error, along the slave's own ramp.
TEST(Master, LossOfFeedbackStopsTheSlave) {
    CouplingRig rig({encoder(), plain_slave()});
    rig.start();
    rig.drives[0]->coasting = 30;
    rig.run(100);
    const auto id = rig.accept(1, measured(gear_in(0)));
    ASSERT_TRUE(rig.run_to_sync(1, id, 1000));
    rig.run(100);
    rig.drives[0]->silent = true;
    rig.run(2);
    rig.drives[0]->silent = false;
    rig.run(50);
    EXPECT_EQ(rig.status(1, id), CommandStatus::in_target);
    EXPECT_NEAR(rig.view(1).set_velocity, 30, 0.01);

    rig.drives[0]->offline = true;
    rig.step();
    EXPECT_EQ(rig.view(1).state, AxisState::ErrorStop);
    EXPECT_EQ(rig.error_of(1, id), ErrorId::master_lost);
    EXPECT_TRUE(rig.raised(1, AxisAlarm::master_lost));
    rig.run(100);
    EXPECT_EQ(rig.view(1).set_velocity, 0);
    rig.expect_no_jump();

    rig.drives[0]->offline = false;
    rig.run(5);
    EXPECT_EQ(rig.axes[1].reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.run_until([&] { return rig.view(1).state == AxisState::Standstill; }, 100));
    ASSERT_TRUE(rig.run_to_sync(1, rig.accept(1, measured(gear_in(0))), 1000));
    rig.expect_no_jump();
}

// A master's drive fails: the master stops along its error ramp, and a slave of its set-points goes with it to the end.
TEST(Master, ASlaveOfSetPointsFollowsItsMasterIntoTheErrorStop) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(40));
    const auto id = rig.accept(1, gear_in(0));
    ASSERT_TRUE(rig.run_to_sync(1, id));
    rig.run(100);
    const double apart = rig.view(1).set_position - rig.view(0).set_position;
    rig.drives[0]->blocked = true;
    rig.axes[0].stop_for_error(0x3001, false);
    for (int i = 0; i < 60; ++i) {
        rig.step();
        ASSERT_NEAR(rig.view(1).set_position - rig.view(0).set_position, apart, 1e-9);
    }
    EXPECT_EQ(rig.view(0).state, AxisState::ErrorStop);
    EXPECT_EQ(rig.view(1).state, AxisState::SynchronizedMotion);
    EXPECT_EQ(rig.view(1).set_velocity, 0);
    rig.expect_no_jump();
}

// The master's place gets another number while it is coupled: no slave may go there.
TEST(Master, AJumpOfTheMastersPlaceIsALoss) {
    CouplingRig rig({encoder(), plain_slave()});
    rig.start();
    rig.run(20);
    const auto id = rig.accept(1, measured(gear_in(0)));
    rig.run(100);
    rig.drives[0]->position += 50'000;
    rig.run(2);
    EXPECT_EQ(rig.error_of(1, id), ErrorId::master_lost);
    EXPECT_EQ(rig.view(1).state, AxisState::ErrorStop);
    EXPECT_NEAR(rig.view(1).set_position, 0, 1e-6);
    rig.expect_no_jump();
}

// MC_SetPosition gives places other numbers and moves nothing: neither the slave of the master nor the slave itself (U-19).
TEST(Master, SetPositionDisturbsNoCoupling) {
    CouplingRig rig(2);
    rig.start();
    rig.accept(0, at_velocity(20));
    const auto id = rig.accept(1, gear_in(0));
    ASSERT_TRUE(rig.run_to_sync(1, id));
    rig.run(10);
    const auto counts = [&](std::size_t axis) { return rig.axes[axis].drive_command().position; };
    const auto apart = counts(1) - counts(0);
    EXPECT_EQ(rig.axes[0].set(SetPosition{500}, Owner::program), ErrorId::none);
    rig.run(10);
    EXPECT_EQ(rig.axes[1].set(SetPosition{-70, true}, Owner::program), ErrorId::none);
    for (int i = 0; i < 200; ++i) {
        rig.step();
        ASSERT_LE(std::abs(counts(1) - counts(0) - apart), 1);
        ASSERT_EQ(rig.status(1, id), CommandStatus::in_target);
    }
}

// A coupling that runs for ever: the axes move their anchors, the slave stays where the ratio says, to the count. Ten thousand turns
// with the ratio 1/3 between feeds of 10 and 10.
TEST(Master, EndlessAxesDoNotDrift) {
    auto fast = plain_slave();
    fast.gearing.feed = 0.1;  // ten turns a second at 1 u/s: anchors move often
    fast.gearing.counts_per_revolution = 100;
    CouplingRig rig({fast, fast});
    rig.start();
    const auto id = rig.accept(1, gear_in(0, 1, 3));
    rig.run(3);
    rig.accept(0, at_velocity(99));
    for (int i = 0; i < 12000; ++i) {
        rig.step();
        const double master = static_cast<double>(rig.axes[0].drive_command().position);
        const double slave = static_cast<double>(rig.axes[1].drive_command().position);
        ASSERT_NEAR(slave, master / 3, 1.01) << i;
    }
    EXPECT_EQ(rig.status(1, id), CommandStatus::in_target);
    EXPECT_GT(rig.axes[0].drive_command().position, 1'100'000);  // 11000 turns
    rig.expect_no_jump();
}

// Somebody turns the master's motor without power faster than the axis may be, and long enough that its set-point would have stayed far behind.
TEST(MasterWithoutPower, IsFollowedAlsoFasterThanItsLimit) {
    auto slave = plain_slave();
    slave.limits.velocity = 500;
    CouplingRig rig({plain_axis(), slave});
    rig.start();
    rig.enabled[0] = false;
    rig.run(50);
    ASSERT_EQ(rig.view(0).state, AxisState::Disabled);
    const auto id = rig.accept(1, gear_in(0));
    rig.run(5);
    rig.drives[0]->coasting = 120;  // u/s, of 100
    rig.run(8000);
    EXPECT_EQ(rig.status(1, id), CommandStatus::in_target);
    EXPECT_NEAR(rig.view(1).set_velocity, 120, 1e-6);
    EXPECT_NEAR(rig.view(0).set_position, rig.view(0).actual_position, 1e-6);
}

}  // namespace
}  // namespace taktwerk::axes::test
