// taktwerk check FILE: everything that can be known without starting: the file, its drives, its programs, and what it means.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "apps/machine/axis_group_summary.hpp"
#include "apps/machine/checked_machine.hpp"
#include "apps/machine/group_summary.hpp"
#include "apps/machine/master_gone.hpp"
#include "apps/machine/modbus_asked.hpp"
#include "apps/machine/modbus_offer.hpp"
#include "apps/machine/problem_json.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/print_error.hpp"
#include "axes/axis/error_reaction.hpp"
#include "axes/port/drive_scale.hpp"
#include "axes/port/parameter_text.hpp"
#include "hmi_bridge/views/view_check.hpp"
#include "runtime/check/drive_hazards.hpp"
#include "runtime/check/machine_remarks.hpp"
#include "runtime/check/recording_memory.hpp"
#include "runtime/machine/machine.hpp"
#include "runtime/run/task_priorities.hpp"
#include "runtime/tasks/task_watch.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;
using runtime::MachineConfig;

struct CheckOptions {
    std::string file;
    bool json = false;
};

std::string homing_text(const axes::HomingConfig& homing) {
    switch (homing.kind) {
        case axes::HomingKind::none: return "none";
        case axes::HomingKind::drive: return fmt::format("by the drive, method {}", homing.method);
        case axes::HomingKind::home_switch: return fmt::format("home switch, {} direction", homing.negative ? "negative" : "positive");
        case axes::HomingKind::limit_switch: return fmt::format("{} limit switch", homing.negative ? "negative" : "positive");
        case axes::HomingKind::block: return fmt::format("fixed stop, {} direction", homing.negative ? "negative" : "positive");
        case axes::HomingKind::reference_pulse:
            return fmt::format("home switch and index pulse, {} direction", homing.negative ? "negative" : "positive");
        case axes::HomingKind::absolute: return "absolute encoder";
        case axes::HomingKind::set_here: return "where it stands";
    }
    return "";
}

std::string range_text(const axes::AxisLimits& limits, const std::string& unit) {
    if (std::isinf(limits.position_min) && std::isinf(limits.position_max)) return "unlimited";
    return fmt::format("{:g} .. {:g} {}", limits.position_min, limits.position_max, unit);
}

void print_slaves(const MachineConfig& config) {
    std::string interfaces = config.bus.interface.empty() ? std::string("simulated") : "EtherCAT on " + config.bus.interface;
    if (const auto& ring = config.bus.ring) {
        interfaces += ring->interface2.empty() ? ", a ring" : " and " + ring->interface2 + ", a ring";
        interfaces += ring->behind_break == ecat::BehindBreak::ramp_down ? "; axes cut off from the reference clock by a break stop"
                                                                         : "; behind a break clocks are handed the reference's time";
    }
    if (!config.bus.interface.empty() && config.bus.transport != ecat::BusTransport::packet)
        interfaces += config.bus.transport == ecat::BusTransport::xdp ? "; by AF_XDP" : "; by AF_XDP where the driver has it";
    fmt::print("\nBus: {}\n", interfaces);
    for (const auto& slave : config.bus.slaves) {
        fmt::print("  {:<14} {:<22} {:<12} {}{}\n", slave.name, slave.device ? slave.device->name : "?", place_of(slave),
                   slave.dc ? "distributed clock" : "free running",
                   slave.startup.empty() ? "" : ", " + count_text(slave.startup.size(), "start-up SDO"));
    }
}

void print_groups(const MachineConfig& config) {
    for (const auto& group : group_summaries(config)) {
        fmt::print("\nGroup {}: joins and leaves while the rest runs; known by {}; {} and {} tell whether it is there\n", group.name,
                   group.known_by, group.name + ".present", group.name + ".joining");
        fmt::print("  slaves {}{}{}\n", fmt::join(group.slaves, ", "), group.axes.empty() ? "" : "; axes ", fmt::join(group.axes, ", "));
        fmt::print("  while it is away:\n");
        for (const auto& sentence : group.when_absent) fmt::print("    {}\n", sentence);
    }
}

