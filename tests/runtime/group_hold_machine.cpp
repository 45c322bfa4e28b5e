// What a person holds of a group of axes, against what the machine around it does: the end of a program, another mode, two programs, and who is told what.

#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;
using namespace testing;
using axes::AxisState;
using axes::GroupState;

/// Powers and enables the group, draws a long line forth and back while `goes`, interrupts and continues by switches.
class GoesForthAndBack : public Program {
public:
    axes::GroupRef group;
    fb::MC_GroupPower power;
    fb::MC_GroupEnable enable;
    fb::MC_MoveLinearAbsolute line;
    fb::MC_GroupInterrupt interrupt;
    fb::MC_GroupContinue go_on;
    fb::MC_SetPosition renumber;
    AxisRef x_axis;
    bool goes = false, interrupts = false, continues = false, renumbers = false;
    std::int64_t lines = 0, failed = 0;
    void declare(Declaration& d) override {
        group = d.axis_group("table");
        x_axis = d.axis("x");
        d.block("line", line);
        d.monitor("failed", failed);
        d.operator_switch("goes", goes);
        d.operator_switch("interrupts", interrupts);
        d.operator_switch("continues", continues);
        d.operator_switch("renumbers", renumbers);
        d.task<&GoesForthAndBack::scan>("main");
    }
    void start() override { line.Execute = enable.Execute = false; }
    void scan(TaskContext& ctx) {
        for (auto* any : {&power.AxesGroup, &enable.AxesGroup, &line.AxesGroup, &interrupt.AxesGroup, &go_on.AxesGroup}) *any = group;
        power.Enable = true;
        power(ctx);
        enable.Execute = power.Status;
        enable(ctx);
        interrupt.Execute = interrupts;
        interrupt(ctx);
        go_on.Execute = continues;
        go_on(ctx);
        renumber.Axis = x_axis;
        renumber.Execute = renumbers;
        renumber.Position = 5;
        renumber.Relative = true;
        renumber(ctx);
        const auto* view = ctx.groups->view(group);
        if (!line.Execute && goes && power.Status && view->state != GroupState::GroupDisabled) {
            const bool back = lines++ % 2 != 0;
            line.Position.A.Axes = {back ? 0.0 : 300.0, back ? 0.0 : 400.0};
            line.Velocity = 200;
            line.Execute = true;
        }
        line(ctx);
        failed += line.Error || interrupt.Error || go_on.Error ? 1 : 0;
        if (line.Done || line.CommandAborted || line.Error) {
            line.Execute = false;
            line(ctx);
        }
    }
};

/// Moves x alone, told so.
class MovesOneAlone : public Program {
public:
    AxisRef x_axis;
    fb::MC_MoveRelative alone;
    bool go = false;
    void declare(Declaration& d) override {
        x_axis = d.axis("x");
        d.operator_switch("alone", go);
        d.task<&MovesOneAlone::scan>("main");
    }
    void scan(TaskContext& ctx) {
        alone.Axis = x_axis;
        alone.Distance = 10;
        alone.Velocity = 100;
        alone.Execute = go;
        alone(ctx);
    }
};

MachineConfig table_of_two() {
    auto config = with_program(2, entry_of<GoesForthAndBack>);
    add_program(config, "q", entry_of<MovesOneAlone>);
    axes::AxisGroupConfig group{.name = "table", .members = {}, .kinematics = {}};
    for (auto& binding : config.axes) {
        binding.axis.require_homed = false;
        group.members.push_back(binding.axis.name);
    }
    config.axis_groups.push_back(group);
    return config;
}

class HeldTable : public TestMachine {
public:
    HeldTable() : TestMachine(table_of_two()) {
        if (!up()) return;
        EXPECT_TRUE(until([&] { return seen().state == GroupState::GroupStandby && seen().powered; }, 5s)) << alarms();
    }
    const SeenGroup& seen() { return state().groups[0]; }
    void put(std::string_view name, bool on) {
        const auto& names = machine->layout().variables;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i].name == name) {
                EXPECT_EQ(command(OperatorAction::set_value, static_cast<std::uint16_t>(i), false, on ? 1 : 0).answer, Answer::accepted);
            }
    }
    Answer interrupt() { return command(OperatorAction::group_interrupt, 0).answer; }
    Answer go_on() { return command(OperatorAction::group_continue, 0).answer; }
    bool moves(Duration patience = 2s) {
        return until([&] { return std::abs(axis(1).set_velocity) > 20; }, patience);
    }
    bool stands() {
        return until([&] { return axis(0).state == AxisState::Standstill && axis(1).state == AxisState::Standstill; }, 2s);
    }
};

