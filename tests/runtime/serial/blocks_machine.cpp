// Every motion block on an axis over the line of an XP200: what works works, and what cannot says NotSupported; docs/drives/xp200.md says why.

#include <cstring>
#include <map>

#include "fb_library/all_blocks.hpp"
#include "tests/runtime/serial/line_machine.hpp"
#include "tests/runtime/test_program.hpp"

namespace taktwerk::runtime::testing {
namespace {

using namespace fb;
using axes::ErrorId;

/// What a block may be wired to.
struct Around {
    axes::AxisRef x, u;
    CamSwitchRef switches;
};

/// Inputs with which the block would work on a drive that can: u as its axis, x as a master, small numbers.
template <class B>
B ready_to_work(const Around& around) {
    const auto& [x, u, switches] = around;
    B block;
    if constexpr (requires { block.Master; }) block.Master = x;
    if constexpr (requires { block.Master1; }) block.Master1 = block.Master2 = x;
    if constexpr (requires { block.Slave; }) block.Slave = u;
    if constexpr (requires { block.Axis; }) block.Axis = u;
    if constexpr (requires { block.Velocity; }) block.Velocity = 10;
    if constexpr (requires { block.Distance; }) block.Distance = 1;
    if constexpr (requires {
                      block.Position;
                      requires std::is_same_v<decltype(block.Position), double>;
                      block.Execute;
                  })
        block.Position = 1;
    if constexpr (requires {
                      block.Torque;
                      block.Execute;
                  })
        block.Torque = 0.1;
    if constexpr (requires { block.RatioNumerator; }) block.RatioNumerator = block.RatioDenominator = 1;
    if constexpr (requires { block.ParameterNumber; }) block.ParameterNumber = axes::enable_limit_positive;  // a BOOL
    if constexpr (requires { block.Input.axis; }) block.Input.axis = u;
    if constexpr (requires { block.Output.axis; }) block.Output.axis = u;
    if constexpr (requires { block.TriggerInput.source; }) block.TriggerInput.source = axes::TriggerSource::home_switch;
    if constexpr (requires { block.Switches; }) block.Switches = switches;
    if constexpr (requires { block.DetectionVelocityLimit; }) {
        block.DetectionVelocityLimit = 1;
        block.DetectionVelocityTime = 100ms;
        block.TorqueLimit = 0.5;
    }
    if constexpr (std::is_same_v<B, MC_SetControllerMode>) block.Mode = static_cast<decltype(block.Mode)>(axes::DriveMode::cyclic_velocity);
    return block;
}

/// Powers and homes u, then calls one block until the time is over, and keeps its first error.
class OneBlock final : public Program {
public:
    struct Task {
        std::string_view name;
        void (*prepare)(void* bytes, const Around& around) = nullptr;
        BlockType type;
    };
    inline static const Task* task = nullptr;  // the one under test

    Around around;
    MC_Power power;
    MC_Home home;
    alignas(16) std::byte block[2048];
    std::int64_t begun = 0;
    double error = 0, calls = 0;

