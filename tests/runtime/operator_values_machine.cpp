// Variables of programs that people write (Declaration::operator_value): when a value arrives, what is refused, and that a button which nobody
// holds any more is let go, whatever happened to its page.

#include <gmock/gmock.h>

#include "runtime/alarms.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::ErrorId;
using enum OperatorAction;

/// One of each kind; notes what its scans saw.
class Written : public Program {
public:
    double speed = 100, speed_at_begin = 0;
    std::int32_t count = 3;
    std::uint16_t recipe = 1;
    bool lamp = false, start = false;
    std::int64_t scans = 0, presses = 0, scans_pressed = 0, changed_within = 0;
    bool before = false;

    void declare(Declaration& d) override {
        if (uses_axis()) (void)d.axis("x");
        d.operator_value("speed", speed, {.minimum = 10, .maximum = 600, .unit = "mm/s", .doc = "travel", .task = task()});
        d.operator_value("count", count, {.minimum = -5, .maximum = 9, .task = task()});
        d.operator_value("recipe", recipe, {.minimum = 0, .maximum = 65535, .task = task()});
        d.operator_switch("lamp", lamp, {.doc = "light", .task = task()});
        d.operator_button("start", start, {.doc = "begin", .task = task()});
        d.monitor("scans", scans);
        d.monitor("presses", presses);
        d.monitor("scans_pressed", scans_pressed);
        declare_tasks(d);
    }
    virtual void declare_tasks(Declaration& d) { d.task<&Written::scan>("main"); }
    virtual std::string_view task() const { return {}; }
    virtual bool uses_axis() const { return false; }
    void scan(TaskContext&) {
        ++scans;
        if (start && !before) ++presses;
        before = start;
        if (start) ++scans_pressed;
    }
};

class WithAxis final : public Written {
    bool uses_axis() const override { return true; }
};

/// Reads them in a slow task, beside a base task.
class WrittenSlowly final : public Written {
    void declare_tasks(Declaration& d) override {
        d.task<&WrittenSlowly::fast>("fast");
        d.task<&Written::scan>("main");
    }
    std::string_view task() const override { return "main"; }

public:
    void fast(TaskContext&) {}
};

/// What the program makes of a switch is what people see.
class Declines final : public Program {
    bool wish_ = false;

public:
    void declare(Declaration& d) override {
        d.operator_switch("wish", wish_);
        d.task<&Declines::scan>("main");
    }
    void scan(TaskContext&) { wish_ = false; }
};

struct OperatorValue : ::testing::Test {
    std::unique_ptr<TestMachine> machine;
    void start(const ProgramEntry* (*entry)() = &entry_of<Written>, std::uint16_t divisor = 1, std::size_t axes = 1) {
        machine = std::make_unique<TestMachine>(with_program(axes, entry, divisor));
        ASSERT_TRUE(machine->up());
    }
    TestMachine& m() { return *machine; }
    std::uint16_t place(std::string_view name) {
        const auto& variables = m().machine->layout().variables;
        for (std::size_t i = 0; i < variables.size(); ++i)
            if (variables[i].name == name) return static_cast<std::uint16_t>(i);
        ADD_FAILURE() << "no variable " << name;
        return 0;
    }
    double shown(std::string_view name) { return variable(m(), name); }
    CommandAnswer write(std::string_view name, double value) { return m().command(set_value, place(name), false, value); }
    CommandAnswer press(std::string_view name = "start") { return m().command(set_value, place(name), true, 1); }
    CommandAnswer renew(std::string_view name = "start") { return m().command(set_value, place(name), false, 1); }
    /// Another client than the one of the others.
    CommandAnswer by_another(bool flag, double value) {
        OperatorCommand c;
        c.action = set_value;
        c.index = place("start");
        c.flag = flag;
        c.value = value;
        c.client = 2;
        c.sequence = ++others;
        EXPECT_TRUE(m().machine->submit(c));
        for (int i = 0; i < 10; ++i) {
            m().run(1ms);
            while (const auto answer = m().machine->next_answer())
                if (answer->client == 2) return *answer;
        }
        ADD_FAILURE() << "no answer";
        return {};
    }
    void hold_for(Duration time) {
        for (Duration held{}; held < time; held += 50ms) {
            ASSERT_EQ(renew().answer, Answer::accepted);
            m().run(49ms);
        }
    }
    std::uint64_t others = 0;
};

