#include "hmi_bridge/modbus/shown_value.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/nearest_name.hpp"

namespace taktwerk::hmi {

namespace {

using modbus::server::NumberType;
using modbus::server::ServedRegister;
using Of = ShownValue::Of;
using What = ShownValue::What;
using Named = ShownNames::Named;

constexpr std::array<std::pair<What, std::string_view>, 19> words{{
    {What::value, "value"},
    {What::good, "good"},
    {What::position, "position"},
    {What::velocity, "velocity"},
    {What::set_position, "set_position"},
    {What::set_velocity, "set_velocity"},
    {What::torque, "torque"},
    {What::following_error, "following_error"},
    {What::state, "state"},
    {What::error, "error"},
    {What::powered, "powered"},
    {What::homed, "homed"},
    {What::in_position, "in_position"},
    {What::alarm, "alarm"},
    {What::heartbeat, "heartbeat"},
    {What::phase, "phase"},
    {What::mode, "mode"},
    {What::emergency_stop, "emergency_stop"},
    {What::alarms, "alarms"},
}};

/// Of `max_age`: one that is under way, one that is late, and what the way to the client takes.
constexpr int least_cycles = 3;

/// The key of a point that names such a value.
std::string_view key_of(Of of) noexcept {
    switch (of) {
        case Of::machine: return "machine";
        case Of::input: return "input";
        case Of::output: return "output";
        case Of::axis: return "axis";
        case Of::variable: return "variable";
        case Of::parameter: return "parameter";
        case Of::none: break;
    }
    return "";
}

const std::vector<Named>* list_of(Of of, const ShownNames& names) noexcept {
    switch (of) {
        case Of::input: return &names.inputs;
        case Of::output: return &names.outputs;
        case Of::axis: return &names.axes;
        case Of::variable: return &names.variables;
        case Of::parameter: return &names.parameters;
        case Of::machine:
        case Of::none: break;
    }
    return nullptr;
}

bool of_program(Of of) noexcept { return of == Of::variable || of == Of::parameter; }

bool fits(Of of, What what) noexcept {
    switch (what) {
        case What::value: return of == Of::input || of == Of::output || of_program(of);
        case What::good: return of == Of::input;
        case What::alarm: return of == Of::axis || of == Of::machine;
        case What::heartbeat:
        case What::phase:
        case What::mode:
        case What::emergency_stop:
        case What::alarms: return of == Of::machine;
        default: return of == Of::axis;
    }
}

/// 0 or 1, whatever it is of.
bool is_flag(What what) noexcept {
    return what == What::good || what == What::powered || what == What::homed || what == What::in_position || what == What::alarm ||
           what == What::emergency_stop;
}

/// Of the machine and its axes: what has more than two values. A heartbeat may be a bit that changes.
bool is_number(const ShownValue& value) noexcept {
    return value.what == What::state || value.what == What::error || value.what == What::phase || value.what == What::mode ||
           value.what == What::alarms || value.what == What::torque;
}

std::string unit_of(What what, const std::string& unit) {
    if (what == What::velocity || what == What::set_velocity) return unit.empty() ? unit : unit + "/s";
    if (what == What::value || what == What::position || what == What::set_position || what == What::following_error) return unit;
    return {};
}

std::string listed(const std::vector<std::string>& all) {
    std::string out;
    for (const auto& one : all) out += (out.empty() ? "" : ", ") + one;
    return out.empty() ? "none" : out;
}

std::string_view name_of(modbus::server::Table table) noexcept {
    using modbus::server::Table;
    switch (table) {
        case Table::coil: return "coil";
        case Table::discrete_input: return "discrete input";
        case Table::holding: return "holding register";
        case Table::input: break;
    }
    return "input register";
}

/// What a register of this type tells apart.
std::pair<double, double> range_of(NumberType type) noexcept {
    switch (type) {
        case NumberType::boolean: return {0, 1};
        case NumberType::uint16: return {0, 0xFFFF};
        case NumberType::int16: return {-0x8000, 0x7FFF};
        case NumberType::uint32: return {0, 0xFFFF'FFFF};
        case NumberType::int32: return {-0x8000'0000LL, 0x7FFF'FFFF};
        case NumberType::float32: break;
    }
    constexpr double most = std::numeric_limits<float>::max();
    return {-most, most};
}

class PointCheck {
public:
    PointCheck(const ModbusServerConfig& config, const ShownNames& names) : config_(config), names_(names) {}

    std::vector<Error> run() {
        if (!names_.with_programs) server();
        for (const auto& point : config_.points) {
            if (!names_.with_programs) {
                overlaps(point);
                access(point);
            }
            if (of_program(point.shows.of) == names_.with_programs) value(point);
        }
        return std::move(errors_);
    }

private:
    void add(std::string code, const ModbusPoint& point, std::string_view key, std::string what, std::string remedy) {
        auto subject =
            names_.with_programs && !point.where.empty() ? point.where : fmt::format("modbus_server.points.{}.{}", point.place.name, key);
        errors_.push_back({std::move(code), std::move(subject), std::move(what), std::move(remedy)});
    }

    void server() {
        const auto& server = config_.server;
        if (server.unit == 0 || server.unit > 247)
            errors_.push_back({"served.unit", "modbus_server.unit", fmt::format("{} is no unit of a server", server.unit),
                               "use 1 to 247; 0 and 255 are answered besides"});
        if (server.max_age < least_cycles * names_.cycle)
            errors_.push_back(
                {"served.max_age", "modbus_server.max_age",
                 fmt::format("a cycle is {:g} ms: what it says would be too old before the next one has said anything",
                             to_seconds(names_.cycle) * 1e3),
                 fmt::format("use {:g} ms at least, {} cycles", to_seconds(least_cycles * names_.cycle) * 1e3, least_cycles)});
        if (config_.points.empty())
            errors_.push_back({"served.nothing", "modbus_server.points", "nothing is offered", "name a point, or remove `modbus_server`"});
    }

    void overlaps(const ModbusPoint& point) {
        for (const auto& other : config_.points) {
            if (&other == &point) return;
            if (!modbus::server::overlap(other.place, point.place)) continue;
            const auto both = std::max(other.place.address, point.place.address);
            return add("served.overlap", point, "address",
                       fmt::format("'{}' has {} {} already", other.place.name, name_of(point.place.table), both),
                       fmt::format("use an address from {} on, or another table", end_of(other.place)));
        }
    }

    /// Who may write.
    void access(const ModbusPoint& point) {
        const auto& place = point.place;
        if (!place.writable) return;
        if (!is_writable(place.table))
            add("served.read_only", point, "writable", fmt::format("clients cannot write {}s", name_of(place.table)),
                is_bits(place.table) ? "use `table: coil`" : "use `table: holding`");
        if (place.type == NumberType::boolean && !is_bits(place.table))
            add("served.bit_written", point, "writable",
                "one bit of a register cannot be written alone: the others would be written with it", "use a coil");
        if (point.shows.of != Of::output && point.shows.of != Of::parameter)
            add("served.not_commanded", point, "writable",
                fmt::format("nobody commands {}: it is what the machine says", text_of(point.shows)),
                "remove `writable`; outputs and parameters of programs may have it");
    }

    void value(const ModbusPoint& point) {
        const auto key = key_of(point.shows.of);
        if (!fits(point.shows.of, point.shows.what)) {
            std::vector<std::string> all;
            for (const auto& [what, text] : words)
                if (fits(point.shows.of, what)) all.emplace_back(text);
            return add("served.shows", point, point.shows.of == Of::machine ? "machine" : "shows",
                       fmt::format("{} has no `{}`", key == "machine" ? "the machine" : fmt::format("an {}", key), word(point.shows.what)),
                       fmt::format("choose one of {}", listed(all)));
        }
        const auto bound = bind(point.shows, names_);
        if (!bound) return unknown(point, key);
        scale(point, *bound);
        const auto& place = point.place;
        if (place.type == NumberType::boolean && is_number(point.shows))
            add("served.type", point, is_bits(place.table) ? "table" : "type",
                fmt::format("{} is a number: of a bit all but 0 would be the same", text_of(point.shows)),
                "use a table of registers, and a type such as uint16");
        else if (place.type == NumberType::boolean && !bound->unit.empty())
            add("served.type", point, is_bits(place.table) ? "table" : "type",
                fmt::format("{} is a number in {}: a bit does not hold it", text_of(point.shows), bound->unit),
                "use a table of registers, and a type such as float32");
        if (place.writable && point.shows.of == Of::output && !names_.outputs[bound->index].by_hand)
            add("served.not_commanded", point, "writable",
                fmt::format("output {} belongs to an axis or a serial line: nobody sets it by hand", point.shows.name),
                "remove `writable`");
    }

    void unknown(const ModbusPoint& point, std::string_view key) {
        std::vector<std::string> all;
        if (const auto* list = list_of(point.shows.of, names_))
            for (const auto& one : *list) all.push_back(one.name);
        const auto near = nearest_name(point.shows.name, all);
        add("served.unknown_name", point, key, fmt::format("there is no {} '{}' (there is: {})", key, point.shows.name, listed(all)),
            near.empty() ? "correct the name" : fmt::format("did you mean `{}`?", near));
    }

    void scale(const ModbusPoint& point, const BoundValue& bound) {
        if (!point.scaled) return;
        if (is_flag(point.shows.what) || point.shows.what == What::heartbeat)
            return add("served.scale", point, "scale", fmt::format("{} has no scale", text_of(point.shows)), "remove `scale`");
        if (point.place.type == NumberType::boolean) return add("served.scale", point, "scale", "a bit has no scale", "remove `scale`");
        if (point.unit != bound.unit)
            return add(
                "served.scale", point, "scale",
                fmt::format("{} is {}, and `from` {}", text_of(point.shows), bound.unit.empty() ? "without a unit" : "in " + bound.unit,
                            point.unit.empty() ? "has none" : "is in " + point.unit),
                bound.unit.empty() ? "write `from` as two bare numbers"
                                   : fmt::format("write `from` in {0}, such as `from: [0 {0}, 100 {0}]`", bound.unit));
        if (!std::isfinite(point.factor) || point.factor == 0 || !std::isfinite(point.offset))
            add("served.scale", point, "scale", "the scale is no finite line", "give two different values in `from` and in `to`");
        const auto held = range_of(point.place.type);
        if (std::min(point.register_low, point.register_high) < held.first ||
            std::max(point.register_low, point.register_high) > held.second)
            add("served.scale", point, "scale",
                fmt::format("`to` goes beyond what the register holds: {:.0f} to {:.0f}", held.first, held.second),
                "choose a wider type, such as int32 or float32, or a narrower `to`");
    }

    const ModbusServerConfig& config_;
    const ShownNames& names_;
    std::vector<Error> errors_;
};

double wrapped(std::uint64_t count, NumberType type) noexcept {
    switch (type) {
        case NumberType::boolean: return static_cast<double>(count % 2);
        case NumberType::uint16: return static_cast<double>(count % 0x10000);
        case NumberType::int16: return static_cast<double>(count % 0x8000);
        case NumberType::uint32: return static_cast<double>(count % 0x1'0000'0000);
        case NumberType::int32: return static_cast<double>(count % 0x8000'0000);
        case NumberType::float32: break;
    }
    return static_cast<double>(count % 0x100'0000);  // beyond 24 bits a float skips numbers
}

std::size_t standing(const runtime::Snapshot& snapshot, const std::optional<std::uint16_t>& axis) noexcept {
    std::size_t count = 0;
    for (std::size_t i = 0; i < snapshot.alarm_count; ++i) {
        const auto& alarm = snapshot.alarms[i];
        count += alarm.standing && (!axis || (alarm.fact.source == AlarmSource::axis && alarm.fact.index == *axis)) ? 1 : 0;
    }
    return count;
}

double of_axis(What what, std::uint16_t index, const runtime::Snapshot& snapshot) noexcept {
    const auto& axis = snapshot.axes[index];
    switch (what) {
        case What::position: return axis.actual_position;
        case What::velocity: return axis.actual_velocity;
        case What::set_position: return axis.set_position;
        case What::set_velocity: return axis.set_velocity;
        case What::torque: return axis.actual_torque;
        case What::following_error: return axis.following_error;
        case What::state: return static_cast<double>(axis.state);
        case What::error: return axis.error;
        case What::powered: return axis.powered ? 1 : 0;
        case What::homed: return axis.homed ? 1 : 0;
        case What::in_position: return axis.in_position ? 1 : 0;
        case What::alarm: return standing(snapshot, index) > 0 ? 1 : 0;
        default: return 0;
    }
}

double of_machine(What what, NumberType type, const runtime::Snapshot& snapshot) noexcept {
    switch (what) {
        case What::heartbeat: return wrapped(snapshot.cycle, type);
        case What::phase: return static_cast<double>(snapshot.phase);
        case What::mode: return static_cast<double>(snapshot.mode);
        case What::emergency_stop: return snapshot.emergency_stop ? 1 : 0;
        case What::alarm: return standing(snapshot, std::nullopt) > 0 ? 1 : 0;
        case What::alarms: return static_cast<double>(standing(snapshot, std::nullopt));
        default: return 0;
    }
}

/// Outputs that the machine itself drives, whoever commands.
bool is_its_own(const runtime::MachineConfig& config, const std::string& output) {
    for (const auto& binding : config.axes) {
        if (binding.brake_output == output) return true;
        if (binding.analog && (binding.analog->setpoint == output || binding.analog->enable == output || binding.analog->reset == output))
            return true;
    }
    for (const auto& line : config.serial)
        for (const auto& entry : line.drives)
            if (entry.watchdog_output == output) return true;
    return false;
}

}  // namespace

std::string_view word(What what) noexcept {
    return std::ranges::find(words, what, [](const auto& w) { return w.first; })->second;
}

std::string text_of(const ShownValue& value) {
    if (value.of == Of::machine) return std::string(word(value.what));
    auto out = fmt::format("{} {}", key_of(value.of), value.name);
    if (value.what != What::value) out += fmt::format(" {}", word(value.what));
    return out;
}

ShownNames names_of(const runtime::MachineConfig& config) {
    ShownNames out;
    out.cycle = config.cycle;
    for (const auto& binding : config.axes) out.axes.push_back({binding.axis.name, binding.axis.unit});
    for (const auto& point : config.io) {
        if (point.direction == runtime::IoDirection::input) out.inputs.push_back({point.name, point.unit});
        else out.outputs.push_back({point.name, point.unit, !is_its_own(config, point.name)});
    }
    return out;
}

ShownNames names_of(const runtime::MachineLayout& layout) {
    ShownNames out;
    const auto unit = [](const std::vector<std::string>& units, std::size_t i) { return i < units.size() ? units[i] : std::string{}; };
    for (const auto& axis : layout.axes) out.axes.push_back({axis.name, axis.unit});
    for (std::size_t i = 0; i < layout.inputs.size(); ++i) out.inputs.push_back({layout.inputs[i], unit(layout.input_units, i)});
    for (std::size_t i = 0; i < layout.outputs.size(); ++i) out.outputs.push_back({layout.outputs[i], unit(layout.output_units, i)});
    for (const auto& one : layout.variables) out.variables.push_back({one.program + "." + one.name, one.unit});
    for (const auto& one : layout.parameters) out.parameters.push_back({one.program + "." + one.name, one.unit});
    out.cycle = layout.cycle;
    out.with_programs = true;
    return out;
}

std::optional<BoundValue> bind(const ShownValue& value, const ShownNames& names) {
    if (value.of == Of::machine) return BoundValue{value.of, value.what, 0, {}};
    const auto* list = list_of(value.of, names);
    if (list == nullptr) return std::nullopt;
    const auto found = std::ranges::find(*list, value.name, &Named::name);
    if (found == list->end()) return std::nullopt;
    return BoundValue{value.of, value.what, static_cast<std::uint16_t>(found - list->begin()), unit_of(value.what, found->unit)};
}

std::vector<Error> check(const ModbusServerConfig& config, const ShownNames& names) { return PointCheck{config, names}.run(); }

double value_of(const BoundValue& value, const ServedRegister& place, const runtime::Snapshot& snapshot) noexcept {
    switch (value.of) {
        case Of::machine: return of_machine(value.what, place.type, snapshot);
        case Of::input:
            if (value.what == What::good) return snapshot.input_values[value.index].good ? 1 : 0;
            return snapshot.input_values[value.index].value;
        case Of::output: return snapshot.output_values[value.index];
        case Of::axis: return of_axis(value.what, value.index, snapshot);
        case Of::variable: return snapshot.variables[value.index];
        case Of::parameter: return snapshot.parameters[value.index];
        case Of::none: break;
    }
    return 0;
}

}  // namespace taktwerk::hmi