Json groups_json(const MachineConfig& config) {
    auto out = Json::array();
    for (const auto& group : group_summaries(config))
        out.push_back(Json{{"name", group.name},
                           {"known_by", group.known_by},
                           {"slaves", group.slaves},
                           {"axes", group.axes},
                           {"inputs", group.inputs},
                           {"outputs", group.outputs},
                           {"when_absent", group.when_absent}});
    return out;
}

/// What has to fit between the start of a cycle and SYNC0.
void print_clocks(const MachineConfig& config) {
    const ecat::SlaveConfig* tightest = nullptr;
    for (const auto& slave : config.bus.slaves)
        if (slave.dc && (!tightest || time_to_compute(config.bus, slave) < time_to_compute(config.bus, *tightest))) tightest = &slave;
    if (!tightest) return;
    const auto us = [](Duration d) { return to_seconds(d) * 1e6; };
    const Duration left = time_to_compute(config.bus, *tightest), flight = estimated_flight(config.bus);
    const Duration late = config.watch.lateness_warning > Duration{} ? config.watch.lateness_warning : config.cycle / 4;
    fmt::print(
        "\nSYNC0 of '{}' comes {:.0f} us after the start of the cycle. The frames need about {:.0f} us on the wire; {:.0f} us are left "
        "for\n"
        "computing and lateness, of which {:.0f} us of lateness are warned about.{}\n",
        tightest->name, us(left + flight), us(flight), us(left), us(late),
        late > left ? " A cycle may be too late for SYNC0 before that warning: shift SYNC0 or lower the limit." : "");
}

/// What a turn of the motor must be for the drive, what else it must have stored, and what nobody can compare: said here, once.
std::vector<std::string> scale_sentences(const runtime::AxisBinding& binding) {
    std::vector<std::string> out;
    if (!binding.profile || binding.axis.disabled) return out;
    const auto& profile = *binding.profile;
    if (const auto words = axes::scale_words(profile); !words.empty())
        out.push_back(fmt::format("a turn of the motor must be {} counts for the drive: {}, compared before it is enabled",
                                  binding.axis.gearing.counts_per_revolution, words));
    if (!profile.scale.doubt.empty())
        out.push_back(fmt::format("scale: {} [{} {}]", profile.scale.doubt, profile.name, profile.scale.section));
    for (const auto& stored : binding.stored)
        for (const auto& row : profile.parameters)
            if (row.address == stored.object)
                out.push_back(fmt::format("stored in the drive: {} ({}) = {}, compared before it is enabled", axes::name_of(row), row.name,
                                          axes::value_text(row, stored.value)));
    return out;
}

/// What holds in one direction only.
std::vector<std::string> direction_sentences(const axes::AxisConfig& axis) {
    std::vector<std::string> out;
    for (const auto& [word, limits] : {std::pair{"positive", axis.limits.positive}, std::pair{"negative", axis.limits.negative}}) {
        std::vector<std::string> tighter;
        const auto add = [&tighter](const char* what, double value, const std::string& unit) {
            if (value > 0) tighter.push_back(fmt::format("{} {:g}{}", what, value, unit));
        };
        add("velocity", limits.velocity, fmt::format(" {}/s", axis.unit));
        add("acceleration", limits.acceleration, fmt::format(" {}/s2", axis.unit));
        add("deceleration", limits.deceleration, fmt::format(" {}/s2", axis.unit));
        add("torque", limits.torque, " of the rated one");
        if (!tighter.empty()) out.push_back(fmt::format("in {} direction at most: {}", word, fmt::join(tighter, ", ")));
    }
    return out;
}

