// Power cycles of controller and drive in virtual time: an axis with an absolute encoder knows its coordinates again, one without does not,
// and what cannot be right is said. Real frames, simulated drives, a real directory.

#include <unistd.h>

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
        config.retain.directory = directory.string();
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
        for (const char* name : {"retain.0", "retain.1"}) {
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

// Written in motion, found far away: as far as it can have gone on its travel and coasted is believed, and no further.
TEST_F(RetainedPositions, CutInMotionItIsNotBelievedBeyondItsTravel) {
    const auto cut_in_motion = [&] {
        fs::remove_all(directory);
        start(config());
        work();
        machine->run(2500ms);
        ASSERT_EQ(machine->command(move_absolute, 0, false, 700, 200).answer, Answer::accepted);
        machine->run(500ms);
        ASSERT_GT(machine->axis(0).set_velocity, 100);
        machine.reset();
    };
    const auto found_at = [&](double stands) {
        auto c = config(stands);
        c.axes[0].simulation.negative_stop = -1e5;
        c.axes[0].simulation.positive_stop = 1e5;
        start(std::move(c));
    };
    // 300 mm of the program are 50 mm of the mechanics: 0 to 800 mm lie at -250 to 550; it coasts 500^2 / 5000 = 50 mm.
    for (const double stands : {599.0, -299.0}) {
        cut_in_motion();
        found_at(stands);
        EXPECT_TRUE(machine->axis(0).homed) << stands;
        EXPECT_NEAR(machine->axis(0).actual_position, stands + 250, 0.1);
        machine.reset();
    }
    for (const double stands : {610.0, -310.0, 30500.0, -30500.0}) {
        cut_in_motion();
        found_at(stands);
        EXPECT_FALSE(machine->axis(0).homed) << stands;
        EXPECT_TRUE(machine->has_alarm(id(axes::AxisAlarm::moved_while_off))) << machine->alarms();
        machine.reset();
    }
}

/// While it lives the process is nobody of rights: a directory without the right to write holds it up, also when tests run as root.
struct AsNobody {
    AsNobody() {
        if (::geteuid() == 0) changed = ::seteuid(65534) == 0;
    }
    ~AsNobody() {
        if (changed) (void)!::seteuid(0);
    }
    bool changed = false;
};

// The finding: homed anew while the directory cannot be written, started again, homed at the old place.
TEST_F(RetainedPositions, AReferenceThatCannotBeReplacedOnTheDiskStopsTheMachineAndNeverComesBackSilently) {
    if (::geteuid() == 0) {
        ASSERT_EQ(::chown(directory.c_str(), 65534, 65534), 0);
    }
    const AsNobody nobody;
    start(config());
    work();
    machine->run(2500ms);
    for (const char* name : {"retain.0", "retain.1"}) fs::permissions(directory / name, fs::perms::owner_read);
    fs::permissions(directory, fs::perms::owner_read | fs::perms::owner_exec);

    ASSERT_EQ(machine->command(home, 0).answer, Answer::accepted);
    machine->run(100ms);
    EXPECT_TRUE(machine->has_alarm(id(MachineAlarm::positions_outdated))) << machine->alarms();
    EXPECT_EQ(machine->axis(0).state, axes::AxisState::ErrorStop) << "nobody works on with what the next start would not know";
    (void)machine->command(reset);
    machine->run(500ms);
    EXPECT_TRUE(machine->has_alarm(id(MachineAlarm::positions_outdated))) << "it stays until the disk is right";

    fs::permissions(directory, fs::perms::owner_all);
    machine->run(1500ms);
    EXPECT_EQ(machine->command(reset).answer, Answer::accepted);
    machine->run(500ms);
    EXPECT_FALSE(machine->has_alarm(id(MachineAlarm::positions_outdated))) << machine->alarms();
    end();
    start(config(170));
    EXPECT_EQ(slots().find("shift 250 "), std::string::npos) << slots();
    machine.reset();
}

// Where only a new file cannot be made, the old reference is taken back, and the machine works on with a warning.
TEST_F(RetainedPositions, WithoutRoomForANewSlotTheOldReferenceIsGoneAfterAHoming) {
    start(config());
    work();
    machine->run(2500ms);
    for (const char* beside : {"retain.0.new", "retain.1.new"}) fs::create_directory(directory / beside);
    machine->home(0);  // other coordinates: it stands 120 mm further
    machine->run(100ms);
    EXPECT_TRUE(machine->has_alarm(id(MachineAlarm::retain_not_written))) << machine->alarms();
    EXPECT_FALSE(machine->has_alarm(id(MachineAlarm::positions_outdated)));
    machine.reset();
    start(config(170));
    EXPECT_FALSE(machine->axis(0).homed) << "at " << machine->axis(0).actual_position;
}

// The disk says "no reference" before there is another one: a homing that takes its time, cut off in its middle.
TEST_F(RetainedPositions, WhileAnAxisHomesTheDiskNamesNoReference) {
    auto c = config();
    c.axes[0].axis.homing.kind = axes::HomingKind::home_switch;
    start(config());
    work();
    end();
    ASSERT_NE(slots().find("axis x"), std::string::npos);
    auto searching = config(170);
    searching.axes[0].axis.homing = c.axes[0].axis.homing;
    start(std::move(searching));
    ASSERT_TRUE(machine->axis(0).homed);
    machine->enable(0);
    ASSERT_EQ(machine->command(home, 0).answer, Answer::accepted);
    machine->run(5ms);
    ASSERT_EQ(machine->axis(0).state, axes::AxisState::Homing);
    machine.reset();
    EXPECT_EQ(slots().find("axis x"), std::string::npos);
}

TEST_F(RetainedPositions, ADiskThatTakesNothingIsSaidBeforeAnythingMoves) {
    auto c = config();
    std::ofstream(directory / "file") << "";
    c.retain.directory = (directory / "file" / "state").string();
    start(std::move(c));
    machine->run(5ms);
    EXPECT_TRUE(machine->has_alarm(id(MachineAlarm::retain_not_written))) << machine->alarms();
}

TEST_F(RetainedPositions, ASecondMachineInTheSameDirectoryDoesNotStart) {
    start(config());
    VirtualClock clock{Instant{} + 1s};
    auto second = config();
    World world{second, clock.now()};
    auto built = Machine::build(second, world.transport(), world.serial().lines());
    ASSERT_EQ(built.index(), 1u);
    EXPECT_EQ(std::get<1>(built).front().code, "retain.in_use");
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
    const char* newer = newest("retain.0") > newest("retain.1") ? "retain.0" : "retain.1";
    std::ofstream(directory / newer) << "torn";
    start(config(170));
    EXPECT_TRUE(machine->axis(0).homed);
    EXPECT_NEAR(machine->axis(0).actual_position, 420, 0.05);
    EXPECT_FALSE(machine->has_alarm(id(MachineAlarm::positions_lost)));
    end();

    for (const char* name : {"retain.0", "retain.1"}) std::ofstream(directory / name) << "torn";
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
    c.retain.directory = (directory / "file" / "state").string();
    start(std::move(c));
    work();
    EXPECT_TRUE(machine->has_alarm(id(MachineAlarm::retain_not_written))) << machine->alarms();
    fs::remove(directory / "file");
    machine->run(1500ms);
    EXPECT_FALSE(machine->has_alarm(id(MachineAlarm::retain_not_written)));
    EXPECT_TRUE(fs::exists(directory / "file" / "state" / "retain.0"));
}

// Cycle by cycle the same set-points, whether positions are kept or not.
TEST_F(RetainedPositions, KeepingDoesNotInfluenceTheMotion) {
    std::vector<double> with, without;
    for (auto* positions : {&with, &without}) {
        auto c = config();
        if (positions == &without) c.retain.directory.clear();
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
