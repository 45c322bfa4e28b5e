// Programs on a machine: MC_ blocks through real frames, tasks at divisors, and what happens when a program misbehaves.

#include <stdexcept>

#include "fb_library/all_blocks.hpp"
#include "runtime/alarms.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using namespace fb;
using axes::AxisState;

/// Powers x, makes its present position 100 mm, moves to 150 mm.
class PowerAndMove final : public Program {
public:
    AxisRef x;
    MC_Power power;
    MC_Home home;
    MC_MoveAbsolute move;
    bool done = false;
    std::int64_t scans = 0;
    double seen = 0;
    Output<bool> lamp;
    void declare(Declaration& d) override {
        x = d.axis("x");
        lamp = d.output("lamp");
        d.monitor("done", done);
        d.monitor("scans", scans);
        d.monitor("seen", seen, "u");
        d.task<&PowerAndMove::scan>("main");
    }
    void scan(TaskContext& ctx) {
        ++scans;
        power.Axis = home.Axis = move.Axis = x;
        power.Enable = true;
        power(ctx);
        home.Execute = power.Status;
        home.Position = 100;
        home(ctx);
        move.Position = 150;
        move.Velocity = 100;
        move.Execute = home.Done || move.Busy || move.Done;
        move(ctx);
        done = move.Done;
        seen = ctx.view(x)->set_position;
        ctx.set(lamp, move.Busy);
    }
};

MachineConfig homing_in_place(MachineConfig config) {
    config.axes[0].axis.homing.kind = axes::HomingKind::set_here;
    return config;
}

TEST(Program, McPowerAndMcMoveAbsoluteMoveAnAxisThroughRealFrames) {
    TestMachine m{homing_in_place(with_program(1, &entry_of<PowerAndMove>))};
    ASSERT_TRUE(m.up());

    bool lamp = false;
    m.on_cycle = [&] { lamp = lamp || m.world.output("lamp"); };
    EXPECT_TRUE(m.until([&] { return variable(m, "done") != 0; }, 10s)) << m.alarms();

    EXPECT_EQ(m.axis(0).set_position, 150.0);
    EXPECT_TRUE(m.until([&] { return m.axis(0).in_position; }, 1s));
    EXPECT_NEAR(m.axis(0).actual_position, 150.0, 0.05);
    EXPECT_TRUE(lamp) << "the terminal never drove the lamp";
    m.expect_no_jump();
}

TEST(Program, ATaskAtADivisorMovesTheSameAxisAndScansThatMuchLess) {
    TestMachine m{homing_in_place(with_program(1, &entry_of<PowerAndMove>, 8))};
    ASSERT_TRUE(m.up());

    const auto cycle = m.state().cycle;
    EXPECT_TRUE(m.until([&] { return variable(m, "done") != 0; }, 20s)) << m.alarms();
    const double scans = variable(m, "scans");
    EXPECT_NEAR(scans, static_cast<double>(m.state().cycle - cycle) / 8.0, 4.0);
    EXPECT_NEAR(m.axis(0).set_position, 150.0, 1e-9);
    m.expect_no_jump();
}

TEST(Program, StoppingItRampsTheAxisDownAndTakesPowerAway) {
    TestMachine m{homing_in_place(with_program(1, &entry_of<PowerAndMove>))};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity > 90; }, 10s));

    EXPECT_EQ(m.command(OperatorAction::program_stop, 0).answer, Answer::accepted);
    EXPECT_TRUE(m.until([&] { return m.axis(0).state == AxisState::Disabled; }, 3s));
    EXPECT_TRUE(m.until([&] { return m.axis(0).drive_state == axes::PowerState::disabled; }, 1s));
    EXPECT_EQ(m.state().programs[0], ProgramState::stopped);
    EXPECT_FALSE(m.world.output("lamp"));
    m.expect_no_jump();
}

TEST(Program, ManualModeStopsItAndGivesTheAxisToTheOperator) {
    TestMachine m{homing_in_place(with_program(1, &entry_of<PowerAndMove>))};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(0).powered; }, 5s));
    EXPECT_EQ(m.command(OperatorAction::move_absolute, 0, false, 120, 50).answer, Answer::no_control);

    EXPECT_EQ(m.mode(Mode::manual).answer, Answer::accepted);
    EXPECT_TRUE(m.until([&] { return m.axis(0).state == AxisState::Disabled; }, 3s));
    m.enable(0);
    EXPECT_EQ(m.command(OperatorAction::move_absolute, 0, false, 120, 50).answer, Answer::accepted);
    OperatorCommand start;
    start.action = OperatorAction::program_start;
    start.index = 0;
    EXPECT_EQ(m.command(start).answer, Answer::wrong_mode);
    m.expect_no_jump();
}