/// The second encoder.
std::string load_sentence(const runtime::AxisBinding& binding) {
    const auto& load = binding.axis.load_encoder;
    if (!load.on) return {};
    return fmt::format("load encoder: input {}, {:g} counts per {}; motor and load may be {:g} {} apart{}", binding.load_input,
                       load.counts_per_unit, binding.axis.unit, load.tolerance, binding.axis.unit,
                       load.shown ? "; the actual position is the load's" : "");
}

/// The amplifier on wires.
std::vector<std::string> analog_sentences(const runtime::AxisBinding& binding) {
    if (!binding.analog) return {};
    const auto& analog = *binding.analog;
    const auto& drive = analog.drive;
    const auto& u = binding.axis.unit;
    std::string wires;
    for (const auto& [word, name] :
         {std::pair{"ready", &analog.ready}, std::pair{"fault", &analog.fault}, std::pair{"reset", &analog.reset}})
        if (!name->empty()) wires += fmt::format(", {} {}", word, *name);
    return {fmt::format("set-point {}: 10 V is {:g} {}/s, offset {:g} mV; enable {}{}", analog.setpoint, drive.velocity_at_10v, u,
                        drive.offset * 1e3, analog.enable, wires),
            fmt::format("the position loop is closed here; stopped when it runs {:g} {} against its set-point after enabling",
                        drive.runaway(binding.axis.limits.velocity), u)};
}

/// The other side of a portal.
std::string gantry_sentence(const runtime::AxisBinding& binding) {
    const auto& gantry = binding.axis.gantry;
    if (!gantry.on) return {};
    return fmt::format("gantry: leader {}, follower {}{}; stops at a skew of {:g} {}{}", binding.slave, binding.follower.slave,
                       binding.follower.mirrored ? " (mirrored)" : "", gantry.error, binding.axis.unit,
                       gantry.warning > 0 ? fmt::format(", warns from {:g} {}", gantry.warning, binding.axis.unit) : "");
}

/// Who works the holding brake, where it is not the drive.
std::string brake_sentence(const runtime::AxisBinding& binding) {
    const auto& brake = binding.axis.brake;
    if (brake.by == axes::BrakeBy::drive) return {};
    return fmt::format("brake by the controller, {}: motion waits {:g} ms until it is open, power {:g} ms until it holds{}",
                       brake.by == axes::BrakeBy::object ? "through 60FEh of the drive" : "output " + binding.brake_output,
                       to_seconds(brake.release) * 1e3, to_seconds(brake.engage) * 1e3,
                       brake.release_without_power ? "; MC_SetBrake may open it without power" : "");
}

/// What the file chose otherwise than the alarm tables.
std::vector<std::string> reaction_sentences(const axes::AxisConfig& axis) {
    std::vector<std::string> out;
    for (const auto& row : axes::reaction_bounds::rows) {
        const auto chosen = axis.reactions.chosen(row.alarm);
        if (chosen == axes::ErrorReaction::by_table) continue;
        out.push_back(fmt::format("on {}: {} (without `reactions`: {})", find_alarm(axes::axis_alarms, axes::id(row.alarm))->name,
                                  axes::word_of(chosen).text, axes::word_of(axes::reaction_by_table(row.alarm)).text));
    }
    return out;
}

