// MC_TorqueControl over the line of an XP200 (manual 4.4): Pr004 = 5 and CMODE, internal torques in whole per cent, Pr078 for the speed, and EMG
// by Pr063 as the way out.

#include "tests/axes/drives/xp200/axis_rig.hpp"

namespace taktwerk::axes::xp200 {
namespace {

/// As commissioned for torque: Pr004 = 5, EMG brakes (Pr164) with 200 ms for 1000 r/min (Pr063).
struct TorqueRig : AxisRig {
    explicit TorqueRig(sim::PlantConfig plant = {}, sim::xp200::Options options = {})
        : AxisRig({{4, 5}, {97, 33}, {108, 9}, {136, 1}, {164, 1}, {63, 200}}, plant, HomingKind::set_here, options) {
        drive.servo().parameters().commission(4, 5);
    }
    /// `limit` in mm/s, 0 = the axis' 100.
    Submitted torque(double fraction, double limit = 50) {
        AxisCommand command;
        command.kind = CommandKind::torque;
        command.velocity = limit;
        command.direction = mcPositiveDirection;
        command.details = TorqueDetails{.torque = fraction};
        return axis.submit(command, Owner::program);
    }
    [[nodiscard]] sim::xp200::Servo& servo() { return drive.servo(); }
    [[nodiscard]] int commanded() { return static_cast<std::int16_t>(servo().status(status::torque_command)); }  // %
};

// 50 mm/s are 300 r/min. Pr078 holds the speed "slightly above" (5.4.1): 20 % make a fifteenth of Pr079 = 100 more in the model, 306.7.
TEST(Xp200Torque, RunsUpToItsSpeedLimitInTorqueControl) {
    TorqueRig rig;
    rig.go();
    ASSERT_EQ(rig.servo().mode(), sim::xp200::Servo::Mode::speed);
    ASSERT_EQ(rig.torque(0.2).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.servo().mode() == sim::xp200::Servo::Mode::torque; }, 300ms));
    EXPECT_NEAR(rig.rpm(), 0, 1) << "CMODE changes at standstill";
    rig.run(2s);
    EXPECT_EQ(rig.axis.view().state, AxisState::ContinuousMotion);
    EXPECT_EQ(rig.axis.view().drive_mode, DriveMode::profile_torque);
    EXPECT_EQ(rig.servo().parameters()[78], 300);
    EXPECT_EQ(rig.commanded(), 20);
    EXPECT_GT(rig.rpm(), 299);
    EXPECT_LT(rig.rpm(), 307);
    EXPECT_FALSE(rig.axis.view().active_in_target) << "InTorque: the speed holds it back";
    EXPECT_EQ(rig.axis.view().error, 0);
}

// Against a block nothing but the torque is left: InTorque when the drive has it. Another torque is taken in motion.
TEST(Xp200Torque, PressesWithWhatIsAskedFor) {
    TorqueRig rig;
    rig.go();
    rig.servo().jam(true);
    ASSERT_EQ(rig.torque(0.3).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().active_in_target; }, 1s));
    EXPECT_EQ(rig.commanded(), 30) << "not before the drive has it";
    rig.run(200ms);
    EXPECT_NEAR(rig.axis.view().actual_torque, 0.3, 0.01);
    ASSERT_EQ(rig.torque(-0.25).error, ErrorId::none);
    rig.run(300ms);
    EXPECT_EQ(rig.commanded(), -25);
    EXPECT_TRUE(rig.axis.view().active_in_target);
}

// 4.4.3, 5.4.2: torque 0 would let the motor run out. EMG brakes it by Pr063: 300 r/min in 60 ms, after 40 ms for the word. Then speed control
// with nothing selected, no EMG, and still enabled.
TEST(Xp200Torque, StopAndHaltBrakeOutOfTorque) {
    for (const auto kind : {CommandKind::stop, CommandKind::halt}) {
        sim::PlantConfig plant;
        plant.coulomb_friction = plant.viscous_friction = 0;
        TorqueRig rig{plant};
        rig.go();
        ASSERT_EQ(rig.torque(0.2).error, ErrorId::none);
        rig.run(2s);
        ASSERT_GT(rig.rpm(), 290);
        const auto stop = rig.submit(kind, 0, 0);
        ASSERT_EQ(stop.error, ErrorId::none);
        const auto begun = rig.now;
        ASSERT_TRUE(rig.until([&] { return rig.servo().parameters()[123] == 11; }, 60ms)) << "EMG, before anything else";
        ASSERT_TRUE(rig.until([&] { return std::abs(rig.rpm()) < 1; }, 1s));
        EXPECT_LE(rig.now - begun, 140ms);
        ASSERT_TRUE(rig.until([&] { return rig.servo().parameters()[123] == 0; }, 1s));
        EXPECT_EQ(rig.servo().parameters()[122], 0);
        EXPECT_TRUE(rig.servo().energised());
        if (kind == CommandKind::stop) rig.axis.release_stop(stop.id, Owner::program);
        ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Standstill; }, 1s)) << static_cast<int>(kind);
        EXPECT_EQ(rig.axis.view().drive_mode, DriveMode::profile_velocity);
        EXPECT_EQ(rig.axis.view().error, 0);
        // And it moves as before.
        ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 20).error, ErrorId::none);
        rig.run(1s);
        EXPECT_NEAR(rig.rpm(), 120, 3);
    }
}

