#include "runtime/tasks/program_host.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "axes/tables/cam_check.hpp"
#include "core/nearest_name.hpp"
#include "runtime/present_slaves.hpp"
#include "runtime/retain/kept_names.hpp"
#include "runtime/retain/kept_text.hpp"
#include "runtime/retain/value_type.hpp"

namespace taktwerk::runtime {

/// Answers a program's declarations from the configuration and notes every problem.
class ProgramHost::Collector final : public Declaration {
public:
    Collector(ProgramHost& host, const MachineConfig& config, const IoImage& io, axes::MotionTables& tables, std::size_t program,
              std::vector<Error>& errors)
        : host_(host), config_(config), io_(io), tables_(tables), program_(program), errors_(errors) {}

    AxisRef axis(std::string_view name) override {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < config_.axes.size(); ++i) {
            if (config_.axes[i].axis.name == name) {
                const auto known = std::any_of(host_.axis_uses_.begin(), host_.axis_uses_.end(),
                                               [&](const AxisUse& use) { return use.program == program_ && use.axis == i; });
                if (!known) host_.axis_uses_.push_back({program_, i});
                return AxisRef{static_cast<std::uint16_t>(i)};
            }
            names.push_back(config_.axes[i].axis.name);
        }
        unknown("program.unknown_axis", "axis", name, names, "axes");
        return {};
    }
    axes::GroupRef axis_group(std::string_view name) override {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < config_.axis_groups.size(); ++i) {
            const auto& group = config_.axis_groups[i];
            if (group.name == name) {
                for (const auto& member : group.members) (void)axis(member);  // it moves them
                return {static_cast<std::uint16_t>(i)};
            }
            names.push_back(group.name);
        }
        unknown("program.unknown_axis_group", "group of axes", name, names, "axis_groups");
        return {};
    }
    axes::PathRef path(std::string_view name) override {
        std::vector<std::string> names;
        for (std::size_t i = 0; i < config_.paths.size(); ++i) {
            if (config_.paths[i].name == name) return {static_cast<std::uint16_t>(i)};
            names.push_back(config_.paths[i].name);
        }
        unknown("program.unknown_path", "path", name, names, "paths");
        return {};
    }
    DeviceRef device(std::string_view name) override {
        std::vector<std::string> names;
        const auto slaves = present_slaves(config_);
        for (std::size_t i = 0; i < slaves.size(); ++i) {
            if (slaves[i].name == name) return DeviceRef{static_cast<std::uint16_t>(i)};
            names.push_back(slaves[i].name);
        }
        unknown("program.unknown_device", "slave", name, names, "bus.slaves");
        return {};
    }
    Input<bool> input(std::string_view name) override { return {point(IoDirection::input, name)}; }
    Output<bool> output(std::string_view name) override { return {point(IoDirection::output, name)}; }
    Input<std::int64_t> input_word(std::string_view name) override { return {point(IoDirection::input, name)}; }
    Output<std::int64_t> output_word(std::string_view name) override { return {point(IoDirection::output, name)}; }

    Parameter parameter(std::string_view name, const ParameterSpec& spec) override {
        const auto& program = config_.programs[program_];
        once(parameter_names_, name, "parameter");
        double value = spec.value;
        if (!(spec.minimum <= spec.value && spec.value <= spec.maximum))
            problem(
                "program.parameter_range",
                fmt::format("parameter '{}' has default {} outside its own range {} to {}", name, spec.value, spec.minimum, spec.maximum),
                "correct the declaration in the program");
        const bool whole = spec.kind == ParameterKind::whole;
        const auto is_whole = [](double number) { return number == std::floor(number); };
        if (whole && !(is_whole(spec.value) && is_whole(spec.minimum) && is_whole(spec.maximum)))
            problem("program.parameter_range",
                    fmt::format("parameter '{}' takes whole numbers, and its default {} or its range {} to {} has others", name, spec.value,
                                spec.minimum, spec.maximum),
                    "correct the declaration in the program");
        for (const auto& set : program.parameters) {
            if (set.name != name) continue;
            const auto given = value_of(set, spec.unit);
            if (!given)
                problem("program.parameter_unit",
                        fmt::format("parameter '{}' = {} is told in another unit: the program takes {}", name, set.text,
                                    spec.unit.empty() ? std::string_view("a number without a unit") : spec.unit),
                        fmt::format("write it as `{}: {}{}{}`", name, spec.value, spec.unit.empty() ? "" : " ", spec.unit));
            else if (!(spec.minimum <= *given && *given <= spec.maximum))
                problem("program.parameter_range",
                        fmt::format("parameter '{}' = {} {} is outside {} to {}", name, *given, spec.unit, spec.minimum, spec.maximum),
                        "choose a value inside the range");
            else if (whole && !is_whole(*given))
                problem("program.parameter_range",
                        fmt::format("parameter '{}' = {} is not a whole number, and the program counts with it", name, *given),
                        fmt::format("write {} or {}", std::floor(*given), std::ceil(*given)));
            else value = *given;
        }
        host_.parameters_.push_back(value);
        host_.parameter_info_.push_back(
            {program.name, std::string(name), std::string(spec.unit), std::string(spec.doc), spec.minimum, spec.maximum, value, whole});
        parameter_names_.emplace_back(name);
        return {static_cast<std::uint16_t>(host_.parameters_.size() - 1)};
    }

    axes::CamRef cam(std::string_view name, std::span<const axes::CamPoint> points, std::size_t room) override {
        if (const auto why = unusable(points); !why.empty()) bad_table("cam", name, why);
        return tables_.add_cam(points, room);
    }
    axes::CamRef cam(std::string_view name) override {
        std::vector<std::string> names;
        for (const auto& known : config_.cams) {
            if (known.name == name) return tables_.add_cam(known.points);
            names.push_back(known.name);
        }
        unknown("program.unknown_cam", "cam", name, names, "cams");
        return {};
    }
    axes::TimeTableRef time_table(std::string_view name, std::span<const axes::TimePoint> rows, std::size_t room) override {
        if (const auto why = unusable(rows); !why.empty()) bad_table("time table", name, why);
        return tables_.add_time_table(rows, room);
    }
    axes::CamSwitchRef cam_switches(std::string_view name, std::span<const axes::CamSwitch> switches, std::size_t room) override {
        if (const auto why = unusable(switches); !why.empty()) bad_table("list of cam switches", name, why);
        return tables_.add_cam_switches(switches, room);
    }
    axes::TrackRef tracks(std::string_view name, std::span<const axes::TrackOptions> options) override {
        if (options.size() > axes::MotionTables::tracks)
            bad_table("list of tracks", name,
                      fmt::format("it has {} tracks, at most {} are possible", options.size(), axes::MotionTables::tracks));
        for (std::size_t i = 0; i < options.size(); ++i)
            if (!(options[i].hysteresis >= 0) || std::isinf(options[i].hysteresis))
                bad_table("list of tracks", name, fmt::format("track {}: the hysteresis is {}", i + 1, options[i].hysteresis));
        return tables_.add_tracks(options);
    }

    void alarm(std::uint8_t number, Reaction reaction, std::string_view english, std::string_view chinese,
               std::string_view remedy) override {
        if (number >= 64) {
            problem("program.alarm_number", fmt::format("alarm number {} is beyond 63", number), "use 0 to 63");
            return;
        }
        host_.programs_[program_].alarm_texts[number] = {true, reaction, std::string(english), std::string(chinese), std::string(remedy)};
    }

    /// After declare(): configured names that the program does not know, and whose the operator values are.
    void check_configuration() {
        find_owners();
        find_retained_tasks();
        refuse_kept_buttons();
        refuse_too_much_kept();
        refuse_names_kept_twice();
        const auto& program = config_.programs[program_];
        for (const auto& set : program.parameters) {
            bool known = false;
            for (const auto& name : parameter_names_) known = known || name == set.name;
            if (!known) unknown("program.unknown_parameter", "parameter", set.name, parameter_names_, "its parameters");
        }
        for (const auto& task : config_.tasks) {
            if (task.program != program.name) continue;
            bool known = false;
            for (const auto& name : task_names_) known = known || name == task.name;
            if (!known) unknown("program.unknown_task", "task", task.name, task_names_, "the program's tasks");
        }
    }

