#pragma once
// How the cycle and the tasks have spent their time, for who looks at a machine: written by the cycle, read by anybody meanwhile.

#include <array>
#include <cstddef>
#include <vector>

#include "core/shared_histogram.hpp"
#include "core/stopwatch.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::runtime {

struct CycleHistograms {
    /// A cycle is over. Real-time safe.
    void record(const CycleStatistics& cycle, const StepStatistics<step_count - 1>& spent) noexcept {
        lateness.record(cycle.lateness, cycle.cycles);
        compute.record(cycle.compute, cycle.cycles);
        for (std::size_t i = 0; i < steps.size(); ++i) steps[i].record(spent.in_this_cycle(i), cycle.cycles);
    }
    /// The cycle's thread: all begin anew. 4 KB of stores for each.
    void reset() noexcept {
        lateness.reset();
        compute.reset();
        for (auto& step : steps) step.reset();
    }

    SharedHistogram lateness;                           ///< of the wake-up
    SharedHistogram compute;                            ///< steps 1 to 10
    std::array<SharedHistogram, step_count - 1> steps;  ///< by Step
};

/// All of them, for readers: as long as the machine lives, any thread.
struct MachineTimes {
    const CycleHistograms* cycle = nullptr;                       ///< nullptr: there is no cycle
    const std::vector<SharedHistogram>* tasks = nullptr;          ///< runs, by MachineLayout::tasks
    const std::vector<SharedHistogram>* task_lateness = nullptr;  ///< from release to run, likewise
};

}  // namespace taktwerk::runtime
