#pragma once
// What people ask for, inside the cycle: stop levels, the inbox of commands, authority, modes, power and outputs by hand. Who may do what, and
// when, stands in operator_command.hpp.

#include <atomic>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/spsc_ring.hpp"
#include "runtime/machine/group_desk.hpp"
#include "runtime/machine/hand_motion.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/measuring.hpp"
#include "runtime/machine/program_runner.hpp"
#include "runtime/operator_command.hpp"
#include "runtime/stop_levels.hpp"

namespace taktwerk::runtime {

class OperatorDesk {
public:
    OperatorDesk(MachineBody& body, HandMotion& hands, Measuring& measuring, GroupDesk& groups, ProgramRunner& programs);

    // --- other threads: as Machine has them ----------------------------------------------------------------------------------------
    bool submit(const OperatorCommand& command) noexcept { return inbox_.try_push(command); }
    [[nodiscard]] std::optional<CommandAnswer> next_answer() noexcept;
    [[nodiscard]] StopLevels& levels() noexcept { return levels_; }
    StopLevels::Ticket request_shutdown() noexcept;
    [[nodiscard]] bool shutdown_asked() const noexcept { return shutdown_asked_.load(std::memory_order_acquire); }

    /// The machine is armed: its axes know its mode, programs that start by themselves do so.
    void begin() noexcept;

    // --- cycle: real-time safe -----------------------------------------------------------------------------------------------------
    /// Stop, jog let go, end: before all commands. Also before the machine is armed.
    void take_levels(Instant at) noexcept;
    /// A bounded number of commands.
    void drain_inbox(Instant at) noexcept;
    /// Where programs give their wishes for power, people give theirs.
    void renew_power() noexcept;
    /// In the supervision step.
    void raise_alarms() noexcept { groups_.hand().raise_alarms(); }
    /// The run ends: nobody wants power any more.
    void drop_power() noexcept;
    /// What people have set goes back to its safe value.
    void release_outputs() noexcept;
    /// A level: it stays.
    [[nodiscard]] bool shutdown_taken() const noexcept { return shutdown_taken_; }
    /// Since the last call.
    [[nodiscard]] bool statistics_reset() noexcept { return std::exchange(statistics_reset_, false); }

private:
    struct OutputByHand {
        bool held = false;  // a client has set it
        std::uint32_t client = 0;
    };

    // operator_desk.cpp
    [[nodiscard]] bool overtaken(const OperatorCommand& command) const noexcept;
    void answer(const OperatorCommand& command, Verdict verdict) noexcept;
    void tell_limit(const OperatorCommand& command, CommandAnswer& reply) const noexcept;
    // operator_actions.cpp
    Verdict execute(const OperatorCommand& command) noexcept;
    Verdict execute_machine(const OperatorCommand& command) noexcept;
    Verdict execute_all(const OperatorCommand& command) noexcept;
    Verdict execute_axis(const OperatorCommand& command, std::size_t axis) noexcept;
    Verdict execute_group(const OperatorCommand& command) noexcept;
    Verdict execute_program(const OperatorCommand& command) noexcept;
    Verdict start_program(const OperatorCommand& command) noexcept;
    Verdict set_parameter(const OperatorCommand& command) noexcept;
    Verdict set_output(const OperatorCommand& command) noexcept;
    Verdict force(const OperatorCommand& command) noexcept;
    Verdict override_velocity(const OperatorCommand& command) noexcept;
    Verdict reset_peaks(const OperatorCommand& command) noexcept;
    Verdict power(const OperatorCommand& command, std::size_t axis) noexcept;
    void set_mode(Mode wanted) noexcept;
    void release_outputs_of(std::uint32_t client) noexcept;

    MachineBody& body_;
    HandMotion& hands_;
    Measuring& measuring_;
    GroupDesk& groups_;
    ProgramRunner& programs_;
    SpscRing<OperatorCommand> inbox_;
    SpscRing<CommandAnswer> answers_;
    StopLevels levels_;
    std::vector<std::uint8_t> power_held_;       // per axis: whoever has manual control of it holds the power wish
    std::vector<OutputByHand> outputs_by_hand_;  // as io.outputs()
    bool shutdown_taken_ = false;
    bool statistics_reset_ = false;
    std::atomic<bool> shutdown_asked_{false};
};

}  // namespace taktwerk::runtime
