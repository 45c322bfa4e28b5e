// Parameters by number, settings in their turn, and the outputs of a drive.
#include <gtest/gtest.h>

#include "axes/axis/parameters.hpp"
#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisConfig limited_axis() {
    auto config = plain_axis();
    config.limits.position_min = -50;
    config.limits.position_max = 200;
    config.following = {.window = 1, .time = 10ms};
    config.homing.kind = HomingKind::set_here;
    return config;
}

struct ParameterRig : Rig {
    explicit ParameterRig(const AxisConfig& config = limited_axis(), const std::function<void(FakeDrive&)>& prepare = {})
        : Rig(config, prepare) {
        power_on();
    }
    [[nodiscard]] double read(std::int32_t number) const { return find_parameter(number)->read(view()); }
    ErrorId write(std::int32_t number, double value) { return axis.set(WriteParameter{number, value}, Owner::program); }
    void home_here() {
        const auto id = accept(home(0));
        ASSERT_TRUE(run_until([&] { return status(id) == CommandStatus::done; }));
        ASSERT_TRUE(view().homed);
    }
};

AxisCommand queued(const AxisSetting& setting) { return {.kind = CommandKind::setting, .buffer_mode = mcBuffered, .details = setting}; }

TEST(Parameters, EachCanBeRead) {
    for (const auto& entry : parameter_table) EXPECT_NE(entry.read, nullptr) << entry.number << " " << entry.name;
}

// Table 5 of the standard: number, name, BOOL or REAL, readable only or writable.
TEST(Parameters, TheStandardsNumbersAreAsInItsTable) {  // P1-217
    struct Row {
        int number;
        std::string_view name;
        bool boolean, writable;
    };
    constexpr Row rows[] = {
        {1, "CommandedPosition", false, false},   {2, "SWLimitPos", false, true},
        {3, "SWLimitNeg", false, true},           {4, "EnableLimitPos", true, true},
        {5, "EnableLimitNeg", true, true},        {6, "EnablePosLagMonitoring", true, true},
        {7, "MaxPositionLag", false, true},       {8, "MaxVelocitySystem", false, false},
        {9, "MaxVelocityAppl", false, true},      {10, "ActualVelocity", false, false},
        {11, "CommandedVelocity", false, false},  {12, "MaxAccelerationSystem", false, false},
        {13, "MaxAccelerationAppl", false, true}, {14, "MaxDecelerationSystem", false, false},
        {15, "MaxDecelerationAppl", false, true}, {16, "MaxJerkSystem", false, false},
        {17, "MaxJerkAppl", false, true},
    };
    for (const auto& row : rows) {
        const auto* entry = find_parameter(row.number);
        ASSERT_NE(entry, nullptr) << row.number;
        EXPECT_EQ(entry->name, row.name);
        EXPECT_EQ(entry->type == ParameterType::boolean, row.boolean) << row.name;
        EXPECT_EQ(entry->range != ParameterRange::read_only, row.writable) << row.name;
    }
}

TEST(Parameters, ReadWhatIsConfiguredAndWhatHappens) {  // P1-217
    ParameterRig rig;
    EXPECT_EQ(rig.read(2), 200);
    EXPECT_EQ(rig.read(3), -50);
    EXPECT_EQ(rig.read(4), 1);
    EXPECT_EQ(rig.read(6), 1);
    EXPECT_EQ(rig.read(7), 1);
    EXPECT_EQ(rig.read(8), 100);
    EXPECT_EQ(rig.read(9), 100);
    EXPECT_EQ(rig.read(12), 1000);
    EXPECT_EQ(rig.read(16), 20000);
    EXPECT_EQ(rig.read(1020), 5);   // 5 % of the velocity limit
    EXPECT_EQ(rig.read(1021), 25);  // 25 %
    rig.accept(at_velocity(40));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().active_in_target; }));
    rig.run(5);
    EXPECT_EQ(rig.read(1), rig.view().set_position);
    EXPECT_EQ(rig.read(11), 40);
    EXPECT_NEAR(rig.read(10), 40, 1);  // counts per cycle
    EXPECT_EQ(rig.read(1000), rig.view().actual_position);
}

