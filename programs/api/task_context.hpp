#pragma once
// What a program sees in a scan: its points, its parameters, its alarms. FROZEN SHAPE (extend additively); the ABI hash of
// programs/api/abi.hpp guards it.

#include <cmath>
#include <cstdint>
#include <span>

#include "axes/axis/motion_context.hpp"
#include "core/point_line.hpp"
#include "core/process_image.hpp"
#include "programs/api/task_info.hpp"

namespace taktwerk {

/// Named points of the machine, resolved when the program is loaded. Read and written through the TaskContext, so that a
/// slower task sees its latched values. `bool`: FALSE is 0, everything else TRUE; `std::int64_t`: the value as the terminal
/// gives it (sign-extended where the object is signed), without scaling; `double`: in the unit that the machine file gives the point.
///
/// A handle that was never declared, or whose name the machine lacks, is unresolved (0xFFFF): reads give 0 and FALSE, writes do
/// nothing. A program with an unresolved name is not started; the use of a handle that was forgotten in declare() is told while the
/// program runs (alarm undeclared_use).
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

/// What a task function is handed: the motion context (time, axis views, requests) plus the task's own view of I/O points and
/// parameters. Real-time safe throughout. Lives as long as the call: keep no reference to it.
///
/// `tables` holds the declared tables; a task edits only its own program's, and a program with several tasks each table in one task only.
/// In a slower task a table must rest while a command that names it waits for its turn: the axis reads it when that begins.
class TaskContext : public axes::MotionContext {
public:
    [[nodiscard]] bool get(Input<bool> point) const noexcept { return value_at(inputs, point.index) != 0; }
    [[nodiscard]] std::int64_t get(Input<std::int64_t> point) const noexcept { return value_at(inputs, point.index); }
    /// What was last written to it, by whomever.
    [[nodiscard]] bool get(Output<bool> point) const noexcept { return value_at(outputs, point.index) != 0; }
    [[nodiscard]] std::int64_t get(Output<std::int64_t> point) const noexcept { return value_at(outputs, point.index); }
    /// In the unit of the point, filtered where the machine file says so.
    [[nodiscard]] double get(Input<double> point) const noexcept { return value_at(input_values, point.index).value; }
    [[nodiscard]] double get(Output<double> point) const noexcept {
        const auto raw = value_at(outputs, point.index);
        return point.index < output_lines.size() ? output_lines[point.index].value_of(raw) : 0;
    }
    /// Whether an input can be believed: its slave was exchanged, its terminal reports no error (wire break, out of range), it lies within
    /// the limits that the machine file gives it.
    template <class T>
    [[nodiscard]] bool good(Input<T> point) const noexcept {
        return value_at(input_values, point.index).good;
    }
    /// An output keeps its value until it is written again; while no program runs it has its safe value.
    void set(Output<bool> point, bool value) noexcept { write(point.index, value ? 1 : 0); }
    /// The low bits that the terminal has are sent; the rest is cut off.
    void set(Output<std::int64_t> point, std::int64_t value) noexcept { write(point.index, value); }
    /// In the unit of the point; what its terminal cannot hold becomes the nearest that it can. What is no number (NaN, infinity) is not
    /// written: the output keeps its value, and the alarm output_no_number says so.
    void set(Output<double> point, double value) noexcept {
        if (!std::isfinite(value)) undeclared = {Undeclared::What::not_a_number, 0};
        else write(point.index, point.index < output_lines.size() ? output_lines[point.index].raw_of(value) : 0);
    }
    /// What is known of this task: how often it ran, how long that took, how late it was.
    [[nodiscard]] const TaskInfo& task() const noexcept {
        task_asked = true;
        return *task_info;
    }
    [[nodiscard]] double get(Parameter parameter) const noexcept { return value_at(parameters, parameter.index); }

    /// Raises the program's alarm `number` (0..63) for as long as `active` holds; texts come from Declaration::alarm. Any other number
    /// raises nothing but the alarm undeclared_use, which names it.
    void alarm(std::uint8_t number, bool active) noexcept {
        if (number > 63) {
            if (active) undeclared = {Undeclared::What::alarm, number};
            return;
        }
        const auto bit = std::uint64_t{1} << number;
        alarms = active ? (alarms | bit) : (alarms & ~bit);
    }

    // Filled by the runtime, indexed by the handles.
    std::span<const double> parameters;
    std::span<const PointValue> input_values;
    std::span<const PointLine> output_lines;
    std::uint64_t alarms = 0;
    bool first_scan = false;  ///< first call after start
    /// Something that was used and never declared: read by the runtime after the scan.
    struct Undeclared {
        enum class What : std::uint8_t { nothing, point, alarm, not_a_number } what = What::nothing;
        std::uint8_t number = 0;  ///< of the alarm
    };
    mutable Undeclared undeclared;
    const TaskInfo* task_info = &no_info;
    mutable bool task_asked = false;  ///< task() was called: what it says of times goes into a recording

private:
    static constexpr TaskInfo no_info{};
    template <class T>
    [[nodiscard]] T value_at(std::span<const T> values, std::uint16_t index) const noexcept {
        if (index < values.size()) return values[index];
        undeclared = {Undeclared::What::point, 0};
        return T{};
    }
    [[nodiscard]] std::int64_t value_at(std::span<std::int64_t> values, std::uint16_t index) const noexcept {
        return value_at(std::span<const std::int64_t>(values), index);
    }
    void write(std::uint16_t index, std::int64_t value) noexcept {
        if (index < outputs.size()) outputs[index] = value;
        else undeclared = {Undeclared::What::point, 0};
    }
};

}  // namespace taktwerk
