#pragma once
// Every value of a machine that a page of its builder can show or write, by name: "pick_and_place.pieces", "x.actual_position",
// "in.door_closed", "out.lamp", "machine.mode". The names are those of the recorder's signals where it has the value. Not real-time.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/machine_config.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

struct ViewValue {
    enum class Source : std::uint8_t { axis, input, output, variable, parameter, machine };
    enum class Form : std::uint8_t { number, flag, word };
    std::string name;
    Source source = Source::machine;
    std::string of;      ///< the axis, the point, the program
    std::string member;  ///< of an axis, a program, the machine: the key in `state`
    Form form = Form::number;
    std::string unit{};
    std::optional<double> minimum{}, maximum{};  ///< where it has a range of its own
    bool whole = false;
    bool writable = false;   ///< by people
    bool momentary = false;  ///< a button
    bool recorded = true;    ///< a trend can show it
};

struct ViewValues {
    std::vector<ViewValue> all;
    std::vector<std::string> axes, programs;
    bool with_programs = false;  ///< false: what programs have is not known yet, and nothing is said of it

    [[nodiscard]] const ViewValue* find(std::string_view name) const noexcept;
    /// Of a program: "feeder.length".
    [[nodiscard]] bool of_program(std::string_view name) const noexcept;
};

/// As far as a configuration knows them.
[[nodiscard]] ViewValues view_values_of(const runtime::MachineConfig& config);
/// All of them.
[[nodiscard]] ViewValues view_values_of(const runtime::MachineConfig& config, const runtime::MachineLayout& layout);

/// The word in JSON: "axis", "input", ...
[[nodiscard]] std::string_view word(ViewValue::Source source) noexcept;

}  // namespace taktwerk::hmi
