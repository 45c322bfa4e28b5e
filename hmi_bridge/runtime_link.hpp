#pragma once
// MachineLink over a real machine.

#include <mutex>
#include <utility>

#include "hmi_bridge/machine_link.hpp"
#include "runtime/flight/flight_recorder.hpp"
#include "runtime/run/advance_watch.hpp"

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
    /// `recorder` outlives the link; nullptr: nothing is kept.
    void set_recorder(const runtime::FlightRecorder* recorder) noexcept { recorder_ = recorder; }
    [[nodiscard]] std::string recording_of(const AlarmFact& fact, Instant since) const override {
        return recorder_ ? recorder_->recording_of(fact, since) : std::string{};
    }
    [[nodiscard]] const runtime::SignalRows* signals() const override { return &machine_.signals(); }
    [[nodiscard]] ecat::Master* bus() override { return &machine_.bus(); }
    [[nodiscard]] runtime::BusLook* bus_look() override { return &machine_.bus_look(); }
    [[nodiscard]] runtime::MachineTimes times() const override { return machine_.times(); }
    bool next_measure_sample(axes::MeasureSample& out) override { return machine_.next_measure_sample(out); }
    [[nodiscard]] const axes::AxisConfig* axis_config(std::uint16_t axis) const override {
        return axis < machine_.config().axes.size() ? &machine_.config().axes[axis].axis : nullptr;
    }
    runtime::StopLevels::Ticket request_stop(std::uint16_t axis) override { return machine_.request_stop(axis); }
    runtime::StopLevels::Ticket release_jog(std::uint16_t axis) override { return machine_.release_jog(axis); }
    runtime::StopLevels::Ticket request_shutdown() override { return machine_.request_shutdown(); }
    [[nodiscard]] bool taken(runtime::StopLevels::Ticket ticket) const override { return machine_.taken(ticket); }
    [[nodiscard]] std::uint64_t levels_raised() const override { return machine_.levels_raised(); }
    [[nodiscard]] std::optional<std::string> stuck() const override {
        const std::lock_guard lock{mutex_};
        return stuck_;
    }
    /// Any thread: what a watch beside the cycle has seen (RealtimeRunner::on_stuck).
    void tell_stuck(const runtime::StuckCycle* stuck) {
        auto words = stuck ? std::optional<std::string>(stuck->text()) : std::nullopt;
        const std::lock_guard lock{mutex_};
        stuck_ = std::move(words);
    }

private:
    runtime::Machine& machine_;
    const runtime::FlightRecorder* recorder_ = nullptr;
    mutable std::mutex mutex_;
    std::optional<std::string> stuck_;
};

}  // namespace taktwerk::hmi