protected:
    void add(std::string_view name, VariableType type, const void* address, std::string_view unit, std::string_view doc) override {
        once(variable_names_, name, "monitored variable");
        variable_names_.emplace_back(name);
        host_.variables_.push_back({type, address, program_});
        host_.variable_info_.push_back({config_.programs[program_].name, std::string(name), std::string(unit), std::string(doc), type});
    }
    void add_operator_value(std::string_view name, VariableType type, void* address, const OperatorValueSpec& spec,
                            OperatorValueKind kind) override {
        add(name, type, address, spec.unit, spec.doc);
        auto& info = host_.variable_info_.back();
        info.writable = true;
        info.momentary = kind == OperatorValueKind::button;
        info.minimum = kind == OperatorValueKind::value ? spec.minimum : 0;
        info.maximum = kind == OperatorValueKind::value ? spec.maximum : 1;
        const double first = ProgramHost::read(host_.variables_.back());
        const auto [least, most] = range_of(type);
        if (kind == OperatorValueKind::value && !(least <= spec.minimum && spec.minimum < spec.maximum && spec.maximum <= most))
            problem("program.operator_value_range",
                    fmt::format("operator value '{}' has the range {} to {}, and its type holds {} to {}", name, spec.minimum, spec.maximum,
                                least, most),
                    "give .minimum and .maximum in the declaration, the smaller one first");
        else if (!info.takes(first))
            problem("program.operator_value_range",
                    fmt::format("operator value '{}' begins with {}, which a person could not write: it takes {}{} to {}", name, first,
                                info.whole() ? "whole numbers from " : "", info.minimum, info.maximum),
                    "correct its first value or its range in the program");
        host_.operator_values_.push_back({host_.variables_.size() - 1, address, host_.tasks_.size(), info.momentary});
        owners_.push_back({std::string(name), std::string(spec.task)});
    }
    RetainedItem& add_kept(RetainKind kind, std::string_view name, std::string_view task) {
        once(retained_names_, name, "kept variable");
        retained_names_.emplace_back(name);
        retained_tasks_.emplace_back(task);
        auto& item = host_.retained_.emplace_back();
        item.name = fmt::format("{}.{}", config_.programs[program_].name, name);
        item.kind = kind;
        item.program = program_;
        return item;
    }
    void add_retained(RetainKind kind, std::string_view name, const fb::PinType& type, void* address, std::string_view task) override {
        add_kept(kind, name, task).type = type.kind;
        host_.retained_.back().address = address;
        host_.retained_.back().size = size_of(type.kind);
    }
    void add_retained_block(RetainKind kind, std::string_view name, const fb::BlockType& type, void* address,
                            std::string_view task) override {
        add_kept(kind, name, task).block = &type;
        host_.retained_.back().address = address;
        host_.retained_.back().size = type.size;
        if (type.size > largest_kept_block)
            problem("program.retain_size",
                    fmt::format("'{}' has {} bytes, and a block that is kept has at most {}", name, type.size, largest_kept_block),
                    "keep the variables of it that matter");
    }
    void add_task(std::string_view name, TaskFunction function) override {
        once(task_names_, name, "task");
        task_names_.emplace_back(name);
        TaskConfig config;  // a task that the configuration does not mention runs in each cycle
        config.name = std::string(name);
        config.program = config_.programs[program_].name;
        for (const auto& task : config_.tasks)
            if (task.program == config.program && task.name == name) config = task;
        host_.tasks_.push_back({config, program_, function});
    }

    void add_block(std::string_view name, const void* begin, std::size_t size) override {
        const auto& program = config_.programs[program_].name;
        host_.blocks_.push_back({fmt::format("{}.{}", program, name), static_cast<const std::byte*>(begin), size});
    }

