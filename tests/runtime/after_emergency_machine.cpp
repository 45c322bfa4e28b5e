// After an emergency stop nothing moves and nothing has power but by a live command that a person gives after its release.

#include "fb_library/all_blocks.hpp"
#include "runtime/alarms.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using namespace fb;
using axes::AxisState;
using axes::ErrorId;

/// Wants to be on and on the way whatever happens: standing MC_Power, MC_Reset as soon as there is something to reset, the next move at
/// once. `raises_anew`: Enable follows the safety circuit, so it falls and rises with the button.
template <bool raises_anew>
class Eager final : public Program {
public:
    AxisRef x;
    Input<bool> estop_ok;
    Output<bool> lamp;
    MC_Power power;
    MC_Reset reset;
    MC_MoveVelocity move;
    bool refused = false;
    void declare(Declaration& d) override {
        x = d.axis("x");
        estop_ok = d.input("estop_ok");
        lamp = d.output("lamp");
        d.monitor("refused", refused);
        d.task<&Eager::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Axis = reset.Axis = move.Axis = x;
        power.Enable = !raises_anew || ctx.get(estop_ok);
        power(ctx);
        reset.Execute = ctx.view(x)->state == AxisState::ErrorStop && !reset.Execute;
        reset(ctx);
        move.Execute = power.Status && ctx.view(x)->state == AxisState::Standstill;
        move.Velocity = 100;
        move(ctx);
        ctx.set(lamp, true);
        refused = power.Error && power.ErrorID == ErrorId::interlocked;
    }
};

/// The same, and leaves resets to people.
class Runner final : public Program {
public:
    AxisRef x;
    MC_Power power;
    MC_MoveVelocity move;
    void declare(Declaration& d) override {
        x = d.axis("x");
        d.task<&Runner::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Axis = move.Axis = x;
        power.Enable = true;
        power(ctx);
        move.Execute = power.Status && ctx.view(x)->state == AxisState::Standstill;
        move.Velocity = 100;
        move(ctx);
    }
};

struct AfterEmergency : ::testing::TestWithParam<std::uint16_t> {
    std::unique_ptr<TestMachine> machine;
    TestMachine& m() { return *machine; }
    void start(const ProgramEntry* (*entry)()) {
        auto config = with_program(2, entry, GetParam());
        config.emergency_stop.restart = "button";
        start(std::move(config));
    }
    void start(MachineConfig config) {
        machine = std::make_unique<TestMachine>(std::move(config));
        ASSERT_TRUE(m().up());
    }
    bool runs() {
        return m().until([&] { return m().axis(0).set_velocity > 90; }, 3s);
    }
    void press_and_release() {
        m().world.set_input("estop_ok", false);
        ASSERT_TRUE(m().until([&] { return m().axis(0).drive_state != axes::PowerState::enabled; }, 2s));
        m().run(500ms);
        m().world.set_input("estop_ok", true);
        m().run(100ms);
    }
    void press_button(Duration each) {
        m().world.set_input("button", true);
        m().run(each);
        m().world.set_input("button", false);
        m().run(each);
    }
    /// For as long as anybody would wait.
    void expect_off(const char* when) {
        for (int i = 0; i < 50; ++i) {
            m().run(100ms);
            ASSERT_NE(m().axis(0).drive_state, axes::PowerState::enabled) << when;
            ASSERT_FALSE(m().axis(0).powered) << when;
            ASSERT_EQ(m().axis(0).set_velocity, 0) << when;
        }
    }
};
INSTANTIATE_TEST_SUITE_P(BaseAndSlowerTask, AfterEmergency, ::testing::Values(1, 8));

TEST_P(AfterEmergency, ReleaseAndResetPowerNothingAlsoNotAStandingMcPower) {
    start(&entry_of<Eager<false>>);
    ASSERT_TRUE(runs());
    press_and_release();
    expect_off("released");
    EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
    expect_off("released and reset");
    EXPECT_EQ(m().axis(0).state, AxisState::Disabled);
    EXPECT_EQ(m().state().programs[0], ProgramState::running) << "it goes on, without power";
    EXPECT_EQ(variable(m(), "refused"), 1.0) << "and its block says why";
    EXPECT_TRUE(m().has_alarm(id(MachineAlarm::program_waits))) << m().alarms();

    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::accepted);
    EXPECT_TRUE(runs()) << m().alarms();
    EXPECT_FALSE(m().has_alarm(id(MachineAlarm::program_waits)));
    m().expect_no_jump();
}

TEST_P(AfterEmergency, AnEnableThatRisesWithTheReleasePowersNothingEither) {
    start(&entry_of<Eager<true>>);
    ASSERT_TRUE(runs());
    press_and_release();
    EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
    expect_off("released and reset");
    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::accepted);
    EXPECT_TRUE(runs());
}

