#pragma once
// How far the calendar clock is from the machine's. The kernel dates frames by the former; whoever gets such a date carries it
// over with this. Both clocks are disciplined alike: the distance changes only when somebody sets the time.

#include "core/time.hpp"

namespace taktwerk {

/// Calendar time (CLOCK_REALTIME) minus machine time (CLOCK_MONOTONIC, SystemClock), to about a microsecond. Reads clocks: for
/// the service side, never in the control path.
[[nodiscard]] Duration calendar_minus_machine_time() noexcept;

}  // namespace taktwerk
