// MC_Home through the axis: the three kinds, their coordinates, their ends. PLCopen Part 1 v2.0, 3.2.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

// P1-121: the position at the reference becomes Position; here the reference is where the axis stands.
TEST(HomeHere, GivesThePresentPositionItsCoordinate) {
    Rig rig(homing_by(HomingKind::set_here), [](FakeDrive& drive) { drive.position = 4321; });
    rig.power_on();
    const auto id = rig.accept(home(123.5));
    EXPECT_EQ(rig.view().state, AxisState::Homing);
    rig.step();

    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_TRUE(rig.view().homed);
    EXPECT_DOUBLE_EQ(rig.view().actual_position, 123.5);
    EXPECT_EQ(rig.drive.largest_step, 0);
}

// Position not given (NaN): the configured offset.
TEST(HomeHere, TakesTheConfiguredOffsetWhenPositionIsNotGiven) {
    auto config = homing_by(HomingKind::set_here);
    config.homing.offset = -7;
    Rig rig(config);
    rig.power_on();
    rig.accept(home(std::nan("")));
    rig.step();
    EXPECT_DOUBLE_EQ(rig.view().actual_position, -7);
}

// The drive searches by itself: mode homing at standstill, start held, back to cyclic position; its zero is the reference.
TEST(HomeByDrive, ChangesModeStartsAndComesBackWithoutAJump) {
    Rig rig(homing_by(HomingKind::drive), [](FakeDrive& drive) {
        drive.homing_place = -2000;
        drive.caps.mode_change_delay = 10ms;
    });
    rig.power_on();
    const auto id = rig.accept(home(50));
    ASSERT_TRUE(rig.run_until([&] { return rig.drive.last.start_homing; }, 100));
    EXPECT_EQ(rig.drive.last.mode, DriveMode::homing);
    EXPECT_EQ(rig.view().state, AxisState::Homing);
    EXPECT_FALSE(rig.view().homed);
    EXPECT_EQ(rig.refuse(absolute(0)), ErrorId::state_forbids);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 2000));

    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_TRUE(rig.view().homed);
    EXPECT_EQ(rig.drive.last.mode, DriveMode::cyclic_position);
    EXPECT_DOUBLE_EQ(rig.view().actual_position, 50);
    EXPECT_EQ(rig.drive.largest_step, 0);
    EXPECT_TRUE(rig.alarms.empty());  // 2 u of motion that no set-point commanded: the following error watch kept still

    rig.accept(absolute(51));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.drive.last.position, 1000);  // the drive's zero is 50 u
    EXPECT_EQ(rig.drive.zero, -2000);
    EXPECT_LE(rig.drive.largest_step, 100);
}

// The port unwraps 32 bit positions; after homing the drive's zero may read as any multiple of 2^32.
TEST(HomeByDrive, ReferenceIsTheDrivesZeroWhateverWasUnwrapped) {
    Rig rig(homing_by(HomingKind::drive), [](FakeDrive& drive) { drive.wraps_at_home = -2; });
    rig.power_on();
    rig.accept(home(50));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 2000));
    EXPECT_NEAR(rig.view().actual_position, 50, 1e-9);
    rig.accept(absolute(51));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.drive.last.position, -2 * (1LL << 32) + 1000);
    EXPECT_LE(rig.drive.largest_step, 100);
}

// P1-035: only Stop leads out. The drive gets its start taken back, stands, and is in cyclic position before Stop is done.
TEST(HomeByDrive, StopAbortsIt) {
    Rig rig(homing_by(HomingKind::drive), [](FakeDrive& drive) { drive.homing_hangs = true; });
    rig.power_on();
    const auto id = rig.accept(home(0));
    rig.run(50);
    const auto stopping = rig.accept(stop());
    EXPECT_EQ(rig.status(id), CommandStatus::aborted);
    EXPECT_EQ(rig.view().state, AxisState::Stopping);
    rig.step();
    EXPECT_FALSE(rig.drive.last.start_homing);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(stopping) == CommandStatus::done; }, 200));
    EXPECT_EQ(rig.drive.last.mode, DriveMode::cyclic_position);
    EXPECT_FALSE(rig.view().homed);
    rig.axis.release_stop(stopping, Owner::program);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_EQ(rig.drive.largest_step, 0);
}

TEST(HomeByDrive, ErrorOfTheDriveIsAnAxisError) {
    Rig rig(homing_by(HomingKind::drive), [](FakeDrive& drive) { drive.homing_fails = true; });
    rig.power_on();
    const auto id = rig.accept(home(0));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 2000));
    EXPECT_TRUE(rig.raised(AxisAlarm::drive_homing_failed));
    EXPECT_EQ(rig.status(id), CommandStatus::error);
    EXPECT_FALSE(rig.view().homed);
    rig.run(10);
    rig.axis.reset(Owner::program);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 100));
    EXPECT_EQ(rig.drive.last.mode, DriveMode::cyclic_position);
}

