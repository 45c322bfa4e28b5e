// Problems between the floors of one configuration: each has its code, its place, and a sentence that says what to do.

#include <gtest/gtest.h>

#include <limits>

#include "runtime/check/machine_check.hpp"
#include "runtime/check/machine_remarks.hpp"
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

/// The one remark that this change gives cause for; nothing without one.
template <class Change>
Error remark(Change change) {
    auto config = machine_config(2);
    change(config);
    EXPECT_TRUE(check(config).empty()) << check(config).front().what;
    const auto found = remarks(config, {}, 4);
    EXPECT_LE(found.size(), 1u) << found.back().subject << ": " << found.back().what;
    for (const auto& one : found) EXPECT_FALSE(one.remedy.empty()) << one.code;
    return found.empty() ? Error{} : found[0];
}

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST(MachineCheck, APlainMachineHasNoProblem) { EXPECT_TRUE(check(machine_config(3)).empty()); }

TEST(MachineCheck, AnUnknownSlaveOfAnAxisComesWithASuggestion) {
    const auto error = problem([](MachineConfig& m) { m.axes[0].slave = "x_driv"; });
    EXPECT_EQ(error.code, "axis.unknown_slave");
    EXPECT_TRUE(contains(error.text(), "did you mean 'x_drive'?")) << error.text();
}