TEST_P(AfterEmergency, TheButtonOfTheConfigurationCountsOnlyWhenItIsPressedAfterTheRelease) {
    start(&entry_of<Eager<false>>);
    ASSERT_TRUE(runs());
    m().world.set_input("estop_ok", false);
    m().run(1s);
    m().world.set_input("button", true);  // while the circuit is open, and jammed
    m().run(100ms);
    m().world.set_input("estop_ok", true);
    expect_off("the button was pressed before the release");
    m().world.set_input("button", false);
    expect_off("let go");
    m().world.set_input("button", true);
    EXPECT_TRUE(runs());
}

TEST_P(AfterEmergency, AStartGivenWhileItHoldsIsRefusedAndCountsForNothing) {
    start(&entry_of<Eager<false>>);
    ASSERT_TRUE(runs());
    m().world.set_input("estop_ok", false);
    m().run(1s);
    const auto refused = m().command(OperatorAction::program_start, 0);
    EXPECT_EQ(refused.answer, Answer::not_possible_now);
    EXPECT_EQ(refused.error, ErrorId::interlocked);
    m().world.set_input("estop_ok", true);
    m().run(10ms);
    EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
    expect_off("released and reset");
}

// The machine is switched on with the button pressed: its program starts by itself, its axes do not.
TEST_P(AfterEmergency, AProgramThatStartsWhileItHoldsWaitsToo) {
    auto config = with_program(1, &entry_of<Eager<false>>, GetParam());
    for (auto& point : config.io)
        if (point.name == "estop_ok") point.simulated = 0;
    start(std::move(config));
    m().run(500ms);
    ASSERT_TRUE(m().state().emergency_stop);
    ASSERT_EQ(m().state().programs[0], ProgramState::running);
    m().world.set_input("estop_ok", true);
    expect_off("released");
    EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::accepted);
    EXPECT_TRUE(runs());
}

// Whoever resets later has not started anything: a start counts only when nothing is left to be reset.
TEST_P(AfterEmergency, AStartBetweenReleaseAndResetIsRefusedAndTheResetStartsNothing) {
    start(&entry_of<Runner>);
    ASSERT_TRUE(runs());
    press_and_release();
    ASSERT_EQ(m().axis(0).state, AxisState::ErrorStop);
    const auto refused = m().command(OperatorAction::program_start, 0);
    EXPECT_EQ(refused.answer, Answer::not_possible_now);
    EXPECT_EQ(refused.error, ErrorId::in_error_stop);
    EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
    expect_off("started too early, then reset");

    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::accepted);
    EXPECT_TRUE(runs());
}

TEST_P(AfterEmergency, AProgramThatWasStoppedMeanwhileIsNotStartedBeforeTheResetEither) {
    start(&entry_of<Runner>);
    ASSERT_TRUE(runs());
    press_and_release();
    ASSERT_EQ(m().command(OperatorAction::program_stop, 0).answer, Answer::accepted);
    m().run(100ms);
    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::not_possible_now);
    EXPECT_EQ(m().command(OperatorAction::reset).answer, Answer::accepted);
    expect_off("started too early, then reset");
    EXPECT_EQ(m().state().programs[0], ProgramState::stopped);
    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::accepted);
    EXPECT_TRUE(runs());
}

// Each half is not enough: the axes alone, or the alarm alone.
TEST_P(AfterEmergency, TheAlarmMustBeAcknowledgedAndTheAxesReset) {
    start(&entry_of<Runner>);
    ASSERT_TRUE(runs());
    press_and_release();
    EXPECT_EQ(m().command(OperatorAction::acknowledge_alarms).answer, Answer::accepted);
    m().run(10ms);
    ASSERT_FALSE(m().has_alarm(id(MachineAlarm::emergency_stop)));
    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::not_possible_now) << "x is in ErrorStop";
    press_and_release();
    EXPECT_EQ(m().command(OperatorAction::reset, 0).answer, Answer::accepted);
    ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::Disabled; }, 1s));
    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::not_possible_now) << "the alarm waits";
    EXPECT_EQ(m().command(OperatorAction::acknowledge_alarms).answer, Answer::accepted);
    EXPECT_EQ(m().command(OperatorAction::program_start, 0).answer, Answer::accepted);
    EXPECT_TRUE(runs());
}

// One button for both: what is left to be reset takes the first press, and the start wants another.
TEST_P(AfterEmergency, TheFirstPressOfTheButtonResetsTheSecondStarts) {
    start(&entry_of<Runner>);
    ASSERT_TRUE(runs());
    press_and_release();
    press_button(100ms);
    expect_off("one press");
    EXPECT_EQ(m().axis(0).state, AxisState::Disabled);
    EXPECT_FALSE(m().has_alarm(id(MachineAlarm::emergency_stop)));
    EXPECT_TRUE(m().has_alarm(id(MachineAlarm::program_waits)));
    press_button(100ms);
    EXPECT_TRUE(runs());
}

TEST_P(AfterEmergency, AButtonWhoseContactBouncesIsPressedOnce) {
    start(&entry_of<Runner>);
    ASSERT_TRUE(runs());
    press_and_release();
    for (int i = 0; i < 10; ++i) press_button(5ms);
    expect_off("one press that bounced");
    press_button(100ms);
    EXPECT_TRUE(runs());
}