void print_axis(const MachineConfig& config, const runtime::AxisBinding& binding) {
    const auto& axis = binding.axis;
    const auto& u = axis.unit;
    fmt::print("  {:<8} {}{}{}\n", axis.name,
               !binding.drive.empty()  ? "drive " + binding.drive + " on a serial line"
               : binding.analog        ? "analog drive, encoder at " + binding.slave
               : binding.slave.empty() ? "virtual"
               : binding.encoder       ? "encoder " + binding.slave
                                       : "drive " + binding.slave,
               axis.disabled ? "  LEFT OUT" : "", axis.simulated ? "  SIMULATED" : "");
    if (binding.encoder && !binding.analog) {
        fmt::print("           it is read, and moves nothing; one {} = {:g} counts; faster than {:g} {}/s is taken for no motion\n", u,
                   axis.gearing.counts_per_unit(), 2 * axis.limits.velocity, u);
        if (axis.simulated)
            fmt::print("           simulated: slave '{}' is taken as not there yet, and the axis stands at 0\n", binding.slave);
        return;
    }
    fmt::print("           velocity {:g} {}/s, acceleration {:g} {}/s2, deceleration {:g} {}/s2, jerk {}\n", axis.limits.velocity, u,
               axis.limits.acceleration, u, axis.limits.deceleration, u,
               std::isinf(axis.limits.jerk) ? std::string("unlimited") : fmt::format("{:g} {}/s3", axis.limits.jerk, u));
    for (const auto& sentence : direction_sentences(axis)) fmt::print("           {}\n", sentence);
    if (!binding.slave.empty() || !binding.drive.empty()) {
        const auto stroke = runtime::stroke_seconds(axis);
        fmt::print("           at full velocity the motor turns at {:.0f} r/min{}\n", runtime::motor_rpm(axis, axis.limits.velocity),
                   stroke ? fmt::format("; from one software limit to the other takes about {:.2f} s", *stroke) : "");
    }
    fmt::print("           range {}, homing: {}, jogging {:g} and {:g} {}/s, one {} = {:g} counts\n", range_text(axis.limits, u),
               homing_text(axis.homing), axis.manual.slow > 0 ? axis.manual.slow : axis.limits.velocity * 0.05,
               axis.manual.fast > 0 ? axis.manual.fast : axis.limits.velocity * 0.25, u, u, axis.gearing.counts_per_unit());
    for (const auto& sentence : analog_sentences(binding)) fmt::print("           {}\n", sentence);
    for (const auto& sentence : scale_sentences(binding)) fmt::print("           {}\n", sentence);
    for (const auto& sentence : reaction_sentences(axis)) fmt::print("           {}\n", sentence);
    if (const auto load = load_sentence(binding); !load.empty()) fmt::print("           {}\n", load);
    if (const auto gantry = gantry_sentence(binding); !gantry.empty()) fmt::print("           {}\n", gantry);
    if (const auto brake = brake_sentence(binding); !brake.empty()) fmt::print("           {}\n", brake);
    fmt::print("           if the master is gone:\n");
    for (const auto& sentence : master_gone(config, binding)) fmt::print("             {}\n", sentence);
}

std::string written_text(const runtime::MachineLayout::Variable& variable) {
    if (!variable.writable) return "";
    if (variable.momentary) return "; people press it";
    if (variable.type == VariableType::boolean) return "; people switch it";
    return fmt::format("; people write it ({:g} .. {:g})", variable.minimum, variable.maximum);
}

/// When a slower task has had its chances, and what follows.
std::string slower_task_text(const MachineConfig& config, const runtime::TaskConfig& task) {
    std::vector<runtime::TaskConfig> slower;
    std::size_t place = 0;
    for (const auto& other : config.tasks) {
        if (other.divisor == 1) continue;
        if (&other == &task) place = slower.size();
        slower.push_back(other);
    }
    const int priority = runtime::task_priorities(slower, config.realtime.priority)[place];
    std::string out = priority > 0 ? fmt::format(", priority {}", priority) : std::string(", an ordinary thread");
    if (task.overrun == runtime::OverrunReaction::count) out += ", missed releases are counted";
    else
        out += fmt::format(", {} missed releases in a row are borne, then {}", runtime::TaskWatch::overruns_allowed(task, config),
                           task.overrun == runtime::OverrunReaction::stop_program ? "the program stops" : "all axes stop");
    const auto watchdog = runtime::TaskWatch::watchdog_of(task, config);
    if (watchdog == Duration{}) return out + ", no watchdog";
    out += fmt::format(", watchdog {:g} ms", to_seconds(watchdog) * 1e3);
    if (task.watchdog_sensitivity > 1) out += fmt::format(" ({} runs in a row)", task.watchdog_sensitivity);
    return out;
}

