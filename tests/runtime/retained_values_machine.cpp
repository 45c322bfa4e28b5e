// Programs over a time without power, in virtual time on a real directory: what they keep stands before their first scan, no more is lost
// than was promised, and a disk that fails costs an alarm and nothing else.

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "fb_library/iec/counters.hpp"
#include "fb_library/iec/timers.hpp"
#include "runtime/alarms.hpp"
#include "runtime/retain/kept_text.hpp"
#include "runtime/retain/value_type.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

namespace fs = std::filesystem;
using enum OperatorAction;

/// Counts its scans; what a start found is remembered before anything is counted.
struct Counting : Program {
    std::int64_t scans = 0;
    std::int32_t total = 0;
    std::array<double, 3> recipe{1, 2, 3};
    fb::CTU edges;
    fb::TON delay;
    Parameter speed;
    std::int64_t found_at_start = -1, delay_ms = 0, edges_counted = 0;
    double told_speed = 0;

    void declare(Declaration& d) override {
        d.retain("scans", scans);
        d.persistent("total", total);
        d.retain("recipe", recipe);
        d.retain("edges", edges);
        d.retain("delay", delay);
        speed = d.parameter("speed", {.value = 200, .minimum = 10, .maximum = 500, .unit = "mm/s"});
        d.monitor("scans", scans);
        d.monitor("total", total);
        d.monitor("found", found_at_start);
        d.monitor("delay_ms", delay_ms);
        d.monitor("edges", edges_counted);
        d.monitor("speed", told_speed);
        d.monitor("recipe_1", recipe[1]);
        d.task<&Counting::scan>("main");
    }
    void start() override { found_at_start = scans; }
    void scan(TaskContext& ctx) {
        ++scans;
        if (ctx.first_scan) ++total;
        recipe[1] = 2.5;
        edges.CU = true, edges.PV = 100;
        edges(ctx);
        edges_counted = edges.CV;
        delay.IN = true, delay.PT = std::chrono::seconds{10};
        delay(ctx);
        delay_ms = std::chrono::duration_cast<std::chrono::milliseconds>(delay.ET).count();
        told_speed = ctx.get(speed);
    }
};
struct RetainedValues : ::testing::Test {
    RetainedValues() {
        auto name = (fs::temp_directory_path() / "taktwerk_values_XXXXXX").string();
        directory = mkdtemp(name.data());
    }
    ~RetainedValues() override {
        machine.reset();
        fs::permissions(directory, fs::perms::owner_all);
        fs::remove_all(directory);
    }
    MachineConfig config(std::uint16_t divisor = 1, RetainStart start = RetainStart::warm) const {
        auto config = with_program(1, &entry_of<Counting>, divisor);
        config.retain.directory = (directory / "kept").string();
        config.retain.start = start;
        return config;
    }
    void up(MachineConfig config) {
        machine = std::make_unique<TestMachine>(std::move(config));
        ASSERT_TRUE(machine->up());
    }
    void run(MachineConfig config, Duration time) {
        up(std::move(config));
        machine->run(time);
    }
    double value(std::string_view name) { return variable(*machine, name); }
    /// Orderly.
    void end() {
        machine->runner->shut_down();
        machine.reset();
    }
    /// What a start would find now.
    Kept kept() const {
        Kept newest;
        for (const auto* slot : {"retain.0", "retain.1"}) {
            std::ifstream in(directory / "kept" / slot, std::ios::binary);
            const std::string text{std::istreambuf_iterator<char>(in), {}};
            if (auto read = kept_of(text); read && read->number > newest.number) newest = std::move(*read);
        }
        return newest;
    }
    std::string kept_text(std::string_view name) const {
        for (const auto& value : kept().values)
            if (value.name == name) return text_of(value.type, value.bits);
        return "nothing";
    }

    fs::path directory;
    std::unique_ptr<TestMachine> machine;
};

using namespace std::chrono_literals;