private:
    /// The task that an operator value is for: the one it names, or the only one.
    void find_owners() {
        const auto first = host_.operator_values_.size() - owners_.size();
        const auto first_task = host_.tasks_.size() - task_names_.size();
        for (std::size_t i = 0; i < owners_.size(); ++i) {
            const auto& [name, task] = owners_[i];
            const auto found = std::find(task_names_.begin(), task_names_.end(), task);
            if (task.empty() && task_names_.size() == 1) host_.operator_values_[first + i].task = first_task;
            else if (found != task_names_.end())
                host_.operator_values_[first + i].task = first_task + static_cast<std::size_t>(found - task_names_.begin());
            else if (task.empty())
                problem(
                    "program.operator_value_task",
                    fmt::format("operator value '{}' does not say which of the program's {} tasks it is for", name, task_names_.size()),
                    task_names_.empty() ? "declare a task" : fmt::format("write .task = \"{}\" in its declaration", task_names_.front()));
            else unknown("program.unknown_task", "task", task, task_names_, "the program's tasks");
        }
    }
    void find_retained_tasks() {
        const auto first = host_.retained_.size() - retained_tasks_.size();
        const auto first_task = host_.tasks_.size() - task_names_.size();
        for (std::size_t i = 0; i < retained_tasks_.size(); ++i) {
            if (retained_tasks_[i].empty()) continue;
            const auto found = std::find(task_names_.begin(), task_names_.end(), retained_tasks_[i]);
            if (found != task_names_.end())
                host_.retained_[first + i].task = first_task + static_cast<std::size_t>(found - task_names_.begin());
            else unknown("program.unknown_task", "task", retained_tasks_[i], task_names_, "the program's tasks");
        }
    }
    /// Once a machine: what is written has to be readable again.
    void refuse_too_much_kept() {
        if (retained_names_.empty()) return;
        std::size_t values = 0, bytes = 0;
        for (const auto& item : host_.retained_) {
            values += item.block != nullptr ? item.block->pins.size() : 1;
            bytes += item.size;
        }
        if (values > most_kept_values || bytes > most_kept_bytes)
            problem("program.retain_size",
                    fmt::format("the programs up to this one keep {} values in {} bytes, and a machine keeps at most {} in {}", values,
                                bytes, most_kept_values, most_kept_bytes),
                    "keep less, or write large tables into a file of the program's own in stop()");
    }
    void refuse_names_kept_twice() {
        if (const auto name = name_kept_twice(host_.retained_, host_.retained_.size() - retained_names_.size()))
            problem("program.duplicate_name", fmt::format("'{}' is kept twice: a kept block has its pins as NAME.PIN", *name),
                    "give each a name of its own");
    }
    /// Nobody holds a button after a restart.
    void refuse_kept_buttons() {
        for (std::size_t i = host_.retained_.size() - retained_names_.size(); i < host_.retained_.size(); ++i)
            for (const auto& value : host_.operator_values_)
                if (value.momentary && value.address == host_.retained_[i].address)
                    problem("program.retain_button",
                            fmt::format("'{}' is a button and kept: after a restart it would be held by nobody", host_.retained_[i].name),
                            "do not keep it; a switch (operator_switch) may be kept");
    }
    /// What a variable holds exactly; a double tells whole numbers apart up to 2^53.
    static std::pair<double, double> range_of(VariableType type) noexcept {
        constexpr double exact = 9007199254740992.0;
        switch (type) {
            case VariableType::boolean: return {0, 1};
            case VariableType::int32: return {-2147483648.0, 2147483647.0};
            case VariableType::uint16: return {0, 65535};
            case VariableType::uint32: return {0, 4294967295.0};
            case VariableType::int64: return {-exact, exact};
            case VariableType::real:
            case VariableType::duration: break;
        }
        return {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
    }
    std::uint16_t point(IoDirection direction, std::string_view name) {
        const int index = io_.find(direction, name);
        if (index >= 0) {
            const auto found = static_cast<std::uint16_t>(index);
            if (direction == IoDirection::output && !host_.drives(program_, found)) host_.outputs_[program_].push_back(found);
            return found;
        }
        unknown(direction == IoDirection::input ? "program.unknown_input" : "program.unknown_output",
                direction == IoDirection::input ? "input" : "output", name, io_.names(direction),
                direction == IoDirection::input ? "io.inputs" : "io.outputs");
        return 0xFFFF;
    }
    /// In the unit of the program; nothing where it was told in one that does not convert.
    static std::optional<double> value_of(const ParameterValue& set, std::string_view unit) {
        if (set.in_units.empty()) return set.value;
        const auto plain = [](std::string_view text) {
            std::string out;
            for (const char c : text)
                if (c != ' ' && c != '^') out += c;
            return out;
        };
        for (const auto& one : set.in_units)
            if (plain(one.unit) == plain(unit)) return one.value;
        return std::nullopt;
    }
    // Why a table cannot be used; empty = it can, or it has no points yet.
    static std::string unusable(std::span<const axes::CamPoint> points) {
        if (points.empty()) return {};
        if (points.size() == 1) return "it has one point, and needs two";
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto& p = points[i];
            for (const double value : {p.master, p.slave, p.velocity, p.acceleration})
                if (!std::isfinite(value)) return fmt::format("point {} has a value that is no finite number", i + 1);
            if (i > 0 && !(p.master > points[i - 1].master))
                return fmt::format("point {}: the master's position {} is not beyond {}", i + 1, p.master, points[i - 1].master);
        }
        if (const auto misfits = axes::misfits_of(points); !misfits.empty())
            return fmt::format("point {}: its law cannot get to the next one with what is given there", misfits.front() + 1);
        return {};
    }
    static std::string unusable(std::span<const axes::TimePoint> rows) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (!std::isfinite(rows[i].value)) return fmt::format("row {} has a value that is no finite number", i + 1);
            if (rows[i].delta < Duration::zero() || (i > 0 && rows[i].delta == Duration::zero()))
                return fmt::format("row {}: its time after the row before is not above zero", i + 1);
        }
        return {};
    }
    static std::string unusable(std::span<const axes::CamSwitch> switches) {
        for (std::size_t i = 0; i < switches.size(); ++i) {
            const auto& s = switches[i];
            if (s.track < 1 || s.track > axes::MotionTables::tracks)
                return fmt::format("switch {} is on track {}; tracks are 1 to {}", i + 1, s.track, axes::MotionTables::tracks);
            if (!std::isfinite(s.first) || !std::isfinite(s.last))
                return fmt::format("switch {} has a position that is no finite number", i + 1);
            if (s.mode == axes::CamSwitchMode::time && s.duration <= Duration::zero())
                return fmt::format("switch {} switches by time and has no duration", i + 1);
        }
        return {};
    }
    /// Two of one name could not be told apart by anybody who reads or writes them.
    void once(const std::vector<std::string>& names, std::string_view name, std::string_view kind) {
        if (std::find(names.begin(), names.end(), name) != names.end())
            problem("program.duplicate_name", fmt::format("{} '{}' is declared twice", kind, name), "give each a name of its own");
    }
    void bad_table(std::string_view kind, std::string_view name, std::string_view why) {
        problem("program.table", fmt::format("{} '{}' cannot be used: {}", kind, name, why), "correct the declaration in the program");
    }
    void problem(std::string code, std::string what, std::string remedy) {
        errors_.push_back(
            {std::move(code), fmt::format("program '{}'", config_.programs[program_].name), std::move(what), std::move(remedy)});
    }
    void unknown(std::string code, std::string_view kind, std::string_view name, const std::vector<std::string>& known,
                 std::string_view where) {
        const auto near = nearest_name(name, known);
        std::string list;
        for (const auto& n : known) list += (list.empty() ? "" : ", ") + n;
        problem(std::move(code), fmt::format("there is no {} '{}' among {}: {}", kind, name, where, list.empty() ? "none" : list),
                near.empty() ? fmt::format("add it to {}, or correct the name", where) : fmt::format("did you mean '{}'?", near));
    }

    ProgramHost& host_;
    const MachineConfig& config_;
    const IoImage& io_;
    axes::MotionTables& tables_;
    std::size_t program_;
    std::vector<Error>& errors_;
    std::vector<std::string> parameter_names_, task_names_, variable_names_, retained_names_, retained_tasks_;
    std::vector<std::pair<std::string, std::string>> owners_;  // of its operator values: name, task
};

