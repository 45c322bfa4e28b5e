#pragma once
// The ordered end of a run: programs stop, the axes ramp down, power goes off; then the machine says `stopped`. Real-time safe.

#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/operator_desk.hpp"
#include "runtime/machine/program_runner.hpp"

namespace taktwerk::runtime {

class Shutdown {
public:
    Shutdown(MachineBody& body, ProgramRunner& programs, OperatorDesk& desk);

    /// Does its part of the end, once it is asked for.
    void step() noexcept;
    /// From its begin on, with a margin for a drive that does not answer.
    [[nodiscard]] Duration patience() const noexcept { return patience_; }

private:
    void begin() noexcept;

    MachineBody& body_;
    ProgramRunner& programs_;
    OperatorDesk& desk_;
    Duration patience_{};
    Instant since_{};
};

}  // namespace taktwerk::runtime
