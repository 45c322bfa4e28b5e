// Problems between the floors of one configuration: each has its code, its place, and a sentence that says what to do.

#include <gtest/gtest.h>

#include "runtime/machine_config.hpp"
#include "tests/machines/plain_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

/// The one problem that this change causes.
template <class Change>
Error problem(Change change) {
    auto config = machine_config(2);
    change(config);
    auto errors = check(config);
    if (errors.size() != 1) {
        std::string all;
        for (const auto& error : errors) all += error.text() + "\n";
        ADD_FAILURE() << errors.size() << " problems instead of one:\n" << all;
        if (errors.empty()) return {};
    }
    EXPECT_FALSE(errors[0].remedy.empty()) << errors[0].code << " does not say what to do";
    return errors[0];
}

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST(MachineCheck, APlainMachineHasNoProblem) { EXPECT_TRUE(check(machine_config(3)).empty()); }

TEST(MachineCheck, AnUnknownSlaveOfAnAxisComesWithASuggestion) {
    const auto error = problem([](MachineConfig& m) { m.axes[0].slave = "x_driv"; });
    EXPECT_EQ(error.code, "axis.unknown_slave");
    EXPECT_TRUE(contains(error.text(), "did you mean 'x_drive'?")) << error.text();
}

TEST(MachineCheck, TwoAxesOnOneDriveAxis) {
    EXPECT_EQ(problem([](MachineConfig& m) { m.axes[1].slave = "x_drive"; }).code, "axis.drive_axis_taken");
}

TEST(MachineCheck, ADriveAxisThatTheDriveLacks) {
    const auto error = problem([](MachineConfig& m) { m.axes[1].drive_axis = 1; });
    EXPECT_EQ(error.code, "axis.drive_axis");
    EXPECT_TRUE(contains(error.text(), "there is no axis 2")) << error.text();
}

TEST(MachineCheck, AnAxisOnASlaveWithoutProfile) {
    EXPECT_EQ(problem([](MachineConfig& m) { m.axes[0].profile = nullptr; }).code, "axis.no_profile");
}

TEST(MachineCheck, AVirtualAxisHasNoSwitches) {
    EXPECT_EQ(problem([](MachineConfig& m) { m.axes[0].slave.clear(); }).code, "axis.homing");
}

TEST(MachineCheck, AHomingMethodThatTheDriveDoesNotDocument) {
    const auto error = problem([](MachineConfig& m) { m.axes[0].axis.homing.method = 33; });
    EXPECT_EQ(error.code, "axis.homing_method");
    EXPECT_TRUE(contains(error.text(), "17, 18, 19, 20, 21, 22")) << error.text();
}

TEST(MachineCheck, ACycleShorterThanADriveCanKeep) {
    auto profile = std::make_shared<axes::DriveProfile>(*servo_profile());
    profile->minimum_cycle_csp = 2ms;
    const auto error = problem([&](MachineConfig& m) { m.axes[0].profile = profile; });
    EXPECT_EQ(error.code, "axis.cycle_too_short");
    EXPECT_TRUE(contains(error.text(), "2000 us")) << error.text();
}

TEST(MachineCheck, ACycleOutsideWhatTheRuntimeRuns) {
    auto config = machine_config(1);
    for (const auto cycle : {Duration{50us}, Duration{200ms}}) {
        config.cycle = cycle;
        bool found = false;
        for (const auto& error : check(config)) found = found || error.code == "machine.cycle";
        EXPECT_TRUE(found);
    }
}

// 500 mm/s at 5000 mm/s2 and 100 000 mm/s3: 500/5000 + 5000/100000 = 0.15 s.
TEST(MachineCheck, PowerThatGoesBeforeTheAxisCanStandStill) {
    const auto needs = [](Duration has) {
        auto config = machine_config(1);
        config.emergency_stop.power_off_after = has;
        return check(config).size();
    };
    EXPECT_EQ(needs(151ms), 0u);
    EXPECT_EQ(needs(149ms), 1u);
    const auto error = problem([](MachineConfig& m) {
        m.emergency_stop.power_off_after = 100ms;
        m.axes.pop_back();
    });
    EXPECT_EQ(error.code, "machine.emergency_stop_time");
    EXPECT_TRUE(contains(error.text(), "0.15 s")) << error.text();
}

TEST(MachineCheck, AnEmergencyStopInputThatDoesNotExist) {
    const auto error = problem([](MachineConfig& m) { m.emergency_stop.input = "estop"; });
    EXPECT_EQ(error.code, "machine.emergency_stop_input");
    EXPECT_TRUE(contains(error.text(), "estop_ok")) << error.text();
}

TEST(MachineCheck, AnIoPointOnAnUnknownSlave) {
    EXPECT_EQ(problem([](MachineConfig& m) { m.io[1].slave = "oi"; }).code, "io.unknown_slave");
}

TEST(MachineCheck, NamesAreUsedOnceAndNotEmpty) {
    EXPECT_EQ(problem([](MachineConfig& m) { m.axes[1].axis.name = "x"; }).code, "config.duplicate_name");
    EXPECT_EQ(problem([](MachineConfig& m) { m.io[1].name = "estop_ok"; }).code, "config.duplicate_name");
    EXPECT_EQ(problem([](MachineConfig& m) { m.io[2].name = ""; }).code, "config.name_missing");
}

TEST(MachineCheck, ATaskOfAnUnknownProgramAndADivisorOfZero) {
    TaskConfig task;
    task.name = "main";
    task.program = "p";
    EXPECT_EQ(problem([&](MachineConfig& m) { m.tasks.push_back(task); }).code, "task.unknown_program");
    task.divisor = 0;
    ProgramConfig program;
    program.name = "p";
    EXPECT_EQ(problem([&](MachineConfig& m) {
                  m.programs.push_back(program);
                  m.tasks.push_back(task);
              }).code,
              "task.divisor");
}

TEST(MachineCheck, AProgramStartsByItselfOnlyInAutomaticMode) {
    ProgramConfig program;
    program.name = "p";
    program.autostart = true;
    EXPECT_EQ(problem([&](MachineConfig& m) { m.programs.push_back(program); }).code, "program.autostart");
}

TEST(MachineCheck, AnEventOfTheSimulationNeedsItsTarget) {
    SimulationEvent event;
    event.kind = SimulationEvent::Kind::drive_fault;
    event.target = "x_drive";  // a slave, not an axis
    EXPECT_EQ(problem([&](MachineConfig& m) { m.simulation.events.push_back(event); }).code, "simulation.unknown_target");
}

TEST(MachineCheck, NumbersThatWouldStopTheMachineForGood) {
    EXPECT_EQ(problem([](MachineConfig& m) { m.commands_per_cycle = 0; }).code, "machine.commands_per_cycle");
}

TEST(MachineCheck, AllProblemsComeAtOnce) {
    auto config = machine_config(2);
    config.axes[0].slave = "nowhere";
    config.axes[1].drive_axis = 7;
    config.io[0].slave = "nothing";
    EXPECT_EQ(check(config).size(), 3u);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