/// As PowerAndMove, and a stop at half way that holds for a second, each with a name.
class MovesAndHolds final : public Program {
public:
    AxisRef x;
    MC_Power power;
    MC_Home home;
    MC_MoveAbsolute move;
    MC_Stop hold;
    Instant held_since{};
    void declare(Declaration& d) override {
        x = d.axis("x");
        d.block("move", move);
        d.block("hold", hold);
        d.task<&MovesAndHolds::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Axis = home.Axis = move.Axis = hold.Axis = x;
        power.Enable = true;
        power(ctx);
        home.Execute = power.Status;
        home(ctx);
        move.Position = 100;
        move.Velocity = 50;
        move.Execute = home.Done;
        move(ctx);
        if (!hold.Execute && held_since == Instant{} && ctx.view(x)->set_position > 50) {
            hold.Execute = true;
            held_since = ctx.now;
        }
        if (hold.Execute && ctx.now - held_since > 1s) hold.Execute = false;
        hold(ctx);
    }
};

// Who moves an axis, and who blocks it: the block by its name, for the live state and for the refusal of somebody else's command.
TEST(Program, AnAxisKnowsTheBlockThatMovesOrHoldsIt) {
    for (const std::uint16_t divisor : {std::uint16_t{1}, std::uint16_t{8}}) {
        TestMachine m{homing_in_place(with_program(1, &entry_of<MovesAndHolds>, divisor))};
        ASSERT_TRUE(m.up());
        const auto holder = [&] { return m.machine->layout().block_at(m.axis(0).holder); };
        EXPECT_EQ(holder(), "");

        ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity > 40; }, 10s));
        EXPECT_EQ(holder(), "p.move");
        const auto refused = m.command(OperatorAction::move_absolute, 0, false, 10, 50);
        EXPECT_EQ(refused.answer, Answer::no_control);
        EXPECT_EQ(m.machine->layout().block_at(refused.holder), "p.move");

        ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::Stopping; }, 10s));
        EXPECT_EQ(holder(), "p.hold");
        ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 0; }, 10s));
        m.run(100ms);
        ASSERT_EQ(m.axis(0).state, AxisState::Stopping);
        EXPECT_EQ(holder(), "p.hold") << "Done, and its Execute still TRUE";

        ASSERT_TRUE(m.until([&] { return m.axis(0).state == AxisState::Standstill; }, 10s));
        EXPECT_EQ(holder(), "");
    }
}

class Throws final : public Program {
public:
    AxisRef x;
    MC_Power power;
    MC_MoveVelocity move;
    std::int64_t scans = 0;
    void declare(Declaration& d) override {
        x = d.axis("x");
        d.task<&Throws::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Axis = move.Axis = x;
        power.Enable = true;
        power(ctx);
        move.Execute = power.Status;
        move.Velocity = 100;
        move(ctx);
        if (move.InVelocity && ++scans > 100) throw std::runtime_error("a defect");
    }
};

TEST(ProgramFault, AnExceptionStopsTheAxesAlongTheirRampAndIsAnAlarm) {
    TestMachine m{with_program(1, &entry_of<Throws>)};
    ASSERT_TRUE(m.up());

    EXPECT_TRUE(m.until([&] { return m.state().programs[0] == ProgramState::fault; }, 5s));
    m.run(2s);

    EXPECT_TRUE(m.has_alarm(id(MachineAlarm::program_fault)));
    EXPECT_EQ(m.axis(0).set_velocity, 0.0);
    m.expect_no_jump();

    // Reset, once, and start again: as documented it runs, and its axis with it.
    EXPECT_EQ(m.command(OperatorAction::reset).answer, Answer::accepted);
    m.run(20ms);
    EXPECT_EQ(m.state().alarm_count, 0u) << m.alarms();
    OperatorCommand start;
    start.action = OperatorAction::program_start;
    start.index = 0;
    EXPECT_EQ(m.command(start).answer, Answer::accepted);
    EXPECT_TRUE(m.until([&] { return m.state().programs[0] == ProgramState::running; }, 1s));
    EXPECT_TRUE(m.until([&] { return m.axis(0).powered; }, 2s)) << m.alarms();
}

