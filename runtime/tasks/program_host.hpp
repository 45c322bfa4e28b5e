#pragma once
// The programs of a machine: loaded, their declarations checked against the configuration, their tasks ready to be called.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "programs/api/program.hpp"
#include "runtime/machine_config.hpp"
#include "runtime/retain/retained_item.hpp"
#include "runtime/snapshot.hpp"
#include "runtime/tasks/io_image.hpp"
#include "runtime/tasks/program_library.hpp"

namespace taktwerk::runtime {

class ProgramHost {
public:
    struct Task {
        TaskConfig config;
        std::size_t program = 0;
        Declaration::TaskFunction function = nullptr;
    };
    struct Variable {
        VariableType type = VariableType::real;
        const void* address = nullptr;
        std::size_t program = 0;
    };
    /// A variable that people may write.
    struct OperatorValue {
        std::size_t variable = 0;  ///< its place among the variables
        void* address = nullptr;
        std::size_t task = 0;  ///< its place among the tasks: whose scans it is for
        bool momentary = false;
    };
    struct AlarmDeclared {
        bool declared = false;
        Reaction reaction = Reaction::none;
        std::string english, chinese, remedy;
    };
    struct Loaded {
        ProgramConfig config;
        ProgramLibrary::Instance instance;
        std::uint64_t alarms = 0;                ///< those that hold, set by its scans
        std::vector<AlarmDeclared> alarm_texts;  ///< 64
        std::string fault;                       ///< why it stopped by itself; set with state fault
    };

    /// Loads and declares everything; problems are added to `errors` (all of them). `io` gives the point names; declared tables go to
    /// `tables`.
    ProgramHost(const MachineConfig& config, const IoImage& io, axes::MotionTables& tables, std::vector<Error>& errors);
    ~ProgramHost();

    [[nodiscard]] std::vector<Loaded>& programs() noexcept { return programs_; }
    [[nodiscard]] const std::vector<Loaded>& programs() const noexcept { return programs_; }
    [[nodiscard]] const std::vector<Task>& tasks() const noexcept { return tasks_; }
    [[nodiscard]] const std::vector<Variable>& variables() const noexcept { return variables_; }
    [[nodiscard]] const std::vector<OperatorValue>& operator_values() const noexcept { return operator_values_; }
    [[nodiscard]] const std::vector<RetainedItem>& retained() const noexcept { return retained_; }
    [[nodiscard]] const MachineLayout::Variable& variable(std::size_t index) const { return variable_info_[index]; }
    [[nodiscard]] std::vector<double>& parameters() noexcept { return parameters_; }
    [[nodiscard]] const std::vector<double>& parameters() const noexcept { return parameters_; }
    /// Adds names, units and documentation of variables, parameters, programs and tasks.
    void describe(MachineLayout& layout) const;
    [[nodiscard]] const MachineLayout::ParameterInfo& parameter(std::size_t index) const { return parameter_info_[index]; }

    /// The output points that a program has declared, each once. Real-time safe.
    [[nodiscard]] std::span<const std::uint16_t> outputs_of(std::size_t program) const noexcept { return outputs_[program]; }
    [[nodiscard]] bool drives(std::size_t program, std::uint16_t output) const noexcept {
        for (const auto declared : outputs_[program])
            if (declared == output) return true;
        return false;
    }

    /// The program has declared the axis. Real-time safe.
    [[nodiscard]] bool uses(std::size_t program, std::size_t axis) const noexcept {
        for (const auto& use : axis_uses_)
            if (use.program == program && use.axis == axis) return true;
        return false;
    }

    /// Value of a monitored variable. Real-time safe.
    [[nodiscard]] static double read(const Variable& variable) noexcept;
    /// `value` is one that the variable takes (MachineLayout::Variable::takes). Real-time safe.
    static void write(VariableType type, void* address, double value) noexcept;

private:
    class Collector;
    std::vector<ProgramLibrary> libraries_;  // outlive the instances: destroyed after them
    std::vector<Loaded> programs_;
    std::vector<Task> tasks_;
    std::vector<Variable> variables_;
    std::vector<MachineLayout::Variable> variable_info_;
    std::vector<OperatorValue> operator_values_;
    std::vector<RetainedItem> retained_;
    std::vector<double> parameters_;
    std::vector<MachineLayout::ParameterInfo> parameter_info_;
    std::vector<MachineLayout::Block> blocks_;
    std::vector<std::vector<std::uint16_t>> outputs_;  // per program
    struct AxisUse {
        std::size_t program, axis;
    };
    std::vector<AxisUse> axis_uses_;  // each once
};

}  // namespace taktwerk::runtime