TEST_F(OperatorValue, ANumberStandsInTheScanOfTheCycleThatTakesIt) {
    start();
    EXPECT_EQ(shown("speed"), 100);
    OperatorCommand c;
    c.action = set_value;
    c.index = place("speed");
    c.value = 250.5;
    ASSERT_TRUE(m().machine->submit(c));
    m().run(1ms);
    EXPECT_EQ(shown("speed"), 250.5);
    EXPECT_EQ(write("count", -5).answer, Answer::accepted);
    EXPECT_EQ(shown("count"), -5);
    EXPECT_EQ(write("recipe", 65535).answer, Answer::accepted);
    EXPECT_EQ(shown("recipe"), 65535);
}

TEST_F(OperatorValue, WhatIsOutOfItsRangeOrOfAnotherTypeChangesNothing) {
    start();
    const double nan_value = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    for (const double value : {9.9, 600.1, -1e300, nan_value, infinite})
        EXPECT_EQ(write("speed", value).answer, Answer::bad_value) << value;
    for (const double value : {-6.0, 10.0, 2.5, 1e18, nan_value}) EXPECT_EQ(write("count", value).answer, Answer::bad_value) << value;
    for (const double value : {-1.0, 65536.0, 0.5}) EXPECT_EQ(write("recipe", value).answer, Answer::bad_value) << value;
    for (const double value : {2.0, -1.0, 0.5}) {
        EXPECT_EQ(write("lamp", value).answer, Answer::bad_value) << value;
        EXPECT_EQ(m().command(set_value, place("start"), true, value).answer, Answer::bad_value) << value;
    }
    EXPECT_EQ(shown("speed"), 100);
    EXPECT_EQ(shown("count"), 3);
    EXPECT_EQ(shown("lamp"), 0);
    EXPECT_EQ(shown("start"), 0);
    EXPECT_EQ(write("scans", 1).answer, Answer::unknown_name) << "the program's alone";
    EXPECT_EQ(m().command(set_value, 999, false, 1).answer, Answer::unknown_name);
}

TEST_F(OperatorValue, TheLayoutSaysWhatMayBeWritten) {
    start();
    const auto& variables = m().machine->layout().variables;
    const auto& speed = variables[place("speed")];
    EXPECT_TRUE(speed.writable);
    EXPECT_FALSE(speed.momentary);
    EXPECT_EQ(speed.minimum, 10);
    EXPECT_EQ(speed.maximum, 600);
    EXPECT_EQ(speed.unit, "mm/s");
    EXPECT_TRUE(variables[place("start")].momentary);
    EXPECT_TRUE(variables[place("start")].writable);
    EXPECT_FALSE(variables[place("lamp")].momentary);
    EXPECT_EQ(variables[place("lamp")].maximum, 1);
    EXPECT_FALSE(variables[place("scans")].writable);
}

TEST_F(OperatorValue, ASwitchStaysAndAProgramMaySwitchItBack) {
    start();
    EXPECT_EQ(write("lamp", 1).answer, Answer::accepted);
    m().run(5s);
    EXPECT_EQ(shown("lamp"), 1) << "no lease";
    EXPECT_EQ(write("lamp", 0).answer, Answer::accepted);
    EXPECT_EQ(shown("lamp"), 0);

    start(&entry_of<Declines>);
    EXPECT_EQ(write("wish", 1).answer, Answer::accepted);
    EXPECT_EQ(shown("wish"), 0);
}

TEST_F(OperatorValue, AButtonIsTrueWhileItIsHeldAndCountsOnce) {
    start();
    ASSERT_EQ(press().answer, Answer::accepted);
    EXPECT_EQ(shown("start"), 1);
    hold_for(1s);
    EXPECT_EQ(shown("start"), 1);
    EXPECT_EQ(write("start", 0).answer, Answer::accepted);
    EXPECT_EQ(shown("start"), 0);
    EXPECT_EQ(shown("presses"), 1);
}