TEST_F(RetainedValues, StandBeforeTheFirstScanAndBeforeStart) {
    run(config(), 3s);
    const auto scans = value("scans");
    ASSERT_GT(scans, 100);
    const auto delay = value("delay_ms");
    ASSERT_GT(delay, 1000);
    EXPECT_EQ(value("found"), 0) << "nothing was kept yet";
    end();
    const auto written = std::stod(kept_text("p.scans"));
    EXPECT_GE(written, scans) << "an orderly end loses nothing";

    auto by_hand = config();
    by_hand.programs[0].autostart = false;
    up(by_hand);
    machine->run(5s);
    EXPECT_EQ(value("scans"), written) << "shown before it runs";
    ASSERT_EQ(machine->command(program_start, 0).answer, Answer::accepted);
    machine->run(100ms);
    EXPECT_EQ(value("found"), written);
    EXPECT_GT(value("scans"), written);
    EXPECT_EQ(value("total"), 2);
    EXPECT_EQ(value("recipe_1"), 2.5);
    EXPECT_EQ(value("edges"), 1) << "CU stood TRUE all the time: one edge";
    // The timer goes on at the time it had, however long the machine stood before its start.
    EXPECT_GE(value("delay_ms"), delay);
    EXPECT_LE(value("delay_ms"), delay + 2000);
}

TEST_F(RetainedValues, WithoutAnOrderlyEndNoMoreThanTheIntervalIsLost) {
    for (const auto every : {Duration{1s}, Duration{100ms}}) {
        fs::remove_all(directory / "kept");
        auto c = config();
        c.retain.every = every;
        run(c, 3s);
        for (int i = 0; i < 50; ++i) {
            machine->run(37ms);  // at any phase of it
            const auto lost = value("scans") - std::stod(kept_text("p.scans"));
            EXPECT_GE(lost, 0);
            EXPECT_LE(lost, static_cast<double>(every / machine->machine->layout().cycle) + 2) << "virtual time has no slow disk";
        }
        const auto writings = kept().number;
        EXPECT_LE(static_cast<double>(writings), to_seconds(3s + 50 * 37ms + 2s) / to_seconds(every) + 4) << "and not written more often";
        machine.reset();  // the power goes
    }
}

TEST_F(RetainedValues, ThePowerFailInputWritesAtOnce) {
    auto c = config();
    c.retain.every = 1h;
    c.retain.power_fail = "button";
    run(c, 2s);
    const auto before = kept_text("p.scans");
    machine->run(1s);
    ASSERT_EQ(kept_text("p.scans"), before) << "the interval is an hour";
    const auto scans = value("scans");
    machine->world.set_input("button", true);
    machine->run(5ms);
    EXPECT_GE(std::stod(kept_text("p.scans")), scans);
}

TEST_F(RetainedValues, OfASlowTaskEveryRunIsWholeOrNotThere) {
    run(config(10), 2s);
    for (int i = 0; i < 30; ++i) {
        machine->run(31ms);
        ASSERT_NE(kept_text("p.scans"), "nothing");
    }
    end();
    const auto written = std::stod(kept_text("p.scans"));
    run(config(10), 100ms);
    EXPECT_EQ(value("found"), written);
}

TEST_F(RetainedValues, ColdAndOriginBeginAnew) {
    run(config(), 1s);
    end();
    run(config(1, RetainStart::cold), 100ms);
    EXPECT_EQ(value("found"), 0);
    EXPECT_EQ(value("total"), 2) << "persistent";
    end();
    run(config(1, RetainStart::origin), 100ms);
    EXPECT_EQ(value("found"), 0);
    EXPECT_EQ(value("total"), 1);
}

TEST_F(RetainedValues, AParameterOfTheOperatorOutlivesPower) {
    up(config());
    OperatorCommand command;
    command.action = set_parameter;
    command.index = 0;
    command.value = 180;
    ASSERT_EQ(machine->command(command).answer, Answer::accepted);
    machine->run(1200ms);
    machine.reset();
    run(config(), 50ms);
    EXPECT_EQ(value("speed"), 180);
    machine.reset();
    auto edited = config();
    ParameterValue set;
    set.name = "speed";
    set.value = 300;
    edited.programs[0].parameters.push_back(set);
    run(edited, 50ms);
    EXPECT_EQ(value("speed"), 300) << "the machine file was changed since";
}

TEST_F(RetainedValues, ADiskThatTakesNothingCostsAnAlarmAndNothingElse) {
    std::ofstream(directory / "kept") << "a file where the folder should be";
    run(config(), 2s);
    EXPECT_TRUE(machine->has_alarm(id(MachineAlarm::retain_not_written))) << machine->alarms();
    EXPECT_GT(value("scans"), 100) << "it runs on";
    fs::remove(directory / "kept");
    machine->run(1500ms);
    EXPECT_FALSE(machine->has_alarm(id(MachineAlarm::retain_not_written))) << machine->alarms();
    EXPECT_GT(std::stod(kept_text("p.scans")), 100);
}