// limits.velocity bounds what the drive does by itself: it is told no more than that, refused where it has more from its start-up, and stopped
// where it runs faster all the same.
TEST(HomeByDrive, TheLimitsOfTheAxisBindIt) {
    auto config = homing_by(HomingKind::drive);
    config.homing.search_velocity = 40;
    config.homing.latch_velocity = 30;
    config.homing.acceleration = 900;
    EXPECT_TRUE(check(config).empty());
    config.limits.velocity = 20;
    config.limits.deceleration = 500;
    const auto problems = check(config);
    ASSERT_EQ(problems.size(), 3u);  // search, latch, acceleration
    EXPECT_NE(problems[0].what.find("above limits.velocity"), std::string::npos) << problems[0].what;

    Rig told(config, [](FakeDrive& drive) { drive.caps.homing_per_run = true; });
    told.power_on();
    told.accept(home(0));
    ASSERT_TRUE(told.run_until([&] { return told.drive.last.start_homing; }, 100));
    EXPECT_EQ(told.drive.last.homing.search_velocity, 20e3);
    EXPECT_EQ(told.drive.last.homing.latch_velocity, 20e3);
    EXPECT_EQ(told.drive.last.homing.acceleration, 500e3);

    Rig from_startup(config);
    from_startup.power_on();
    EXPECT_EQ(from_startup.refuse(home(0)), ErrorId::invalid_velocity);

    Rig fast(homing_by(HomingKind::drive), [](FakeDrive& drive) { drive.homing_speed = 130; });  // 130 u/s where 100 are allowed
    fast.power_on();
    fast.accept(home(0));
    ASSERT_TRUE(fast.run_to(AxisState::ErrorStop, 200));
    EXPECT_TRUE(fast.raised(AxisAlarm::drive_too_fast));
}

TEST(HomeByDrive, TakingTooLongIsAnAxisError) {
    auto config = homing_by(HomingKind::drive);
    config.homing.timeout = 300ms;
    Rig rig(config, [](FakeDrive& drive) { drive.homing_hangs = true; });
    rig.power_on();
    rig.accept(home(0));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 400));
    EXPECT_TRUE(rig.raised(AxisAlarm::drive_homing_timeout));
}

// The axis asks in counts for what its own configuration says; the port sees to it. 20 u/s, 1 u/s, 100 u/s2 at 1000 counts a u.
TEST(HomeByDrive, GivesThePortItsMethodAndSpeeds) {
    auto config = homing_by(HomingKind::drive);
    config.homing.method = -1;
    Rig rig(config, [](FakeDrive& drive) {
        drive.homing_hangs = true;
        drive.caps.homing_per_run = true;
    });
    rig.power_on();
    EXPECT_EQ(rig.drive.last.homing.method, 0);
    rig.accept(home(0));
    ASSERT_TRUE(rig.run_until([&] { return rig.drive.last.start_homing; }, 100));
    EXPECT_EQ(rig.drive.last.homing.method, -1);
    EXPECT_DOUBLE_EQ(rig.drive.last.homing.search_velocity, 20'000);
    EXPECT_DOUBLE_EQ(rig.drive.last.homing.latch_velocity, 1'000);
    EXPECT_DOUBLE_EQ(rig.drive.last.homing.acceleration, 100'000);
}

TEST(HomeByDrive, SettingsThatTheDriveRefusesAreAnErrorOfTheirOwn) {
    auto config = homing_by(HomingKind::drive);
    config.homing.method = 15;
    Rig rig(config, [](FakeDrive& drive) {
        drive.homing_hangs = drive.refuses_homing_setup = true;
        drive.caps.homing_per_run = true;
    });
    rig.power_on();
    const auto id = rig.accept(home(0));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop, 200));
    EXPECT_TRUE(rig.raised(AxisAlarm::drive_homing_refused));
    EXPECT_EQ(rig.status(id), CommandStatus::error);
    rig.run(300);
    EXPECT_FALSE(rig.raised(AxisAlarm::drive_homing_failed)) << "one error, one alarm";
    rig.axis.reset(Owner::program);
    EXPECT_TRUE(rig.run_to(AxisState::Standstill, 300));
}

// Turns cleared, or an alarm that says the reference is gone (SV33-E E.917): absolute moves are refused until the axis is homed again.
class LostReference : public ::testing::Test {
protected:
    void SetUp() override {
        rig.power_on();
        rig.accept(home(0));
        rig.step();
        ASSERT_TRUE(rig.view().homed);
    }
    static AxisConfig needs_reference() {
        auto config = homing_by(HomingKind::set_here);
        config.require_homed = true;
        return config;
    }
    Rig rig{needs_reference()};
};

TEST_F(LostReference, OnRequestItIsNoLongerHomed) {
    ++rig.drive.reference_epoch;
    rig.run(2);
    EXPECT_FALSE(rig.view().homed);
    EXPECT_TRUE(rig.raised(AxisAlarm::reference_lost));
    EXPECT_EQ(rig.refuse(absolute(5)), ErrorId::not_homed);
    rig.accept(home(0));
    rig.run(3);
    EXPECT_TRUE(rig.view().homed);
}

TEST_F(LostReference, ByAnAlarmOfTheDriveItIsNoLongerHomed) {
    rig.drive.fault_code = 0x7305;
    rig.drive.alarm_kind = DriveAlarmKind::reference_lost;
    rig.run(5);
    EXPECT_FALSE(rig.view().homed);
    EXPECT_TRUE(rig.raised(AxisAlarm::reference_lost));
}

TEST_F(LostReference, OtherAlarmsKeepIt) {
    rig.drive.fault_code = 0x7305;
    rig.drive.alarm_kind = DriveAlarmKind::battery_low;
    rig.run(5);
    EXPECT_TRUE(rig.view().homed);
}

TEST(HomeByDrive, PowerLossWhileTheDriveSearchesEndsIt) {
    Rig rig(homing_by(HomingKind::drive), [](FakeDrive& drive) { drive.homing_place = -200'000; });
    rig.power_on();
    rig.accept(home(0));
    rig.run(100);
    rig.drive.fault_code = 0x8400;
    rig.run(5);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_FALSE(rig.drive.last.start_homing);
    EXPECT_EQ(rig.drive.last.mode, DriveMode::cyclic_position);
    rig.drive.fault_code = 0;
    rig.axis.reset(Owner::program);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 200));
    EXPECT_LE(rig.drive.largest_step, 100);
}

// Switch between -10.0 and -8.0 u, search in negative direction: reference is the edge at -8.0 seen while backing off slowly. Switches and
// positions are two cycles old at 1 u/s: within 0.002 u.
class HomeBySwitch : public ::testing::TestWithParam<double> {};
TEST_P(HomeBySwitch, FindsTheSameEdgeFromAnywhere) {
    Rig rig(homing_by(HomingKind::home_switch), [](FakeDrive& drive) {
        drive.switches = true;
        drive.home_low = -10'000;
        drive.home_high = -8'000;
        drive.negative_end = -60'000;
        drive.positive_end = 60'000;
        drive.position = GetParam() * 1000;
    });
    rig.power_on();
    const auto id = rig.accept(home(100));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) != CommandStatus::active; }, 20000));

    ASSERT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_TRUE(rig.view().homed);
    EXPECT_NEAR(rig.view().actual_position - rig.drive.position / 1000, 108, 0.003);
    EXPECT_TRUE(rig.alarms.empty());
    EXPECT_LE(rig.largest_velocity, 20 * (1 + 1e-12));
    rig.expect_no_jump();

    const auto moved = rig.accept(absolute(110));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(moved), CommandStatus::done);
    rig.run(10);
    EXPECT_NEAR(rig.drive.position / 1000, 2, 0.003);
}
INSTANTIATE_TEST_SUITE_P(BeforeOnBehindTheSwitchAndOnTheLimit, HomeBySwitch, ::testing::Values(5.0, 30.0, -9.0, -8.5, -20.0, -60.0));

