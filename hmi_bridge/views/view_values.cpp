#include "hmi_bridge/views/view_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace taktwerk::hmi {

namespace {

using Form = ViewValue::Form;
using Source = ViewValue::Source;

/// What of an axis, by its key in `state`. `unit`: u stands for that of the axis.
struct AxisMember {
    std::string_view key;
    Form form;
    std::string_view unit;
    bool recorded;
};
constexpr std::array<AxisMember, 20> axis_members{{
    {"actual_position", Form::number, "u", true},
    {"set_position", Form::number, "u", true},
    {"target_position", Form::number, "u", true},
    {"actual_velocity", Form::number, "u/s", true},
    {"set_velocity", Form::number, "u/s", true},
    {"set_acceleration", Form::number, "u/s2", true},
    {"following_error", Form::number, "u", true},
    {"actual_torque", Form::number, "", true},
    {"override", Form::number, "", false},
    {"turns", Form::number, "", false},
    {"powered", Form::flag, "", false},
    {"homed", Form::flag, "", true},
    {"in_position", Form::flag, "", false},
    {"has_job", Form::flag, "", false},
    {"online", Form::flag, "", false},
    {"negative_limit_switch", Form::flag, "", false},
    {"positive_limit_switch", Form::flag, "", false},
    {"home_switch", Form::flag, "", false},
    {"warning", Form::flag, "", false},
    {"state", Form::word, "", false},
}};

void add_axis(ViewValues& out, const runtime::AxisBinding& binding) {
    const auto& axis = binding.axis;
    out.axes.push_back(axis.name);
    for (const auto& member : axis_members) {
        ViewValue value;
        value.name = axis.name + "." + std::string(member.key);
        value.source = Source::axis;
        value.of = axis.name;
        value.member = member.key;
        value.form = member.form;
        value.unit = member.unit.starts_with('u') ? axis.unit + std::string(member.unit.substr(1)) : std::string(member.unit);
        value.recorded = member.recorded;
        const auto range = [&](double low, double high) {
            if (std::isfinite(low) && std::isfinite(high) && low < high) value.minimum = low, value.maximum = high;
        };
        if (member.key.ends_with("_position")) range(axis.limits.position_min, axis.limits.position_max);
        if (member.key.ends_with("_velocity")) range(-axis.limits.velocity, axis.limits.velocity);
        if (member.key == "override") range(0, 1);
        out.all.push_back(std::move(value));
    }
}

void add_point(ViewValues& out, const runtime::IoPoint& point) {
    const bool input = point.direction == runtime::IoDirection::input;
    ViewValue value;
    value.name = (input ? "in." : "out.") + point.name;
    value.source = input ? Source::input : Source::output;
    value.of = point.name;
    value.unit = point.unit;
    out.all.push_back(std::move(value));
}

void add_machine(ViewValues& out) {
    for (const auto& [key, form] : {std::pair{"mode", Form::word}, std::pair{"phase", Form::word}, std::pair{"emergency_stop", Form::flag},
                                    std::pair{"alarms", Form::number}}) {
        ViewValue value;
        value.name = std::string("machine.") + key;
        value.member = key;
        value.form = form;
        value.recorded = false;
        out.all.push_back(std::move(value));
    }
}

void add_variables(ViewValues& out, const runtime::MachineLayout& layout) {
    for (const auto& variable : layout.variables) {
        ViewValue value;
        value.name = variable.program + "." + variable.name;
        value.source = Source::variable;
        value.of = variable.program;
        value.member = variable.name;
        value.form = variable.type == VariableType::boolean ? Form::flag : Form::number;
        value.unit = variable.type == VariableType::duration && variable.unit.empty() ? "s" : variable.unit;
        value.whole = variable.whole();
        value.writable = variable.writable;
        value.momentary = variable.momentary;
        if (variable.writable) value.minimum = variable.minimum, value.maximum = variable.maximum;
        out.all.push_back(std::move(value));
    }
    for (const auto& parameter : layout.parameters) {
        ViewValue value;
        value.name = parameter.program + "." + parameter.name;
        value.source = Source::parameter;
        value.of = parameter.program;
        value.member = parameter.name;
        value.unit = parameter.unit;
        value.whole = parameter.whole;
        value.writable = true;
        value.minimum = parameter.minimum, value.maximum = parameter.maximum;
        value.recorded = false;
        out.all.push_back(std::move(value));
    }
}

}  // namespace

const ViewValue* ViewValues::find(std::string_view name) const noexcept {
    const auto found = std::ranges::find(all, name, &ViewValue::name);
    return found == all.end() ? nullptr : &*found;
}

bool ViewValues::of_program(std::string_view name) const noexcept {
    const auto dot = name.find('.');
    return dot != std::string_view::npos && std::ranges::find(programs, name.substr(0, dot)) != programs.end();
}

ViewValues view_values_of(const runtime::MachineConfig& config) {
    ViewValues out;
    for (const auto& binding : config.axes) add_axis(out, binding);
    for (const auto& point : config.io) add_point(out, point);
    add_machine(out);
    for (const auto& program : config.programs) out.programs.push_back(program.name);
    return out;
}

ViewValues view_values_of(const runtime::MachineConfig& config, const runtime::MachineLayout& layout) {
    auto out = view_values_of(config);
    add_variables(out, layout);
    out.with_programs = true;
    return out;
}

std::string_view word(Source source) noexcept {
    switch (source) {
        case Source::axis: return "axis";
        case Source::input: return "input";
        case Source::output: return "output";
        case Source::variable: return "variable";
        case Source::parameter: return "parameter";
        case Source::machine: break;
    }
    return "machine";
}

}  // namespace taktwerk::hmi
