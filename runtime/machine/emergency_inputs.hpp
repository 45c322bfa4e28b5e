#pragma once
// The emergency stop's input and the restart button beside it: what is pressed, and what a press lets go on. Real-time safe.

#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/operator_desk.hpp"
#include "runtime/machine/program_runner.hpp"

namespace taktwerk::runtime {

class EmergencyInputs {
public:
    EmergencyInputs(MachineBody& body, ProgramRunner& programs, OperatorDesk& desk);

    /// Reads both inputs; body.emergency is as they say from here on.
    void watch() noexcept;
    /// What every axis is told in this cycle.
    [[nodiscard]] axes::EmergencyStop level() const noexcept;

private:
    void watch_restart() noexcept;
    void reset_axes() noexcept;

    static constexpr int no_input = -1;
    MachineBody& body_;
    ProgramRunner& programs_;
    OperatorDesk& desk_;
    int input_ = no_input, restart_input_ = no_input;  // of io
    std::size_t slave_ = 0;                            // with the input
    Instant pressed_since_{};
    bool restart_pressed_ = true;   // the last level of its input: only a rising edge counts
    Instant restart_deaf_until_{};  // the press that resets may bounce, and must not be taken for the next one
};

}  // namespace taktwerk::runtime
