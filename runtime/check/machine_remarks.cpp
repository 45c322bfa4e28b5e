#include "runtime/check/machine_remarks.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "runtime/check/analog_check.hpp"
#include "runtime/check/ebus_remarks.hpp"
#include "runtime/check/encoder_check.hpp"
#include "runtime/check/position_loop_check.hpp"
#include "runtime/check/reach_remarks.hpp"
#include "runtime/relaxed_supervision.hpp"

namespace taktwerk::runtime {

namespace {

using axes::AxisConfig;
using axes::HomingKind;

constexpr double usual_rpm = 6000;             // hardly a servo motor turns faster
constexpr double usual_settling_s = 1;         // who waits longer for in-position mostly meant ms
constexpr double following_of_velocity_s = 1;  // a window as wide as the way of a second at full speed is none

constexpr double usual_ramp_s = 20;  // who takes longer to its velocity mostly meant another unit

constexpr int full_percent = 75;  // of the cycle: what mailboxes, recovery and lateness need besides process data

class Remarks {
public:
    void add(std::string_view code, std::string subject, std::string what, std::string remedy) {
        found.push_back({fmt::format("remark.{}", code), std::move(subject), std::move(what), std::move(remedy)});
    }
    std::vector<Error> found;
};

double units_per_motor_turn(const AxisConfig& axis) noexcept {
    const auto& gearing = axis.gearing;
    return static_cast<double>(gearing.load_revolutions) * gearing.feed / static_cast<double>(gearing.motor_revolutions);
}

/// From standstill to that velocity. No jerk: it is not limited.
double ramp_seconds(double velocity, double acceleration, double jerk) noexcept {
    if (jerk <= 0 || !std::isfinite(jerk)) return velocity / acceleration;
    return velocity * jerk >= acceleration * acceleration ? velocity / acceleration + acceleration / jerk : 2 * std::sqrt(velocity / jerk);
}

/// An axis that ramps so slowly is refused for its emergency stop; what a group does by default is nobody's error.
void group_defaults(Remarks& remarks, const MachineConfig& config) {
    for (const auto& group : config.axis_groups) {
        const auto& d = group.default_dynamics;
        if (!(d.velocity > 0 && d.acceleration > 0)) continue;
        const double seconds = ramp_seconds(d.velocity, d.acceleration, d.jerk);
        if (!(seconds > usual_ramp_s)) continue;
        const bool by_jerk = ramp_seconds(d.velocity, d.acceleration, 0) < seconds / 2;
        const auto& u = group.unit;
        remarks.add("ramp", fmt::format("groups.{}.default", group.name),
                    fmt::format("from standstill to {:g} {}/s it takes {:.0f} s", d.velocity, u, seconds),
                    by_jerk ? fmt::format("is its jerk of {:g} {}/s3 meant so? with {:g} {}/s3 the acceleration is there within 0.1 s",
                                          d.jerk, u, 10 * d.acceleration, u)
                            : fmt::format("is its acceleration of {:g} {}/s2 meant so?", d.acceleration, u));
    }
}

void limits(Remarks& remarks, const AxisBinding& binding, const std::string& here) {
    const auto& axis = binding.axis;
    const auto& u = axis.unit;
    const double rpm = motor_rpm(axis, axis.limits.velocity);
    if (rpm > usual_rpm)
        remarks.add("motor_speed", here + ".limits.velocity",
                    fmt::format("{:g} {}/s is {:.0f} r/min of the motor", axis.limits.velocity, u, rpm),
                    fmt::format("compare with the motor's maximum; was {}/min meant ({:g} {}/s)? is `feed` or `gear` right?", u,
                                axis.limits.velocity / 60, u));
    const double turn = units_per_motor_turn(axis);
    if (axis.windows.in_position > turn)
        remarks.add("in_position", here + ".in_position.window",
                    fmt::format("within {:g} {} counts as arrived: more than a turn of the motor", axis.windows.in_position, u),
                    "give what the work needs, such as a hundredth of a turn");
    if (to_seconds(axis.windows.in_position_time) > usual_settling_s)
        remarks.add("in_position", here + ".in_position.time",
                    fmt::format("each motion waits {:g} s in its window", to_seconds(axis.windows.in_position_time)), "was ms meant?");
    const double stroke = axis.limits.position_max - axis.limits.position_min;
    const double widest = std::min(stroke, axis.limits.velocity * following_of_velocity_s);
    const double window = axis.following.window + axis.limits.velocity * to_seconds(axis.following.per_velocity);
    if (std::isfinite(window) && window > widest)
        remarks.add("following_error", here + ".following_error.window",
                    fmt::format("an error of {:g} {} is hardly ever reached: the axis is not watched", window, u),
                    "give what the axis lags at full speed, and a half more");
    for (const auto& [key, speed] : {std::pair{"slow", axis.manual.slow}, std::pair{"fast", axis.manual.fast},
                                     std::pair{"setup_velocity", axis.manual.setup_velocity}})
        if (speed > axis.limits.velocity)
            remarks.add("manual_speed", fmt::format("{}.manual.{}", here, key),
                        fmt::format("{:g} {}/s is above limits.velocity, {:g} {}/s, which holds", speed, u, axis.limits.velocity, u),
                        "give at most the limit");
    if (axis.modulo > 0 && turn > axis.modulo)
        remarks.add("modulo", here + ".modulo",
                    fmt::format("one turn of the motor is {:g} {}, more than the modulo of {:g} {}", turn, u, axis.modulo, u),
                    "compare `feed` and `gear` with the mechanics");
}

void simulated_switches(Remarks& remarks, const AxisBinding& binding, const std::string& here) {
    const auto& home = binding.axis.homing;
    const auto& world = binding.simulation;
    const bool no_switch = (home.kind == HomingKind::home_switch || home.kind == HomingKind::reference_pulse) && !world.home_from;
    const bool no_limit = home.kind == HomingKind::limit_switch && !(home.negative ? world.negative_limit : world.positive_limit);
    const bool no_stop = home.kind == HomingKind::block && !(home.negative ? world.negative_stop : world.positive_stop);
    const auto sense = home.negative ? "negative" : "positive";
    if (no_switch || no_limit || no_stop)
        remarks.add("simulated_switch", here + ".simulation",
                    "the simulated axis has not what its homing searches: in the simulation it never ends",
                    no_switch  ? std::string("add `simulation: {home_switch: ...}` to the axis")
                    : no_limit ? fmt::format("add `simulation: {{{}_limit: ...}}` to the axis", sense)
                               : fmt::format("add `simulation: {{{}_stop: ...}}` to the axis", sense));
}

void simulated_stops(Remarks& remarks, const AxisBinding& binding, const std::string& here) {
    const auto& [min, max] = std::pair{binding.axis.limits.position_min, binding.axis.limits.position_max};
    const auto& world = binding.simulation;
    const bool low = world.negative_stop && std::isfinite(min) && min < *world.negative_stop;
    const bool high = world.positive_stop && std::isfinite(max) && max > *world.positive_stop;
    if (low || high)
        remarks.add("simulated_stop", here + ".limits.position",
                    fmt::format("the software limit at {:g} {} lies beyond the simulated hard stop at {:g} {}", low ? min : max,
                                binding.axis.unit, low ? *world.negative_stop : *world.positive_stop, binding.axis.unit),
                    "a software limit stands before the stop: correct one of them");
}

void bus_load(Remarks& remarks, const MachineConfig& config) {
    auto bus = config.bus;
    bus.cycle = config.cycle;
    const auto load = ecat::bus_load(bus);
    const auto percent = load.round_trip * 100 / bus.cycle;
    if (percent < full_percent) return;
    // Refused is only what fits in no case (check_load of ecat/bus_config.cpp): a slave on an E-bus costs a third of one with cables.
    const auto* beyond = percent < 100 ? ""
                                       : ". The frames come back behind the next ones, and the bus does not come up, unless most of the "
                                         "slaves are terminals on an E-bus";
    remarks.add(
        "bus_load", "cycle",
        fmt::format("process data takes about {:.0f} us of the cycle of {:.0f} us there and back ({} bytes in {} frame(s), {} slaves): "
                    "{} %{}",
                    to_seconds(load.round_trip) * 1e6, to_seconds(bus.cycle) * 1e6, load.bytes, load.frames, bus.slaves.size(), percent,
                    beyond),
        fmt::format(
            "choose a cycle of {:.0f} us or more, or slower sync units: mailboxes, recovery and this computer's lateness need the rest",
            to_seconds(load.round_trip) * 1e6 * 100 / full_percent));
}

/// Frames may be lost for longer than the slaves bear it: the limit says something that does not hold.
void watchdogs(Remarks& remarks, const MachineConfig& config) {
    const bool relaxed = config.simulation.supervision == Supervision::relaxed;
    const std::int64_t cycles = supervised_limit(config, config.bus.lost_frames_limit);
    const Duration borne = cycles * config.cycle;
    std::vector<std::string> earlier;
    Duration shortest = borne;
    for (const auto& slave : config.bus.slaves) {
        const Duration watchdog = sm_watchdog(config, slave);
        if (!slave.device || slave.device->rx_pdos.empty() || watchdog >= borne) continue;
        earlier.push_back("'" + slave.name + "'");
        shortest = std::min(shortest, watchdog);
    }
    if (earlier.empty()) return;
    constexpr std::size_t named = 3;
    const std::size_t more = earlier.size() > named ? earlier.size() - named : 0;
    earlier.resize(std::min(earlier.size(), named));
    remarks.add(
        "watchdog_below_limit", "bus.lost_frames_limit",
        fmt::format("the machine bears {} cycles in a row without an answer{}, {:g} ms, but the watchdog of {}{} trips after {:g} ms",
                    cycles, relaxed ? fmt::format(" ({} times the limit: relaxed)", relaxed_factor) : "", to_seconds(borne) * 1e3,
                    fmt::join(earlier, ", "), more > 0 ? fmt::format(" and {} more", more) : "", to_seconds(shortest) * 1e3),
        "lost frames stop these slaves, and the machine with them, before the limit is reached: give a smaller `lost_frames_limit`, or "
        "them a longer `sm_watchdog`");
}

/// The file may know its drive better than the profile, so this is no error.
void startup_sizes(Remarks& remarks, const MachineConfig& config) {
    for (const auto& slave : config.bus.slaves) {
        if (!slave.device) continue;
        for (const auto& sdo : slave.startup)
            for (const auto& object : slave.device->objects) {
                if (object.index != sdo.index || object.sub != sdo.sub || ecat::bit_size(object.type) == ecat::bit_size(sdo.type)) continue;
                remarks.add("startup_size", sdo.origin,
                            fmt::format("writes {:04X}h:{:02X} of '{}' with {} bits, and the description of {} has it with {}", sdo.index,
                                        sdo.sub, slave.name, ecat::bit_size(sdo.type), slave.device->name, ecat::bit_size(object.type)),
                            "a slave refuses another length (06070010h) and does not come up: leave `type` out, unless the manual "
                            "of this very drive says so");
            }
    }
}

/// Only what a terminal can show trips a limit.
void point_limits(Remarks& remarks, const IoPoint& point) {
    constexpr double no_object = 0x1p62;  // beyond it nothing is known of the object's bits
    const auto& line = point.line;
    if (!point.limits || line.number != PointLine::Number::whole || line.most > no_object) return;
    const auto [low, high] = std::minmax({line.least * line.factor + line.offset, line.most * line.factor + line.offset});
    for (const auto& [word, limit, beyond] : {std::tuple{"lower", point.limits->low, point.limits->low < low},
                                              std::tuple{"upper", point.limits->high, point.limits->high > high}})
        if (beyond)
            remarks.add("point_limit", fmt::format("io.inputs.{}.limits", point.name),
                        fmt::format("the {} limit, {:g} {}, is never reached: the input shows {:.6g} to {:.6g} {}", word, limit, point.unit,
                                    low, high, point.unit),
                        "compare it with `scale`, and with what the terminal measures");
}

/// It is copied along with the rest of a file that ran simulated.
void relaxed_on_a_port(Remarks& remarks, const MachineConfig& config) {
    if (config.bus.interface.empty() || config.simulation.supervision != Supervision::relaxed) return;
    const auto cycles = supervised_limit(config, config.bus.lost_frames_limit);
    remarks.add(
        "relaxed_on_a_port", "simulation.supervision",
        fmt::format("relaxed holds on '{}', too: {} cycles without an answer are borne, and behind such a gap a drive leaps to where its "
                    "axis is by then",
                    config.bus.interface, cycles),
        "with real drives: strict; relaxed is for slaves that `taktwerk sim` plays");
}

void programs(Remarks& remarks, const MachineConfig& config, const MachineLayout& layout) {
    for (const auto& axis : layout.axes)
        if (axis.programs.size() > 1)
            remarks.add("axis_of_two_programs", "axes." + axis.name,
                        fmt::format("the programs {} declare this axis", fmt::join(axis.programs, " and ")),
                        "only one may command it (the newer command wins); reading is free");
    for (std::size_t i = 0; i < config.programs.size(); ++i) {
        const auto& program = config.programs[i];
        if (program.autostart && config.start_mode != Mode::automatic)
            remarks.add("autostart", fmt::format("programs.{}.autostart", program.name),
                        "the machine does not start in automatic mode, so the program does not start by itself",
                        "set `start_mode: automatic`, or start it with `taktwerk mode automatic` and `taktwerk start`");
        for (std::size_t k = 0; k < i; ++k)
            if (!program.library.empty() && config.programs[k].library == program.library)
                remarks.add("same_library", fmt::format("programs.{}.library", program.name),
                            fmt::format("'{}' runs the same library", config.programs[k].name),
                            "meant only where each has axes and outputs of its own");
    }
}

}  // namespace

double motor_rpm(const AxisConfig& axis, double velocity) noexcept { return velocity / units_per_motor_turn(axis) * 60; }

std::optional<double> stroke_seconds(const AxisConfig& axis) noexcept {
    const auto& limits = axis.limits;
    const double way = limits.position_max - limits.position_min;
    if (!std::isfinite(way)) return std::nullopt;
    const double v = limits.velocity, ramps = v * v / 2 * (1 / limits.acceleration + 1 / limits.deceleration);
    if (way >= ramps) return way / v + v / 2 * (1 / limits.acceleration + 1 / limits.deceleration);
    const double peak = std::sqrt(2 * way / (1 / limits.acceleration + 1 / limits.deceleration));
    return peak * (1 / limits.acceleration + 1 / limits.deceleration);
}

std::optional<Error> nothing_answers(const MachineConfig& config) {
    if (!config.bus.interface.empty() || !config.bus.slaves.empty()) return std::nullopt;
    return Error{"remark.no_slave", "bus.slaves", "a bus without a slave sends no frame back, so this machine does not run",
                 "add one, even where all axes are virtual: { name: coupler, device: ek1100 }"};
}

std::vector<Error> remarks(const MachineConfig& config, const MachineLayout& layout, unsigned cpus) {
    Remarks out;
    if (auto nobody = nothing_answers(config)) out.found.push_back(std::move(*nobody));
    const bool simulated = config.bus.interface.empty();
    for (const auto& binding : config.axes) {
        const auto here = "axes." + binding.axis.name;
        const bool virtual_axis = binding.slave.empty() && binding.drive.empty();
        if (!virtual_axis && binding.axis.encoder && !binding.axis.disabled)
            for (auto& remark : measuring_remarks(binding, here)) out.found.push_back(std::move(remark));
        if (virtual_axis || binding.axis.encoder || binding.axis.disabled) continue;
        for (auto& remark : position_loop_remarks(config, binding, here)) out.found.push_back(std::move(remark));
        limits(out, binding, here);
        if (simulated || binding.axis.simulated) simulated_switches(out, binding, here);
        simulated_stops(out, binding, here);
        if (binding.analog)
            for (auto& remark : analog_remarks(binding, here)) out.found.push_back(std::move(remark));
    }
    group_defaults(out, config);
    for (auto& remark : reach_remarks(config)) out.found.push_back(std::move(remark));
    for (const auto& point : config.io) point_limits(out, point);
    for (const auto& point : config.io)
        if (!config.emergency_stop.input.empty() && point.name == config.emergency_stop.input && point.inverted)
            out.add("emergency_stop_inverted", "emergency_stop.input",
                    fmt::format("'{}' is inverted: a broken wire or a terminal without power reads as released", point.name),
                    "take the normally closed contact and remove `inverted`");
    for (const auto cpu : config.realtime.cpus)
        if (cpus > 0 && static_cast<unsigned>(cpu) >= cpus)
            out.add("cpu", "realtime.cpus", fmt::format("this computer has the CPUs 0 to {}; there is no {}", cpus - 1, cpu),
                    "choose one that is there, best an isolated one");
    if (!config.bus.slaves.empty()) bus_load(out, config);
    for (auto& remark : ebus_remarks(config)) out.found.push_back(std::move(remark));
    watchdogs(out, config);
    relaxed_on_a_port(out, config);
    startup_sizes(out, config);
    programs(out, config, layout);
    return out.found;
}

}  // namespace taktwerk::runtime
