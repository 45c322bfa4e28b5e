#pragma once
// What a machine program is: a shared object built against the SDK that declares what it needs by name and is called each
// scan. FROZEN SHAPE (extend additively); the ABI hash of programs/api/abi.hpp guards it.
//
//   class Cell final : public taktwerk::Program {
//       void declare(taktwerk::Declaration& d) override {
//           x_ = d.axis("x");
//           start_ = d.input("start_button");
//           lamp_ = d.output("lamp_run");
//           speed_ = d.parameter("speed", {.value = 200, .minimum = 10, .maximum = 500, .unit = "mm/s", .doc = "transfer speed"});
//           d.monitor("step", step_, "", "step of the sequence");
//           d.task<&Cell::scan>("main");
//       }
//       void scan(taktwerk::TaskContext& ctx) {
//           power_.Axis = x_; power_.Enable = true; power_(ctx);
//           ctx.set(lamp_, power_.Status);
//       }
//   };
//   TAKTWERK_PROGRAM(Cell)
//
// Threads: declare(), start() and stop() are called on the service side, never during a scan; a task function runs on the
// task's thread, one at a time. A program is trusted native code: an endless loop in it stops the bus, and the drives'
// watchdogs are the reaction.

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "axes/axis/motion_context.hpp"
#include "core/alarm.hpp"
#include "core/process_image.hpp"

namespace taktwerk {

using axes::AxisRef;

/// Named points of the machine, resolved when the program is loaded. Read and written through the TaskContext, so that a
/// slower task sees its latched values.
template <class T>
struct Input {
    std::uint16_t index = 0xFFFF;
};
template <class T>
struct Output {
    std::uint16_t index = 0xFFFF;
};
/// A value that the operator may change while the program runs (range-checked by the runtime), constant within a scan.
struct Parameter {
    std::uint16_t index = 0xFFFF;
};

struct ParameterSpec {
    double value = 0;
    double minimum = 0, maximum = 0;
    std::string_view unit;
    std::string_view doc;
};

/// Types of monitored variables.
enum class VariableType : std::uint8_t { boolean, int32, int64, uint16, uint32, real, duration };

/// What a task function is handed: the motion context (time, axis views, requests) plus the task's own view of I/O points and
/// parameters. Real-time safe throughout. Lives as long as the call.
class TaskContext : public axes::MotionContext {
public:
    [[nodiscard]] bool get(Input<bool> point) const noexcept { return inputs[point.index] != 0; }
    [[nodiscard]] std::int64_t get(Input<std::int64_t> point) const noexcept { return inputs[point.index]; }
    [[nodiscard]] bool get(Output<bool> point) const noexcept { return outputs[point.index] != 0; }
    void set(Output<bool> point, bool value) noexcept { outputs[point.index] = value ? 1 : 0; }
    void set(Output<std::int64_t> point, std::int64_t value) noexcept { outputs[point.index] = value; }
    [[nodiscard]] double get(Parameter parameter) const noexcept { return parameters[parameter.index]; }

    /// Raises the program's alarm `number` (0..63) for as long as `active` holds; texts come from Declaration::alarm.
    void alarm(std::uint8_t number, bool active) noexcept {
        const auto bit = std::uint64_t{1} << (number & 63u);
        alarms = active ? (alarms | bit) : (alarms & ~bit);
    }

    // Filled by the runtime, one value per declared point of the whole machine, indexed by the handles.
    std::span<const std::int64_t> inputs;
    std::span<std::int64_t> outputs;
    std::span<const double> parameters;
    std::uint64_t alarms = 0;
    bool first_scan = false;   ///< first call after start
};

/// Collects what a program needs. A name that the configuration lacks is an error that names it and the nearest one;
/// handles stay invalid then, and the program is not started.
class Declaration {
public:
    using TaskFunction = void (*)(void* program, TaskContext& context);

    virtual AxisRef axis(std::string_view name) = 0;
    virtual Input<bool> input(std::string_view name) = 0;
    virtual Output<bool> output(std::string_view name) = 0;
    virtual Input<std::int64_t> input_word(std::string_view name) = 0;
    virtual Output<std::int64_t> output_word(std::string_view name) = 0;
    virtual Parameter parameter(std::string_view name, const ParameterSpec& spec) = 0;
    /// `number` 0..63; reaction as in core/alarm.hpp.
    virtual void alarm(std::uint8_t number, Reaction reaction, std::string_view english, std::string_view chinese,
                       std::string_view remedy) = 0;

    void monitor(std::string_view name, const bool& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::boolean, &v, unit, doc); }
    void monitor(std::string_view name, const std::int32_t& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::int32, &v, unit, doc); }
    void monitor(std::string_view name, const std::int64_t& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::int64, &v, unit, doc); }
    void monitor(std::string_view name, const std::uint16_t& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::uint16, &v, unit, doc); }
    void monitor(std::string_view name, const std::uint32_t& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::uint32, &v, unit, doc); }
    void monitor(std::string_view name, const double& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::real, &v, unit, doc); }
    void monitor(std::string_view name, const Duration& v, std::string_view unit = {}, std::string_view doc = {}) { add(name, VariableType::duration, &v, unit, doc); }

    /// A task by the name under which the configuration schedules it: `d.task<&Cell::scan>("main")`.
    template <auto Method>
    void task(std::string_view name) {
        add_task(name, &call<Method>);
    }

protected:
    ~Declaration() = default;
    virtual void add(std::string_view name, VariableType type, const void* address, std::string_view unit, std::string_view doc) = 0;
    virtual void add_task(std::string_view name, TaskFunction function) = 0;

private:
    template <class P>
    struct Class;
    template <class P>
    struct Class<void (P::*)(TaskContext&)> {
        using type = P;
    };
    template <auto Method>
    static void call(void* program, TaskContext& context);
};

class Program {
public:
    virtual ~Program() = default;
    /// Called once after loading. Names are resolved here.
    virtual void declare(Declaration& declaration) = 0;
    /// The operator started the program (also after a fault was reset): put the sequence to its beginning.
    virtual void start() {}
    virtual void stop() {}
};

template <auto Method>
void Declaration::call(void* program, TaskContext& context) {
    using P = typename Class<decltype(Method)>::type;
    (static_cast<P*>(static_cast<Program*>(program))->*Method)(context);
}

}  // namespace taktwerk
