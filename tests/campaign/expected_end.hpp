#pragma once
// How a run may end, per kind of fault and phase. Written by thought from docs/faults.md and the rules of the protocol, before
// and independently of what runs show.

#include <string>
#include <vector>

#include "core/alarm.hpp"
#include "tests/campaign/fault_kind.hpp"

namespace taktwerk::campaign {

struct ExpectedEnd {
    bool operational = true;  ///< the bus may be (or be again) in OP
    bool failed = false;      ///< the bring-up may end with an error; once the cause is gone the next one reaches OP
    bool stopped = false;     ///< the bus is stopped, as it was asked
    bool degraded = false;    ///< in OP without the slaves concerned, and their alarm stands
    enum class Axes : std::uint8_t { not_asked, run_on, may_stop, stop } axes = Axes::not_asked;
    std::vector<AlarmId> announced;      ///< one of them must have been raised; empty: none need be
    bool drives_may_see_a_jump = false;  ///< a target was changed behind the master's back
};

[[nodiscard]] ExpectedEnd expected_end(FaultKind kind, Phase phase);
/// "operational; axes stop; slave_lost or cable_broken"
[[nodiscard]] std::string text(const ExpectedEnd& end);

}  // namespace taktwerk::campaign
