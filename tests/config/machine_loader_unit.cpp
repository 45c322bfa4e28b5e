// Whole machine files: what must load, and as what; what must be refused, with which words and where.

#include "config/machine_file/machine_loader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "config/drive_file/drive_loader.hpp"
#include "config/reading/document.hpp"

namespace taktwerk::config {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string source = TAKTWERK_SOURCE_DIR;

LoadOptions without_programs() {
    LoadOptions options;
    options.drive_dirs = {source + "/config/drives"};
    options.resolve_programs = false;
    return options;
}

std::string one_a_line(const std::vector<Error>& errors) {
    std::string out;
    for (const auto& error : errors) out += error.text() + "\n";
    return out;
}

LoadedMachine must_load(const std::string& path, const LoadOptions& options = without_programs()) {
    auto loaded = load_machine(path, options);
    if (const auto* errors = std::get_if<std::vector<Error>>(&loaded)) {
        ADD_FAILURE() << one_a_line(*errors);
        return {};
    }
    return std::move(std::get<LoadedMachine>(loaded));
}

std::vector<Error> must_fail(const std::string& path, const LoadOptions& options = without_programs()) {
    auto loaded = load_machine(path, options);
    if (auto* errors = std::get_if<std::vector<Error>>(&loaded)) return std::move(*errors);
    ADD_FAILURE() << path << " loads";
    return {};
}

std::string written(const std::string& name, const std::string& text) {
    const auto path = std::filesystem::path(testing::TempDir()) / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
}

// --- bad files: `# expect LINE:COL text` in the first lines, 0:0 for the file as a whole -----------------------------------

struct Expectation {
    std::string subject, text;
};

std::vector<Expectation> expectations(const std::string& path) {
    std::vector<Expectation> out;
    std::ifstream stream(path);
    for (std::string line; std::getline(stream, line) && line.rfind("# expect ", 0) == 0;) {
        line.erase(0, 9);
        const auto space = line.find(' ');
        const auto where = line.substr(0, space);
        out.push_back({where == "0:0" ? path : path + ":" + where, line.substr(space + 1)});
    }
    return out;
}

std::vector<std::string> bad_files() {
    std::vector<std::string> out;
    for (const auto& file : std::filesystem::directory_iterator(source + "/tests/config/bad"))
        if (file.path().extension() == ".yaml") out.push_back(file.path().stem().string());
    std::sort(out.begin(), out.end());
    return out;
}

class BadFile : public testing::TestWithParam<std::string> {};

TEST_P(BadFile, IsRefusedWithEveryProblemAtItsPlace) {
    const auto path = source + "/tests/config/bad/" + GetParam() + ".yaml";
    const auto expected = expectations(path);
    ASSERT_FALSE(expected.empty());

    auto options = without_programs();
    options.device_dirs = {source + "/config/devices"};
    const auto errors = must_fail(path, options);

    EXPECT_EQ(errors.size(), expected.size()) << one_a_line(errors);
    for (const auto& expectation : expected) {
        const bool found = std::any_of(errors.begin(), errors.end(), [&](const Error& error) {
            return error.subject == expectation.subject && error.text().find(expectation.text) != std::string::npos;
        });
        EXPECT_TRUE(found) << "not reported: " << expectation.subject << " " << expectation.text << "\nbut:\n" << one_a_line(errors);
    }
    for (const auto& error : errors) {
        EXPECT_THAT(error.code, testing::ContainsRegex("^[a-z]+\\.[a-z_]+$"));
        EXPECT_FALSE(error.remedy.empty()) << error.text();
    }
}

INSTANTIATE_TEST_SUITE_P(All, BadFile, testing::ValuesIn(bad_files()), [](const auto& one) { return one.param; });

TEST(BadFiles, AreManyEnoughToMeanSomething) { EXPECT_GE(bad_files().size(), 20u); }

// --- hostile files ------------------------------------------------------------------------------------------------------------

TEST(HostileFile, ThatIsMissingOrADirectoryIsOneClearError) {
    EXPECT_THAT(must_fail("/nowhere/machine.yaml"), ElementsAre(testing::Field(&Error::what, HasSubstr("no such file"))));
    EXPECT_THAT(must_fail(testing::TempDir()), ElementsAre(testing::Field(&Error::what, HasSubstr("not a regular file"))));
}

TEST(HostileFile, NestedTooDeeplyIsOneClearError) {
    for (const int depth : {50, 400, 100'000}) {
        const auto errors = must_fail(written("deep.yaml", std::string(static_cast<std::size_t>(depth), '[')));
        EXPECT_GE(errors.size(), 1u);
        EXPECT_LE(errors.size(), 2u) << one_a_line(errors);
    }
    const auto errors = must_fail(written("deep.yaml", "version: 1\nname: " + std::string(60, '[') + std::string(60, ']')));
    EXPECT_THAT(one_a_line(errors), HasSubstr("nested more than 40 levels deep"));
}

TEST(PathTables, OneNumberOfAToolIsWrittenOnce) {
    written("one_tool.ngc", "M30\n");
    written("one_tool_tables.yaml", "tools:\n  1: { z: 5 mm }\n  01: { z: 4 mm }\n");
    const auto errors = must_fail(written("one_tool.yaml",
                                          "version: 1\nname: p\ncycle: 1 ms\nbus: { interface: simulated, slaves: [] }\naxes: {}\n"
                                          "paths: { plate: { file: one_tool.ngc, tables: one_tool_tables.yaml } }\n"));
    ASSERT_EQ(errors.size(), 1u) << one_a_line(errors);
    EXPECT_THAT(errors[0].subject, testing::EndsWith("one_tool_tables.yaml:3:3"));
    EXPECT_THAT(errors[0].what, HasSubstr("'01' and '1' are one number"));
}

// What yaml-cpp says of them is its parser's word.
TEST(Syntax, IsToldInWordsOfWhoWritesTheFile) {
    const auto told = [](const std::string& text) { return one_a_line(parse_document("f.yaml", text).errors); };
    EXPECT_THAT(told("a:\n  b: 1\n c: 2\n"), HasSubstr("begins in a column in which none of the lines above it does"));
    EXPECT_THAT(told("a: { b: 1, c: 2\nd: 3\n"), HasSubstr("a `{` in front of this is not closed"));
    EXPECT_THAT(told("a: [1, 2\nd: 3\n"), HasSubstr("a `[` in front of this is not closed"));
    EXPECT_THAT(told("a:\n  tool:x\n  frame: y\n"), HasSubstr("is the `:`, or the blank behind it, missing in the line in front?"));
    EXPECT_THAT(told("a: *b\n"), HasSubstr("there is no anchor `&name`"));
}

TEST(HostileFile, ThatIsHugeIsRefusedBeforeItIsParsed) {
    EXPECT_THAT(must_fail(written("huge.yaml", std::string(2u << 20, 'x'))), ElementsAre(testing::Field(&Error::code, "config.too_large")));
}

TEST(HostileFile, WhoseAliasesMultiplyIsRefused) {
    std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
    for (int n = 1; n < 12; ++n) {
        const auto before = "*a" + std::to_string(n - 1);
        bomb += "a" + std::to_string(n) + ": &a" + std::to_string(n) + " [";
        for (int i = 0; i < 10; ++i) bomb += before + (i < 9 ? ", " : "]\n");
    }
    EXPECT_THAT(one_a_line(must_fail(written("bomb.yaml", bomb))), HasSubstr("expands to more than 100000 values"));
}

TEST(HostileFile, ThatRefersToItselfIsRefused) {
    EXPECT_THAT(one_a_line(must_fail(written("self.yaml", "version: 1\nname: &a [*a]\n"))),
                HasSubstr(":2:7: values are nested more than 40 levels deep"));
}

// yaml-cpp 0.7 sees endless empty documents here and fills the memory.
TEST(HostileFile, WithAStrayCommaIsOneClearError) {
    for (const char* text : {",", ",,\nversion: 1\n", "# comment\n, a: 1\n", "version: 1\n]\n", "}"}) {
        const auto errors = must_fail(written("comma.yaml", text));
        EXPECT_GE(errors.size(), 1u) << text;
        EXPECT_THAT(one_a_line(errors), HasSubstr("comma.yaml")) << text;
    }
}

TEST(HostileFile, WithControlCharactersIsRefused) {
    EXPECT_THAT(must_fail(written("nul.yaml", std::string("name: a\0b\n", 10))),
                ElementsAre(testing::Field(&Error::what, HasSubstr("byte 00h"))));
}

// --- good files ---------------------------------------------------------------------------------------------------------------

TEST(MachineLoader, TheDemoIsWhatItsCommentsSay) {
    const auto [machine, hmi, warnings, files] = must_load(source + "/config/machines/demo.yaml");

    EXPECT_TRUE(warnings.empty()) << one_a_line(warnings);
    EXPECT_EQ(machine.cycle, 1ms);
    EXPECT_EQ(machine.start_mode, runtime::Mode::automatic);
    EXPECT_TRUE(machine.bus.interface.empty());
    ASSERT_EQ(machine.bus.slaves.size(), 4u);
    EXPECT_EQ(machine.bus.slaves[3].position, 3);
    EXPECT_FALSE(machine.bus.slaves[3].device->mailbox.has_value());
    EXPECT_TRUE(machine.bus.slaves[0].dc);
    ASSERT_EQ(machine.axes.size(), 3u);
    EXPECT_EQ(machine.axes[1].axis.name, "y");
    EXPECT_EQ(machine.axes[1].profile->name, "sv33-e");
    // 131072 counts a turn, 5 turns for 100 mm: 6553.6 counts/mm.
    EXPECT_DOUBLE_EQ(machine.axes[1].axis.gearing.counts_per_unit(), 6553.6);
    EXPECT_EQ(machine.axes[2].axis.homing.kind, axes::HomingKind::home_switch);
    ASSERT_EQ(machine.tasks.size(), 1u);
    EXPECT_EQ(machine.tasks[0].divisor, 1);
    EXPECT_EQ(machine.programs[0].library, "pick_and_place.so");
    EXPECT_EQ(machine.emergency_stop.input, "estop_ok");
    EXPECT_EQ(hmi.rate_hz, 50);
}

// Homing must be able to work: the axis starts on the side from which its method searches, and has room to stop.
TEST(MachineLoader, TheDemoCanHome) {
    const auto loaded = must_load(source + "/config/machines/demo.yaml");
    for (const auto& binding : loaded.machine.axes) {
        const auto& s = binding.simulation;
        SCOPED_TRACE(binding.axis.name);
        ASSERT_TRUE(s.home_from && s.home_to && s.negative_limit && s.negative_stop && s.positive_limit && s.positive_stop);
        EXPECT_GT(s.start, *s.home_to);  // all three search backward
        EXPECT_EQ(*s.home_to, 0);        // and take their zero at the upper edge
        const auto& homing = binding.axis.homing;
        EXPECT_LT(homing.search_velocity * homing.search_velocity / (2 * homing.acceleration), *s.home_to - *s.home_from);
        EXPECT_LE(*s.negative_stop, *s.negative_limit);
        EXPECT_GT(binding.axis.limits.position_min, *s.negative_limit);
        EXPECT_LT(binding.axis.limits.position_max, *s.positive_limit);
    }
}

TEST(MachineLoader, TheSmallestMachineLoads) { EXPECT_EQ(must_load(source + "/config/machines/minimal.yaml").machine.axes.size(), 1u); }

TEST(MachineLoader, UnitsAreConvertedToTheAxisOwn) {
    const auto loaded = must_load(source + "/tests/config/good/units.yaml");
    ASSERT_EQ(loaded.machine.axes.size(), 3u);

    const auto& linear = loaded.machine.axes[0].axis;
    EXPECT_EQ(linear.gearing.counts_per_revolution, 131072);
    EXPECT_EQ(linear.gearing.motor_revolutions, 25);
    EXPECT_EQ(linear.gearing.load_revolutions, 2);
    EXPECT_EQ(linear.gearing.feed, 10);
    EXPECT_TRUE(linear.gearing.inverted);
    EXPECT_EQ(linear.limits.velocity, 500);  // 30 m/min
    EXPECT_EQ(linear.limits.acceleration, 2000);
    EXPECT_EQ(linear.limits.deceleration, 1500);
    EXPECT_TRUE(std::isinf(linear.limits.jerk));
    EXPECT_EQ(linear.limits.stop_deceleration, 4000);
    EXPECT_EQ(linear.limits.position_min, -50);
    EXPECT_EQ(linear.limits.position_max, 500);
    EXPECT_EQ(linear.following.window, 2.5);
    EXPECT_EQ(linear.windows.in_position_time, 5ms);
    EXPECT_FALSE(linear.homing.negative);
    EXPECT_EQ(linear.homing.search_velocity, 60);
    EXPECT_EQ(linear.homing.offset, -10);
    EXPECT_EQ(linear.manual.slow, 10);
    EXPECT_DOUBLE_EQ(loaded.machine.axes[0].simulation.inertia, 3e-4);
    EXPECT_EQ(loaded.machine.axes[0].simulation.load_torque, -0.5);
    EXPECT_EQ(loaded.machine.axes[0].simulation.home_to, 10);

    const auto& table = loaded.machine.axes[1].axis;
    EXPECT_EQ(table.limits.velocity, 360);  // 60 rpm
    EXPECT_EQ(table.limits.acceleration, 3600);
    EXPECT_EQ(table.limits.deceleration, 3600) << "as acceleration when not given";
    EXPECT_EQ(table.gearing.feed, 360);
    EXPECT_TRUE(table.disabled);
}

// Units: 9 m/min are 150 mm/s, a pitch of -15 um is -0.015 mm. What is left out keeps its default.
TEST(MachineLoader, AnAxisHasItsPositionLoopCompensationAndMemory) {
    const auto machine = must_load(source + "/tests/config/good/axes.yaml").machine;
    ASSERT_EQ(machine.axes.size(), 4u);
    const auto& loop = machine.axes[0].axis;
    EXPECT_EQ(loop.control.mode, axes::ControlMode::velocity);
    EXPECT_EQ(loop.control.kv, 25);
    EXPECT_EQ(loop.control.feed_forward, 0.9);
    EXPECT_EQ(loop.control.torque_feed_forward, 0.5);
    EXPECT_EQ(loop.control.rated_acceleration, 2000);
    EXPECT_DOUBLE_EQ(loop.control.output_limit, 150);
    EXPECT_EQ(loop.control.integral.time, 400ms);
    EXPECT_DOUBLE_EQ(loop.control.integral.limit, 10);
    EXPECT_DOUBLE_EQ(loop.control.integral.dead_band, 0.005);
    EXPECT_EQ(loop.control.load.gravity, -0.2);
    EXPECT_EQ(loop.control.load.coulomb_friction, 0.05);
    EXPECT_EQ(loop.control.load.viscous_friction, 0.0004);
    EXPECT_EQ(loop.control.load.friction_velocity, 1);
    EXPECT_EQ(loop.following.per_velocity, 15ms);
    EXPECT_EQ(loop.limits.torque, 2);
    EXPECT_DOUBLE_EQ(loop.limits.positive.velocity, 50);
    EXPECT_EQ(loop.limits.positive.acceleration, 0) << "as in both";
    EXPECT_DOUBLE_EQ(loop.limits.positive.deceleration, 500);
    EXPECT_EQ(loop.limits.positive.torque, 1.5);
    EXPECT_EQ(loop.limits.negative.acceleration, 800);
    EXPECT_DOUBLE_EQ(loop.compensation.backlash, 0.02);
    EXPECT_EQ(loop.compensation.velocity, 2);
    ASSERT_EQ(loop.compensation.pitch.size(), 2u);
    EXPECT_EQ(loop.compensation.pitch[0].position, -10);
    EXPECT_EQ(loop.compensation.pitch[1].position, 100);
    EXPECT_DOUBLE_EQ(loop.compensation.pitch[1].correction, -0.015);
    EXPECT_EQ(loop.patience.feed, 0);
    EXPECT_TRUE(loop.memory.absolute);
    EXPECT_EQ(loop.memory.range, 1 << 24);
    EXPECT_EQ(loop.memory.moved_while_off, 5);

    const auto& plain = machine.axes[3].axis;
    EXPECT_EQ(plain.control.mode, axes::ControlMode::position);
    EXPECT_EQ(plain.control.feed_forward, 1);
    EXPECT_TRUE(plain.compensation.pitch.empty());
    EXPECT_EQ(plain.patience.feed, 3);
    EXPECT_FALSE(plain.memory.absolute);
    EXPECT_FALSE(plain.control.integral.used());
    EXPECT_FALSE(plain.control.load.used());
    EXPECT_EQ(plain.following.per_velocity, 0ms);
    EXPECT_FALSE(plain.limits.differ());
    EXPECT_TRUE(std::isinf(plain.limits.torque));
    EXPECT_EQ(plain.modulo, 0);
    EXPECT_FALSE(plain.encoder);
    EXPECT_EQ(machine.axes[1].axis.modulo, 360);
    EXPECT_TRUE(machine.axes[2].axis.encoder);
}

TEST(MachineLoader, AnAxisHasItsReactions) {
    using axes::AxisAlarm;
    using axes::ErrorReaction;
    const auto machine = must_load(source + "/tests/config/good/axes.yaml").machine;
    const auto& chosen = machine.axes.at(0).axis.reactions;
    EXPECT_EQ(chosen.chosen(AxisAlarm::following_error), ErrorReaction::quick_stop);
    EXPECT_EQ(chosen.chosen(AxisAlarm::drive_warning), ErrorReaction::ramp_stop);
    EXPECT_EQ(chosen.chosen(AxisAlarm::master_lost), ErrorReaction::stop_machine);
    EXPECT_EQ(chosen.chosen(AxisAlarm::drive_fault), ErrorReaction::by_table);
    EXPECT_EQ(machine.axes.at(1).axis.reactions.chosen(AxisAlarm::following_error), ErrorReaction::by_table);
}

TEST(MachineLoader, ABrakeIsTheDrivesOrOnAnOutput) {
    const auto machine = must_load(source + "/tests/config/good/brake.yaml").machine;
    const auto& z = machine.axes.at(0);
    EXPECT_EQ(z.axis.brake.by, axes::BrakeBy::output);
    EXPECT_EQ(z.brake_output, "z_brake");
    EXPECT_EQ(z.axis.brake.release, 80ms);
    EXPECT_EQ(z.axis.brake.engage, 120ms);
    EXPECT_TRUE(z.axis.brake.release_without_power);
    const auto plain = must_load(source + "/tests/config/good/axes.yaml").machine;
    EXPECT_EQ(plain.axes.at(0).axis.brake.by, axes::BrakeBy::drive);
    EXPECT_FALSE(plain.axes.at(0).axis.brake.release_without_power);
}

TEST(MachineLoader, AGantryHasTwoSidesAndALoadItsEncoder) {
    const auto machine = must_load(source + "/tests/config/good/gantry.yaml").machine;
    const auto& y = machine.axes.at(0);
    EXPECT_TRUE(y.axis.gantry.on);
    EXPECT_EQ(y.axis.gantry.warning, 0.3);
    EXPECT_EQ(y.axis.gantry.error, 1);
    EXPECT_EQ(y.axis.gantry.square_velocity, 2);
    EXPECT_EQ(y.axis.gantry.square_offset, -0.05);
    EXPECT_EQ(y.follower.slave, "right");
    EXPECT_TRUE(y.follower.mirrored);
    EXPECT_EQ(y.follower.profile, y.profile);
    EXPECT_EQ(y.axis.reactions.chosen(axes::AxisAlarm::drive_fault), axes::ErrorReaction::ramp_then_off);
    const auto sides = sides_of(machine.axes);
    ASSERT_EQ(sides.size(), 2u);
    EXPECT_EQ(sides[1].axis.name, "y.follower");
    EXPECT_EQ(sides[1].simulation.start, 0.5);
    EXPECT_TRUE(sides[1].axis.gearing.inverted);
    EXPECT_FALSE(sides[1].axis.gantry.on);
    const auto& load = y.axis.load_encoder;
    EXPECT_EQ(y.load_input, "scale");
    EXPECT_EQ(load.counts_per_unit, 200);
    EXPECT_TRUE(load.inverted);
    EXPECT_EQ(load.bits, 24);
    EXPECT_EQ(load.tolerance, 0.5);
    EXPECT_EQ(load.time, 20ms);
    EXPECT_TRUE(load.shown);
}

TEST(MachineLoader, EachKindOfHomingHasItsValues) {
    const auto machine = must_load(source + "/tests/config/good/axes.yaml").machine;
    ASSERT_EQ(machine.axes.size(), 4u);
    const auto homing = [&](std::size_t i) { return machine.axes[i].axis.homing; };
    EXPECT_EQ(homing(0).kind, axes::HomingKind::block);
    EXPECT_FALSE(homing(0).negative);
    EXPECT_EQ(homing(0).torque, 0.3);
    EXPECT_EQ(homing(0).block_velocity, 2);
    EXPECT_EQ(homing(0).block_time, 80ms);
    EXPECT_EQ(homing(1).kind, axes::HomingKind::reference_pulse);
    EXPECT_EQ(homing(1).search_velocity, 20);
    EXPECT_EQ(homing(1).latch_velocity, 1);
    EXPECT_EQ(homing(1).marks.spacing, 1000);
    EXPECT_EQ(homing(1).marks.step, 5);
    EXPECT_EQ(homing(2).kind, axes::HomingKind::absolute);
    EXPECT_EQ(homing(2).offset, 3);
    EXPECT_EQ(homing(3).kind, axes::HomingKind::limit_switch);
    EXPECT_TRUE(homing(3).negative);
    EXPECT_EQ(homing(3).acceleration, 200);
    EXPECT_EQ(homing(3).timeout, 30s);
}

// Kept positions are those of real drives: beside the machine file, and nowhere while the bus is simulated.
TEST(MachineLoader, RetainIsRelativeToTheFileAndNotForSimulatedDrives) {
    auto options = without_programs();
    const auto path = source + "/tests/config/good/axes.yaml";
    EXPECT_EQ(must_load(path, options).machine.retain.directory, source + "/tests/config/good/kept");
    options.simulate = true;
    EXPECT_EQ(must_load(path, options).machine.retain.directory, "");
}

// A directory alone, or with more: docs/retain.md.
TEST(MachineLoader, RetainIsADirectoryOrASection) {
    const auto path = source + "/tests/config/good/axes.yaml";
    std::ifstream in(path);
    const std::string whole{std::istreambuf_iterator<char>(in), {}};
    const auto with = [&](const std::string& retain) {
        auto text = whole;
        const auto at = text.find("retain: state/../kept");
        EXPECT_NE(at, std::string::npos);
        return load_machine_text(path, text.replace(at, std::string("retain: state/../kept").size(), "retain: " + retain),
                                 without_programs());
    };
    const auto loaded = with("{ directory: /var/lib/m, every: 200 ms }");
    ASSERT_TRUE(std::holds_alternative<LoadedMachine>(loaded));
    const auto& kept = std::get<LoadedMachine>(loaded).machine.retain;
    EXPECT_EQ(kept.directory, "/var/lib/m");
    EXPECT_EQ(kept.every, 200ms);
    EXPECT_EQ(kept.power_fail, "");
    const auto plain = with("/var/lib/m");
    ASSERT_TRUE(std::holds_alternative<LoadedMachine>(plain));
    EXPECT_EQ(std::get<LoadedMachine>(plain).machine.retain.every, 1s);
    const auto wrong = with("{ every: 200 ms }");
    ASSERT_TRUE(std::holds_alternative<std::vector<Error>>(wrong));
    EXPECT_NE(std::get<std::vector<Error>>(wrong).front().what.find("directory"), std::string::npos);
    const auto unknown = with("{ directory: d, power_fail: supply }");
    ASSERT_TRUE(std::holds_alternative<std::vector<Error>>(unknown));
    EXPECT_EQ(std::get<std::vector<Error>>(unknown).front().code, "retain.power_fail");
}

TEST(MachineLoader, TasksRunAtWholeCycles) {
    const auto loaded = must_load(source + "/tests/config/good/units.yaml");
    ASSERT_EQ(loaded.machine.tasks.size(), 4u);
    EXPECT_EQ(loaded.machine.tasks[0].divisor, 1);
    EXPECT_EQ(loaded.machine.tasks[1].divisor, 4);  // 8 ms at 2 ms
    EXPECT_EQ(loaded.machine.tasks[1].overrun, runtime::OverrunReaction::count);
    EXPECT_FALSE(loaded.machine.tasks[1].watchdog);
    EXPECT_FALSE(loaded.machine.tasks[1].priority);
    EXPECT_EQ(loaded.machine.tasks[2].divisor, 250);
    EXPECT_EQ(loaded.machine.tasks[2].overrun, runtime::OverrunReaction::stop_program);
    EXPECT_EQ(loaded.machine.tasks[2].watchdog, 400ms);
    EXPECT_EQ(loaded.machine.tasks[2].watchdog_sensitivity, 2);
    EXPECT_EQ(loaded.machine.tasks[2].priority, 30);
    EXPECT_EQ(loaded.machine.tasks[3].name, "main") << "a program without `tasks` has one";
    EXPECT_EQ(loaded.machine.tasks[3].program, "other");
    const auto& parameters = loaded.machine.programs[0].parameters;
    ASSERT_EQ(parameters.size(), 3u);
    EXPECT_EQ(parameters[0].value, 12.5);
    EXPECT_TRUE(parameters[0].in_units.empty()) << "in the program's own unit, whatever that is";
    EXPECT_EQ(parameters[1].value, 1);
    // Which unit it takes only the program knows: here it is in each.
    EXPECT_EQ(parameters[2].text, "6 cm");
    double mm = 0;
    for (const auto& one : parameters[2].in_units)
        if (one.unit == "mm") mm = one.value;
    EXPECT_DOUBLE_EQ(mm, 60);
}

TEST(MachineLoader, StartupListsReplaceTheProfilesEntriesAndKnowWhereTheyStand) {
    const auto path = source + "/tests/config/good/units.yaml";
    const auto loaded = must_load(path);
    const auto& startup = loaded.machine.bus.slaves[0].startup;
    ASSERT_EQ(startup.size(), 3u);
    EXPECT_EQ(startup[0].index, 0x2005);
    EXPECT_EQ(startup[0].sub, 0x0B);
    EXPECT_EQ(startup[0].value, 2);
    EXPECT_EQ(startup[0].type, ecat::DataType::U16) << "as the dictionary says";
    EXPECT_EQ(startup[0].origin, path + ":13:11");
    EXPECT_EQ(startup[1].sub, 0x2C) << "decimal 44";
    EXPECT_EQ(startup[2].at, ecat::Transition::SafeopToOp);
    EXPECT_EQ(startup[2].value, -5);
    EXPECT_FALSE(startup[2].verify);
    EXPECT_EQ(loaded.machine.bus.slaves[1].startup.size(), 3u) << "through the alias";
}

TEST(MachineLoader, ProcessDataIsTheProfilesOrTheMachines) {
    const auto loaded = must_load(source + "/tests/config/good/units.yaml");
    const auto& a = loaded.machine.bus.slaves[0];
    ASSERT_EQ(a.rx.assigned.size(), 1u);
    EXPECT_EQ(a.rx.assigned[0].index, 0x1702);
    EXPECT_EQ(a.tx.assigned[0].index, 0x1A00);
    const auto& b = loaded.machine.bus.slaves[1];
    ASSERT_EQ(b.tx.assigned.size(), 1u);
    EXPECT_THAT(b.tx.assigned[0].entries,
                ElementsAre(ecat::PdoEntry{0x6041, 0, 16}, ecat::PdoEntry{0x6061, 0, 8}, ecat::PdoEntry{0x6064, 0, 32}));
    EXPECT_EQ(b.alias, 300);
    EXPECT_FALSE(b.position.has_value());
}

TEST(MachineLoader, TheBusSaysWhoIsWhereHowFastAndWhatIfItIsGone) {
    auto options = without_programs();
    options.drive_dirs.push_back(source + "/tests/config/good");
    const auto bus = must_load(source + "/tests/config/good/bus.yaml", options).machine.bus;
    EXPECT_EQ(bus.extra_slaves, ecat::ExtraSlaves::ignore);
    EXPECT_EQ(bus.state_timeouts.preop, 4s);
    EXPECT_EQ(bus.state_timeouts.safeop, 10s) << "the default";
    EXPECT_EQ(bus.state_timeouts.op, 500ms);
    ASSERT_EQ(bus.sync_units.size(), 1u);
    EXPECT_EQ(bus.sync_units[0].name, "slow");
    EXPECT_EQ(bus.sync_units[0].divisor, 4);

    ASSERT_EQ(bus.slaves.size(), 2u);
    const auto& robot = bus.slaves[0];
    EXPECT_FALSE(robot.position.has_value());
    EXPECT_EQ(robot.device_id, 7);
    EXPECT_EQ(robot.revision_rule, ecat::RevisionRule::exact);
    EXPECT_EQ(robot.on_loss, ecat::LossPolicy::stop_own_axes);
    EXPECT_EQ(robot.sync_unit, "slow");
    EXPECT_EQ(robot.pdi_watchdog, 20ms);
    ASSERT_EQ(robot.modules.size(), 2u);
    EXPECT_EQ(robot.modules[0].slot, 1);
    EXPECT_EQ(robot.modules[0].module, "csp");
    const auto& y = bus.slaves[1];
    EXPECT_EQ(y.alias, 3);
    EXPECT_EQ(y.sync1, 250us);
    EXPECT_EQ(y.sync_start, ecat::SyncStart::in_safeop);
    EXPECT_FALSE(y.revision_rule.has_value());
}

TEST(DriveLoader, AModularDriveHasSlotsModulesGapsAndASyncManagerPerPdo) {
    const auto loaded = load_drive(source + "/tests/config/good/modular_drive.yaml");
    ASSERT_TRUE(std::holds_alternative<LoadedDrive>(loaded)) << one_a_line(std::get<std::vector<Error>>(loaded));
    const auto& device = *std::get<LoadedDrive>(loaded).device;
    EXPECT_EQ(device.revision_rule, ecat::RevisionRule::at_least);
    EXPECT_EQ(device.slots.count, 2);
    EXPECT_EQ(device.slots.index_increment, 0x800);
    EXPECT_EQ(device.slots.pdo_increment, 0x40);
    ASSERT_EQ(device.slots.modules.size(), 1u);
    EXPECT_EQ(device.slots.modules[0].name, "csp");
    EXPECT_EQ(device.slots.modules[0].ident, 0x11u);
    ASSERT_EQ(device.slots.modules[0].rx_pdos.size(), 1u);
    EXPECT_THAT(device.slots.modules[0].rx_pdos[0].entries, ElementsAre(ecat::PdoEntry{0x6040, 0, 16}, ecat::PdoEntry{0x607A, 0, 32}));
    ASSERT_EQ(device.tx_pdos.size(), 1u);
    EXPECT_EQ(device.tx_pdos[0].sync_manager, 4);
    EXPECT_THAT(device.tx_pdos[0].entries, ElementsAre(ecat::PdoEntry{0, 0, 3}, ecat::PdoEntry{0x60FD, 0, 16}, ecat::PdoEntry{0, 0, 5}));
}

TEST(MachineLoader, PointsAreObjectsOfTheirSlave) {
    const auto loaded = must_load(source + "/tests/config/good/units.yaml");
    ASSERT_EQ(loaded.machine.io.size(), 2u);
    EXPECT_EQ(loaded.machine.io[0].index, 0x6000);
    EXPECT_EQ(loaded.machine.io[0].sub, 16);
    EXPECT_TRUE(loaded.machine.io[0].inverted);
    EXPECT_EQ(loaded.machine.io[0].simulated, 1);
    EXPECT_EQ(loaded.machine.io[1].index, 0x60FD);
}

TEST(MachineLoader, SlavesAreExchangedAtTheRateOfTheirSyncUnit) {
    const auto bus = must_load(source + "/tests/config/good/sync_units.yaml").machine.bus;
    ASSERT_EQ(bus.slaves.size(), 3u);
    EXPECT_EQ(ecat::exchange_period(bus, bus.slaves[0]), 1ms);
    EXPECT_EQ(ecat::exchange_period(bus, bus.slaves[1]), 10ms);
    EXPECT_EQ(ecat::exchange_period(bus, bus.slaves[2]), 10ms);
    EXPECT_EQ(bus.slaves[1].sync_unit, "station");
}

TEST(MachineLoader, SimulateReplacesTheInterfaceOnly) {
    auto options = without_programs();
    EXPECT_EQ(must_load(source + "/tests/config/good/units.yaml", options).machine.bus.interface, "eth0");
    options.simulate = true;
    EXPECT_EQ(must_load(source + "/tests/config/good/units.yaml", options).machine.bus.interface, "");
}

TEST(MachineLoader, WhatIsLegalButPerhapsNotMeantIsAWarning) {
    const auto loaded = must_load(source + "/tests/config/good/units.yaml");
    EXPECT_THAT(one_a_line(loaded.warnings),
                testing::AllOf(HasSubstr("axis table is left out"), HasSubstr("following error of axis table is not watched")));
    EXPECT_EQ(loaded.warnings.size(), 2u) << "a virtual axis has no following error";
}

// A program of a CAM system has a hundred thousand lines and more; what people write has fewer.
TEST(MachineLoader, AProgramInGCodeMayBeLarge) {
    auto pattern = (std::filesystem::temp_directory_path() / "taktwerk-large-XXXXXX").string();
    const std::filesystem::path folder = ::mkdtemp(pattern.data());
    {
        std::ofstream program(folder / "part.ngc");
        program << "G21 G90 F600\n";
        for (int i = 0; i < 100'000; ++i) program << "G1 X" << i % 100 << ".125 Y" << i % 7 << ".250\n";
        program << "M30\n";
        std::ofstream(folder / "mill.yaml") << "version: 1\nname: mill\ncycle: 1 ms\nbus: { interface: simulated, slaves: [] }\n"
                                               "axes:\n  x: { unit: mm, gearing: { counts_per_revolution: 36000, feed: 10 mm }, limits: "
                                               "{ velocity: 100 mm/s, acceleration: 1000 mm/s2, jerk: none } }\n"
                                               "paths:\n  part: { file: part.ngc }\n";
    }
    ASSERT_GT(std::filesystem::file_size(folder / "part.ngc"), max_file_bytes);
    const auto machine = must_load((folder / "mill.yaml").string()).machine;
    ASSERT_EQ(machine.paths.size(), 1u);
    EXPECT_EQ(machine.paths[0].text->size(), std::filesystem::file_size(folder / "part.ngc"));
    std::filesystem::remove_all(folder);
}

TEST(MachineLoader, ProgramsAreFoundBesideTheFileOrInThePath) {
    auto options = without_programs();
    options.resolve_programs = true;
    const auto demo = source + "/config/machines/demo.yaml";
    const auto errors = must_fail(demo, options);
    ASSERT_EQ(errors.size(), 1u);
    EXPECT_THAT(errors[0].text(), testing::AllOf(HasSubstr("demo.yaml:"), HasSubstr("config/machines/pick_and_place.so")));

    written("pick_and_place.so", "any file");
    options.program_path = {"/nowhere", testing::TempDir()};
    const auto library = must_load(demo, options).machine.programs[0].library;
    EXPECT_EQ(std::filesystem::path(library), std::filesystem::path(testing::TempDir()) / "pick_and_place.so");
}

TEST(MachineLoader, ErrorsOfADriveFileNameThatFile) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "drives";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "broken.yaml") << "version: 1\nname: broken\nvender: me\n";
    const auto path = written("uses_broken.yaml",
                              "version: 1\nname: m\ncycle: 1 ms\nbus: {interface: simulated, slaves: [{name: d, profile: broken}]}\n"
                              "axes: {x: {slave: d, unit: mm, gearing: {counts_per_revolution: 1, feed: 1 mm}, limits: {velocity: 1 mm/s, "
                              "acceleration: 1 mm/s2, jerk: none}}}\n");
    auto options = without_programs();
    options.drive_dirs = {folder.string()};
    const auto errors = must_fail(path, options);
    EXPECT_THAT(one_a_line(errors), HasSubstr("broken.yaml:3:1: there is no key `vender` here. did you mean `vendor`?"));
    for (const auto& error : errors) EXPECT_THAT(error.subject, HasSubstr("broken.yaml")) << error.text();
}

// A bus for other people's masters: no axis, and slaves that do not stand in a line.
TEST(MachineLoader, AFileMayDescribeOnlyABusAndWhereItsSlavesHang) {
    const auto path = written("bus_only.yaml",
                              "version: 1\nname: tree\ncycle: 1 ms\nbus:\n  interface: simulated\n  slaves:\n"
                              "    - {name: junction, terminal: {inputs: 8}}\n"
                              "    - {name: y_drive, profile: sv33-e, alias: 7}\n"
                              "    - {name: lamp, terminal: {outputs: 8}}\n"
                              "simulation:\n  slaves:\n"
                              "    y_drive: {behind: junction, port: 3, cable: 25, drift: -40 ppm}\n"
                              "    lamp: {behind: junction}\n");
    const auto loaded = must_load(path);

    EXPECT_TRUE(loaded.machine.axes.empty());
    const auto& wires = loaded.machine.simulation.slaves;
    ASSERT_EQ(wires.size(), 2u);
    EXPECT_EQ(wires[0].slave, "y_drive");
    EXPECT_EQ(wires[0].behind, "junction");
    EXPECT_EQ(wires[0].port, 3);
    EXPECT_EQ(wires[0].cable, 25.0);
    EXPECT_EQ(wires[0].drift_ppm, -40.0);
    EXPECT_EQ(wires[1].port, 1);
    EXPECT_FALSE(wires[1].drift_ppm);
}

// --- what a bundle is made of ---------------------------------------------------------------------------------------------------

TEST(UsedFiles, AreThoseOfDrivesDevicesCamsAndImagesEachOnce) {
    const auto loaded = must_load(source + "/config/machines/demo.yaml");
    std::vector<std::string> files;
    for (const auto& file : loaded.files) {
        EXPECT_TRUE(std::filesystem::is_regular_file(file.path)) << file.path;
        files.push_back(file.written);
    }
    EXPECT_THAT(files, ElementsAre("se-808x.yaml", "se-808x.objects.yaml", "se-808x.alarms.yaml", "sv33-e.yaml", "sv33-e.objects.yaml",
                                   "sv33-e.alarms.yaml", "demo-cell.svg"))
        << "two slaves have one drive file; its terminal has none; programs were not asked for";
    EXPECT_EQ(loaded.files.back().kind, UsedFile::Kind::image);
    const auto based = must_load(source + "/config/machines/any-servo.yaml");
    EXPECT_TRUE(
        std::any_of(based.files.begin(), based.files.end(), [](const UsedFile& file) { return file.written == "cia402.alarms.yaml"; }));
}

TEST(StateDirectory, TakesTheRelativeDirectoriesOfWhatIsKept) {
    const std::string machine =
        "version: 1\nname: m\ncycle: 1 ms\nbus: { interface: eth9, slaves: [{ name: io, terminal: { inputs: 8 } }] }\n";
    const auto path = written("state.yaml", machine + "retain: kept\nevidence: { directory: seen }\nhistory: { directory: /var/log/m }\n");
    auto options = without_programs();
    const auto beside = must_load(path, options);
    EXPECT_EQ(beside.machine.retain.directory, (std::filesystem::path(path).parent_path() / "kept").lexically_normal().string());
    options.state_dir = "/state/m";
    const auto apart = must_load(path, options);
    EXPECT_EQ(apart.machine.retain.directory, "/state/m/kept");
    EXPECT_EQ(apart.machine.evidence.directory, "/state/m/seen");
    EXPECT_EQ(apart.hmi.history.directory, "/var/log/m") << "an absolute one is what it is";
}

}  // namespace
}  // namespace taktwerk::config