// What would only show when the bus is in OP is known from the file.
TEST(MachineCheck, AnAxisWithoutItsObjectsInTheProcessData) {
    const auto error = problem([](MachineConfig& m) {
        auto pdo = m.bus.slaves[0].device->rx_pdos.at(0);
        std::erase_if(pdo.entries, [](const auto& entry) { return entry.index == 0x6040; });
        m.bus.slaves[0].rx.assigned = {pdo};
    });
    EXPECT_EQ(error.code, "axis.not_mapped");
    EXPECT_TRUE(contains(error.text(), "6040h (controlword) is not in the RxPDO of slave 'x_drive'")) << error.text();
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

// z^2 - z + kv T = 0, the loop of an integrator that acts one sample later, has poles outside the unit circle from kv T = 1 on.
TEST(MachineCheck, AGainWithWhichNoLoopIsStable) {
    const auto error = problem([](MachineConfig& m) {
        m.axes[0].axis.control.mode = axes::ControlMode::velocity;
        m.axes[0].axis.control.kv = 1000;  // 1 ms
    });
    EXPECT_EQ(error.code, "axis.position_loop");
    EXPECT_EQ(error.subject, "axes.x.control.kv");
}

// A slave is there or it is not: its other axis would be moved in earnest, and called simulated.
TEST(MachineCheck, OneOfTwoAxesOfADriveIsNotSimulatedAlone) {
    const auto two_on_one = [](MachineConfig& m) {
        auto profile = std::make_shared<axes::DriveProfile>(*m.axes[0].profile);
        profile->axes = 2;
        profile->object_offset = 0;  // the second axis has the objects of the first: enough for a check
        m.axes[0].profile = m.axes[1].profile = profile;
        m.axes[1].slave = m.axes[0].slave;
        m.axes[1].drive_axis = 1;
        m.axes[0].axis.simulated = true;
    };
    const auto error = problem(two_on_one);
    EXPECT_EQ(error.code, "axis.simulated");
    EXPECT_TRUE(contains(error.what, "axis y is on slave 'x_drive', too, and is not simulated")) << error.what;
    auto both = machine_config(2);
    two_on_one(both);
    both.axes[1].axis.simulated = true;
    EXPECT_TRUE(check(both).empty());
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

TEST(MachineCheck, AFaultOfAnInputWhoseTerminalReportsNone) {
    auto config = machine_config(1);
    using Kind = SimulationEvent::Kind;
    config.simulation.events = {{std::chrono::seconds{1}, Kind::input_fault, "button", 1}};
    const auto errors = check(config);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_EQ(errors[0].code, "simulation.no_status");
    std::ranges::find(config.io, "button", &IoPoint::name)->status = {{PointStatus::Kind::error, 0x6000, 7}};
    EXPECT_TRUE(check(config).empty());
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

TEST(MachineCheck, TimesAndPriorityOfATask) {
    const auto with = [](auto change) {
        auto config = machine_config(1);
        ProgramConfig program;
        program.name = "p";
        config.programs.push_back(program);
        TaskConfig task;
        task.name = "main";
        task.program = "p";
        task.divisor = 4;
        config.realtime.priority = 80;
        change(config, task);
        config.tasks.push_back(task);
        const auto errors = check(config);
        EXPECT_LE(errors.size(), 1u);
        return errors.empty() ? Error{} : errors[0];
    };
    using M = MachineConfig;
    using T = TaskConfig;
    EXPECT_EQ(with([](M&, T&) {}).code, "");
    EXPECT_EQ(with([](M&, T& t) { t.priority = 78; }).code, "");
    EXPECT_EQ(with([](M&, T& t) { t.priority = 79; }).code, "task.priority") << "the watch stands between it and the cycle";
    EXPECT_EQ(with([](M&, T& t) { t.priority = 79; }).subject, "programs.p.tasks.main.priority");
    EXPECT_EQ(with([](M&, T& t) { t.priority = -1; }).code, "task.priority");
    EXPECT_EQ(with([](M&, T& t) { t.priority = 0; }).code, "") << "an ordinary thread";
    EXPECT_EQ(with([](M& m, T& t) { m.realtime.priority = 0, t.priority = 1; }).code, "task.priority");
    EXPECT_EQ(with([](M& m, T&) { m.realtime.priority = 0; }).code, "");
    EXPECT_EQ(with([](M& m, T& t) { t.watchdog = m.cycle; }).code, "");
    EXPECT_EQ(with([](M& m, T& t) { t.watchdog = m.cycle - Duration{1}; }).code, "task.watchdog");
    EXPECT_EQ(with([](M&, T& t) { t.watchdog = Duration{}; }).code, "") << "no limit";
    EXPECT_EQ(with([](M& m, T& t) { t.divisor = 1, t.watchdog = m.cycle; }).code, "task.base");
    EXPECT_EQ(with([](M&, T& t) { t.divisor = 1, t.priority = 40; }).code, "task.base");
}

TEST(MachineCheck, AProgramStartsByItselfOnlyInAutomaticMode) {
    ProgramConfig program;
    program.name = "p";
    program.autostart = true;
    auto config = machine_config(1);
    config.programs.push_back(program);
    EXPECT_TRUE(check(config).empty()) << "no error: one may start it by hand";
    EXPECT_EQ(remark([&](MachineConfig& m) { m.programs.push_back(program); }).code, "remark.autostart");
    EXPECT_EQ(remark([&](MachineConfig& m) {
                  m.programs.push_back(program);
                  m.start_mode = Mode::automatic;
              }).code,
              "");
}

TEST(MachineCheck, NamesOfAxesDoNotHoldWhatSeparatesNames) {
    for (const char* name : {"x 1", "x,y", "x[1]", "a=b"})
        EXPECT_EQ(problem([&](MachineConfig& m) { m.axes[0].axis.name = name; }).code, "config.name_characters") << name;
    auto config = machine_config(1);
    config.axes[0].axis.name = "x-1_a.b";
    EXPECT_TRUE(check(config).empty());
}

// --- what a file may say and hardly anybody means -----------------------------------------------------------------------------

TEST(MachineRemarks, APlainMachineGivesNoCauseForOne) {
    EXPECT_EQ(remark([](MachineConfig&) {}).code, "");
}

// 10 mm a turn: 100 mm/s are 600 r/min. Somebody who meant 2500 mm/min and wrote mm/s asks for 15 000 r/min.
TEST(MachineRemarks, TheMotorsSpeedIsComputedAndAnUnusualOneIsAsked) {
    auto config = machine_config(1);
    EXPECT_DOUBLE_EQ(motor_rpm(config.axes[0].axis, 100), 600);
    config.axes[0].axis.gearing.motor_revolutions = 5;
    EXPECT_DOUBLE_EQ(motor_rpm(config.axes[0].axis, 100), 3000);

    const auto told = remark([](MachineConfig& m) {
        m.axes[0].axis.limits.velocity = 2500;
        m.emergency_stop.power_off_after = 1min;
    });
    EXPECT_EQ(told.code, "remark.motor_speed");
    EXPECT_EQ(told.subject, "axes.x.limits.velocity");
    EXPECT_TRUE(contains(told.what, "15000 r/min")) << told.what;
}

// By hand: 800 mm at 100 mm/s and 1000 mm/s2 both ways: 8 s, and 0.1 s for the ramps together. A short way never reaches the speed:
// 5 mm at 1000 mm/s2 is 2.5 mm up and 2.5 mm down, sqrt(2 * 2.5 / 1000) = 0.0707 s each.
// 6 servos of the test machine there and back: some 20 us of the wire and 7 us of slaves. A cycle of 1 ms has room, one of 30 us has not much.
TEST(MachineRemarks, ABusThatFillsItsCycleIsAsked) {
    auto config = machine_config(6);
    const MachineLayout layout;
    const auto load = ecat::bus_load(config.bus);
    config.cycle = load.round_trip * 10 / 8;
    const auto told = remarks(config, layout, 1);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].code, "remark.bus_load");
    EXPECT_TRUE(contains(told[0].what, "7 slaves): 80 %")) << told[0].what;
    EXPECT_FALSE(contains(told[0].what, "come back behind")) << told[0].what;
    config.cycle = load.round_trip * 10 / 7;
    EXPECT_TRUE(remarks(config, layout, 1).empty());
    // 100 / 94 = 106 %: too short with a cable to each slave, and refused only where it fits in no case.
    config.cycle = load.round_trip * 94 / 100;
    const auto over = remarks(config, layout, 1);
    ASSERT_EQ(over.size(), 1u);
    EXPECT_TRUE(contains(over[0].what, "106 %. The frames come back behind the next ones, and the bus does not come up")) << over[0].what;
}

TEST(MachineRemarks, TheTimeOfAStroke) {
    axes::AxisConfig axis;
    EXPECT_FALSE(stroke_seconds(axis));
    axis.limits.velocity = 100;
    axis.limits.acceleration = axis.limits.deceleration = 1000;
    axis.limits.position_min = 0;
    axis.limits.position_max = 800;
    EXPECT_NEAR(*stroke_seconds(axis), 8.1, 1e-12);
    axis.limits.position_max = 5;
    EXPECT_NEAR(*stroke_seconds(axis), 0.141421, 1e-6);
}

TEST(MachineRemarks, EachThingThatIsHardlyMeantIsAsked) {
    using axes::HomingKind;
    const auto of_axis = [](auto change) { return remark([change](MachineConfig& m) { change(m.axes[0]); }); };
    EXPECT_EQ(of_axis([](AxisBinding& b) { b.axis.windows.in_position = 500; }).code, "remark.in_position");
    EXPECT_EQ(of_axis([](AxisBinding& b) { b.axis.windows.in_position_time = 10s; }).subject, "axes.x.in_position.time");
    EXPECT_EQ(of_axis([](AxisBinding& b) { b.axis.following.window = 30000; }).code, "remark.following_error");
    EXPECT_EQ(of_axis([](AxisBinding& b) { b.axis.manual.fast = b.axis.limits.velocity + 1; }).subject, "axes.x.manual.fast");
    EXPECT_EQ(of_axis([](AxisBinding& b) {
                  b.axis.homing.kind = HomingKind::home_switch;
                  b.simulation.home_from.reset();
              }).code,
              "remark.simulated_switch");
    EXPECT_EQ(of_axis([](AxisBinding& b) {
                  b.axis.limits.position_max = 900;
                  b.simulation.positive_stop = 820;
              }).code,
              "remark.simulated_stop");
    EXPECT_EQ(of_axis([](AxisBinding& b) {
                  b.axis.modulo = 360;
                  b.axis.gearing.feed = 400;
                  b.axis.limits.position_min = -std::numeric_limits<double>::infinity();
                  b.axis.limits.position_max = std::numeric_limits<double>::infinity();
              }).code,
              "remark.modulo");
    EXPECT_EQ(remark([](MachineConfig& m) {
                  for (auto& point : m.io)
                      if (point.name == m.emergency_stop.input) point.inverted = true;
              }).code,
              "remark.emergency_stop_inverted");
    EXPECT_EQ(remark([](MachineConfig& m) { m.realtime.cpus = {99}; }).code, "remark.cpu");
    EXPECT_EQ(remark([](MachineConfig& m) {
                  m.bus.slaves.clear();
                  m.axes.clear();
                  m.io.clear();
                  m.emergency_stop.input.clear();
              }).code,
              "remark.no_slave");
    const auto upper_limit = [](double limit) {
        return remark([limit](MachineConfig& m) {
            m.io[0].line.fit(16, true);
            m.io[0].limits = PointLimits{0, limit};
        });
    };
    EXPECT_EQ(upper_limit(32767).code, "") << "the most of 16 bits with sign";
    EXPECT_EQ(upper_limit(32768).code, "remark.point_limit");
    EXPECT_EQ(of_axis([](AxisBinding& b) {
                  b.axis.control.mode = axes::ControlMode::velocity;
                  b.axis.control.kv = 101;  // a tenth of the rate is 100
              }).subject,
              "axes.x.control.kv");
    // 2 sqrt(v/j) = 2 sqrt(100/0.5) = 28 s
    const auto default_of = [](double acceleration, double jerk) {
        return remark([&](MachineConfig& m) {
            axes::AxisGroupConfig group;
            group.name = "arm";
            group.members = {"x", "y"};
            group.default_dynamics = {100, acceleration, acceleration, jerk};
            m.axis_groups.push_back(group);
        });
    };
    const auto slow = default_of(1000, 0.5);
    EXPECT_EQ(slow.subject, "groups.arm.default");
    EXPECT_TRUE(contains(slow.what, "28 s")) << slow.what;
    EXPECT_TRUE(contains(slow.remedy, "jerk of 0.5")) << slow.remedy;
    EXPECT_TRUE(contains(default_of(2, 1000).remedy, "acceleration of 2")) << default_of(2, 1000).remedy;
    EXPECT_EQ(default_of(1000, 10000).code, "");
    EXPECT_EQ(remark([](MachineConfig& m) { m.bus.lost_frames_limit = 11; }).code, "remark.watchdog_below_limit") << "10 ms";
    EXPECT_EQ(remark([](MachineConfig& m) {
                  ProgramConfig program;
                  program.library = "cell.so";
                  for (const char* name : {"p", "q"}) {
                      program.name = name;
                      m.programs.push_back(program);
                  }
              }).code,
              "remark.same_library");
}

// Relaxed, three cycles are 300 ms, and who says nothing has a watchdog of 500 ms.
TEST(MachineRemarks, AWatchdogThatTripsBeforeTheLimitIsReached) {
    auto config = machine_config(2);
    config.simulation.supervision = Supervision::relaxed;
    EXPECT_TRUE(remarks(config, {}, 4).empty());
    config.bus.slaves[1].sm_watchdog = 300ms;
    EXPECT_TRUE(remarks(config, {}, 4).empty());
    config.bus.slaves[1].sm_watchdog = 100ms;
    const auto found = remarks(config, {}, 4);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].subject, "bus.lost_frames_limit");
    EXPECT_EQ(found[0].what,
              "the machine bears 300 cycles in a row without an answer (100 times the limit: relaxed), 300 ms, but the watchdog of "
              "'y_drive' trips after 100 ms");
}