void print_programs(const MachineConfig& config, const runtime::MachineLayout& layout) {
    if (config.programs.empty()) fmt::print("\nNo program: axes are moved from the command line.\n");
    else fmt::print("\nPrograms\n");
    for (const auto& program : config.programs) {
        fmt::print("  {:<16} {}{}\n", program.name, program.library, program.autostart ? ", starts by itself" : "");
        for (const auto& task : config.tasks)
            if (task.program == program.name)
                fmt::print("    task {:<12} every {:g} ms{}\n", task.name, to_seconds(config.cycle) * 1e3 * task.divisor,
                           task.divisor == 1 ? ", inline in the cycle" : slower_task_text(config, task));
        for (const auto& p : layout.parameters)
            if (p.program == program.name)
                fmt::print("    parameter {:<12} {:g} {} ({:g} .. {:g})  {}\n", p.name, p.value, p.unit, p.minimum, p.maximum, p.doc);
        for (const auto& v : layout.variables)
            if (v.program == program.name) fmt::print("    variable  {:<12} {} {}{}\n", v.name, v.unit, v.doc, written_text(v));
    }
}

void print_assumptions(const MachineConfig& config) {
    std::vector<std::string> seen;
    for (const auto& binding : config.axes) {
        if (binding.axis.encoder || !binding.profile || binding.profile->assumed.empty() ||
            std::find(seen.begin(), seen.end(), binding.profile->name) != seen.end())
            continue;
        std::vector<std::string> axes;
        for (const auto& other : config.axes)
            if (!other.axis.encoder && other.profile && other.profile->name == binding.profile->name) axes.push_back(other.axis.name);
        fmt::print("\nAssumed about {} ({} {}), because its manual leaves it open:\n", binding.profile->name,
                   axes.size() == 1 ? "axis" : "axes", fmt::join(axes, ", "));
        for (const auto& sentence : binding.profile->assumed) fmt::print("  {}\n", sentence);
        seen.push_back(binding.profile->name);
    }
}

/// Of drives that nobody described: each slave has its own, as far as the machine states nothing.
void print_undescribed(const MachineConfig& config) {
    for (const auto& binding : config.axes) {
        if (!binding.profile || binding.profile->assumptions.empty() || binding.drive_axis != 0) continue;
        fmt::print("\nAssumed about slave '{}' ({}), because nobody described it:\n", binding.slave, binding.profile->name);
        for (const auto& assumption : binding.profile->assumptions)
            fmt::print("  {}: {}\n      otherwise: {}\n", assumption.text, assumption.why, assumption.otherwise);
    }
}

Json undescribed_json(const axes::DriveProfile* profile) {
    auto out = Json::array();
    if (profile != nullptr)
        for (const auto& assumption : profile->assumptions)
            out.push_back(Json{{"what", assumption.text}, {"why", assumption.why}, {"otherwise", assumption.otherwise}});
    return out;
}

const axes::DriveProfile& profile_of(const MachineConfig& config, const std::string& axis) {
    return *std::find_if(config.axes.begin(), config.axes.end(), [&](const auto& b) { return b.axis.name == axis; })->profile;
}

std::string sentence(const std::string& text) { return text.empty() || text.back() == '.' ? text : text + "."; }

/// The memory of the scope.
void print_recording(const MachineConfig& config, const runtime::SignalRing& ring) {
    const auto& recording = config.recording;
    fmt::print("\nRecording: {} of every cycle stay in memory for {:g} s: {:.1f} MB ({} bytes a cycle).{}\n",
               count_text(ring.signals().size(), "signal"), to_seconds(recording.depth), static_cast<double>(ring.bytes()) / 1e6,
               ring.words() * 8,
               recording.files == 0
                   ? std::string(" Nothing is kept around alarms.")
                   : fmt::format(" Around an alarm that stops something {:g} s before and {:g} s behind it are kept, the newest {}.",
                                 to_seconds(recording.before), to_seconds(recording.after), recording.files));
}