// A program that has moved one member alone ends. The group is another program's, and what a person holds of it he holds on.
TEST(GroupHoldMachine, TheEndOfAnotherProgramDoesNotLetGo) {
    HeldTable m;
    m.put("alone", true);
    m.run(1s);
    ASSERT_TRUE(m.stands());
    ASSERT_EQ(m.interrupt(), Answer::accepted);
    ASSERT_EQ(m.command(OperatorAction::program_stop, 1).answer, Answer::accepted);
    m.run(100ms);
    EXPECT_TRUE(m.seen().held);
    m.put("goes", true);
    EXPECT_FALSE(m.moves());
    EXPECT_EQ(m.go_on(), Answer::accepted);
    EXPECT_TRUE(m.moves());
    m.expect_no_jump();
}

// Nor does it end what the other program has interrupted itself.
TEST(GroupHoldMachine, TheEndOfAnotherProgramEndsNoInterruption) {
    HeldTable m;
    m.put("goes", true);
    ASSERT_TRUE(m.moves());
    m.put("interrupts", true);
    ASSERT_TRUE(m.stands());
    m.put("alone", true);
    m.run(500ms);
    ASSERT_TRUE(m.stands());
    ASSERT_EQ(m.command(OperatorAction::program_stop, 1).answer, Answer::accepted);
    m.run(100ms);
    EXPECT_TRUE(m.seen().interrupted);
    EXPECT_NE(m.seen().active, 0u);
}

// The program that moves the group ends, and begins anew: what it commands then waits for the person, too.
TEST(GroupHoldMachine, TheEndOfItsProgramDoesNotLetGo) {
    for (const auto later : {0ms, 20ms, 1000ms}) {
        HeldTable m;
        m.put("goes", true);
        ASSERT_TRUE(m.moves());
        ASSERT_EQ(m.interrupt(), Answer::accepted);
        m.run(later);
        ASSERT_EQ(m.command(OperatorAction::program_stop, 0).answer, Answer::accepted);
        ASSERT_TRUE(m.until([&] { return !m.axis(0).powered && m.axis(1).set_velocity == 0; }, 3s));
        EXPECT_TRUE(m.seen().held) << later.count();
        ASSERT_EQ(m.command(OperatorAction::program_start, 0).answer, Answer::accepted);
        EXPECT_FALSE(m.moves()) << later.count();
        EXPECT_TRUE(m.seen().held);
        EXPECT_EQ(m.go_on(), Answer::accepted);
        EXPECT_TRUE(m.moves()) << later.count();
        m.expect_no_jump();
    }
}

// Somebody else turns the selector through manual or set-up mode and starts the program again.
TEST(GroupHoldMachine, AnotherModeDoesNotLetGo) {
    for (const auto between : {Mode::manual, Mode::setup}) {
        HeldTable m;
        m.put("goes", true);
        ASSERT_TRUE(m.moves());
        ASSERT_EQ(m.interrupt(), Answer::accepted);
        ASSERT_TRUE(m.stands());
        ASSERT_EQ(m.mode(between).answer, Answer::accepted);
        m.run(500ms);
        EXPECT_TRUE(m.seen().held);
        ASSERT_EQ(m.mode(Mode::automatic).answer, Answer::accepted);
        ASSERT_EQ(m.command(OperatorAction::program_start, 0).answer, Answer::accepted);
        EXPECT_FALSE(m.moves());
        EXPECT_TRUE(m.seen().held);
        EXPECT_EQ(m.go_on(), Answer::accepted);
        EXPECT_TRUE(m.moves());
        m.expect_no_jump();
    }
}

