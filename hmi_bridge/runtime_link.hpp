#pragma once
// MachineLink over a real machine.

#include "hmi_bridge/machine_link.hpp"

namespace taktwerk::hmi {

class RuntimeLink final : public MachineLink {
public:
    /// `machine` outlives the link. Nobody else may read its answers and snapshots.
    explicit RuntimeLink(runtime::Machine& machine) : machine_(machine) {}
    bool submit(const runtime::OperatorCommand& command) override { return machine_.submit(command); }
    std::optional<runtime::CommandAnswer> next_answer() override { return machine_.next_answer(); }
    const runtime::Snapshot* latest() override { return machine_.latest(); }
    [[nodiscard]] const runtime::MachineLayout& layout() const override { return machine_.layout(); }
    [[nodiscard]] runtime::AlarmText describe(const AlarmFact& fact) const override { return machine_.describe(fact); }
    [[nodiscard]] Drive drive(std::uint16_t axis) override {
        auto* port = machine_.drive_port(axis);
        return {port, port ? machine_.config().axes[axis].profile.get() : nullptr};
    }
    void request_shutdown() override { machine_.request_shutdown(); }

private:
    runtime::Machine& machine_;
};

}  // namespace taktwerk::hmi
