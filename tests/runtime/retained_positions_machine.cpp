// Power cycles of controller and drive in virtual time: an axis with an absolute encoder knows its coordinates again, one without does not,
// and what cannot be right is said. Real frames, simulated drives, a real directory.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "axes/axis/alarms.hpp"
#include "runtime/alarms.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::runtime::testing {
namespace {

namespace fs = std::filesystem;
using enum OperatorAction;

struct RetainedPositions : ::testing::Test {
    RetainedPositions() {
        auto name = (fs::temp_directory_path() / "taktwerk_retained_XXXXXX").string();
        directory = mkdtemp(name.data());
    }
    ~RetainedPositions() override {
        machine.reset();
        fs::remove_all(directory);
    }

    /// x has an absolute encoder, y has not. Both home in place.
    MachineConfig config(double x_stands = 50) const {
        auto config = machine_config(2);
        for (auto& binding : config.axes) {
            binding.axis.homing.kind = axes::HomingKind::set_here;
            binding.axis.homing.offset = 300;
            binding.simulation.start = 50;
        }
        config.axes[0].simulation.start = x_stands;
        config.axes[0].axis.memory.absolute = true;
        config.retain = directory.string();
        return config;
    }
    void start(MachineConfig config) {
        machine = std::make_unique<TestMachine>(std::move(config));
        ASSERT_TRUE(machine->up());
    }
    /// Both homed as 300 mm at 50 mm of the mechanics, then x moved to 420 mm.
    void work() {
        for (std::uint16_t i = 0; i < 2; ++i) {
            machine->enable(i);
            machine->home(i);
        }
        ASSERT_EQ(machine->command(move_absolute, 0, false, 420, 200).answer, Answer::accepted);
        ASSERT_TRUE(machine->until([&] { return std::abs(machine->axis(0).actual_position - 420) < 0.05; }, 5s));
    }
    void end() {
        machine->runner->shut_down();
        machine.reset();
    }
    std::string slots() const {
        std::string text;
        for (const char* name : {"positions.0", "positions.1"}) {
            std::ifstream in(directory / name);
            text += std::string{std::istreambuf_iterator<char>(in), {}};
        }
        return text;
    }

