// What the log of a machine tells of alarms that nobody looking at the list would have seen.

#include "apps/machine/machine_log.hpp"

#include <gmock/gmock.h>

#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::apps {
namespace {

using namespace std::chrono_literals;
using runtime::testing::entry_of;
using runtime::testing::TestMachine;
using runtime::testing::with_program;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Raises its alarm while `jammed`.
class Feeder final : public Program {
public:
    static inline bool jammed = false;
    void declare(Declaration& d) override {
        d.alarm(0, Reaction::warn, "the feeder is jammed", "送料器卡住", "clear it");
        d.task<&Feeder::scan>("main");
    }
    void scan(TaskContext& ctx) { ctx.alarm(0, jammed); }
};

struct MachineLogOf : testing::Test {
    void SetUp() override {
        Feeder::jammed = false;
        ASSERT_TRUE(m.up());
        m.run(50ms);
        look();
        said.clear();
    }
    void look() { log.step(m.clock.now(), &m.state()); }
    /// For one cycle.
    void jam() {
        Feeder::jammed = true;
        m.run(1ms);
        Feeder::jammed = false;
        m.run(4ms);
    }

    TestMachine m{with_program(1, &entry_of<Feeder>)};
    std::string said;
    MachineLog log{*m.machine, m.clock.now(), false, [this](std::string lines) { said += lines; }};
};

TEST_F(MachineLogOf, AnAlarmBetweenTwoLooksIsTold) {
    jam();
    look();
    EXPECT_THAT(said, AllOf(HasSubstr("ALARM"), HasSubstr("the feeder is jammed"), HasSubstr("clear it"))) << said;
    said.clear();
    look();
    EXPECT_EQ(said, "") << "once";
}

TEST_F(MachineLogOf, AnAlarmThatWasSeenIsNotToldAgainWhenItHasPassed) {
    Feeder::jammed = true;
    m.run(5ms);
    look();
    EXPECT_THAT(said, HasSubstr("the feeder is jammed"));
    said.clear();
    Feeder::jammed = false;
    m.run(5ms);
    look();
    EXPECT_THAT(said, AllOf(HasSubstr("gone"), Not(HasSubstr("ALARM"))));
}

TEST_F(MachineLogOf, OneThatGoesAndComesBackBetweenTwoLooksIsNews) {
    Feeder::jammed = true;
    m.run(5ms);
    look();
    said.clear();
    Feeder::jammed = false;
    m.run(5ms);
    Feeder::jammed = true;
    m.run(5ms);
    look();
    EXPECT_THAT(said, HasSubstr("ALARM"));
}

TEST_F(MachineLogOf, WhatPassedBeforeItBeganIsNotTold) {
    for (int i = 0; i < 30; ++i) jam();
    std::string later;
    MachineLog other{*m.machine, m.clock.now(), false, [&](std::string lines) { later += lines; }};
    other.step(m.clock.now(), &m.state());
    EXPECT_THAT(later, AllOf(Not(HasSubstr("feeder")), Not(HasSubstr("missed"))));
    jam();
    other.step(m.clock.now(), &m.state());
    EXPECT_THAT(later, HasSubstr("the feeder is jammed"));
}

// A hundred of them are not a hundred lines, but their number is.
TEST_F(MachineLogOf, ManyOfTheSameAreCounted) {
    for (int i = 0; i < 100; ++i) {
        jam();
        if (i % 4 == 3) look();
    }
    m.run(11s);
    jam();
    look();
    const auto lines = std::count(said.begin(), said.end(), '\n');
    EXPECT_LT(lines, 20) << said;
    EXPECT_THAT(said, HasSubstr("more since the last line"));
}

TEST_F(MachineLogOf, WhatWasTooMuchIsSaid) {
    for (std::size_t i = 0; i < runtime::PassedAlarms::capacity + 14; ++i) jam();
    look();
    EXPECT_THAT(said, HasSubstr("14 alarms came and went too fast to be shown")) << said;
}

}  // namespace
}  // namespace taktwerk::apps
