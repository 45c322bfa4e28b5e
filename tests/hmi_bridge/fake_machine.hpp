#pragma once
// A machine played by hand: keeps what was submitted, answers what the test says, shows the snapshot the test fills.

#include <deque>
#include <vector>

#include "hmi_bridge/machine_link.hpp"

namespace taktwerk::hmi::test {

class FakeMachine final : public MachineLink {
public:
    FakeMachine() {
        its_layout.machine = "demo";
        its_layout.cycle = std::chrono::milliseconds{1};
        its_layout.axes = {{"x", "mm", false, true, 10, 50, "x_drive", "sv33-e", 0},
                           {"y", "mm", false, true, 10, 50, "y_drive", "sv33-e", 0},
                           {"turret", "deg", true, true, 5, 20, "", "", 0}};
        its_layout.groups = {{"table", "mm", {0, 1}, true, {true, true, false, false, false, false}}};
        its_layout.slaves = {"x_drive", "y_drive"};
        its_layout.inputs = {"start_button", "estop_ok"};
        its_layout.outputs = {"lamp_run"};
        its_layout.programs = {"cell", "feeder"};
        its_layout.tasks = {"cell.main"};
        its_layout.variables = {{"cell", "step", "", "step of the sequence", VariableType::int32},
                                {"cell", "start", "", "begin", VariableType::boolean, true, true, 0, 1},
                                {"cell", "count", "", "pieces to make", VariableType::uint16, true, false, 1, 50},
                                {"feeder", "tempo", "mm/s", "", VariableType::real, true, false, 10, 100},
                                {"feeder", "light", "", "", VariableType::boolean, true, false, 0, 1}};
        its_layout.parameters = {{"cell", "speed", "mm/s", "transfer speed", 10, 500, 200},
                                 {"cell", "pause", "s", "", 0, 5, 1},
                                 {"feeder", "pause", "s", "", 0, 9, 2}};
        snapshot.cycle = 1000;
        snapshot.at = Instant{std::chrono::seconds{1}};
        snapshot.phase = runtime::MachinePhase::running;
        snapshot.simulated = true;
        snapshot.bus_phase = ecat::Master::Phase::operational;
        snapshot.slaves.resize(2);
        snapshot.axes.resize(3);
        snapshot.groups.resize(1);
        snapshot.inputs = {0, 1};
        snapshot.outputs = {1};
        snapshot.parameters = {200, 1, 2};
        snapshot.variables = {7, 0, 5, 50, 1};
        snapshot.programs = {runtime::ProgramState::running, runtime::ProgramState::stopped};
        snapshot.tasks.resize(1);
    }

    bool submit(const runtime::OperatorCommand& command) override {
        if (submitted.size() >= inbox_size) return false;
        submitted.push_back(command);
        return true;
    }
    std::optional<runtime::CommandAnswer> next_answer() override {
        if (answers.empty()) return std::nullopt;
        const auto answer = answers.front();
        answers.pop_front();
        return answer;
    }
    const runtime::Snapshot* latest() override { return cycling ? &snapshot : nullptr; }
    [[nodiscard]] const runtime::MachineLayout& layout() const override { return its_layout; }
    [[nodiscard]] runtime::AlarmText describe(const AlarmFact&) const override {
        return {"axis x", "following_error", "The axis lags behind", "跟随误差过大", "It is blocked", "Free it", "the axis stops", "reset"};
    }
    [[nodiscard]] const axes::AxisConfig* axis_config(std::uint16_t) const override { return &its_config; }
    bool next_measure_sample(axes::MeasureSample& out) override {
        if (samples.empty()) return false;
        out = samples.front();
        samples.pop_front();
        return true;
    }
    [[nodiscard]] Drive drive(std::uint16_t axis) override { return axis < drives.size() ? drives[axis] : Drive{}; }
    [[nodiscard]] runtime::MachineTimes times() const override { return its_times; }
    [[nodiscard]] const runtime::SignalRows* signals() const override { return rows; }
    [[nodiscard]] std::string recording_of(const AlarmFact& fact, Instant) const override { return fact.id == recorded ? "demo-1" : ""; }
    runtime::StopLevels::Ticket request_stop(std::uint16_t axis) override {
        stops.push_back(axis);
        return {0, ++levels};
    }
    runtime::StopLevels::Ticket release_jog(std::uint16_t axis) override {
        releases.push_back(axis);
        return {0, ++levels};
    }
    runtime::StopLevels::Ticket request_shutdown() override {
        shutdown_requested = true;
        return {0, ++levels};
    }
    [[nodiscard]] bool taken(runtime::StopLevels::Ticket) const override { return takes_levels; }
    [[nodiscard]] std::uint64_t levels_raised() const override { return levels; }
    [[nodiscard]] std::optional<std::string> stuck() const override { return stuck_words; }

    /// Answers the newest command.
    void answer(runtime::Answer verdict, axes::ErrorId error = axes::ErrorId::none, axes::Owner owner = axes::Owner::none,
                const void* holder = nullptr) {
        answers.push_back({submitted.back().client, submitted.back().sequence, verdict, error, owner, holder});
    }

    std::vector<runtime::OperatorCommand> submitted;
    std::deque<runtime::CommandAnswer> answers;
    runtime::Snapshot snapshot;
    runtime::MachineLayout its_layout;
    axes::AxisConfig its_config{};  ///< of each axis
    std::deque<axes::MeasureSample> samples{};
    std::vector<Drive> drives;  ///< by axis; those behind have none
    runtime::MachineTimes its_times;
    std::size_t inbox_size = 1000;
    bool cycling = true;
    bool shutdown_requested = false;
    std::vector<std::uint16_t> stops, releases;  ///< levels, by axis
    std::uint64_t levels = 0;
    bool takes_levels = true;
    std::optional<std::string> stuck_words;
    const runtime::SignalRows* rows = nullptr;
    AlarmId recorded = 0;  ///< the alarm that has a recording
};

}  // namespace taktwerk::hmi::test