TEST_P(AfterEmergency, AButtonThatBouncesWhenItIsLetGoIsPressedOnceHoweverLongItWasHeld) {
    start(&entry_of<Runner>);
    ASSERT_TRUE(runs());
    press_and_release();
    m().world.set_input("button", true);
    m().run(700ms);
    m().world.set_input("button", false);
    m().run(4ms);
    for (int i = 0; i < 10; ++i) press_button(4ms);
    expect_off("one long press that bounced when it was let go");
    press_button(100ms);
    EXPECT_TRUE(runs());
}

// Somebody has reset already, by command or by the program: then the press is the start.
TEST_P(AfterEmergency, WhereTheAxesAreResetOnePressStartsAndAcknowledges) {
    start(&entry_of<Runner>);
    ASSERT_TRUE(runs());
    press_and_release();
    EXPECT_EQ(m().command(OperatorAction::reset, 0).answer, Answer::accepted);
    ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::Disabled; }, 1s));
    press_button(100ms);
    EXPECT_TRUE(runs());
    EXPECT_FALSE(m().has_alarm(id(MachineAlarm::emergency_stop)));
}

// Another fault that waits for its reset is none of the button's business.
TEST_P(AfterEmergency, TheButtonResetsNothingElse) {
    start(&entry_of<Runner>);
    ASSERT_TRUE(runs());
    m().world.drive("x")->raise(0x3130);
    ASSERT_TRUE(m().until([&] { return m().axis(0).state == AxisState::ErrorStop; }, 1s));
    m().run(500ms);
    const auto before = m().alarms();
    press_button(200ms);
    expect_off("pressed beside a drive's fault");
    EXPECT_EQ(m().axis(0).state, AxisState::ErrorStop);
    EXPECT_EQ(m().alarms(), before);
}

struct HandAndEmergency : ::testing::Test {
    TestMachine m{machine_config(2)};
    void SetUp() override { ASSERT_TRUE(m.up()); }
    Answer set_lamp(std::uint32_t client = 1) {
        OperatorCommand c;
        c.action = OperatorAction::set_output;
        c.index = 0;
        c.value = 1;
        c.client = client;
        EXPECT_TRUE(m.machine->submit(c));
        m.run(3ms);
        Answer answer = Answer::duplicate;
        while (const auto next = m.machine->next_answer()) answer = next->answer;
        return answer;
    }
    void gone(std::uint32_t client) {
        OperatorCommand c;
        c.action = OperatorAction::release_outputs;
        c.client = client;
        EXPECT_TRUE(m.machine->submit(c));
        m.run(3ms);
    }
};

TEST_F(HandAndEmergency, WhatSwitchesSomethingOnIsRefusedWhileItHolds) {
    m.world.set_input("estop_ok", false);
    m.run(100ms);
    EXPECT_EQ(set_lamp(), Answer::not_possible_now);
    EXPECT_EQ(m.mode(Mode::automatic).answer, Answer::not_possible_now);
    EXPECT_EQ(m.state().mode, Mode::manual);
    EXPECT_EQ(m.mode(Mode::setup).answer, Answer::accepted) << "that takes something away";
    m.world.set_input("estop_ok", true);
    m.run(10ms);
    EXPECT_EQ(set_lamp(), Answer::accepted);
    EXPECT_EQ(m.mode(Mode::automatic).answer, Answer::accepted);
}

TEST_F(HandAndEmergency, AnOutputSetByHandEndsWithTheEmergencyStopForGood) {
    ASSERT_EQ(set_lamp(), Answer::accepted);
    EXPECT_TRUE(m.world.output("lamp"));
    m.world.set_input("estop_ok", false);
    m.run(5ms);
    EXPECT_FALSE(m.world.output("lamp"));
    m.world.set_input("estop_ok", true);
    m.command(OperatorAction::reset);
    m.run(500ms);
    EXPECT_FALSE(m.world.output("lamp"));
}

TEST_F(HandAndEmergency, AnOutputSetByHandEndsWithTheMode) {
    ASSERT_EQ(set_lamp(), Answer::accepted);
    EXPECT_EQ(m.mode(Mode::automatic).answer, Answer::accepted);
    m.run(3ms);
    EXPECT_FALSE(m.world.output("lamp"));
}

TEST_F(HandAndEmergency, AnOutputSetByHandEndsWithTheClientWhoSetItLast) {
    ASSERT_EQ(set_lamp(7), Answer::accepted);
    gone(8);
    EXPECT_TRUE(m.world.output("lamp")) << "somebody else has gone";
    ASSERT_EQ(set_lamp(9), Answer::accepted);
    gone(7);
    EXPECT_TRUE(m.world.output("lamp")) << "it is in other hands now";
    gone(9);
    EXPECT_FALSE(m.world.output("lamp"));
}

}  // namespace
}  // namespace taktwerk::runtime::testing
