#include "runtime/check/analog_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "runtime/check/mapped_objects.hpp"

namespace taktwerk::runtime {

namespace {

using axes::HomingKind;

constexpr double most_offset = 1, most_volts = 10;  // V
constexpr double usual_offset = 0.1;                // V: an amplifier that needs more is to be adjusted itself
constexpr double headroom = 1.1;                    // of the velocity limit, for the position loop

/// u/s at the highest voltage.
double full_velocity(const axes::AnalogDrive& drive) noexcept { return std::abs(drive.velocity_at_10v) * drive.voltage_limit / 10; }

class AnalogCheck {
public:
    AnalogCheck(const MachineConfig& config, const AxisBinding& binding, const std::string& subject, std::set<std::string>& outputs,
                Problems& problems)
        : config_(config), binding_(binding), analog_(*binding.analog), subject_(subject), outputs_(outputs), problems_(problems) {}

    void run() {
        check_drive();
        check_loop();
        check_what_it_lacks();
        check_homing();
        check_setpoint();
        check_bit("enable", analog_.enable, IoDirection::output);
        check_bit("reset", analog_.reset, IoDirection::output);
        for (const auto& [key, name] :
             {std::pair{"ready", &analog_.ready}, std::pair{"fault", &analog_.fault}, std::pair{"negative_limit", &analog_.negative_limit},
              std::pair{"positive_limit", &analog_.positive_limit}, std::pair{"home_switch", &analog_.home_switch}})
            check_bit(key, *name, IoDirection::input);
        check_wires_apart();
    }

private:
    void add(const std::string& key, std::string what, std::string remedy) {
        problems_.add("axis.analog", subject_ + key, std::move(what), std::move(remedy));
    }

    void check_drive() {
        const auto& drive = analog_.drive;
        const auto& axis = binding_.axis;
        if (drive.velocity_at_10v == 0 || !std::isfinite(drive.velocity_at_10v))
            add(".analog.velocity_at_10V", "a voltage would move nothing",
                "give the velocity of the axis at +10 V, as set at the amplifier");
        else if (full_velocity(drive) < axis.limits.velocity)
            add(".analog.velocity_at_10V",
                fmt::format("{:g} V are {:g} {}/s, and limits.velocity is {:g} {}/s", drive.voltage_limit, full_velocity(drive), axis.unit,
                            axis.limits.velocity, axis.unit),
                "lower limits.velocity, or raise the velocity at 10 V at the amplifier and here");
        if (!(std::abs(drive.offset) <= most_offset))
            add(".analog.offset", "must be from -1 V to 1 V", "adjust a larger drift at the amplifier itself");
        if (!(drive.voltage_limit > 0 && drive.voltage_limit <= most_volts))
            add(".analog.voltage_limit", "must be above 0 and at most 10 V", "leave it out for 10 V");
    }

    void check_loop() {
        const auto& axis = binding_.axis;
        if (axis.control.mode != axes::ControlMode::velocity)
            add(".control.mode", "an analog drive closes no position loop: the axis does", "write `control: {mode: velocity, kv: 20}`");
        if (std::isinf(axis.following.window))
            add(".following_error", "nothing would stop a motor whose encoder has slipped or fallen silent",
                "add `following_error: {window: ...}`");
    }

    void check_what_it_lacks() {
        const auto& axis = binding_.axis;
        const auto& limits = axis.limits;
        if (axis.encoder) add(".encoder", "an axis that only measures has no motor", "remove `encoder`, or `analog`");
        if (!binding_.drive.empty()) add(".drive", "the axis has two drives", "remove `drive`, or `analog`");
        if (axis.gantry.on) add(".gantry", "a portal is moved by two drives on the bus", "remove `gantry`");
        if (axis.simulated)
            add(".simulated", "an analog axis is simulated with its whole bus only",
                "run the machine with --simulate, or write `disabled: true`");
        if (std::isfinite(limits.torque_towards(1)) || std::isfinite(limits.torque_towards(-1)))
            add(".limits", "an analog drive is told no torque", "remove `torque` from the limits; set it at the amplifier");
        if (axis.control.load.used() || axis.control.torque_feed_forward != 0)
            add(".control", "an analog drive is told no torque", "remove `load` and `torque_feed_forward`");
    }

    void check_homing() {
        const auto& homing = binding_.axis.homing;
        const auto needs = [&](const std::string& wire, const char* key) {
            if (wire.empty())
                add(".homing.kind", fmt::format("needs the input `analog.{}`", key),
                    "wire it, or choose another kind (docs/motion/homing.md)");
        };
        switch (homing.kind) {
            case HomingKind::drive:
            case HomingKind::block:
                return add(".homing.kind", "an analog drive homes by no method of its own, and says no torque",
                           "choose home_switch, limit_switch, reference_pulse, absolute or set_here");
            case HomingKind::limit_switch:
                return homing.negative ? needs(analog_.negative_limit, "negative_limit") : needs(analog_.positive_limit, "positive_limit");
            case HomingKind::reference_pulse:
                if (binding_.encoder && !binding_.encoder->index.there())
                    add(".homing.kind", "the encoder's terminal latches no index", "choose home_switch");
                return needs(analog_.home_switch, "home_switch");
            case HomingKind::home_switch: return needs(analog_.home_switch, "home_switch");
            default: return;
        }
    }