// The page is gone, frozen or cut off: nothing comes any more.
TEST_F(OperatorValue, AButtonWhoseHolderFallsSilentIsLetGoWithinTheLease) {
    start();
    ASSERT_EQ(press().answer, Answer::accepted);
    const auto pressed_at = m().state().at;
    ASSERT_TRUE(m().until([&] { return shown("start") == 0; }, 1s));
    EXPECT_LE(m().state().at - pressed_at, 200ms + 2 * m().machine->config().cycle);
    EXPECT_GE(m().state().at - pressed_at, 150ms) << "three renewals of 50 ms may be lost";
    EXPECT_EQ(renew().answer, Answer::stale) << "a renewal that comes late presses nothing";
    m().run(10ms);
    EXPECT_EQ(shown("start"), 0);
    EXPECT_EQ(press().answer, Answer::accepted) << "a new press does";
    EXPECT_EQ(shown("presses"), 2);
}

TEST_F(OperatorValue, ARenewalThatNobodyPressedForIsStale) {
    start();
    EXPECT_EQ(renew().answer, Answer::stale);
    EXPECT_EQ(shown("presses"), 0);
}

TEST_F(OperatorValue, AButtonIsLetGoWhenItsClientIsGoneAndByNobodyElsesGoing) {
    start();
    ASSERT_EQ(press().answer, Answer::accepted);
    OperatorCommand gone;
    gone.action = release_values;
    gone.client = 2;
    ASSERT_TRUE(m().machine->submit(gone));
    m().run(2ms);
    EXPECT_EQ(shown("start"), 1);
    gone.client = 1;
    ASSERT_TRUE(m().machine->submit(gone));
    m().run(1ms);
    EXPECT_EQ(shown("start"), 0);
}

TEST_F(OperatorValue, ASecondHandNeitherPressesNorRenewsButMayLetGo) {
    start();
    ASSERT_EQ(press().answer, Answer::accepted);
    EXPECT_EQ(by_another(true, 1).answer, Answer::no_control);
    EXPECT_EQ(by_another(false, 1).answer, Answer::no_control);
    EXPECT_EQ(shown("start"), 1);
    EXPECT_EQ(by_another(false, 0).answer, Answer::accepted);
    EXPECT_EQ(shown("start"), 0);
    EXPECT_EQ(by_another(true, 1).answer, Answer::accepted) << "now it is free";
}

TEST_F(OperatorValue, TheEmergencyStopLetsGoAndNothingIsPutOnWhileItHolds) {
    start();
    ASSERT_EQ(press().answer, Answer::accepted);
    m().world.set_input("estop_ok", false);
    m().run(4ms);
    ASSERT_TRUE(m().state().emergency_stop);
    EXPECT_EQ(shown("start"), 0);
    for (const auto refused : {press(), write("lamp", 1)}) {
        EXPECT_EQ(refused.answer, Answer::not_possible_now);
        EXPECT_EQ(refused.error, ErrorId::interlocked);
    }
    EXPECT_EQ(write("speed", 50).answer, Answer::accepted) << "a number moves nothing";
    EXPECT_EQ(write("lamp", 0).answer, Answer::accepted);
    m().world.set_input("estop_ok", true);
    m().run(10ms);
    EXPECT_EQ(renew().answer, Answer::stale) << "what was held before it is not held behind it";
    EXPECT_EQ(shown("start"), 0);
}

TEST_F(OperatorValue, AStopOfAnAxisOfItsProgramLetsGo) {
    start(&entry_of<WithAxis>, 1, 2);
    ASSERT_EQ(press().answer, Answer::accepted);
    (void)m().machine->request_stop(1);
    m().run(2ms);
    EXPECT_EQ(shown("start"), 1) << "that axis is none of its program's";
    (void)m().machine->request_stop(0);
    m().run(2ms);
    EXPECT_EQ(shown("start"), 0);
    EXPECT_EQ(renew().answer, Answer::stale);

    OperatorCommand late;  // given before the stop, and at its turn behind it
    late.action = set_value;
    late.index = place("start");
    late.flag = true;
    late.value = 1;
    late.after = 1;
    EXPECT_EQ(m().command(late).answer, Answer::stale);
    late.after = m().machine->levels_raised();
    EXPECT_EQ(m().command(late).answer, Answer::accepted);
}

