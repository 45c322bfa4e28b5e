// Two programs on one machine: what ends with one of them, and what does not.

#include "fb_library/all_blocks.hpp"
#include "runtime/alarms.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using namespace fb;
using axes::AxisState;

/// Powers one axis and runs another with a velocity; drives one output.
template <char powered, char moved, bool shines>
class Runs final : public Program {
public:
    AxisRef power_axis, move_axis;
    Output<bool> lamp;
    MC_Power power;
    MC_MoveVelocity move;
    void declare(Declaration& d) override {
        power_axis = d.axis(std::string_view(&name_powered, 1));
        move_axis = d.axis(std::string_view(&name_moved, 1));
        if (shines) lamp = d.output("lamp");
        d.task<&Runs::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Axis = power_axis;
        power.Enable = true;
        power(ctx);
        move.Axis = move_axis;
        move.Execute = ctx.view(move_axis)->powered;
        move.Velocity = 60;
        move(ctx);
        if (shines) ctx.set(lamp, true);
    }

private:
    static constexpr char name_powered = powered, name_moved = moved;
};

MachineConfig two(const ProgramEntry* (*a)(), const ProgramEntry* (*b)(), std::uint16_t divisor) {
    auto config = with_program(2, a, divisor);
    auto second = config.programs[0];
    second.name = "q";
    second.entry = b;
    config.programs.push_back(second);
    auto task = config.tasks[0];
    task.program = "q";
    config.tasks.push_back(task);
    return config;
}

struct TwoPrograms : ::testing::TestWithParam<std::uint16_t> {
    std::unique_ptr<TestMachine> machine;
    TestMachine& m() { return *machine; }
    void start(const ProgramEntry* (*a)(), const ProgramEntry* (*b)()) {
        machine = std::make_unique<TestMachine>(two(a, b, GetParam()));
        ASSERT_TRUE(m().up());
        ASSERT_TRUE(m().until([&] { return m().axis(0).set_velocity == 60 && m().axis(1).set_velocity == 60; }, 3s));
    }
};
INSTANTIATE_TEST_SUITE_P(BaseAndSlowerTask, TwoPrograms, ::testing::Values(1, 8));

TEST_P(TwoPrograms, AStopTakesTheAxesOfThatProgramAndNoOthers) {
    start(&entry_of<Runs<'x', 'x', true>>, &entry_of<Runs<'y', 'y', false>>);
    double slowest = 60;
    bool off = false;
    m().on_cycle = [&] {
        slowest = std::min(slowest, m().axis(1).set_velocity);
        off = off || !m().axis(1).powered;
    };
    ASSERT_EQ(m().command(OperatorAction::program_stop, 0).answer, Answer::accepted);
    EXPECT_TRUE(m().until([&] { return m().axis(0).state == AxisState::Disabled; }, 2s));
    m().run(1s);
    EXPECT_EQ(m().axis(0).state, AxisState::Disabled);
    EXPECT_NE(m().axis(0).drive_state, axes::PowerState::enabled);
    EXPECT_FALSE(off) << "the other program's axis lost its power";
    EXPECT_EQ(slowest, 60) << "the other program's axis slowed down";
    EXPECT_FALSE(m().world.output("lamp")) << "nobody drives it any more";

    ASSERT_EQ(m().command(OperatorAction::program_stop, 1).answer, Answer::accepted);
    EXPECT_TRUE(m().until([&] { return m().axis(1).state == AxisState::Disabled; }, 2s));
    m().expect_no_jump();
}

// The last program that ran has not given it.
TEST_P(TwoPrograms, AStopByAPersonIsNoQuarrelOfTwoPrograms) {
    start(&entry_of<Runs<'x', 'x', true>>, &entry_of<Runs<'y', 'y', false>>);
    (void)m().machine->request_stop(0xFFFF);
    ASSERT_TRUE(m().until([&] { return m().axis(0).set_velocity == 0 && m().axis(1).set_velocity == 0; }, 3s));
    EXPECT_FALSE(m().has_alarm(id(MachineAlarm::axis_of_two_programs))) << m().alarms();
}

TEST_P(TwoPrograms, AnOutputThatTheOtherOneDrivesTooStays) {
    start(&entry_of<Runs<'x', 'x', true>>, &entry_of<Runs<'y', 'y', true>>);
    int dark = 0;
    m().on_cycle = [&] { dark += m().world.output("lamp") ? 0 : 1; };
    ASSERT_EQ(m().command(OperatorAction::program_stop, 0).answer, Answer::accepted);
    m().run(50ms);
    EXPECT_EQ(dark, 0);
}

// p powers x and moves y, q powers y and moves x.
TEST_P(TwoPrograms, WhatItMovedForTheOtherStopsAndKeepsItsPowerWhatItPoweredGoesOff) {
    start(&entry_of<Runs<'x', 'y', false>>, &entry_of<Runs<'y', 'x', false>>);
    ASSERT_EQ(m().command(OperatorAction::program_stop, 0).answer, Answer::accepted);
    EXPECT_TRUE(m().until([&] { return m().axis(0).state == AxisState::Disabled; }, 2s));
    EXPECT_TRUE(m().until([&] { return m().axis(1).state == AxisState::Standstill; }, 2s)) << axes::name(m().axis(1).state);
    m().run(1s);
    EXPECT_FALSE(m().axis(0).powered);
    EXPECT_TRUE(m().axis(1).powered);
    EXPECT_EQ(m().axis(1).set_velocity, 0);
    m().expect_no_jump();
}

}  // namespace
}  // namespace taktwerk::runtime::testing