/// One sentence for all axes that it concerns.
void print_hazards(const MachineConfig& config) {
    auto left = runtime::drive_hazards(config);
    if (left.empty()) return;
    fmt::print("\nHazards that the manuals name, and what to do about them:\n");
    while (!left.empty()) {
        const auto* hazard = left.front().hazard;
        const auto& drive = profile_of(config, left.front().axis).name;
        std::vector<std::string> axes;
        for (const auto& other : left)
            if (other.hazard->text == hazard->text && profile_of(config, other.axis).name == drive) axes.push_back(other.axis);
        fmt::print("  {} ({} {}): {}{}\n", fmt::join(axes, ", "), drive, hazard->section, sentence(hazard->text),
                   hazard->remedy.empty() ? "" : fmt::format("\n      {}", sentence(hazard->remedy)));
        std::erase_if(left, [&](const auto& other) {
            return std::find(axes.begin(), axes.end(), other.axis) != axes.end() && other.hazard->text == hazard->text;
        });
    }
}

Json hazards_json(const MachineConfig& config) {
    auto out = Json::array();
    for (const auto& [axis, hazard] : runtime::drive_hazards(config))
        out.push_back(Json{{"axis", axis},
                           {"drive", profile_of(config, axis).name},
                           {"section", hazard->section},
                           {"what", hazard->text},
                           {"remedy", hazard->remedy}});
    return out;
}

Json summary_json(const MachineConfig& config, const runtime::MachineLayout& layout, const std::vector<Error>& warnings,
                  const std::vector<Error>& remarks) {
    Json out{{"ok", true}, {"machine", config.name}, {"cycle_us", config.cycle.count() / 1000}, {"interface", config.bus.interface}};
    auto& slaves = out["slaves"] = Json::array();
    for (const auto& slave : config.bus.slaves)
        slaves.push_back(Json{{"name", slave.name},
                              {"device", slave.device ? slave.device->name : ""},
                              {"dc", slave.dc},
                              {"hot_connect", slave.hot_connect}});
    out["groups"] = groups_json(config);
    auto& axes = out["axes"] = Json::array();
    for (const auto& binding : config.axes) {
        const auto& axis = binding.axis;
        axes.push_back(Json{{"name", axis.name},
                            {"unit", axis.unit},
                            {"slave", binding.slave},
                            {"disabled", axis.disabled},
                            {"simulated", axis.simulated},
                            {"velocity", axis.limits.velocity},
                            {"acceleration", axis.limits.acceleration},
                            {"direction_limits", direction_sentences(axis)},
                            {"motor_rpm", runtime::motor_rpm(axis, axis.limits.velocity)},
                            {"homing", homing_text(axis.homing)},
                            {"scale", scale_sentences(binding)},
                            {"reactions", reaction_sentences(axis)},
                            {"brake", brake_sentence(binding)},
                            {"gantry", gantry_sentence(binding)},
                            {"load_encoder", load_sentence(binding)},
                            {"master_gone", master_gone(config, binding)},
                            {"assumed", binding.profile ? binding.profile->assumed : std::vector<std::string>{}},
                            {"undescribed", undescribed_json(binding.profile.get())}});
    }
    if (!config.axis_groups.empty()) out["axis_groups"] = axis_groups_json(config);
    if (!config.paths.empty()) out["paths"] = paths_json(config);
    out["programs"] = layout.programs;
    out["tasks"] = layout.tasks;
    out["hazards"] = hazards_json(config);
    out["warnings"] = problems_json(warnings);
    out["remarks"] = problems_json(remarks);
    return out;
}

void print_views(const std::vector<hmi::View>& views) {
    if (!views.empty()) fmt::print("\nPages of its own, for `taktwerk hmi`\n");
    for (const auto& view : views)
        fmt::print("  {:<16} {}{}: {}\n", view.name, view.title.english,
                   view.title.chinese == view.title.english ? "" : " · " + view.title.chinese, hmi::summary_of(view));
}