// G-066: the program interrupts by itself while a person holds the group. Both do then: who continues gives it back, is told so, and moves nothing.
TEST(GroupHoldMachine, WhatItsProgramInterruptsMeanwhileStaysInterrupted) {
    for (const auto later : {5ms, 1000ms}) {
        HeldTable m;
        m.put("goes", true);
        ASSERT_TRUE(m.moves());
        ASSERT_EQ(m.interrupt(), Answer::accepted);
        m.run(later);
        m.put("interrupts", true);
        ASSERT_TRUE(m.stands());
        const auto given_back = m.command(OperatorAction::group_continue, 0);
        EXPECT_EQ(given_back.answer, Answer::accepted);
        EXPECT_TRUE(given_back.waits_for_program);
        EXPECT_FALSE(m.moves());
        EXPECT_FALSE(m.seen().held);
        m.put("continues", true);
        EXPECT_TRUE(m.moves());
        EXPECT_EQ(variable(m, "failed"), 0);
        m.expect_no_jump();
    }
}

// Nothing of that is the program's, and nobody is told that something waits for it.
TEST(GroupHoldMachine, WhoContinuesHisOwnMovesIt) {
    HeldTable m;
    m.put("goes", true);
    ASSERT_TRUE(m.moves());
    ASSERT_EQ(m.interrupt(), Answer::accepted);
    ASSERT_TRUE(m.stands());
    const auto given_back = m.command(OperatorAction::group_continue, 0);
    EXPECT_EQ(given_back.answer, Answer::accepted);
    EXPECT_FALSE(given_back.waits_for_program);
    EXPECT_TRUE(m.moves());
}

// What he is refused he is told. It is no refusal of the program's, and he holds it on.
TEST(GroupHoldMachine, ARefusedContinueIsHis) {
    HeldTable m;
    m.put("goes", true);
    ASSERT_TRUE(m.moves());
    ASSERT_EQ(m.interrupt(), Answer::accepted);
    ASSERT_TRUE(m.stands());
    const auto refusals = m.seen().refusal.number;
    EXPECT_EQ(m.interrupt(), Answer::refused_by_axis) << "twice";
    m.put("renumbers", true);
    m.run(10ms);
    const auto refused = m.command(OperatorAction::group_continue, 0);
    EXPECT_EQ(refused.answer, Answer::refused_by_axis);
    EXPECT_EQ(refused.error, axes::ErrorId::not_at_interruption);
    EXPECT_EQ(m.seen().refusal.number, refusals);
    EXPECT_EQ(m.state().event_count, 0u);
    EXPECT_TRUE(m.seen().held);
}

void expect_ended_by_person(TestMachine& m) {
    ASSERT_EQ(m.state().event_count, 1u);
    const auto& event = m.state().events[0];
    EXPECT_EQ(event.what, CommandEvent::What::aborted);
    EXPECT_EQ(event.given.group_kind, axes::GroupCommandKind::linear_absolute);
    EXPECT_EQ(event.by.owner, axes::Owner::operator_panel);
    EXPECT_EQ(event.by.group_kind, axes::GroupCommandKind::halt);
}

// Whoever stops it, whether it moves or stands: he is named.
TEST(GroupHoldMachine, WhoStopsWhatHeHoldsIsNamed) {
    HeldTable m;
    m.put("goes", true);
    ASSERT_TRUE(m.moves());
    ASSERT_EQ(m.interrupt(), Answer::accepted);
    ASSERT_TRUE(m.stands());
    m.put("goes", false);
    (void)m.machine->request_stop(1);
    m.run(20ms);
    expect_ended_by_person(m);
}
TEST(GroupHoldMachine, WhoStopsWhatStandsAtAnOverrideOfZeroIsNamed) {
    HeldTable m;
    m.put("goes", true);
    ASSERT_TRUE(m.moves());
    ASSERT_EQ(m.command(OperatorAction::group_override, 0, false, 0).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(1).set_velocity == 0; }, 2s));
    m.run(100ms);
    m.put("goes", false);
    (void)m.machine->request_stop(1);
    m.run(20ms);
    expect_ended_by_person(m);
}
// What waits behind what he has interrupted at rest, with nothing under way.
TEST(GroupHoldMachine, WhoStopsWhatWaitsForHimIsNamed) {
    HeldTable m;
    ASSERT_EQ(m.interrupt(), Answer::accepted);
    m.put("goes", true);
    m.run(50ms);
    m.put("goes", false);
    (void)m.machine->request_stop(1);
    m.run(20ms);
    expect_ended_by_person(m);
}

}  // namespace
}  // namespace taktwerk::runtime