// docs/faults.md, "What a drive sees behind lost frames".
TEST(MachineRemarks, RelaxedSupervisionOfARealPort) {
    auto config = machine_config(1);
    config.bus.interface = "eth1";
    EXPECT_TRUE(remarks(config, {}, 4).empty());
    config.simulation.supervision = Supervision::relaxed;
    const auto found = remarks(config, {}, 4);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].subject, "simulation.supervision");
    EXPECT_EQ(found[0].what,
              "relaxed holds on 'eth1', too: 300 cycles without an answer are borne, and behind such a gap a drive leaps to where "
              "its axis is by then");
}

TEST(MachineRemarks, AStartupValueOfAnotherSizeThanTheDriveHas) {
    auto config = machine_config(1);
    auto device = *config.bus.slaves[0].device;
    ecat::ObjectEntry velocity;
    velocity.index = 0x6081;
    velocity.type = ecat::DataType::U32;
    device.objects.push_back(velocity);
    config.bus.slaves[0].device = std::make_shared<const ecat::DeviceDescription>(device);
    ecat::StartupSdo sdo;
    sdo.index = 0x6081;
    sdo.type = ecat::DataType::U32;
    sdo.origin = "cell.yaml:7:9";
    config.bus.slaves[0].startup.push_back(sdo);
    EXPECT_TRUE(remarks(config, {}, 4).empty());
    config.bus.slaves[0].startup[0].type = ecat::DataType::U16;
    const auto found = remarks(config, {}, 4);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].code, "remark.startup_size");
    EXPECT_EQ(found[0].subject, "cell.yaml:7:9");
}

TEST(MachineRemarks, AnAxisThatTwoProgramsDeclare) {
    const auto config = machine_config(1);
    MachineLayout layout;
    layout.axes.resize(1);
    layout.axes[0].name = "x";
    layout.axes[0].programs = {"p"};
    EXPECT_TRUE(remarks(config, layout, 4).empty());
    layout.axes[0].programs = {"p", "q"};
    ASSERT_EQ(remarks(config, layout, 4).size(), 1u);
    EXPECT_EQ(remarks(config, layout, 4)[0].what, "the programs p and q declare this axis");
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