ProgramHost::ProgramHost(const MachineConfig& config, const IoImage& io, axes::MotionTables& tables, std::vector<Error>& errors) {
    for (std::size_t i = 0; i < config.programs.size(); ++i) {
        const auto& program = config.programs[i];
        outputs_.emplace_back();
        programs_.push_back({program, ProgramLibrary::Instance{nullptr, {}}, 0, std::vector<AlarmDeclared>(64), {}});
        auto library = program.entry ? ProgramLibrary::linked(program.entry()) : ProgramLibrary::open(program.library);
        if (!library) {
            auto error = library.error();
            error.subject = fmt::format("program '{}' ({})", program.name, error.subject);
            errors.push_back(std::move(error));
            continue;
        }
        auto instance = library->create();
        libraries_.push_back(std::move(*library));
        if (!instance) {
            auto error = instance.error();
            error.subject = fmt::format("program '{}' ({})", program.name, error.subject);
            errors.push_back(std::move(error));
            continue;
        }
        programs_.back().instance = std::move(*instance);
        Collector collector{*this, config, io, tables, i, errors};
        try {
            programs_.back().instance->declare(collector);
            collector.check_configuration();
        } catch (const std::exception& e) {
            errors.push_back({"program.declare", fmt::format("program '{}'", program.name), fmt::format("declare() threw: {}", e.what()),
                              "mend the program"});
        } catch (...) {
            errors.push_back({"program.declare", fmt::format("program '{}'", program.name),
                              "declare() threw something that is no std::exception", "mend the program"});
        }
    }
}

