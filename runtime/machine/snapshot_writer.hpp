#pragma once
// Step 10: the one copy of the machine's state for everybody else. Copying allocates nothing.

#include "core/latest_value.hpp"
#include "runtime/machine/group_desk.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/measuring.hpp"
#include "runtime/machine/program_runner.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::runtime {

class SnapshotWriter {
public:
    SnapshotWriter(MachineBody& body, const Measuring& measuring, const GroupDesk& groups, const ProgramRunner& programs)
        : body_(body), measuring_(measuring), groups_(groups), programs_(programs) {}

    /// Takes all memory. Before the first step().
    void prepare();
    /// Real-time safe.
    void step() noexcept;

    /// Service side (one reader); nullptr before the first step().
    [[nodiscard]] const Snapshot* latest() noexcept;

private:
    MachineBody& body_;
    const Measuring& measuring_;
    const GroupDesk& groups_;
    const ProgramRunner& programs_;
    LatestValue<Snapshot> snapshots_;
};

}  // namespace taktwerk::runtime
