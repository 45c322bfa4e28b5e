#pragma once
// Step 10: the one copy of the machine's state for everybody else, and the row of the trace. Copying allocates nothing.

#include <memory>
#include <string>
#include <vector>

#include "core/latest_value.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/program_runner.hpp"
#include "runtime/recording/trace_ring.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::runtime {

class SnapshotWriter {
public:
    SnapshotWriter(MachineBody& body, const ProgramRunner& programs) : body_(body), programs_(programs) {}

    /// Takes all memory. Before the first step().
    void prepare();
    /// As Machine has it.
    TraceRing& enable_trace(std::size_t rows, const MachineLayout& layout);
    /// Real-time safe.
    void step() noexcept;

    /// Service side (one reader); nullptr before the first step().
    [[nodiscard]] const Snapshot* latest() noexcept;

private:
    void take_snapshot() noexcept;
    void take_row() noexcept;

    MachineBody& body_;
    const ProgramRunner& programs_;
    LatestValue<Snapshot> snapshots_;
    std::unique_ptr<TraceRing> trace_;  // nullptr: nobody wants one
};

}  // namespace taktwerk::runtime
