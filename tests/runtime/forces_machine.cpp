// Forcing inputs and outputs: what programs read and what the wire carries, who may, and what ends it.

#include "runtime/alarms.hpp"
#include "runtime/recording/inbox_record.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

/// lamp follows button; and tells what it reads.
class Follows final : public Program {
public:
    Input<bool> button;
    Output<bool> lamp;
    bool seen = false, good = false;
    void declare(Declaration& d) override {
        button = d.input("button");
        lamp = d.output("lamp");
        d.monitor("seen", seen);
        d.task<&Follows::scan>("main");
    }
    void scan(TaskContext& ctx) {
        seen = ctx.get(button);
        ctx.set(lamp, seen);
    }
};

constexpr std::uint16_t estop_ok = 0, button = 1;  // as machine_config() declares them
constexpr std::uint16_t lamp = 0;
constexpr bool input = false, output = true;

struct Forces : ::testing::Test {
    TestMachine m{with_program(1, &entry_of<Follows>)};
    void SetUp() override {
        ASSERT_TRUE(m.up());
        m.run(10ms);
    }
    CommandAnswer force(bool an_output, std::uint16_t point, double value) {
        return m.command(OperatorAction::force, point, an_output, value);
    }
    [[nodiscard]] bool alarm() {
        const auto& s = m.state();
        return std::any_of(s.alarms.begin(), s.alarms.begin() + static_cast<std::ptrdiff_t>(s.alarm_count),
                           [](const ActiveAlarm& a) { return a.fact.id == id(MachineAlarm::points_forced) && a.standing; });
    }
};

TEST_F(Forces, AProgramReadsAForcedInputAndTheRealOneAfterwards) {
    EXPECT_FALSE(alarm());
    ASSERT_EQ(force(input, button, 1).answer, Answer::accepted);
    m.run(3ms);
    EXPECT_EQ(variable(m, "seen"), 1);
    EXPECT_EQ(m.state().inputs[button], 1);
    EXPECT_TRUE(m.world.output("lamp")) << "everything behind the image";
    ASSERT_EQ(m.state().force_count, 1u);
    EXPECT_EQ(m.state().forces[0].client, 1u);
    EXPECT_TRUE(alarm());

    ASSERT_EQ(m.command(OperatorAction::unforce, button, input).answer, Answer::accepted);
    m.run(3ms);
    EXPECT_EQ(variable(m, "seen"), 0);
    EXPECT_FALSE(m.world.output("lamp"));
    EXPECT_FALSE(alarm());
}

TEST_F(Forces, TheRealInputGoesOnBehindItsForce) {
    ASSERT_EQ(force(input, button, 0).answer, Answer::accepted);
    m.world.set_input("button", true);
    m.run(5ms);
    EXPECT_EQ(variable(m, "seen"), 0);
    ASSERT_EQ(m.command(OperatorAction::release_forces).answer, Answer::accepted);
    m.run(2ms);
    EXPECT_EQ(variable(m, "seen"), 1);
}

TEST_F(Forces, AForcedOutputIsOverWhatTheProgramWrites) {
    m.world.set_input("button", true);
    m.run(5ms);
    ASSERT_TRUE(m.world.output("lamp"));
    ASSERT_EQ(force(output, lamp, 0).answer, Answer::accepted);
    m.run(3ms);
    EXPECT_FALSE(m.world.output("lamp"));
    EXPECT_EQ(m.state().outputs[lamp], 0) << "people see what the wire carries";
    ASSERT_EQ(m.command(OperatorAction::unforce, lamp, output).answer, Answer::accepted);
    m.run(3ms);
    EXPECT_TRUE(m.world.output("lamp")) << "what the program has written is there again";
}

TEST_F(Forces, ProgramsThatStopAndStartChangeNothing) {
    ASSERT_EQ(force(output, lamp, 1).answer, Answer::accepted);
    ASSERT_EQ(m.command(OperatorAction::program_stop, 0).answer, Answer::accepted);
    m.run(5ms);
    EXPECT_TRUE(m.world.output("lamp"));
    ASSERT_EQ(m.command(OperatorAction::program_start, 0).answer, Answer::accepted);
    m.run(5ms);
    EXPECT_TRUE(m.world.output("lamp"));
    ASSERT_EQ(m.mode(Mode::manual).answer, Answer::accepted);
    m.run(5ms);
    EXPECT_TRUE(m.world.output("lamp"));
}

TEST_F(Forces, WhatTheEmergencyStopReadsCannotBeForced) {
    const auto refused = force(input, estop_ok, 1);
    EXPECT_EQ(refused.answer, Answer::not_possible_now);
    EXPECT_EQ(refused.error, axes::ErrorId::not_supported);
    EXPECT_EQ(m.machine->layout().kept_inputs[estop_ok], "the emergency stop reads it");
    EXPECT_EQ(m.machine->layout().kept_inputs[button], "");
    m.world.set_input("estop_ok", false);
    m.run(5ms);
    EXPECT_TRUE(m.state().emergency_stop);
}