/// Powers and runs one axis, and stops it by an alarm of its own.
template <char axis_name>
class SaysStop final : public Program {
public:
    AxisRef axis;
    Parameter jam;
    MC_Power power;
    MC_MoveVelocity move;
    void declare(Declaration& d) override {
        static constexpr char name = axis_name;
        axis = d.axis(std::string_view(&name, 1));
        jam = d.parameter(std::string{"jam_"} + axis_name, {.value = 0, .minimum = 0, .maximum = 1, .unit = "", .doc = ""});
        d.alarm(0, Reaction::stop_axis, "A part is jammed", "零件卡住", "Take it out");
        d.task<&SaysStop::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Axis = move.Axis = axis;
        power.Enable = true;
        power(ctx);
        move.Velocity = 60;
        move.Execute = power.Status;
        move(ctx);
        ctx.alarm(0, ctx.get(jam) != 0);
    }
};

TEST(ProgramAlarm, ThatStopsAxesStopsThoseOfItsProgramAndNoOthers) {
    auto config = with_program(2, &entry_of<SaysStop<'x'>>);
    add_program(config, "q", &entry_of<SaysStop<'y'>>);
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 60 && m.axis(1).set_velocity == 60; }, 3s));
    const auto jam = [&](double value) {
        OperatorCommand c;
        c.action = OperatorAction::set_parameter;
        c.index = 0;
        c.value = value;
        return m.command(c).answer;
    };

    ASSERT_EQ(jam(1), Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 0; }, 2s)) << m.alarms();

    EXPECT_EQ(m.axis(0).state, AxisState::ErrorStop);
    EXPECT_EQ(m.state().alarm_count, 1u) << "one cause is one alarm: " << m.alarms();
    EXPECT_EQ(m.axis(1).set_velocity, 60) << "the other program's axis";
    EXPECT_EQ(m.state().programs[0], ProgramState::running);
    m.expect_no_jump();

    ASSERT_EQ(jam(0), Answer::accepted);
    m.run(1s);
    EXPECT_EQ(m.axis(0).state, AxisState::ErrorStop) << "it goes on behind a reset";
    EXPECT_EQ(m.command(OperatorAction::reset).answer, Answer::accepted);
    m.run(1s);
    EXPECT_NE(m.axis(0).state, AxisState::ErrorStop) << m.alarms();
}

TEST(ProgramLoad, NamesThatTheMachineLacksAreAllReportedWithASuggestion) {
    class Wrong final : public Program {
        void declare(Declaration& d) override {
            d.axis("xx");
            d.input("buton");
            d.output("nothing_like_it");
            d.parameter("p", {.value = 5, .minimum = 10, .maximum = 20, .unit = "", .doc = ""});
        }
    };
    VirtualClock clock;
    auto config = with_program(1, &entry_of<Wrong>);
    World world{config, clock.now()};
    auto built = Machine::build(config, world.transport());

    ASSERT_EQ(built.index(), 1u);
    const auto& errors = std::get<1>(built);
    std::string all;
    for (const auto& e : errors) all += e.text() + "\n";
    EXPECT_EQ(errors.size(), 5u) << all;  // axis, input, output, parameter, and the configured task "main" it does not declare
    EXPECT_NE(all.find("there is no axis 'xx'"), std::string::npos);
    EXPECT_NE(all.find("did you mean 'button'?"), std::string::npos);
    EXPECT_NE(all.find("nothing_like_it"), std::string::npos);
}

TEST(ProgramLoad, AForeignEntryIsRefused) {
    static const ProgramEntry old{program_magic, sizeof(ProgramEntry), 0xDEAD, "0.0.1", "old", nullptr, nullptr};
    VirtualClock clock;
    auto config = with_program(1, [] { return &old; });
    World world{config, clock.now()};
    auto built = Machine::build(config, world.transport());
    ASSERT_EQ(built.index(), 1u);
    EXPECT_NE(std::get<1>(built)[0].text().find("rebuild"), std::string::npos);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