// A weight of half the rated torque, held by torque alone. Deselected first, it would fall for a word of the line before speed control holds
// it: EMG holds it before anything is deselected.
TEST(Xp200Torque, AWeightIsHeldOnTheWayOut) {
    sim::PlantConfig plant;
    plant.load_torque = 0.5 * plant.rated_torque;
    TorqueRig rig{plant, {.brake = true}};
    rig.go();
    ASSERT_EQ(rig.torque(0.5, 2).error, ErrorId::none);
    rig.run(2s);
    ASSERT_EQ(rig.submit(CommandKind::halt, 0, 0).error, ErrorId::none);
    const double at = rig.millimetres();
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().drive_mode == DriveMode::profile_velocity; }, 2s));
    rig.run(500ms);
    EXPECT_NEAR(rig.millimetres(), at, 0.05);
}

// CMODE in motion is not described (5.4.1): what would have to change it must wait for a halt. A stop need not.
TEST(Xp200Torque, AnotherMotionOutOfTorqueNeedsStandstill) {
    TorqueRig rig;
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::move_velocity, 0, 50).error, ErrorId::none);
    rig.run(1s);
    EXPECT_EQ(rig.torque(0.2).error, ErrorId::not_at_standstill) << "into it";
    ASSERT_EQ(rig.submit(CommandKind::halt, 0, 0).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Standstill; }, 2s));
    ASSERT_EQ(rig.torque(0.2).error, ErrorId::none);
    rig.run(1s);
    EXPECT_EQ(rig.submit(CommandKind::move_velocity, 0, 50).error, ErrorId::not_at_standstill) << "out of it";
    EXPECT_EQ(rig.axis.view().state, AxisState::ContinuousMotion);
}

// Without CMODE (Pr004 = 1), or with an EMG that lets the motor run out (Pr164 = 0), there is no way out of a torque: NotSupported.
TEST(Xp200Torque, NeedsItsModeAndItsBrake) {
    for (const auto& parameters : {std::vector<ParameterSetting>{{4, 1}, {97, 33}, {108, 9}, {164, 1}},
                                   {{4, 5}, {97, 33}, {108, 9}, {164, 0}},
                                   {{4, 5}, {97, 33}, {108, 9}}}) {
        AxisRig rig{parameters};
        rig.drive.servo().parameters().commission(4, parameters[0].value);
        rig.go();
        AxisCommand command;
        command.kind = CommandKind::torque;
        command.velocity = 50;
        command.direction = mcPositiveDirection;
        command.details = TorqueDetails{.torque = 0.2};
        EXPECT_EQ(rig.axis.submit(command, Owner::program).error, ErrorId::not_supported);
    }
}

// The drive knows no silence: it goes on pressing. When the line is back it is disabled, torque deselected, before anything else.
TEST(Xp200Torque, AfterSilenceTheTorqueIsGone) {
    TorqueRig rig;
    rig.go();
    ASSERT_EQ(rig.torque(0.2).error, ErrorId::none);
    rig.run(1s);
    rig.line.cut(true);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::ErrorStop; }, 1s));
    rig.run(500ms);
    EXPECT_EQ(rig.commanded(), 20);
    rig.line.cut(false);
    ASSERT_TRUE(rig.until([&] { return !rig.servo().energised(); }, 3s));
    EXPECT_EQ(rig.axis.reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Standstill; }, 8s));
    EXPECT_EQ(rig.servo().mode(), sim::xp200::Servo::Mode::speed);
    EXPECT_EQ(rig.servo().parameters()[122], 0);
    EXPECT_EQ(rig.servo().parameters()[123], 0);
    EXPECT_NEAR(rig.rpm(), 0, 1);
}

// A fault of the axis while in torque: power goes, and it brakes on the way (EMG, then Pr136).
TEST(Xp200Torque, SwitchingOffBrakesFirst) {
    sim::PlantConfig plant;
    plant.coulomb_friction = plant.viscous_friction = 0;
    TorqueRig rig{plant};
    rig.go();
    ASSERT_EQ(rig.torque(0.2).error, ErrorId::none);
    rig.run(2s);
    rig.power(false);
    ASSERT_TRUE(rig.until([&] { return std::abs(rig.rpm()) < 1; }, 300ms));
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::Disabled && !rig.servo().energised(); }, 3s));
    rig.run(200ms);
    EXPECT_EQ(rig.servo().parameters()[123], 0) << "nothing stays forced";
}

// The software limit is watched with the line's latency and the axis' own stop: at 50 mm/s it stays inside 100 mm.
TEST(Xp200Torque, ASoftwareLimitEndsIt) {
    TorqueRig rig;
    rig.go();
    ASSERT_EQ(rig.submit(CommandKind::home, 0, 0).error, ErrorId::none);
    rig.run(50ms);
    // -100 to 100 mm, by their numbers (PLCopen Part 1, table 5): 2, 3, and 4, 5 which let them hold.
    for (const auto& [number, value] : {std::pair{2, 100.0}, {3, -100.0}, {4, 1.0}, {5, 1.0}})
        ASSERT_EQ(rig.axis.set(WriteParameter{number, value}, Owner::program), ErrorId::none) << number;
    ASSERT_EQ(rig.torque(0.2).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis.view().state == AxisState::ErrorStop; }, 10s));
    rig.run(1s);
    EXPECT_EQ(rig.axis.view().error, id(AxisAlarm::software_limit_reached));
    EXPECT_LE(rig.axis.view().actual_position, 100);
    EXPECT_GT(rig.axis.view().actual_position, 80);
    EXPECT_NEAR(rig.rpm(), 0, 1);
}

}  // namespace
}  // namespace taktwerk::axes::xp200
