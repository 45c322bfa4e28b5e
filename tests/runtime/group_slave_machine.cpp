// An axis that follows the length of a group's path (MC_SyncAxisToGroup), and two programs: with whom its motion ends.

#include "fb_library/all_blocks.hpp"
#include "tests/runtime/test_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using namespace fb;
using axes::AxisState;

/// Powers all three axes; may couple the third.
template <bool couples>
class Keeps final : public Program {
public:
    std::array<AxisRef, 3> axis;
    axes::GroupRef group;
    std::array<MC_Power, 3> power;
    MC_SyncAxisToGroup sync;
    bool in_sync = false;
    void declare(Declaration& d) override {
        axis = {d.axis("x"), d.axis("y"), d.axis("z")};
        group = d.axis_group("plane");
        d.monitor("kept_in_sync", in_sync);
        d.task<&Keeps::scan>("main");
    }
    void scan(TaskContext& ctx) {
        bool all = true;
        for (std::size_t i = 0; i < 3; ++i) {
            power[i].Axis = axis[i];
            power[i].Enable = true;
            power[i](ctx);
            all = all && power[i].Status;
        }
        if (!couples) return;
        sync.AxesGroup = group;
        sync.SlaveAxis = axis[2];
        sync.Execute = all && ctx.groups->view(group)->state != axes::GroupState::GroupDisabled;
        sync(ctx);
        in_sync = sync.InSync;
    }
};

/// Moves the group a long way; may couple the third axis.
template <bool couples>
class Goes final : public Program {
public:
    AxisRef pump;
    axes::GroupRef group;
    MC_GroupEnable enable;
    MC_SyncAxisToGroup sync;
    MC_MoveLinearAbsolute move;
    bool in_sync = false, begins = true;
    void declare(Declaration& d) override {
        pump = d.axis("z");
        group = d.axis_group("plane");
        d.monitor("in_sync", in_sync);
        d.task<&Goes::scan>("main");
    }
    void start() override { begins = true; }
    void scan(TaskContext& ctx) {
        enable.AxesGroup = sync.AxesGroup = move.AxesGroup = group;
        enable.Execute = ctx.groups->view(group)->powered && !begins;  // started again, each has to see its edge again
        begins = false;
        enable(ctx);
        const bool ready = enable.Done && ctx.view(pump)->powered;
        sync.SlaveAxis = pump;
        sync.Execute = couples && ready;
        if (couples) sync(ctx);
        in_sync = sync.InSync;
        move.Position.A.Axes = {3000, 4000};
        move.Velocity = 50;
        move.Execute = ready && (!couples || sync.InSync);
        move(ctx);
    }
};

MachineConfig plane(const ProgramEntry* (*keeps)(), const ProgramEntry* (*goes)()) {
    auto config = with_program(3, keeps);
    auto second = config.programs[0];
    second.name = "q";
    second.entry = goes;
    config.programs.push_back(second);
    auto task = config.tasks[0];
    task.program = "q";
    config.tasks.push_back(task);
    for (auto& binding : config.axes) binding.axis.require_homed = false;
    config.axis_groups.push_back({.name = "plane", .members = {"x", "y"}, .kinematics = {}});
    return config;
}

// docs/motion/tracking.md: "A program that ends takes the motion of an axis that it has coupled with it." Also where another program has the power: the axis is
// at rest, keeps its power, and follows no longer.
TEST(GroupSlaveMachine, AProgramThatEndsTakesTheMotionOfItsSlaveWithIt) {
    TestMachine m(plane(&entry_of<Keeps<false>>, &entry_of<Goes<true>>));
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(2).set_velocity > 45; }, 5s)) << m.alarms();
    EXPECT_EQ(variable(m, "in_sync"), 1);
    ASSERT_EQ(m.command(OperatorAction::program_stop, 1).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 0 && m.axis(2).state == AxisState::Standstill; }, 3s));
    m.run(100ms);
    EXPECT_EQ(m.axis(2).active, 0u);
    EXPECT_TRUE(m.axis(2).powered);
    EXPECT_TRUE(m.axis(0).powered);
    EXPECT_EQ(m.axis(0).state, AxisState::Standstill);
    m.expect_no_jump();

    ASSERT_EQ(m.command(OperatorAction::program_start, 1).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(2).set_velocity > 45; }, 5s)) << "coupled again by the program that has begun again";
}

// Who has coupled it has not ended: it stands with the path, in sync, and goes on with the next one.
TEST(GroupSlaveMachine, TheEndOfWhoeverMovesTheGroupIsNoneOfTheSlave) {
    TestMachine m(plane(&entry_of<Keeps<true>>, &entry_of<Goes<false>>));
    ASSERT_TRUE(m.up());
    ASSERT_TRUE(m.until([&] { return m.axis(2).set_velocity > 45; }, 5s)) << m.alarms();
    ASSERT_EQ(m.command(OperatorAction::program_stop, 1).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(0).set_velocity == 0 && m.axis(2).set_velocity == 0; }, 3s));
    m.run(100ms);
    EXPECT_NE(m.axis(2).active, 0u);
    EXPECT_EQ(variable(m, "kept_in_sync"), 1);
    ASSERT_EQ(m.command(OperatorAction::program_start, 1).answer, Answer::accepted);
    ASSERT_TRUE(m.until([&] { return m.axis(2).set_velocity > 45; }, 5s)) << m.alarms();
    m.expect_no_jump();
}

}  // namespace
}  // namespace taktwerk::runtime::testing