Json views_json(const std::vector<hmi::View>& views) {
    auto out = Json::array();
    for (const auto& view : views)
        out.push_back(
            Json{{"name", view.name}, {"title", {{"en", view.title.english}, {"zh", view.title.chinese}}}, {"rows", view.rows.size()}});
    return out;
}

int fail(const CheckOptions& options, const std::vector<Error>& errors) {
    if (options.json) fmt::print("{}\n", failure_json(errors).dump(2));
    else print_errors(errors);
    return exit_bad_file;
}

int check(const CheckOptions& options) {
    auto result = check_machine(options.file);
    if (const auto* errors = std::get_if<std::vector<Error>>(&result)) return fail(options, *errors);
    const auto& checked = std::get<CheckedMachine>(result);
    const MachineConfig& config = checked.config;
    const auto& served = checked.hmi.modbus_server;
    const auto& layout = checked.machine->layout();
    const auto& remarks = checked.remarks;

    if (options.json) {
        auto summary = summary_json(config, layout, checked.warnings, remarks);
        const auto& ring = checked.machine->signals();
        summary["recording"] = Json{{"signals", ring.signals().size()}, {"bytes", ring.bytes()}, {"bytes_a_cycle", ring.words() * 8}};
        if (!config.modbus.empty()) summary["modbus_tcp"] = modbus_asked_json(config.modbus);
        if (!checked.hmi.views.empty()) summary["views"] = views_json(checked.hmi.views);
        if (served) summary["modbus_server"] = modbus_offer_json(*served, hmi::names_of(layout));
        fmt::print("{}\n", summary.dump(2));
        return exit_ok;
    }
    for (const auto& warning : checked.warnings) print_warning(warning);
    const auto looks = checked.warnings.size() + remarks.size();
    fmt::print("{}: machine '{}', cycle {:g} ms, {}, {} {}, {}: {}\n", options.file, config.name, to_seconds(config.cycle) * 1e3,
               count_text(config.bus.slaves.size(), "slave"), config.axes.size(), config.axes.size() == 1 ? "axis" : "axes",
               count_text(config.programs.size(), "program"),
               looks == 0 ? "no problem found" : fmt::format("no error, {} to look at", count_text(looks, "remark")));
    if (!remarks.empty()) fmt::print("\nRuns, but is it meant?\n");
    for (const auto& remark : remarks) fmt::print("  {}: {}\n      {}\n", remark.subject, remark.what, remark.remedy);
    print_slaves(config);
    print_groups(config);
    print_clocks(config);
    if (!config.axes.empty()) fmt::print("\nAxes\n");
    for (const auto& binding : config.axes) print_axis(config, binding);
    fmt::print("{}{}", axis_groups_text(config), paths_text(config));
    print_programs(config, layout);
    print_recording(config, checked.machine->signals());
    if (config.emergency_stop.input.empty())
        fmt::print("\nNo emergency stop input: the runtime does not hear when the safety circuit opens.\n");
    else
        fmt::print("\nEmergency stop: input {}; power off when the axes stand, at the latest after {:g} ms. This is no safety function.\n",
                   config.emergency_stop.input, to_seconds(config.emergency_stop.power_off_after) * 1e3);
    fmt::print("{}", modbus_asked_text(config.modbus));
    print_views(checked.hmi.views);
    if (served) fmt::print("\n{}", modbus_offer_text(*served, hmi::names_of(layout)));
    print_hazards(config);
    print_assumptions(config);
    print_undescribed(config);
    return exit_ok;
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("check", "check a machine file, its drives and programs; say what it means");
    auto options = std::make_shared<CheckOptions>();
    sub->add_option("FILE", options->file, "machine file")->required();
    sub->add_flag("--json", options->json, "the result as one JSON object");
    sub->callback([&action, options] { action = [options] { return check(*options); }; });
}

}  // namespace taktwerk::apps