// No switch between the limits: both are seen once, then it fails; the axis stands.
TEST(HomeBySwitchFailure, WithoutASwitchFailsAfterOneReversal) {
    Rig rig(homing_by(HomingKind::home_switch), [](FakeDrive& drive) {
        drive.switches = true;
        drive.home_low = 1;
        drive.home_high = 0;
        drive.negative_end = -20'000;
        drive.positive_end = 20'000;
    });
    rig.power_on();
    const auto id = rig.accept(home(0));
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop));
    EXPECT_TRUE(rig.raised(AxisAlarm::homing_failed));
    EXPECT_FALSE(rig.raised(AxisAlarm::positive_limit_switch));
    EXPECT_EQ(rig.error_of(id), static_cast<ErrorId>(AxisAlarm::homing_failed));
    EXPECT_GT(rig.view().set_position, 19);
    rig.expect_no_jump();
}

TEST(HomeBySwitchFailure, StopAbortsItAlongTheRamp) {
    Rig rig(homing_by(HomingKind::home_switch), [](FakeDrive& drive) {
        drive.switches = true;
        drive.home_low = 1;
    });
    rig.power_on();
    const auto id = rig.accept(home(0));
    rig.run(300);
    ASSERT_EQ(rig.view().set_velocity, -20);
    const auto stopping = rig.accept(stop());
    EXPECT_EQ(rig.status(id), CommandStatus::aborted);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(stopping) == CommandStatus::done; }));
    EXPECT_FALSE(rig.view().homed);
    rig.expect_no_jump();
}

// P1-122: a command waiting behind MC_Home starts when it is done.
TEST(HomeHere, BufferedMoveFollows) {
    Rig rig(homing_by(HomingKind::set_here));
    rig.power_on();
    const auto homing = rig.accept(home(10));
    const auto move = rig.accept(absolute(12, 100, mcBuffered));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(move) == CommandStatus::done; }, 1000));
    EXPECT_EQ(rig.status(homing), CommandStatus::done);
    EXPECT_DOUBLE_EQ(rig.view().set_position, 12);
    EXPECT_EQ(rig.drive.last.position, 2000);
}

}  // namespace
}  // namespace taktwerk::axes::test
