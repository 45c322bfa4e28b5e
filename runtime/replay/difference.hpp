#pragma once
// Two records that ought to be the same: which signal of the machine is not, and its two values. Not real-time.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/recorder.hpp"
#include "runtime/machine/machine.hpp"

namespace taktwerk::runtime {

struct ReplayDifference {
    std::uint64_t cycle = 0;  ///< as Snapshot::cycle counts; 0: before the machine was up
    Instant at{};             ///< of that cycle
    std::string signal;       ///< "axis x: set position", "output lamp", "slave 'x_drive' 607Ah:00", "a frame that left"
    std::string recorded, replayed;

    /// "cycle 1234, 1.234 s after the start: ...": `start`: what the recording calls 0.
    [[nodiscard]] std::string text(Instant start) const;
};

/// What a machine has come to: the newest record of each kind (runtime/recording/outcome_record.hpp).
struct Outcome {
    std::vector<std::byte> setpoints, points, outputs;
    /// Any record; most are none of these.
    void take(const RecordView& record);
};

/// The first set-point, point or object on the bus that is not the same; nothing: all are. `cycle` and `at` are left to the caller.
[[nodiscard]] std::optional<ReplayDifference> difference_between(const Outcome& recorded, const Outcome& replayed, const Machine& machine);
/// The same of any two records that ought to be one; `nullptr`: there is none on that side.
[[nodiscard]] ReplayDifference difference_between(const RecordView* recorded, const RecordView* replayed);

}  // namespace taktwerk::runtime
