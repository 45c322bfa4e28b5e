#pragma once
// What a task may know of itself (TaskContext::task()): how often it ran, how long that took, how late it was. FROZEN SHAPE (extend additively).

#include <cstdint>

#include "core/time.hpp"

namespace taktwerk {

/// As of the beginning of a scan: the scan itself is not counted yet.
///
/// How often is the same in each run with the same inputs. How long is measured: it differs from run to run, from computer to computer, and is 0 in
/// virtual time, where computing takes none. A recording has what the program was told, so that a replay tells it the same.
struct TaskInfo {
    Duration period{};           ///< configured
    std::uint64_t runs = 0;      ///< that have ended since the machine came up
    std::uint64_t overruns = 0;  ///< slower task: releases missed; base task: scans that took longer than the cycle (measured)
    std::uint32_t missed = 0;    ///< releases missed right before this one (base task: cycles). Above 0: CycleTimeExceeded elsewhere
    /// Of the runs that have ended since people began the statistics anew.
    struct Times {
        Duration last{}, minimum{}, maximum{}, mean{};
    } run;
    /// From the release to the first instruction (base task: of the cycle's wake-up): of the run before, and the most.
    Duration lateness{}, lateness_max{};
};

}  // namespace taktwerk
