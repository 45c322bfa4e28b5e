#pragma once
// The other half of step 10: every signal of this cycle as one row of the signal ring. What a row holds stands here and nowhere else; who
// reads one goes by the list of its signals.

#include <cstdint>
#include <vector>

#include "runtime/machine/group_desk.hpp"
#include "runtime/machine/machine_body.hpp"
#include "runtime/machine/program_runner.hpp"
#include "runtime/recording/signal_ring.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::runtime {

class RowWriter {
public:
    /// Takes the ring's memory: RecordingConfig::depth. The programs have declared their variables.
    RowWriter(const MachineBody& body, const GroupDesk& groups, const ProgramRunner& programs, const MachineLayout& layout);

    [[nodiscard]] SignalRing& ring() noexcept { return ring_; }
    /// After the snapshot. Real-time safe: some hundred stores, straight from where the values are.
    void step() noexcept;

private:
    /// Points by what they take: a bit of a shared word, or a word.
    struct Points {
        std::vector<std::uint16_t> bits, words;
    };
    struct Plan {
        Points inputs, outputs;
        std::vector<MachineLayout::GroupInfo> groups;
        std::vector<RecordedSignal> signals;
        std::size_t words = 0;
    };
    [[nodiscard]] static Points split(const MachineConfig& config, const std::vector<std::string>& names,
                                      const std::vector<std::string>& units, IoDirection direction);
    [[nodiscard]] static Plan plan(const MachineBody& body, const MachineLayout& layout);
    RowWriter(const MachineBody& body, const GroupDesk& groups, const ProgramRunner& programs, Plan plan);

    const MachineBody& body_;
    const GroupDesk& groups_;
    const ProgramRunner& programs_;
    std::vector<MachineLayout::GroupInfo> group_places_;  // as configured
    Points inputs_, outputs_;
    SignalRing ring_;
};

}  // namespace taktwerk::runtime