TEST_F(Forces, TheEmergencyStopEndsThoseOfOutputsAndAllowsNoNewOnes) {
    ASSERT_EQ(force(output, lamp, 1).answer, Answer::accepted);
    ASSERT_EQ(force(input, button, 0).answer, Answer::accepted);
    m.run(3ms);
    ASSERT_TRUE(m.world.output("lamp"));
    m.world.set_input("estop_ok", false);
    m.run(5ms);
    EXPECT_FALSE(m.world.output("lamp"));
    ASSERT_EQ(m.state().force_count, 1u) << "what programs read stays forced";
    EXPECT_EQ(m.state().forces[0].direction, IoDirection::input);
    const auto refused = force(output, lamp, 1);
    EXPECT_EQ(refused.answer, Answer::not_possible_now);
    EXPECT_EQ(refused.error, axes::ErrorId::interlocked);
    m.world.set_input("estop_ok", true);
    m.run(5ms);
    EXPECT_FALSE(m.world.output("lamp")) << "a release switches nothing on";
}

TEST_F(Forces, TheEndOfTheRunEndsThem) {
    ASSERT_EQ(force(output, lamp, 1).answer, Answer::accepted);
    m.run(3ms);
    m.machine->request_shutdown();
    m.run(5ms);
    EXPECT_FALSE(m.world.output("lamp"));
    EXPECT_EQ(m.state().force_count, 0u);
}

TEST_F(Forces, AClientThatGoesTakesOnlyItsOwn) {
    OperatorCommand c;
    c.action = OperatorAction::force;
    c.client = 7;
    c.index = lamp;
    c.flag = output;
    c.value = 1;
    ASSERT_TRUE(m.machine->submit(c));
    ASSERT_EQ(force(input, button, 1).answer, Answer::accepted);
    c = {};
    c.action = OperatorAction::release_forces;
    c.client = 7;
    c.flag = true;
    ASSERT_TRUE(m.machine->submit(c));
    m.run(3ms);
    ASSERT_EQ(m.state().force_count, 1u);
    EXPECT_EQ(m.state().forces[0].client, 1u);
}

TEST_F(Forces, ValuesBeyondTheTerminalAndUnknownPointsAreRefused) {
    for (const double bad : {2.0, -1.0, 0.5, std::nan("")}) EXPECT_EQ(force(input, button, bad).answer, Answer::bad_value) << bad;
    EXPECT_EQ(force(output, 1, 1).answer, Answer::unknown_name);
    EXPECT_EQ(force(input, 2, 1).answer, Answer::unknown_name);
    EXPECT_EQ(m.state().force_count, 0u);
}

// What comes in once is in the recording once: a replay gives the same bits.
TEST(ForcesRecorded, EachIsOneCommand) {
    Recorder recorder{1 << 22, Recorder::Policy::drop_newest};
    TestMachine m{machine_config(1)};
    m.machine->record(recorder);
    ASSERT_TRUE(m.up());
    recorder.clear();
    ASSERT_EQ(m.command(OperatorAction::force, lamp, output, 1).answer, Answer::accepted);
    ASSERT_EQ(m.command(OperatorAction::unforce, lamp, output).answer, Answer::accepted);
    std::vector<std::pair<OperatorAction, unsigned>> order;
    recorder.for_each([&](const RecordView& record) {
        if (record.channel == command_channel)
            order.emplace_back(static_cast<OperatorAction>(record.bytes[0]), std::to_integer<unsigned>(record.bytes[3]));
    });
    const std::vector<std::pair<OperatorAction, unsigned>> expected{{OperatorAction::force, 1}, {OperatorAction::unforce, 1}};
    EXPECT_EQ(order, expected);
}

TEST(ForcesMany, NoMoreThanThereIsRoomFor) {
    auto config = machine_config(1);
    for (std::size_t i = 0; i <= max_forces; ++i) {
        auto more = config.io[1];
        more.name = "more_" + std::to_string(i);
        config.io.push_back(more);
    }
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    for (std::uint16_t i = 0; i < max_forces; ++i)
        ASSERT_EQ(m.command(OperatorAction::force, static_cast<std::uint16_t>(2 + i), input, 1).answer, Answer::accepted);
    const auto refused = m.command(OperatorAction::force, static_cast<std::uint16_t>(2 + max_forces), input, 1);
    EXPECT_EQ(refused.answer, Answer::not_possible_now);
    EXPECT_EQ(refused.error, axes::ErrorId::queue_full);
    EXPECT_EQ(m.command(OperatorAction::force, 2, input, 0).answer, Answer::accepted) << "one that is forced already takes another value";
    m.run(2ms);
    EXPECT_EQ(m.state().inputs[2], 0);
    EXPECT_EQ(m.state().force_count, max_forces);
}

// Its filter, its limits and its alarm see the terminal, not the force.
TEST(ForcesSupervised, TheAlarmOfAnInputIsAboutTheRealOne) {
    auto config = machine_config(1);
    config.io[1].limits = PointLimits{0, 0.5};
    TestMachine m{config};
    ASSERT_TRUE(m.up());
    ASSERT_EQ(m.command(OperatorAction::force, button, input, 0).answer, Answer::accepted);
    m.world.set_input("button", true);
    m.run(5ms);
    EXPECT_EQ(m.state().inputs[button], 0);
    EXPECT_TRUE(m.has_alarm(id(MachineAlarm::input_out_of_limits)));
    ASSERT_EQ(m.command(OperatorAction::release_forces).answer, Answer::accepted);
    m.world.set_input("button", false);
    m.run(5ms);
    ASSERT_EQ(m.command(OperatorAction::force, button, input, 1).answer, Answer::accepted);
    m.run(5ms);
    EXPECT_FALSE(m.has_alarm(id(MachineAlarm::input_out_of_limits))) << "a force beyond them is nobody's fault";
}

}  // namespace
}  // namespace taktwerk::runtime::testing
