#pragma once
// A machine of config/machines/ with its example program, on simulated drives and real frames in virtual time: as `taktwerk run` builds it.

#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "config/machine_file/machine_loader.hpp"
#include "runtime/run/virtual_runner.hpp"
#include "runtime/world/world.hpp"
#include "tests/machines/replay_check.hpp"

namespace taktwerk::testing {

using namespace std::chrono_literals;

/// `simulation: events` of the machine file.
enum class Events : std::uint8_t { happen, left_out };

class ExampleMachine {
public:
    explicit ExampleMachine(const std::string& name, Events events = Events::happen) : ExampleMachine(name, without(events)) {}
    /// `change`: of what its file says, before it is built.
    ExampleMachine(const std::string& name, const std::function<void(runtime::MachineConfig&)>& change) {
        config::LoadOptions options;
        options.simulate = true;
        options.drive_dirs.emplace_back(TAKTWERK_SOURCE_DIR "/config/drives");
        options.program_path.emplace_back(TAKTWERK_BINARY_DIR "/programs");
        auto loaded = config::load_machine(TAKTWERK_SOURCE_DIR "/config/machines/" + name + ".yaml", options);
        if (const auto* errors = std::get_if<1>(&loaded)) {
            for (const auto& error : *errors) ADD_FAILURE() << error.text();
            return;
        }
        auto config = std::move(std::get<0>(loaded).machine);
        if (change) change(config);
        world_ = std::make_unique<runtime::World>(config, clock_.now());
        auto built = runtime::Machine::build(std::move(config), world_->transport(), world_->serial().lines());
        if (const auto* errors = std::get_if<1>(&built)) {
            for (const auto& error : *errors) ADD_FAILURE() << error.text();
            return;
        }
        machine_ = std::move(std::get<0>(built));
        runner_ = std::make_unique<runtime::VirtualRunner>(*machine_, *world_, clock_);
        replayed_.watch(*machine_, runner_.get(), clock_.now());
        runner_->after_cycle = [this](Instant) {
            if (latest_ = machine_->latest(); latest_ != nullptr && each_cycle) each_cycle();
        };
        const auto up = runner_->bring_up();
        if (!up) ADD_FAILURE() << up.error().text();
        up_ = up.ok();
    }
    ~ExampleMachine() {
        each_cycle = {};
        if (up_) runner_->shut_down();
    }
    ExampleMachine(const ExampleMachine&) = delete;
    ExampleMachine& operator=(const ExampleMachine&) = delete;

    /// Looks after every cycle.
    std::function<void()> each_cycle;

    [[nodiscard]] bool up() const { return up_; }
    void run(Duration time) { runner_->run_for(time); }
    bool until(const std::function<bool()>& condition, Duration most) { return runner_->run_until(condition, most); }

    [[nodiscard]] const axes::AxisView& axis(const std::string& name) const {
        const auto& axes = machine_->layout().axes;
        for (std::size_t i = 0; i < axes.size(); ++i)
            if (axes[i].name == name) return latest_->axes[i];
        throw std::runtime_error("no axis " + name);
    }
    [[nodiscard]] bool output(const std::string& name) const {
        const auto& names = machine_->layout().outputs;
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i] == name) return latest_->outputs[i] != 0;
        throw std::runtime_error("no output " + name);
    }
    [[nodiscard]] double variable(const std::string& name) const {
        const auto& variables = machine_->layout().variables;
        for (std::size_t i = 0; i < variables.size(); ++i)
            if (variables[i].name == name) return latest_->variables[i];
        throw std::runtime_error("no variable " + name);
    }
    /// What the operator would do.
    void set_parameter(const std::string& name, double value) {
        const auto& parameters = machine_->layout().parameters;
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            if (parameters[i].name != name) continue;
            runtime::OperatorCommand command;
            command.action = runtime::OperatorAction::set_parameter;
            command.index = static_cast<std::uint16_t>(i);
            command.value = value;
            command.sequence = ++sequence_;
            command.expires = clock_.now() + 1s;
            EXPECT_TRUE(machine_->submit(command));
            return;
        }
        throw std::runtime_error("no parameter " + name);
    }
    /// What an operator's command comes to.
    runtime::CommandAnswer command(runtime::OperatorCommand command) {
        command.client = 1;
        command.sequence = ++sequence_;
        command.expires = clock_.now() + 1s;
        EXPECT_TRUE(machine_->submit(command));
        std::optional<runtime::CommandAnswer> answer;
        EXPECT_TRUE(runner_->run_until([&] { return (answer = machine_->next_answer()).has_value(); }, 1s));
        return answer.value_or(runtime::CommandAnswer{});
    }
    [[nodiscard]] Instant now() const { return clock_.now(); }
    [[nodiscard]] runtime::Machine& machine() { return *machine_; }
    [[nodiscard]] const runtime::Snapshot& snapshot() const { return *latest_; }
    /// The hardware behind the bus: what really moves.
    [[nodiscard]] runtime::World& world() { return *world_; }
    [[nodiscard]] const runtime::MachineConfig& config() const { return machine_->config(); }
    /// Where the mechanics of an axis really are, in its unit, machine coordinates.
    [[nodiscard]] double place(const std::string& name) {
        for (const auto& binding : machine_->config().axes)
            if (binding.axis.name == name) return world_->drive(name)->plant().position() / binding.axis.gearing.counts_per_unit();
        throw std::runtime_error("no axis " + name);
    }
    [[nodiscard]] std::string alarms() const {
        std::string all;
        for (std::size_t i = 0; i < latest_->alarm_count; ++i) {
            const auto words = machine_->describe(latest_->alarms[i].fact);
            all += words.source + ": " + words.english + "; ";
        }
        return all;
    }

private:
    static std::function<void(runtime::MachineConfig&)> without(Events events) {
        if (events == Events::happen) return {};
        return [](runtime::MachineConfig& config) { config.simulation.events.clear(); };
    }

    VirtualClock clock_;
    std::unique_ptr<runtime::World> world_;
    runtime::testing::ReplayCheck replayed_;
    std::unique_ptr<runtime::Machine> machine_;
    std::unique_ptr<runtime::VirtualRunner> runner_;
    const runtime::Snapshot* latest_ = nullptr;
    std::uint64_t sequence_ = 0;
    bool up_ = false;
};

}  // namespace taktwerk::testing
