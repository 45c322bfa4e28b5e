#pragma once
// Cycles that come too late, and whose fault that is: a base task that computes too long, or the wake-up. Real-time safe.

#include "runtime/cycle_tick.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/program_runner.hpp"

namespace taktwerk::runtime {

class LateCycles {
public:
    LateCycles(MachineBody& body, const ProgramRunner& programs) : body_(body), programs_(programs) {}

    /// Raises the alarms that hold.
    void watch(const CycleTick& tick) noexcept;

private:
    void blame_base_task(const CycleTick& tick) noexcept;

    MachineBody& body_;
    const ProgramRunner& programs_;
    Instant late_until_{};
    Duration late_worst_{};  // while a late wake-up is shown
    std::uint32_t overruns_in_a_row_ = 0;
    bool late_by_a_task_ = false;        // this cycle comes late because a base task took too long in the last one
    ProgramRunner::LongestTask blamed_;  // that task ...
    Instant blamed_until_{};             // ... while that is shown
};

}  // namespace taktwerk::runtime