TEST_F(OperatorValue, WhileTheProgramRestsANumberIsWrittenAtOnceAndAButtonIsRefused) {
    start();
    ASSERT_EQ(press().answer, Answer::accepted);
    ASSERT_EQ(m().command(program_stop, 0).answer, Answer::accepted);
    m().run(5ms);
    EXPECT_EQ(shown("start"), 0) << "a program that ends lets go";
    EXPECT_EQ(write("speed", 333).answer, Answer::accepted);
    EXPECT_EQ(shown("speed"), 333);
    EXPECT_EQ(write("lamp", 1).answer, Answer::accepted);
    EXPECT_EQ(press().answer, Answer::not_possible_now);
    const auto pressed = shown("presses");
    ASSERT_EQ(m().command(program_start, 0).answer, Answer::accepted);
    m().run(10ms);
    EXPECT_EQ(shown("speed"), 333);
    EXPECT_EQ(shown("lamp"), 1);
    EXPECT_EQ(shown("presses"), pressed);
}

TEST_F(OperatorValue, ASlowTaskFindsItAtTheBeginningOfItsNextRun) {
    start(&entry_of<WrittenSlowly>, 20);
    m().run(100ms);
    ASSERT_TRUE(m().until([&] { return m().state().cycle % 20 == 3; }, 1s));  // between two releases
    EXPECT_EQ(write("speed", 250).answer, Answer::accepted);
    EXPECT_EQ(shown("speed"), 100) << "it has not begun to run with it";
    m().run(40ms);
    EXPECT_EQ(shown("speed"), 250) << "the run that began with it has been applied";

    ASSERT_EQ(press().answer, Answer::accepted);
    for (int i = 0; i < 4; ++i) {
        m().run(45ms);
        ASSERT_EQ(renew().answer, Answer::accepted);
    }
    EXPECT_EQ(shown("start"), 1);
    m().run(400ms);
    EXPECT_EQ(shown("start"), 0) << "the lease holds for slow tasks, too";
    EXPECT_EQ(shown("presses"), 1);
}

// Pressed and let go between two runs of a task of 20 ms: one run sees it, and one only.
TEST_F(OperatorValue, ATapShorterThanTheTasksPeriodIsSeenByOneRun) {
    start(&entry_of<WrittenSlowly>, 20);
    m().run(100ms);
    const auto tap = [&] {
        ASSERT_TRUE(m().until([&] { return m().state().cycle % 20 == 3; }, 1s));
        ASSERT_EQ(press().answer, Answer::accepted);
        m().run(1ms);
        ASSERT_EQ(write("start", 0).answer, Answer::accepted);
        ASSERT_LT(m().state().cycle % 20, 15u) << "still before the next release";
    };
    tap();
    m().run(100ms);
    EXPECT_EQ(shown("presses"), 1);
    EXPECT_EQ(shown("scans_pressed"), 1);
    EXPECT_EQ(shown("start"), 0);
    tap();
    m().run(100ms);
    EXPECT_EQ(shown("presses"), 2);
    EXPECT_EQ(shown("scans_pressed"), 2);
}

// The same where both come in one cycle, to a task that runs in each.
TEST_F(OperatorValue, ATapWithinOneCycleIsSeen) {
    start();
    OperatorCommand c;
    c.action = set_value, c.index = place("start"), c.client = 1, c.flag = true, c.value = 1, c.sequence = 1;
    ASSERT_TRUE(m().machine->submit(c));
    c.flag = false, c.value = 0, c.sequence = 2;
    ASSERT_TRUE(m().machine->submit(c));
    m().run(10ms);
    EXPECT_EQ(shown("presses"), 1);
    EXPECT_EQ(shown("scans_pressed"), 1);
    EXPECT_EQ(shown("start"), 0);
}