TEST(Parameters, UnknownReadOnlyAndBadValuesAreRefusedAndChangeNothing) {  // P1-214, P1-216
    ParameterRig rig;
    EXPECT_EQ(rig.write(18, 1), ErrorId::unknown_parameter);
    EXPECT_EQ(rig.write(999, 1), ErrorId::unknown_parameter);
    EXPECT_EQ(rig.write(-1, 1), ErrorId::unknown_parameter);
    EXPECT_EQ(rig.write(1, 1), ErrorId::read_only_parameter);
    EXPECT_EQ(rig.write(8, 50), ErrorId::read_only_parameter);
    EXPECT_EQ(rig.write(1005, 0), ErrorId::read_only_parameter);
    EXPECT_EQ(rig.write(9, 0), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.write(9, -1), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.write(9, 100.001), ErrorId::invalid_parameter) << "never above the system's limit";
    EXPECT_EQ(rig.write(13, 1001), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.write(15, 1001), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.write(17, 20001), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.write(4, 0.5), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.write(2, -50), ErrorId::invalid_parameter) << "not above SWLimitNeg";
    EXPECT_EQ(rig.write(3, std::numeric_limits<double>::quiet_NaN()), ErrorId::invalid_parameter);
    EXPECT_EQ(rig.read(9), 100);
    EXPECT_EQ(rig.read(2), 200);
    EXPECT_EQ(rig.axis.set(WriteParameter{9, 50}, Owner::operator_panel), ErrorId::owned_by_other);
}

TEST(Parameters, LoweredLimitsHoldForTheNextCommand) {  // P1-217
    ParameterRig rig;
    ASSERT_EQ(rig.write(9, 30), ErrorId::none);
    ASSERT_EQ(rig.write(13, 200), ErrorId::none);
    ASSERT_EQ(rig.write(15, 200), ErrorId::none);
    ASSERT_EQ(rig.write(17, 5000), ErrorId::none);
    EXPECT_EQ(rig.read(9), 30);
    EXPECT_EQ(rig.read(8), 100) << "the system's stays";
    rig.accept(absolute(30, 100));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_NEAR(rig.largest_velocity, 30, 1e-9);
    EXPECT_NEAR(rig.largest_acceleration, 200, 1e-6);
    EXPECT_DOUBLE_EQ(rig.view().set_position, 30);
}

// Held by an override of 0, a motion is planned anew when it is let go.
TEST(Parameters, LoweredLimitsHoldFromTheNextPlanningOn) {  // P1-217
    auto beyond = absolute(60, 80);
    beyond.kind = CommandKind::move_continuous_absolute;
    beyond.end_velocity = 70;
    for (const auto& command : {absolute(60, 80), at_velocity(80), beyond}) {
        ParameterRig rig;
        const auto id = rig.accept(command);
        rig.run(100);
        ASSERT_EQ(rig.axis.set(Override{.velocity = 0}, Owner::program), ErrorId::none);
        ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity == 0; }, 300));
        ASSERT_EQ(rig.write(9, 30), ErrorId::none);
        ASSERT_EQ(rig.write(13, 200), ErrorId::none);
        ASSERT_EQ(rig.write(15, 250), ErrorId::none);
        ASSERT_EQ(rig.axis.set(Override{}, Owner::program), ErrorId::none);
        rig.largest_velocity = rig.largest_acceleration = 0;
        rig.run(1000);
        EXPECT_EQ(rig.view().set_velocity, 30);
        EXPECT_EQ(rig.view().limiter, VelocityLimiter::axis_limit);
        if (command.kind == CommandKind::move_velocity) {
            EXPECT_EQ(rig.status(id), CommandStatus::in_target);
        }
        rig.run(2000);
        EXPECT_EQ(rig.status(id), command.kind == CommandKind::move_absolute ? CommandStatus::done : CommandStatus::in_target);
        EXPECT_NEAR(rig.largest_velocity, 30, 1e-9);
        EXPECT_LE(rig.largest_acceleration, 250 * (1 + 1e-9));
    }
}

// Lowering what commands may ask for must not make the stop after an error longer: 1000 u/s2 as configured, not 100.
TEST(Parameters, StopsForErrorsStayAsHardAsConfigured) {
    ParameterRig rig;
    ASSERT_EQ(rig.write(15, 100), ErrorId::none);
    rig.accept(at_velocity(100));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().active_in_target; }));
    rig.axis.stop_for_error(0x6001, false);
    int cycles = 0;
    ASSERT_TRUE(rig.run_until([&] { return ++cycles, rig.view().set_velocity == 0; }));
    // 100 u/s at 1000 u/s2 and 20000 u/s3: 0.1 s + 0.05 s.
    EXPECT_NEAR(cycles, 150, 5);
}

TEST(Parameters, DecelerationAndJerkChangeAtStandstillOnly) {
    ParameterRig rig;
    rig.accept(at_velocity(50));
    rig.run(20);
    EXPECT_EQ(rig.write(15, 500), ErrorId::state_forbids);
    EXPECT_EQ(rig.write(17, 500), ErrorId::state_forbids);
    EXPECT_EQ(rig.read(15), 1000);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
}

