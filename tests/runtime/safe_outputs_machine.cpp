// What a terminal is told while nobody drives it: the safe value of each point, from the frame with which it enters OP to the last.
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

/// Drives both outputs away from their safe values.
class Drives final : public Program {
public:
    Output<bool> lamp, brake;
    void declare(Declaration& d) override {
        lamp = d.output("lamp");
        brake = d.output("brake");
        d.task<&Drives::scan>("main");
    }
    void scan(TaskContext& ctx) {
        ctx.set(lamp, false);
        ctx.set(brake, true);
    }
};

/// lamp: safe TRUE, so the terminal's bit is 1. brake: inverted, safe FALSE, so its bit is 1, too.
MachineConfig with_safe_values(MachineConfig config) {
    for (auto& point : config.io)
        if (point.name == "lamp") point.safe_value = 1;
    IoPoint brake;
    brake.name = "brake";
    brake.direction = IoDirection::output;
    brake.slave = "io";
    brake.index = 0x7000;
    brake.sub = 2;
    brake.inverted = true;
    config.io.push_back(brake);
    return config;
}

constexpr std::size_t terminal = 1;  // on the cable, behind the drive

bool in_op(TestMachine& m) { return m.world.network().slave(terminal).state() == ecat::sim::EsmState::op; }
bool safe(TestMachine& m) { return m.world.output("lamp") && m.world.output("brake"); }

TEST(SafeOutputs, ATerminalThatEntersOpDrivesThemWithItsFirstFrame) {
    TestMachine m{with_safe_values(machine_config(1))};
    int cycles_in_op = 0, not_safe = 0;
    m.runner->after_cycle = [&](Instant) {
        if (!in_op(m)) return;
        ++cycles_in_op;
        // In OP its outputs are those of the last frame; the cycle of the transition itself has none yet.
        if (cycles_in_op > 1 && !safe(m)) ++not_safe;
    };
    ASSERT_TRUE(m.up());
    m.run(20ms);
    EXPECT_GT(cycles_in_op, 10);
    EXPECT_EQ(not_safe, 0);
}

TEST(SafeOutputs, TheyReturnWhenTheProgramStops) {
    TestMachine m{with_safe_values(with_program(1, &entry_of<Drives>))};
    ASSERT_TRUE(m.up());
    m.run(20ms);
    ASSERT_FALSE(m.world.output("lamp"));
    ASSERT_FALSE(m.world.output("brake"));
    ASSERT_EQ(m.command(OperatorAction::program_stop, 0).answer, Answer::accepted);
    m.run(5ms);
    EXPECT_TRUE(safe(m));
}

TEST(SafeOutputs, TheyReturnAtTheEndOfTheMachineAndStayUntilTheTerminalLeavesOp) {
    TestMachine m{with_safe_values(with_program(1, &entry_of<Drives>))};
    ASSERT_TRUE(m.up());
    m.run(20ms);
    m.machine->request_shutdown();
    int cycles = 0, not_safe = 0;
    m.runner->after_cycle = [&](Instant) {
        if (!in_op(m)) return;
        ++cycles;
        if (cycles > 3 && !safe(m)) ++not_safe;  // one cycle to stop the program, one to send, one to arrive
    };
    m.runner->shut_down();
    EXPECT_GT(cycles, 3);
    EXPECT_EQ(not_safe, 0);
}

TEST(SafeOutputs, ATerminalThatComesBackAfterAPowerCutGetsThemAgain) {
    TestMachine m{with_safe_values(machine_config(1))};
    ASSERT_TRUE(m.up());
    m.run(20ms);
    m.world.set_slave_power("io", false);
    m.run(100ms);
    EXPECT_FALSE(m.world.output("lamp")) << "without power nothing is driven";
    m.world.set_slave_power("io", true);
    ASSERT_TRUE(m.until([&] { return in_op(m); }, 10s));
    m.run(2ms);
    EXPECT_TRUE(safe(m));
}

}  // namespace
}  // namespace taktwerk::runtime::testing