TEST_F(RetainedValues, ADamagedSlotIsSaidAndTheOtherOneUsed) {
    run(config(), 2s);
    end();
    ASSERT_TRUE(fs::exists(directory / "kept/retain.1"));
    std::ofstream(directory / "kept/retain.1", std::ios::app) << "x";
    run(config(), 100ms);
    EXPECT_GT(value("found"), 0);
    std::string said;
    for (const auto& line : lines_of(machine->machine->retain_notes())) said += line + "\n";
    EXPECT_THAT(said, ::testing::AllOf(::testing::HasSubstr("retain.1: the file is torn or altered"),
                                       ::testing::HasSubstr("the other one is used")));
}

TEST_F(RetainedValues, BothSlotsDamagedIsAnAlarmUntilReset) {
    run(config(), 2s);
    end();
    for (const auto* slot : {"retain.0", "retain.1"}) {
        ASSERT_TRUE(fs::exists(directory / "kept" / slot));
        std::ofstream(directory / "kept" / slot, std::ios::app) << "x";
    }
    run(config(), 100ms);
    EXPECT_EQ(value("found"), 0);
    EXPECT_TRUE(machine->has_alarm(id(MachineAlarm::values_lost))) << machine->alarms();
    ASSERT_EQ(machine->command(reset, StopLevels::all_axes).answer, Answer::accepted);
    machine->run(10ms);
    EXPECT_FALSE(machine->has_alarm(id(MachineAlarm::values_lost))) << machine->alarms();
}

/// As much as a machine may keep, and one more.
template <std::size_t Extra>
struct KeepsTooMuch final : Program {
    std::array<bool, most_kept_values + Extra> values{};
    void declare(Declaration& d) override {
        d.retain("values", values);
        d.task<&KeepsTooMuch::scan>("main");
    }
    void scan(TaskContext&) { values.back() = true; }
};

TEST_F(RetainedValues, WhatCouldNotBeReadAgainIsRefusedAndTheMostThatIsTakenComesBack) {
    auto c = config();
    c.programs[0].entry = &entry_of<KeepsTooMuch<1>>;
    World world{c, Instant{}};
    const auto refused = Machine::build(c, world.bus());
    ASSERT_EQ(refused.index(), 1u);
    EXPECT_EQ(std::get<1>(refused).front().code, "program.retain_size");

    c.programs[0].entry = &entry_of<KeepsTooMuch<0>>;
    run(c, 100ms);
    end();
    EXPECT_EQ(kept().values.size(), most_kept_values);
    EXPECT_EQ(kept_text("p.values[8191]"), "1");
}

/// A counter whose pin CV and a variable have one name. What it wrote could not be read again, positions of axes neither.
template <int Case>
struct SameNames final : Program {
    fb::CTU count;
    std::int16_t value = 0;
    void declare(Declaration& d) override {
        d.retain("count", count);
        d.retain(Case == 1 ? "count.CV" : Case == 2 ? "count" : "count.Axis", value);
        d.task<&SameNames::scan>("main");
    }
    void scan(TaskContext&) {}
};

TEST_F(RetainedValues, AVariableWithTheNameOfAPinThatIsKeptIsRefused) {
    const auto problems = [&](const ProgramEntry* (*entry)()) {
        auto c = config();
        c.programs[0].entry = entry;
        World world{c, Instant{}};
        const auto built = Machine::build(c, world.bus());
        std::string codes;
        if (built.index() == 1)
            for (const auto& error : std::get<1>(built)) codes += error.code + " " + error.what + "\n";
        return codes;
    };

    EXPECT_THAT(problems(&entry_of<SameNames<1>>),
                ::testing::AllOf(::testing::HasSubstr("program.duplicate_name"), ::testing::HasSubstr("'p.count.CV'")));
    EXPECT_EQ(problems(&entry_of<SameNames<2>>), "program.duplicate_name kept variable 'count' is declared twice\n") << "once";
    EXPECT_EQ(problems(&entry_of<SameNames<3>>), "") << "a counter has no such pin";
}

TEST_F(RetainedValues, AButtonIsNotKept) {
    struct Held final : Program {
        bool pressed = false;
        void declare(Declaration& d) override {
            d.operator_button("pressed", pressed);
            d.retain("pressed", pressed);
            d.task<&Held::scan>("main");
        }
        void scan(TaskContext&) {}
    };
    auto c = config();
    c.programs[0].entry = &entry_of<Held>;
    World world{c, Instant{}};
    const auto refused = Machine::build(c, world.bus());
    ASSERT_EQ(refused.index(), 1u);
    EXPECT_EQ(std::get<1>(refused).front().code, "program.retain_button");
}

}  // namespace
}  // namespace taktwerk::runtime::testing