TEST(Parameters, SoftwareLimitsMove) {  // P1-217
    ParameterRig rig;
    rig.home_here();
    EXPECT_EQ(rig.refuse(absolute(250)), ErrorId::beyond_software_limit);
    ASSERT_EQ(rig.write(2, 300), ErrorId::none);
    EXPECT_EQ(rig.write(3, -300), ErrorId::none);
    const auto id = rig.accept(absolute(250));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }));
    ASSERT_EQ(rig.write(4, 0), ErrorId::none);
    rig.accept(absolute(310));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_DOUBLE_EQ(rig.view().set_position, 310);
    EXPECT_EQ(rig.read(2), 300) << "switched off, not forgotten";
    ASSERT_EQ(rig.write(4, 1), ErrorId::none) << "at standstill, even outside";
    EXPECT_EQ(rig.refuse(relative(1)), ErrorId::beyond_software_limit);
}

// 100 u/s stop within 100 * (0.1 + 0.05) / 2 = 7.5 u at 1000 u/s2 and 20000 u/s3.
TEST(Parameters, ALimitTheMovingAxisCannotStopBeforeIsRefused) {
    ParameterRig rig;
    rig.home_here();
    rig.accept(at_velocity(100));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_position > 50; }));
    const double here = rig.view().set_position;
    EXPECT_EQ(rig.write(2, here + 7.4), ErrorId::beyond_software_limit);
    EXPECT_EQ(rig.read(2), 200);
    EXPECT_EQ(rig.write(2, here + 20), ErrorId::none);
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity == 0; }));
    EXPECT_NEAR(rig.view().set_position, here + 20, 1e-9) << "and it stops on the new limit";
}

TEST(Parameters, LagMonitoringCanBeChangedAndSwitchedOff) {  // P1-217
    ParameterRig rig;
    ASSERT_EQ(rig.write(6, 0), ErrorId::none);
    rig.drive.lag = 5000;  // 5 u: the window is 1 u
    rig.run(50);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    ASSERT_EQ(rig.write(7, 6), ErrorId::none);
    ASSERT_EQ(rig.write(6, 1), ErrorId::none);
    rig.run(50);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    ASSERT_EQ(rig.write(7, 4), ErrorId::none);
    rig.run(50);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_TRUE(rig.raised(AxisAlarm::following_error));
}

TEST(Parameters, WindowsAndJogSpeeds) {
    ParameterRig rig;
    ASSERT_EQ(rig.write(1020, 7), ErrorId::none);
    ASSERT_EQ(rig.write(1021, 70), ErrorId::none);
    EXPECT_EQ(rig.view().manual_slow, 7);
    EXPECT_EQ(rig.view().manual_fast, 70);
    rig.drive.lag = 500;  // 0.5 u behind: the in-position window is 0.01 u
    rig.run(50);
    EXPECT_FALSE(rig.view().in_position);
    ASSERT_EQ(rig.write(1010, 0.6), ErrorId::none);
    rig.run(50);
    EXPECT_TRUE(rig.view().in_position);
    ASSERT_EQ(rig.write(1011, 1e12), ErrorId::none) << "more than there is time: never";
    rig.run(50);
    EXPECT_FALSE(rig.view().in_position);
}

// --- in their turn ------------------------------------------------------------------------------------------------------------

TEST(QueuedSetting, WaitsForTheMotionBeforeIt) {  // P1-215
    ParameterRig rig;
    const auto move = rig.accept(absolute(20));
    const auto setting = rig.accept(queued(WriteParameter{9, 10}));
    const auto after = rig.accept(absolute(0, 100, mcBuffered));
    EXPECT_EQ(rig.status(setting), CommandStatus::queued);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(move) == CommandStatus::done; }));
    EXPECT_NEAR(rig.largest_velocity, 100, 10) << "the move before it is as fast as ever";
    EXPECT_EQ(rig.status(setting), CommandStatus::done);
    EXPECT_EQ(rig.read(9), 10);
    EXPECT_EQ(rig.status(after), CommandStatus::active) << "and what stands behind it goes on at once";
    rig.largest_velocity = 0;
    ASSERT_TRUE(rig.run_until([&] { return rig.status(after) == CommandStatus::done; }));
    EXPECT_NEAR(rig.largest_velocity, 10, 1e-9);
}

TEST(QueuedSetting, AtOnceWhenNothingIsBeforeItAndInEveryState) {  // P1-215
    ParameterRig rig;
    EXPECT_EQ(rig.status(rig.accept(queued(WriteParameter{9, 60}))), CommandStatus::done);
    EXPECT_EQ(rig.read(9), 60);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    rig.enable = false;
    ASSERT_TRUE(rig.run_to(AxisState::Disabled));
    EXPECT_EQ(rig.status(rig.accept(queued(WriteParameter{9, 50}))), CommandStatus::done);
    EXPECT_EQ(rig.read(9), 50);
    EXPECT_EQ(rig.view().state, AxisState::Disabled);
}

