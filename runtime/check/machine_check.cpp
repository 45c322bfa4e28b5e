#include "runtime/check/machine_check.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/nearest_name.hpp"
#include "ecat/description/module_pdos.hpp"
#include "runtime/check/serial_check.hpp"
#include "runtime/stop_time.hpp"

namespace taktwerk::runtime {

namespace {

/// How often the slave's process data is exchanged.
Duration exchange_period_of(const MachineConfig& config, const std::string& name) {
    auto bus = config.bus;
    bus.cycle = config.cycle;
    for (const auto& slave : bus.slaves)
        if (slave.name == name) return ecat::exchange_period(bus, slave);
    return config.cycle;
}

/// The objects in a slave's process data as far as they are known without it; empty: they are not.
std::vector<ecat::PdoEntry> mapped(const ecat::PdoSelection& selection, const std::vector<ecat::PdoDescription>& known,
                                   const std::vector<std::uint16_t>& assigned) {
    std::vector<ecat::PdoEntry> out;
    const auto add = [&](const std::vector<ecat::PdoEntry>& entries) { out.insert(out.end(), entries.begin(), entries.end()); };
    const auto add_known = [&](std::uint16_t index) {
        for (const auto& pdo : known)
            if (pdo.index == index) add(pdo.entries);
    };
    for (const auto& pdo : selection.assigned) {
        if (pdo.entries.empty()) add_known(pdo.index);
        else add(pdo.entries);
    }
    if (selection.assigned.empty())
        for (const auto index : assigned) add_known(index);
    return out;
}

/// What every CiA 402 axis lives by (axes/drives/cia402/ refuses to start without).
struct NeededObject {
    std::uint16_t index;
    bool output;
    std::string_view name;
};
constexpr NeededObject needed_objects[] = {
    {0x6040, true, "controlword"},
    {0x6060, true, "modes of operation"},
    {0x6041, false, "statusword"},
    {0x6061, false, "modes of operation display"},
    {0x6064, false, "position actual value"},
};

class Problems {
public:
    explicit Problems(std::vector<Error>& errors) : errors_(errors) {}
    void add(std::string code, std::string subject, std::string what, std::string remedy) {
        errors_.push_back({std::move(code), std::move(subject), std::move(what), std::move(remedy)});
    }
    void unknown(std::string code, std::string subject, std::string_view kind, std::string_view name,
                 const std::vector<std::string>& known) {
        const auto near = nearest_name(name, known);
        std::string list;
        for (const auto& n : known) list += (list.empty() ? "" : ", ") + n;
        add(std::move(code), std::move(subject),
            fmt::format("there is no {} '{}' (there is: {})", kind, name, list.empty() ? "none" : list),
            near.empty() ? "correct the name" : fmt::format("did you mean '{}'?", near));
    }
    template <class Names>
    void duplicates(const Names& names, std::string_view what) {
        std::set<std::string> seen;
        for (const auto& n : names) {
            if (n.empty()) add("config.name_missing", std::string(what), "a name is empty", "give it a name");
            else if (!seen.insert(n).second)
                add("config.duplicate_name", fmt::format("{}.{}", what, n), "the name is used twice", "rename one of them");
        }
    }

private:
    std::vector<Error>& errors_;
};

}  // namespace

std::vector<Error> check(const MachineConfig& config) {
    std::vector<Error> errors;
    Problems problems{errors};
    using namespace std::chrono_literals;

    if (config.cycle < 100us || config.cycle > 100ms)
        problems.add("machine.cycle", "cycle", fmt::format("a cycle of {} us is outside 100 us to 100 ms", config.cycle / 1us),
                     "choose for instance 1 ms");

    if (config.commands_per_cycle == 0)
        problems.add("machine.commands_per_cycle", "commands_per_cycle", "with 0 commands a cycle nobody can operate the machine", "use 4");
    if (config.emergency_stop.power_off_after < Duration::zero())
        problems.add("machine.emergency_stop_time", "emergency_stop.power_off_after", "a time below 0", "use for instance 500 ms");

    std::vector<std::string> slaves, axis_names, inputs, outputs, programs;
    for (const auto& slave : config.bus.slaves) slaves.push_back(slave.name);
    for (const auto& axis : config.axes) axis_names.push_back(axis.axis.name);
    for (const auto& point : config.io) (point.direction == IoDirection::input ? inputs : outputs).push_back(point.name);
    for (const auto& program : config.programs) programs.push_back(program.name);
    problems.duplicates(axis_names, "axes");
    // They head the columns of a trace, stand in lists on the command line and in words over the socket.
    for (const auto& name : axis_names)
        if (name.find_first_of(" \t\n,;\"'[]=/") != std::string::npos)
            problems.add("config.name_characters", fmt::format("axes.{}", name),
                         fmt::format("the name '{}' has a blank or a mark that separates names elsewhere", name),
                         "use letters, digits, '_' and '-'");
    problems.duplicates(inputs, "io.inputs");
    problems.duplicates(outputs, "io.outputs");
    problems.duplicates(programs, "programs");

    if (!slaves.empty() || !config.bus.interface.empty()) {
        auto bus = config.bus;
        bus.cycle = config.cycle;
        for (auto& error : ecat::check(bus)) errors.push_back(std::move(error));
    }

    check_serial(config, errors);
    std::set<std::pair<std::string, int>> taken;
    for (const auto& binding : config.axes) {
        const auto subject = fmt::format("axes.{}", binding.axis.name);
        for (auto& error : axes::check(binding.axis)) errors.push_back(std::move(error));
        if (!binding.drive.empty()) continue;  // see check_serial
        if (binding.slave.empty()) {
            if (binding.axis.encoder)
                problems.add("axis.encoder", subject + ".encoder", "there is nothing that measures",
                             "name the `slave` whose position is meant, or remove `encoder`");
            if (binding.axis.homing.kind != axes::HomingKind::none && binding.axis.homing.kind != axes::HomingKind::set_here)
                problems.add("axis.homing", subject + ".homing", "a virtual axis (without `slave`) has no switches",
                             "use `kind: set_here`");
            continue;
        }
        bool found = false;
        for (const auto& name : slaves) found = found || name == binding.slave;
        if (!found) {
            problems.unknown("axis.unknown_slave", subject + ".slave", "slave", binding.slave, slaves);
            continue;
        }
        if (!taken.insert({binding.slave, binding.drive_axis}).second)
            problems.add("axis.drive_axis_taken", subject + ".axis",
                         fmt::format("axis {} of slave '{}' already belongs to another axis", binding.drive_axis + 1, binding.slave),
                         "give each axis an `axis` of its own");
        if (!binding.profile) {
            problems.add("axis.no_profile", subject + ".slave", fmt::format("slave '{}' has no drive profile", binding.slave),
                         "give the slave a `profile:`; a terminal cannot carry an axis");
            continue;
        }
        const auto& profile = *binding.profile;
        if (binding.drive_axis >= profile.axes)
            problems.add("axis.drive_axis", subject + ".axis",
                         fmt::format("{} has {} {}, there is no axis {}", profile.name, profile.axes, profile.axes == 1 ? "axis" : "axes",
                                     binding.drive_axis + 1),
                         profile.axes == 1 ? "remove `axis`" : fmt::format("choose 1 to {}", profile.axes));
        for (const auto& slave : config.bus.slaves) {
            if (slave.name != binding.slave || !slave.device || binding.drive_axis >= profile.axes) continue;
            const auto offered = ecat::pdos_of(*slave.device, slave.modules);
            const auto rx = mapped(slave.rx, offered.rx, offered.rx_assigned), tx = mapped(slave.tx, offered.tx, offered.tx_assigned);
            for (const auto& needed : needed_objects) {
                const auto& there = needed.output ? rx : tx;
                const auto index = static_cast<std::uint16_t>(needed.index + binding.drive_axis * profile.object_offset);
                bool is_mapped = there.empty();
                for (const auto& entry : there) is_mapped = is_mapped || entry.index == index;
                if (!is_mapped)
                    problems.add("axis.not_mapped", subject + ".slave",
                                 fmt::format("object {:04X}h ({}) is not in the {} of slave '{}'", index, needed.name,
                                             needed.output ? "RxPDO" : "TxPDO", slave.name),
                                 fmt::format("map it: choose a PDO that has it, or add it under `pdo.{}` of the slave (docs/drives.md)",
                                             needed.output ? "rx" : "tx"));
            }
        }
        if (exchange_period_of(config, binding.slave) < profile.minimum_cycle_csp)
            problems.add("axis.cycle_too_short", "cycle",
                         fmt::format("{} (axis {}) needs at least {} us in cyclic synchronous position mode", profile.name,
                                     binding.axis.name, profile.minimum_cycle_csp / 1us),
                         "lengthen `cycle`");
        if (binding.axis.homing.kind == axes::HomingKind::drive && !binding.axis.simulated) {
            bool documented = false;
            std::string list;
            for (const auto method : profile.homing_methods) {
                documented = documented || method == binding.axis.homing.method;
                list += fmt::format("{}{}", list.empty() ? "" : ", ", method);
            }
            if (!documented)
                problems.add("axis.homing_method", subject + ".homing.method",
                             fmt::format("{} does not document homing method {}", profile.name, binding.axis.homing.method),
                             list.empty() ? "use another kind of homing" : fmt::format("choose one of {}", list));
        }
        if (!config.emergency_stop.input.empty()) {
            const double needs = stop_seconds(binding.axis.limits), has = to_seconds(config.emergency_stop.power_off_after);
            if (needs > has)
                problems.add("machine.emergency_stop_time", subject + ".limits",
                             fmt::format("stopping from {} {}/s takes {:.2f} s, but power goes off {:.2f} s after an emergency stop",
                                         binding.axis.limits.velocity, binding.axis.unit, needs, has),
                             "raise `stop_deceleration` and `stop_jerk`, or `emergency_stop.power_off_after` (as the safety relay allows)");
        }
    }

    for (const auto& point : config.io) {
        bool found = false;
        for (const auto& name : slaves) found = found || name == point.slave;
        const auto subject = fmt::format("io.{}.{}", point.direction == IoDirection::input ? "inputs" : "outputs", point.name);
        if (!found) problems.unknown("io.unknown_slave", subject + ".slave", "slave", point.slave, slaves);
    }
    for (const auto& task : config.tasks) {
        bool found = false;
        for (const auto& name : programs) found = found || name == task.program;
        if (!found) problems.unknown("task.unknown_program", "tasks." + task.name, "program", task.program, programs);
        if (task.divisor == 0)
            problems.add("task.divisor", fmt::format("programs.{}.tasks.{}", task.program, task.name), "a divisor of 0 never runs",
                         "use 1 or more");
    }
    if (!config.emergency_stop.input.empty()) {
        bool found = false;
        for (const auto& name : inputs) found = found || name == config.emergency_stop.input;
        if (!found) problems.unknown("machine.emergency_stop_input", "emergency_stop.input", "input", config.emergency_stop.input, inputs);
        const auto& restart = config.emergency_stop.restart;
        if (!restart.empty() && std::find(inputs.begin(), inputs.end(), restart) == inputs.end())
            problems.unknown("machine.emergency_stop_input", "emergency_stop.restart", "input", restart, inputs);
        if (restart == config.emergency_stop.input)
            problems.add("machine.emergency_stop_input", "emergency_stop.restart", "it is the emergency stop itself",
                         "give the input of a button of its own");
    }
    std::vector<std::string> lines;
    for (const auto& line : config.serial) lines.push_back(line.name);
    for (const auto& event : config.simulation.events) {
        using Kind = SimulationEvent::Kind;
        const auto& known = event.kind == Kind::input         ? inputs
                            : event.kind == Kind::slave_power ? slaves
                            : event.kind == Kind::serial_line ? lines
                                                              : axis_names;
        bool found = false;
        for (const auto& name : known) found = found || name == event.target;
        if (!found) problems.unknown("simulation.unknown_target", "simulation.events", "target", event.target, known);
    }
    return errors;
}

}  // namespace taktwerk::runtime
