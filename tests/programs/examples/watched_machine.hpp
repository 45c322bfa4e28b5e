#pragma once
// A machine of config/machines/ with its own program, or another one, under the oracles of every axis: what each drive is told through the frames is what
// its axis shows, and set-points are
// continuous in place, velocity, acceleration and jerk, within the axis' limits (tests/runtime/drive_oracle.hpp). Where its mechanics really are comes
// from the simulated motors alone.

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "config/machine_file/machine_loader.hpp"
#include "tests/machines/add_program.hpp"
#include "tests/runtime/test_machine.hpp"

namespace taktwerk::testing {

using namespace std::chrono_literals;

/// `program`: instead of those of the file.
inline runtime::MachineConfig machine_of_file(const std::string& name, const ProgramEntry* (*program)() = nullptr) {
    config::LoadOptions options;
    options.simulate = true;
    options.drive_dirs.emplace_back(TAKTWERK_SOURCE_DIR "/config/drives");
    options.program_path.emplace_back(TAKTWERK_BINARY_DIR "/programs");
    auto loaded = config::load_machine(TAKTWERK_SOURCE_DIR "/config/machines/" + name + ".yaml", options);
    if (const auto* errors = std::get_if<1>(&loaded)) {
        std::string all;
        for (const auto& error : *errors) all += error.text() + "\n";
        throw std::runtime_error(all);
    }
    auto machine = std::move(std::get<0>(loaded).machine);
    machine.simulation.supervision = runtime::Supervision::strict;  // as on real drives
    if (program != nullptr) {
        machine.programs.clear();
        machine.tasks.clear();
        runtime::testing::add_program(machine, "p", program);
    }
    return machine;
}

class WatchedMachine : public runtime::testing::TestMachine {
public:
    explicit WatchedMachine(const std::string& name, const ProgramEntry* (*program)() = nullptr)
        : TestMachine(machine_of_file(name, program)) {}

    [[nodiscard]] std::uint16_t index(const std::string& name) const {
        const auto& axes = machine->layout().axes;
        for (std::size_t i = 0; i < axes.size(); ++i)
            if (axes[i].name == name) return static_cast<std::uint16_t>(i);
        throw std::runtime_error("no axis " + name);
    }
    [[nodiscard]] const axes::AxisView& view(const std::string& name) { return axis(index(name)); }
    [[nodiscard]] const runtime::SeenGroup& group() { return state().groups[0]; }
    [[nodiscard]] bool output(const std::string& name) {
        const auto& outputs = machine->layout().outputs;
        for (std::size_t i = 0; i < outputs.size(); ++i)
            if (outputs[i] == name) return state().outputs[i] != 0;
        throw std::runtime_error("no output " + name);
    }
    [[nodiscard]] double variable(const std::string& name) {
        const auto& variables = machine->layout().variables;
        for (std::size_t i = 0; i < variables.size(); ++i)
            if (variables[i].name == name) return state().variables[i];
        throw std::runtime_error("no variable " + name);
    }
    /// What a person does on the page.
    void set_switch(const std::string& name, bool on) {
        const auto& variables = machine->layout().variables;
        for (std::size_t i = 0; i < variables.size(); ++i)
            if (variables[i].name == name) {
                EXPECT_EQ(command(runtime::OperatorAction::set_value, static_cast<std::uint16_t>(i), on, on ? 1 : 0).answer,
                          runtime::Answer::accepted)
                    << name;
            }
    }
    /// `taktwerk reset` again and again, as a person does.
    bool reset_until(const std::function<bool()>& well, Duration patience) {
        for (const auto end = clock.now() + patience; clock.now() < end;) {
            if (well()) return true;
            (void)command(runtime::OperatorAction::reset);
            run(300ms);
        }
        return well();
    }
    /// Where the mechanics of an axis really are, in its unit: the motor's counts, by the gearing of the file.
    [[nodiscard]] double place(const std::string& name) {
        return world.drive(name)->plant().position() / machine->config().axes[index(name)].axis.gearing.counts_per_unit();
    }
    [[nodiscard]] bool alarm(const std::string& name) {
        const auto& s = state();
        for (std::size_t i = 0; i < s.alarm_count; ++i)
            if (machine->describe(s.alarms[i].fact).name == name) return true;
        return false;
    }
};

}  // namespace taktwerk::testing
