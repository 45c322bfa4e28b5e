// What does not meet between the floors of one configuration: names, cycles a drive cannot keep, stops that take too long.

#include "runtime/check/machine_check.hpp"

#include <algorithm>

#include "runtime/check/axis_check.hpp"
#include "runtime/check/hot_connect_check.hpp"
#include "runtime/check/modbus_check.hpp"
#include "runtime/check/problems.hpp"
#include "runtime/check/serial_check.hpp"
#include "runtime/group_presence.hpp"

namespace taktwerk::runtime {

namespace {

bool has(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

class MachineCheck {
public:
    MachineCheck(const MachineConfig& config, std::vector<Error>& errors) : config_(config), errors_(errors), problems_(errors) {
        for (const auto& slave : config.bus.slaves) slaves_.push_back(slave.name);
        for (const auto& device : config.modbus) modbus_.push_back(device.name);
        for (const auto& axis : config.axes) axes_.push_back(axis.axis.name);
        for (const auto& point : config.io) (point.direction == IoDirection::input ? inputs_ : outputs_).push_back(point.name);
        for (const auto& program : config.programs) programs_.push_back(program.name);
    }

    void run() {
        check_numbers();
        check_names();
        check_bus();
        check_serial(config_, errors_);
        check_axes(config_, errors_);
        for (auto& error : axes::check(config_.axis_groups, axes_)) errors_.push_back(std::move(error));
        check_group_members();
        check_modbus(config_, errors_);
        check_hot_connect(config_, errors_);
        check_io();
        check_tasks();
        if (!config_.emergency_stop.input.empty()) check_emergency_stop();
        check_retain();
        check_events();
    }

private:
    /// A member that could follow no path would be missed by its group alone, and late.
    void check_group_members() {
        for (const auto& group : config_.axis_groups)
            for (std::size_t i = 0; i < group.members.size(); ++i)
                for (const auto& binding : config_.axes) {
                    const auto& member = group.members[i];
                    if (binding.axis.name != member || (!binding.axis.encoder && binding.axis.modulo <= 0)) continue;
                    problems_.add("group.member_kind", fmt::format("axis_groups.{}.members.{}", group.name, i),
                                  fmt::format("axis '{}' {}, and a group cannot move it", member,
                                              binding.axis.encoder ? "only measures" : "is a modulo axis"),
                                  binding.axis.encoder ? "take it out of the group" : "take it out of the group, or its `modulo`");
                }
    }
    void check_numbers() {
        using namespace std::chrono_literals;
        if (config_.cycle < 100us || config_.cycle > 100ms)
            problems_.add("machine.cycle", "cycle", fmt::format("a cycle of {} us is outside 100 us to 100 ms", config_.cycle / 1us),
                          "choose for instance 1 ms");

        if (config_.commands_per_cycle == 0)
            problems_.add("machine.commands_per_cycle", "commands_per_cycle", "with 0 commands a cycle nobody can operate the machine",
                          "use 4");
        // The alarms that share a recording, and a disk that is slow for a moment.
        const auto& recording = config_.recording;
        if (recording.files > 0 && recording.depth < recording.before + recording.after + 2s)
            problems_.add("machine.recording_depth", "recording.depth",
                          fmt::format("{:g} s are kept, and a recording takes {:g} s before its alarm and {:g} s behind it",
                                      to_seconds(recording.depth), to_seconds(recording.before), to_seconds(recording.after)),
                          fmt::format("write `depth: {:g} s` or more, a shorter `before`, or `files: 0` for no recordings",
                                      to_seconds(recording.before + recording.after + 2s)));
        if (config_.emergency_stop.power_off_after < Duration::zero())
            problems_.add("machine.emergency_stop_time", "emergency_stop.power_off_after", "a time below 0", "use for instance 500 ms");
    }

    /// Names head the columns of a trace, stand in lists on the command line and in words over the socket.
    void check_characters(std::string_view section, const std::string& name) {
        if (name.find_first_of(" \t\n,;\"'[]=/") != std::string::npos)
            problems_.add("config.name_characters", fmt::format("{}.{}", section, name),
                          fmt::format("the name '{}' has a blank or a mark that separates names elsewhere", name),
                          "use letters, digits, '_' and '-'");
    }

    void check_names() {
        problems_.duplicates(axes_, "axes");
        for (const auto& name : axes_) check_characters("axes", name);
        for (const auto& group : config_.axis_groups) check_characters("axis_groups", group.name);
        problems_.duplicates(inputs_, "io.inputs");
        problems_.duplicates(outputs_, "io.outputs");
        problems_.duplicates(programs_, "programs");
    }

    void check_bus() {
        if (slaves_.empty() && config_.bus.interface.empty()) return;
        auto bus = config_.bus;
        bus.cycle = config_.cycle;
        for (auto& error : ecat::check(bus)) errors_.push_back(std::move(error));
    }

    void check_io() {
        for (const auto& point : config_.io) {
            const auto subject = fmt::format("io.{}.{}", point.direction == IoDirection::input ? "inputs" : "outputs", point.name);
            if (point.presence || (point.beside && has(modbus_, point.slave))) continue;
            auto known = slaves_;
            known.insert(known.end(), modbus_.begin(), modbus_.end());
            if (!has(slaves_, point.slave)) problems_.unknown("io.unknown_slave", subject + ".slave", "slave", point.slave, known);
        }
    }

    void check_tasks() {
        for (const auto& task : config_.tasks) {
            if (!has(programs_, task.program))
                problems_.unknown("task.unknown_program", "tasks." + task.name, "program", task.program, programs_);
            if (task.divisor == 0)
                problems_.add("task.divisor", fmt::format("programs.{}.tasks.{}", task.program, task.name), "a divisor of 0 never runs",
                              "use 1 or more");
            check_times(task);
        }
    }

    void check_times(const TaskConfig& task) {
        const auto where = fmt::format("programs.{}.tasks.{}", task.program, task.name);
        if (task.divisor == 1 && (task.watchdog || task.priority))
            problems_.add(
                "task.base", fmt::format("{}.{}", where, task.watchdog ? "watchdog" : "priority"),
                "a task that runs in each cycle runs inside the cycle, on its thread: it has no watchdog and no priority of its own",
                "remove it (`watch:` says when a cycle that is too long stops the machine), or give the task a longer `every`");
        else if (task.watchdog && *task.watchdog != Duration{} && *task.watchdog < config_.cycle)
            problems_.add("task.watchdog", where + ".watchdog", "it is shorter than the machine's cycle, in which it is counted",
                          "give it a cycle or more, or 0 ms for no limit");
        if (task.divisor == 1 || task.priority.value_or(0) == 0) return;
        const int cycle = config_.realtime.priority, most = cycle - 2;
        if (cycle == 0)
            problems_.add("task.priority", where + ".priority",
                          "the cycle has no real-time priority (`realtime.priority: 0`): this task would be above it",
                          "remove it, or give the cycle a priority");
        else if (*task.priority < 1 || *task.priority > most)
            problems_.add("task.priority", where + ".priority",
                          fmt::format("{} is not between 1 and {}: the cycle has {}, and the watch over the tasks stands between them",
                                      *task.priority, most, cycle),
                          "choose a lower one, or none: then the shortest period has the highest");
    }

    void check_emergency_stop() {
        if (!has(inputs_, config_.emergency_stop.input))
            problems_.unknown("machine.emergency_stop_input", "emergency_stop.input", "input", config_.emergency_stop.input, inputs_);
        const auto& restart = config_.emergency_stop.restart;
        if (!restart.empty() && !has(inputs_, restart))
            problems_.unknown("machine.emergency_stop_input", "emergency_stop.restart", "input", restart, inputs_);
        if (restart == config_.emergency_stop.input)
            problems_.add("machine.emergency_stop_input", "emergency_stop.restart", "it is the emergency stop itself",
                          "give the input of a button of its own");
    }

    void check_retain() {
        const auto& retain = config_.retain;
        if (!retain.power_fail.empty() && !has(inputs_, retain.power_fail))
            problems_.unknown("retain.power_fail", "retain.power_fail", "input", retain.power_fail, inputs_);
        if (retain.every < std::chrono::milliseconds{1})
            problems_.add("retain.every", "retain.every", "it writes without an end", "use for instance 1 s");
    }

    void check_events() {
        const auto groups = group_names(config_.bus);
        std::vector<std::string> lines;
        for (const auto& line : config_.serial) lines.push_back(line.name);
        auto powered = slaves_;
        powered.insert(powered.end(), modbus_.begin(), modbus_.end());
        for (const auto& event : config_.simulation.events) {
            using Kind = SimulationEvent::Kind;
            const auto& known = event.kind == Kind::input || event.kind == Kind::input_fault ? inputs_
                                : event.kind == Kind::slave_power                            ? powered
                                : event.kind == Kind::serial_line                            ? lines
                                : event.kind == Kind::group                                  ? groups
                                                                                             : axes_;
            const auto point = std::ranges::find(config_.io, event.target, &IoPoint::name);
            if (event.kind == Kind::input_fault && point != config_.io.end() && point->status.empty())
                problems_.add("simulation.no_status", "simulation.events",
                              fmt::format("the terminal of '{}' reports no errors of it: nothing would happen", event.target),
                              "let the slave lose its power (`slave_power_off`), or set the value itself (`input`)");
            if (!has(known, event.target))
                problems_.unknown("simulation.unknown_target", "simulation.events", "target", event.target, known);
        }
    }

    const MachineConfig& config_;
    std::vector<Error>& errors_;
    Problems problems_;
    std::vector<std::string> slaves_, modbus_, axes_, inputs_, outputs_, programs_;
};

}  // namespace

std::vector<Error> check(const MachineConfig& config) {
    std::vector<Error> errors;
    MachineCheck{config, errors}.run();
    return errors;
}

}  // namespace taktwerk::runtime