    void declare(Declaration& d) override {
        const axes::CamSwitch cam{.track = 1, .first = 0, .last = 1};
        around = {d.axis("x"), d.axis("u"), d.cam_switches("cams", {&cam, 1})};
        d.monitor("error", error);
        d.monitor("calls", calls);
        d.task<&OneBlock::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power.Axis = home.Axis = around.u;
        power.Enable = true;
        if (calls == 0 || task->name != "MC_Power") power(ctx);  // one at a time
        home.Execute = power.Status;
        home(ctx);
        if (!home.Done && calls == 0) return;
        if (calls == 0) {
            std::memcpy(block, task->type.prototype, task->type.size);
            task->prepare(block, around);
        }
        if (++calls == 3) set(block, "Execute"), set(block, "Enable"), set(block, "JogForward");
        task->type.run(block, ctx);
        if (const auto* id = task->type.pin("ErrorID"); id != nullptr && error == 0) {
            std::uint16_t value = 0;
            std::memcpy(&value, block + id->offset, sizeof value);
            error = value;
        }
    }

private:
    static void set(std::byte* bytes, std::string_view pin) {
        if (const auto* found = task->type.pin(pin)) bytes[found->offset] = std::byte{1};
    }
};

template <class... Blocks>
std::vector<OneBlock::Task> tasks_of(BlockList<Blocks...>) {
    return {{block_name<Blocks>(), [](void* bytes, const Around& around) { *static_cast<Blocks*>(bytes) = ready_to_work<Blocks>(around); },
             block_type<Blocks>()}...};
}

ErrorId outcome_of(const OneBlock::Task& task) {
    static_assert(sizeof(ErrorId) == sizeof(std::uint16_t));
    OneBlock::task = &task;
    auto config = with_line(with_program(1, &entry_of<OneBlock>));
    config.serial[0].drives[0].drive.parameters.push_back({4, 5});  // torque control too
    TestMachine m{config};
    if (!m.up() || !m.until([&] { return variable(m, "calls") > 0; }, 10s)) {
        ADD_FAILURE() << task.name << ": never powered and homed; " << m.alarms();
        return ErrorId::none;
    }
    m.run(300ms);
    EXPECT_GT(variable(m, "calls"), 100) << task.name;
    return static_cast<ErrorId>(static_cast<std::uint16_t>(variable(m, "error")));
}

// The list is the library's, so a new block meets this table. Sheet 9.3: no set-point of each cycle, no interpolation, nothing coupled; the drive
// has no homing and no latch of its own, no outputs that could be written, and the axis keeps its own mode but for torque.
TEST(SerialBlocks, WhatCannotWorkSaysNotSupported) {
    const std::map<std::string_view, ErrorId> refused = {
        // a set-point in each cycle
        {"MC_PositionProfile", ErrorId::not_supported},
        {"MC_VelocityProfile", ErrorId::not_supported},
        {"MC_AccelerationProfile", ErrorId::not_supported},
        {"MC_ExtSetPointGenEnable", ErrorId::not_supported},
        {"MC_ExtSetPointGenFeed", ErrorId::not_supported},
        {"MC_MoveSuperimposed", ErrorId::not_supported},
        {"MC_HaltSuperimposed", ErrorId::not_supported},
        {"MC_CamTableSelect", ErrorId::not_supported},
        {"MC_CamIn", ErrorId::not_supported},
        {"MC_CamOut", ErrorId::not_supported},
        {"MC_GearIn", ErrorId::not_supported},
        {"MC_GearOut", ErrorId::not_supported},
        {"MC_GearInPos", ErrorId::not_supported},
        {"MC_PhasingAbsolute", ErrorId::not_supported},
        {"MC_PhasingRelative", ErrorId::not_supported},
        {"MC_HaltPhasing", ErrorId::not_supported},
        {"MC_CombineAxes", ErrorId::not_supported},
        // what the drive has not
        {"MC_SetControllerMode", ErrorId::not_supported},
        {"MC_SetTorqueLimit", ErrorId::no_torque_limit},
        {"MC_SetBrake", ErrorId::brake_not_controlled},
        {"MC_WriteDigitalOutput", ErrorId::not_supported},
        {"MC_HomeAbsolute", ErrorId::not_supported},
        {"MC_StepDistanceCoded", ErrorId::not_supported},
        // profiles of the drive's own, by objects that it has not: MC_MoveVelocity and MC_TorqueControl are what it can
        {"Drive_MoveAbsolute", ErrorId::not_supported},
        {"Drive_MoveRelative", ErrorId::not_supported},
        {"Drive_MoveVelocity", ErrorId::not_supported},
        {"Drive_Torque", ErrorId::not_supported},
        // what this axis is not: it has no modulo
        {"MC_MoveModulo", ErrorId::not_supported},
        // what has nothing to end here
        {"MC_ExtSetPointGenDisable", ErrorId::state_forbids},
        {"MC_AbortTrigger", ErrorId::probe_idle},
        {"MC_FinishHoming", ErrorId::state_forbids},
    };
    std::size_t seen = 0;
    for (const auto& task : tasks_of(decltype(fb::detail::joined(MotionBlocks{}, HomingBlocks{})){})) {
        const auto expected = refused.find(task.name);
        seen += expected != refused.end();
        EXPECT_EQ(outcome_of(task), expected == refused.end() ? ErrorId::none : expected->second) << task.name;
    }
    EXPECT_EQ(seen, refused.size()) << "a block of the table is not in the library's list";
}

}  // namespace
}  // namespace taktwerk::runtime::testing