    fs::path directory;
    std::unique_ptr<TestMachine> machine;
};

TEST_F(RetainedPositions, AfterAPowerCycleTheAbsoluteAxisIsHomedAndTheOtherIsNot) {
    start(config());
    EXPECT_FALSE(machine->axis(0).homed);
    work();
    end();

    start(config(170));  // where x was left: 120 mm on
    EXPECT_TRUE(machine->axis(0).homed);
    EXPECT_NEAR(machine->axis(0).actual_position, 420, 0.05);
    EXPECT_FALSE(machine->axis(1).homed);
    EXPECT_FALSE(machine->has_alarm(id(axes::AxisAlarm::moved_while_off)));
    machine->enable(0);
    ASSERT_EQ(machine->command(move_absolute, 0, false, 300, 200).answer, Answer::accepted);
    ASSERT_TRUE(machine->until([&] { return std::abs(machine->axis(0).actual_position - 300) < 0.05; }, 5s));
    machine->expect_no_jump();
    end();

    start(config(50));
    EXPECT_NEAR(machine->axis(0).actual_position, 300, 0.05);
}

// No orderly end: power is cut while the axis stands. What was written two seconds after it stood counts.
TEST_F(RetainedPositions, WithoutAnOrderlyEndTooOnceItHasStoodForAWhile) {
    start(config());
    work();
    machine->run(2500ms);
    machine.reset();
    start(config(170.5));
    EXPECT_TRUE(machine->axis(0).homed);
    EXPECT_NEAR(machine->axis(0).actual_position, 420.5, 0.05);
}

TEST_F(RetainedPositions, CutInMotionTheEncoderKnowsWhereItCameToRest) {
    start(config());
    work();
    machine->run(2500ms);
    ASSERT_EQ(machine->command(move_absolute, 0, false, 700, 200).answer, Answer::accepted);
    machine->run(500ms);
    ASSERT_GT(machine->axis(0).set_velocity, 100);
    machine.reset();
    start(config(300));
    EXPECT_TRUE(machine->axis(0).homed);
    EXPECT_NEAR(machine->axis(0).actual_position, 550, 0.05);
    EXPECT_FALSE(machine->has_alarm(id(axes::AxisAlarm::moved_while_off)));
}

TEST_F(RetainedPositions, MovedWithoutPowerIsAWarningAndNotHomed) {
    start(config());
    work();
    end();
    start(config(172));
    EXPECT_FALSE(machine->axis(0).homed);
    EXPECT_TRUE(machine->has_alarm(id(axes::AxisAlarm::moved_while_off))) << machine->alarms();
    machine->enable(0);
    machine->home(0);
    EXPECT_TRUE(machine->axis(0).homed);
}

TEST_F(RetainedPositions, ChangedGearingIsSaid) {
    start(config());
    work();
    end();
    auto other = config(170);
    other.axes[0].axis.gearing.feed = 5;
    start(std::move(other));
    EXPECT_FALSE(machine->axis(0).homed);
    EXPECT_TRUE(machine->has_alarm(id(axes::AxisAlarm::retained_gearing_differs))) << machine->alarms();
}

TEST_F(RetainedPositions, OneDamagedSlotCostsNothingBothAreAnAlarmUntilHomed) {
    start(config());
    work();
    machine->run(2500ms);
    end();
    const auto newest = [&](const char* name) { return fs::last_write_time(directory / name); };
    const char* newer = newest("positions.0") > newest("positions.1") ? "positions.0" : "positions.1";
    std::ofstream(directory / newer) << "torn";
    start(config(170));
    EXPECT_TRUE(machine->axis(0).homed);
    EXPECT_NEAR(machine->axis(0).actual_position, 420, 0.05);
    EXPECT_FALSE(machine->has_alarm(id(MachineAlarm::positions_lost)));
    end();

    for (const char* name : {"positions.0", "positions.1"}) std::ofstream(directory / name) << "torn";
    start(config(170));
    EXPECT_FALSE(machine->axis(0).homed);
    EXPECT_TRUE(machine->has_alarm(id(MachineAlarm::positions_lost))) << machine->alarms();
    machine->enable(0);
    machine->home(0);
    machine->run(10ms);
    EXPECT_FALSE(machine->has_alarm(id(MachineAlarm::positions_lost)));
}

TEST_F(RetainedPositions, WhatCannotBeWrittenIsAWarningAndTriedAgain) {
    auto c = config();
    std::ofstream(directory / "file") << "";
    c.retain = (directory / "file" / "state").string();
    start(std::move(c));
    work();
    EXPECT_TRUE(machine->has_alarm(id(MachineAlarm::positions_not_kept))) << machine->alarms();
    fs::remove(directory / "file");
    machine->run(1500ms);
    EXPECT_FALSE(machine->has_alarm(id(MachineAlarm::positions_not_kept)));
    EXPECT_TRUE(fs::exists(directory / "file" / "state" / "positions.0"));
}

// Cycle by cycle the same set-points, whether positions are kept or not.
TEST_F(RetainedPositions, KeepingDoesNotInfluenceTheMotion) {
    std::vector<double> with, without;
    for (auto* positions : {&with, &without}) {
        auto c = config();
        if (positions == &without) c.retain.clear();
        start(std::move(c));
        machine->on_cycle = [&] { positions->push_back(machine->axis(0).set_position); };
        work();
        end();
    }
    EXPECT_EQ(with, without);
    EXPECT_NE(slots().find("axis x"), std::string::npos);
    EXPECT_EQ(slots().find("axis y"), std::string::npos);
}

// A machine that stops and goes does not write each time.
TEST_F(RetainedPositions, ShortStopsAreNotWritten) {
    start(config());
    work();
    machine->run(2500ms);
    const auto number = [&] {
        std::uint64_t highest = 0;
        const auto text = slots();
        for (auto at = text.find("number "); at != std::string::npos; at = text.find("number ", at + 1))
            highest = std::max<std::uint64_t>(highest, std::strtoull(text.c_str() + at + 7, nullptr, 10));
        return highest;
    };
    const auto before = number();
    for (int i = 0; i < 5; ++i) {
        ASSERT_EQ(machine->command(move_absolute, 0, false, i % 2 ? 420 : 400, 200).answer, Answer::accepted);
        machine->run(500ms);
    }
    EXPECT_EQ(number(), before + 1);  // that it moves
    machine->run(2500ms);
    EXPECT_EQ(number(), before + 2);  // that it stands
}

}  // namespace
}  // namespace taktwerk::runtime::testing