TEST_F(OperatorValue, ATapThatAStopOvertakesIsNotSeen) {
    for (const bool emergency : {false, true}) {
        start(&entry_of<WrittenSlowly>, 20);
        m().run(100ms);
        ASSERT_TRUE(m().until([&] { return m().state().cycle % 20 == 3; }, 1s));
        ASSERT_EQ(press().answer, Answer::accepted);
        ASSERT_EQ(write("start", 0).answer, Answer::accepted);
        if (emergency) m().world.set_input("estop_ok", false);
        else ASSERT_EQ(m().command(program_stop, 0).answer, Answer::accepted);
        m().run(100ms);
        EXPECT_EQ(shown("presses"), 0);
        EXPECT_EQ(shown("start"), 0);
    }
}

TEST_F(OperatorValue, ASlowTaskThatRestsShowsWhatIsWritten) {
    start(&entry_of<WrittenSlowly>, 20);
    m().run(100ms);
    ASSERT_EQ(m().command(program_stop, 0).answer, Answer::accepted);
    m().run(50ms);
    EXPECT_EQ(write("count", 7).answer, Answer::accepted);
    m().run(2ms);
    EXPECT_EQ(shown("count"), 7);
}

// --- declarations that are wrong --------------------------------------------------------------------------------------------------

template <int Case>
class Misdeclared final : public Program {
    double real_ = 5;
    std::int32_t whole_ = 1;

public:
    void declare(Declaration& d) override {
        if (Case == 0) d.operator_value("v", real_, {.minimum = 10, .maximum = 20});
        if (Case == 1) d.operator_value("v", real_, {});
        if (Case == 2) d.operator_value("v", whole_, {.minimum = 0, .maximum = 1e12});
        if (Case == 3) d.operator_value("v", real_, {.minimum = 0, .maximum = 20, .task = "mainn"});
        if (Case == 4) {
            d.operator_value("v", real_, {.minimum = 0, .maximum = 20});
            d.task<&Misdeclared::scan>("second");
        }
        if (Case == 5) {
            d.monitor("v", real_);
            d.operator_value("v", real_, {.minimum = 0, .maximum = 20});
        }
        d.task<&Misdeclared::scan>("main");
    }
    void scan(TaskContext&) {}
};

template <int Case>
Error problem_of() {
    auto config = with_program(1, &entry_of<Misdeclared<Case>>);
    World world{config, Instant{}};
    auto built = Machine::build(std::move(config), world.bus(), world.serial().lines(), world.modbus().exchanges());
    const auto* errors = std::get_if<1>(&built);
    if (errors == nullptr || errors->size() != 1) {
        ADD_FAILURE() << "case " << Case << " gives " << (errors ? errors->size() : 0) << " errors";
        return {};
    }
    return errors->front();
}

TEST(OperatorValueDeclaration, IsRefusedWithItsPlaceAndARemedy) {
    using ::testing::HasSubstr;
    const auto outside = problem_of<0>();
    EXPECT_EQ(outside.code, "program.operator_value_range");
    EXPECT_EQ(outside.subject, "program 'p'");
    EXPECT_THAT(outside.what, HasSubstr("'v' begins with 5"));
    EXPECT_THAT(problem_of<1>().what, HasSubstr("range 0 to 0")) << "a range that nobody gave";
    EXPECT_THAT(problem_of<2>().what, HasSubstr("its type holds -2147483648 to 2147483647"));
    const auto misspelt = problem_of<3>();
    EXPECT_EQ(misspelt.code, "program.unknown_task");
    EXPECT_THAT(misspelt.remedy, HasSubstr("'main'"));
    const auto unclear = problem_of<4>();
    EXPECT_EQ(unclear.code, "program.operator_value_task");
    EXPECT_THAT(unclear.remedy, HasSubstr(".task = \"second\""));
    EXPECT_EQ(problem_of<5>().code, "program.duplicate_name");
}

}  // namespace
}  // namespace taktwerk::runtime::testing