    const IoPoint* point(const char* key, const std::string& name, IoDirection direction) {
        std::vector<std::string> known;
        for (const auto& one : config_.io) {
            if (one.direction != direction) continue;
            if (one.name == name) return &one;
            known.push_back(one.name);
        }
        problems_.unknown("axis.analog", fmt::format("{}.analog.{}", subject_, key), direction == IoDirection::input ? "input" : "output",
                          name, known);
        return nullptr;
    }

    void take(const char* key, const std::string& name) {
        if (!outputs_.insert(name).second)
            add(fmt::format(".analog.{}", key), fmt::format("output '{}' already is another axis' or another wire's", name),
                "give each wire an output of its own");
    }

    void check_setpoint() {
        const auto* found = point("setpoint", analog_.setpoint, IoDirection::output);
        if (found == nullptr) return;
        if (found->unit != "V")
            add(".analog.setpoint",
                found->unit.empty() ? fmt::format("output '{}' has no unit", found->name)
                                    : fmt::format("output '{}' is in {}", found->name, found->unit),
                "name one in V: a channel of a terminal of +-10 V (config/devices/), or give the point a `scale` to V");
        else if (!(std::abs(found->line.value_of(found->safe_value)) < 1e-3))
            problems_.add("axis.analog", fmt::format("io.outputs.{}", found->name), "a motor would turn where nobody drives this output",
                          "leave `safe` out");
        else if (const double volts = analog_.drive.voltage_limit;
                 volts <= most_volts && !(found->line.holds(volts) && found->line.holds(-volts)))
            add(".analog.setpoint",
                fmt::format("output '{}' gives no {}: the motor would turn one way only", found->name,
                            found->line.holds(volts)    ? fmt::format("{:g} V", -volts)
                            : found->line.holds(-volts) ? fmt::format("{:g} V", volts)
                                                        : fmt::format("{:g} V and no {:g} V", volts, -volts)),
                "name a channel of a terminal of +-10 V, such as an EL4032 (config/devices/)");
        take("setpoint", found->name);
    }

    /// What cannot be TRUE together, or not without blocking the axis. A home switch may be a limit switch.
    void check_wires_apart() {
        if (!analog_.ready.empty() && analog_.ready == analog_.fault)
            add(".analog.fault", fmt::format("'{}' is `ready`, too: one of the two would always be against the other", analog_.fault),
                "an amplifier with one contact has `ready` alone: leave `fault` out");
        if (!analog_.negative_limit.empty() && analog_.negative_limit == analog_.positive_limit)
            add(".analog.positive_limit",
                fmt::format("'{}' is `negative_limit`, too: on either switch the axis could leave it neither way", analog_.positive_limit),
                "wire each switch to an input of its own");
    }

    /// Off must mean: nothing moves.
    void check_bit(const char* key, const std::string& name, IoDirection direction) {
        if (name.empty()) return;
        const auto* found = point(key, name, direction);
        if (found == nullptr) return;
        if (const auto bits = bits_of_point(config_, name, direction); bits > 1)
            add(fmt::format(".analog.{}", key), fmt::format("'{}' has {} bits", name, bits), "name one of a digital terminal");
        if (direction == IoDirection::input) return;
        if (found->safe_value != 0 || found->inverted)
            problems_.add("axis.analog", fmt::format("io.outputs.{}", name),
                          "an output that enables an amplifier must be off where nobody drives it, and off must mean: without power",
                          "leave `safe` at 0 and `inverted` at false");
        take(key, name);
    }

    const MachineConfig& config_;
    const AxisBinding& binding_;
    const AnalogAxis& analog_;
    const std::string& subject_;
    std::set<std::string>& outputs_;
    Problems& problems_;
};

}  // namespace

void check_analog(const MachineConfig& config, const AxisBinding& binding, const std::string& subject, std::set<std::string>& outputs,
                  Problems& problems) {
    AnalogCheck(config, binding, subject, outputs, problems).run();
}

std::vector<Error> analog_remarks(const AxisBinding& binding, const std::string& subject) {
    std::vector<Error> found;
    const auto add = [&](const char* code, const std::string& key, std::string what, std::string remedy) {
        found.push_back({fmt::format("remark.{}", code), subject + key, std::move(what), std::move(remedy)});
    };
    const auto& analog = *binding.analog;
    const auto& axis = binding.axis;
    if (const double full = full_velocity(analog.drive); full < headroom * axis.limits.velocity)
        add("analog_headroom", ".analog.velocity_at_10V",
            fmt::format("at limits.velocity only {:g} {}/s are left for the position loop", full - axis.limits.velocity, axis.unit),
            "leave a tenth or more: an axis that falls behind at full speed never catches up");
    if (std::abs(analog.drive.offset) > usual_offset)
        add("analog_offset", ".analog.offset", fmt::format("{:g} V are much for a drift", analog.drive.offset),
            "adjust the amplifier itself, or compare with what it was measured by (docs/motion/analog-drives.md)");
    if (analog.ready.empty() && analog.fault.empty())
        add("analog_unwatched", ".analog",
            "neither `ready` nor `fault` is wired: that the amplifier fell is seen by the following error only",
            "wire its ready contact to an input");
    if (const double runaway = analog.drive.runaway(axis.limits.velocity); runaway > axis.following.window)
        add("analog_polarity", ".analog.polarity_distance",
            fmt::format(
                "an encoder that is wired the other way round is stopped by the following error ({:g} {}) before it is told as that "
                "({:g} {})",
                axis.following.window, axis.unit, runaway, axis.unit),
            "make it smaller than following_error.window");
    return found;
}

}  // namespace taktwerk::runtime