TEST(QueuedSetting, BehindAMotionWithoutEndItPassesOnceInVelocityAndTheMotionGoesOn) {
    ParameterRig rig;
    const auto run = rig.accept(at_velocity(40));
    const auto setting = rig.accept(queued(SetPosition{1000, false}));
    EXPECT_EQ(rig.status(setting), CommandStatus::queued);
    ASSERT_TRUE(rig.run_until([&] { return rig.status(setting) == CommandStatus::done; }));
    EXPECT_EQ(rig.status(run), CommandStatus::in_target);
    EXPECT_GT(rig.view().set_position, 990);
    rig.run(10);
    EXPECT_EQ(rig.view().set_velocity, 40);
}

TEST(QueuedSetting, ARefusalShowsWhenItsTurnComes) {
    ParameterRig rig;
    EXPECT_EQ(rig.refuse(queued(WriteParameter{9, 1000})), ErrorId::invalid_parameter) << "what can be said at once";
    rig.accept(absolute(20));
    const auto setting = rig.accept(queued(WriteOutput{40, true}));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(setting), CommandStatus::error);
    EXPECT_EQ(rig.error_of(setting), ErrorId::not_supported);
}

TEST(QueuedSetting, TakesAPlaceInTheQueueAndGoesWithIt) {
    ParameterRig rig;
    rig.accept(absolute(20));
    std::vector<CommandId> waiting;
    for (int i = 0; i < 4; ++i) waiting.push_back(rig.accept(queued(WriteParameter{9, 50})));
    EXPECT_EQ(rig.refuse(queued(WriteParameter{9, 50})), ErrorId::queue_full);
    rig.drive.fault_code = 0x7305;
    ASSERT_TRUE(rig.run_to(AxisState::ErrorStop));
    for (const auto id : waiting) EXPECT_EQ(rig.error_of(id), ErrorId::aborted_by_axis_error);
    EXPECT_EQ(rig.read(9), 100);
}

// --- the drive's points -------------------------------------------------------------------------------------------------------

TEST(DriveOutputs, OnlyWrittenBitsAreTheAxis) {
    ParameterRig rig(limited_axis(), [](FakeDrive& drive) { drive.caps.digital_outputs = true; });
    rig.step();
    EXPECT_EQ(rig.drive.last.digital_output_mask, 0u);
    ASSERT_EQ(rig.axis.set(WriteOutput{16, true}, Owner::program), ErrorId::none);
    ASSERT_EQ(rig.axis.set(WriteOutput{31, true}, Owner::program), ErrorId::none);
    ASSERT_EQ(rig.axis.set(WriteOutput{17, false}, Owner::program), ErrorId::none);
    rig.step();
    EXPECT_EQ(rig.drive.last.digital_outputs, 0x8001'0000u);
    EXPECT_EQ(rig.drive.last.digital_output_mask, 0x8003'0000u);
    EXPECT_EQ(rig.view().digital_outputs, 0x8001'0000u);
    ASSERT_EQ(rig.axis.set(WriteOutput{31, false}, Owner::program), ErrorId::none);
    rig.step();
    EXPECT_EQ(rig.drive.last.digital_outputs, 0x0001'0000u) << "each cycle anew, until it is written again";
    EXPECT_EQ(rig.axis.set(WriteOutput{32, true}, Owner::program), ErrorId::invalid_output);
    EXPECT_EQ(rig.axis.set(WriteOutput{-1, true}, Owner::program), ErrorId::invalid_output);
}

TEST(DriveOutputs, ADriveWithoutThemSaysSo) {
    ParameterRig rig;
    EXPECT_EQ(rig.axis.set(WriteOutput{0, true}, Owner::program), ErrorId::not_supported);
}

// A count is told from the next up to 2^52 of them: a position beyond is none, and what comes back from there would not be the same.
TEST(SetPositionOf, APlaceThatNoCountTellsIsRefused) {
    ParameterRig rig;
    const auto set = [&](double position, bool relative) { return rig.axis.set(SetPosition{position, relative}, Owner::program); };
    for (const double absurd : {1e300, -1e300, 1e18, std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(set(absurd, false), ErrorId::invalid_position) << absurd;
        EXPECT_EQ(set(absurd, true), ErrorId::invalid_position) << absurd;
    }
    EXPECT_EQ(rig.view().set_position, 0);
    EXPECT_EQ(set(4e12, false), ErrorId::none) << "1000 counts a unit: 4e15 of 4.5e15";
    EXPECT_EQ(set(1e12, true), ErrorId::invalid_position) << "together too far";
    EXPECT_EQ(set(0, false), ErrorId::none);
    EXPECT_EQ(rig.view().set_position, 0);
}

TEST(DriveInputs, StandInTheViewAsTheDriveGivesThem) {
    ParameterRig rig;
    rig.drive.inputs = 0x8000'0005u;
    rig.step();
    EXPECT_EQ(rig.view().digital_inputs, 0x8000'0005u);
}

}  // namespace
}  // namespace taktwerk::axes::test