ProgramHost::~ProgramHost() {
    programs_.clear();  // their code is in the libraries
}

void ProgramHost::describe(MachineLayout& layout) const {
    for (const auto& program : programs_) layout.programs.push_back(program.config.name);
    for (const auto& task : tasks_) layout.tasks.push_back(task.config.program + "." + task.config.name);
    layout.variables = variable_info_;
    layout.parameters = parameter_info_;
    layout.blocks = blocks_;
    for (const auto& use : axis_uses_) layout.axes[use.axis].programs.push_back(programs_[use.program].config.name);
}

double ProgramHost::read(const Variable& variable) noexcept {
    switch (variable.type) {
        case VariableType::boolean: return *static_cast<const bool*>(variable.address) ? 1.0 : 0.0;
        case VariableType::int32: return *static_cast<const std::int32_t*>(variable.address);
        case VariableType::int64: return static_cast<double>(*static_cast<const std::int64_t*>(variable.address));
        case VariableType::uint16: return *static_cast<const std::uint16_t*>(variable.address);
        case VariableType::uint32: return *static_cast<const std::uint32_t*>(variable.address);
        case VariableType::real: return *static_cast<const double*>(variable.address);
        case VariableType::duration: return to_seconds(*static_cast<const Duration*>(variable.address));
    }
    return 0;
}

void ProgramHost::write(VariableType type, void* address, double value) noexcept {
    switch (type) {
        case VariableType::boolean: *static_cast<bool*>(address) = value != 0; break;
        case VariableType::int32: *static_cast<std::int32_t*>(address) = static_cast<std::int32_t>(value); break;
        case VariableType::int64: *static_cast<std::int64_t*>(address) = static_cast<std::int64_t>(value); break;
        case VariableType::uint16: *static_cast<std::uint16_t*>(address) = static_cast<std::uint16_t>(value); break;
        case VariableType::uint32: *static_cast<std::uint32_t*>(address) = static_cast<std::uint32_t>(value); break;
        case VariableType::real: *static_cast<double*>(address) = value; break;
        case VariableType::duration: break;  // no declaration takes one
    }
}

}  // namespace taktwerk::runtime
