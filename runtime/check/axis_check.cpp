#include "runtime/check/axis_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ecat/description/module_pdos.hpp"
#include "runtime/check/analog_check.hpp"
#include "runtime/check/encoder_check.hpp"
#include "runtime/check/mapped_objects.hpp"
#include "runtime/check/position_loop_check.hpp"
#include "runtime/stop_time.hpp"

namespace taktwerk::runtime {

namespace {

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

class AxisCheck {
public:
    AxisCheck(const MachineConfig& config, std::vector<Error>& errors) : config_(config), errors_(errors), problems_(errors) {
        for (const auto& slave : config.bus.slaves) slaves_.push_back(slave.name);
    }

    void run() {
        for (const auto& binding : config_.axes) {
            const auto subject = fmt::format("axes.{}", binding.axis.name);
            for (auto& error : axes::check(binding.axis)) errors_.push_back(std::move(error));
            check_reactions(binding, subject);
            check_position_loop(config_, binding, subject, problems_);
            check_mechanics(binding, subject);
            check_brake(binding, subject);
            if (binding.axis.simulated) check_simulated(binding, subject);
            if (binding.axis.load_encoder.on) check_load_encoder(binding, subject);
            if (!binding.drive.empty() && !binding.analog) continue;  // see check_serial
            if (binding.analog) check_analog_axis(binding, subject);
            else if (binding.slave.empty()) check_virtual(binding, subject);
            else if (binding.encoder) {
                check_counter(config_, binding, subject, counters_, problems_);
                check_measuring_axis(config_, binding, subject, problems_);
            } else if (has_place(binding, subject)) {
                check_on_drive(binding, subject);
                if (binding.axis.gantry.on) check_follower(binding, subject);
            }
        }
    }

private:
    /// What the simulation can compute in steps of an eighth of a millisecond.
    void check_mechanics(const AxisBinding& binding, const std::string& subject) {
        const auto& s = binding.simulation;
        const auto here = subject + ".simulation.elastic_load";
        if (s.elastic.load_inertia <= 0) return;
        if (s.elastic.load_inertia >= s.inertia)
            return problems_.add("axis.simulation", here + ".inertia", "it is part of `inertia`, and something must be left for the motor",
                                 fmt::format("give less than {:g} kgm2", s.inertia));
        const double resonance = s.elastic.frequency * std::sqrt(s.inertia / (s.inertia - s.elastic.load_inertia));
        if (s.elastic.frequency <= 0 || resonance > 500)
            problems_.add("axis.simulation", here + ".frequency",
                          fmt::format("motor and load would swing at {:g} Hz; the simulation computes up to 500 Hz", resonance),
                          "give a lower frequency, above 0, or leave `elastic_load` out");
    }

    void check_virtual(const AxisBinding& binding, const std::string& subject) {
        if (std::isfinite(binding.axis.limits.torque_towards(1)) || std::isfinite(binding.axis.limits.torque_towards(-1)))
            problems_.add("axis.no_torque_limit", subject + ".limits", "a virtual axis (without `slave`) has no torque",
                          "remove `torque` from its limits");
        if (binding.axis.gantry.on)
            problems_.add("axis.gantry", subject + ".gantry", "a virtual axis (without `slave`) has no sides", "name the leader's `slave`");
        if (binding.axis.encoder)
            problems_.add("axis.encoder", subject + ".encoder", "there is nothing that measures",
                          "name the `slave` whose position is meant, or remove `encoder`");
        if (binding.axis.homing.kind != axes::HomingKind::none && binding.axis.homing.kind != axes::HomingKind::set_here)
            problems_.add("axis.homing", subject + ".homing", "a virtual axis (without `slave`) has no switches", "use `kind: set_here`");
        if (binding.axis.load_encoder.on)
            problems_.add("axis.load_encoder", subject + ".load_encoder", "a virtual axis (without `slave`) has no motor to compare with",
                          "remove it, or name the `slave` that moves the load");
    }

    void check_load_encoder(const AxisBinding& binding, const std::string& subject) {
        std::vector<std::string> inputs;
        for (const auto& point : config_.io)
            if (point.direction == IoDirection::input) inputs.push_back(point.name);
        if (std::find(inputs.begin(), inputs.end(), binding.load_input) == inputs.end())
            problems_.unknown("axis.load_encoder", subject + ".load_encoder.input", "input", binding.load_input, inputs);
        const auto bits = bits_of_point(config_, binding.load_input, IoDirection::input);
        if (bits == 1)
            problems_.add("axis.load_encoder", subject + ".load_encoder.input", fmt::format("input '{}' is one bit", binding.load_input),
                          "name one that counts");
        else if (bits != 0 && bits < binding.axis.load_encoder.bits)
            problems_.add("axis.load_encoder", subject + ".load_encoder.bits",
                          fmt::format("input '{}' has {} bits: beyond them its counter begins anew", binding.load_input, bits),
                          fmt::format("write `bits: {}`, or fewer where the encoder counts in fewer", bits));
        if (binding.axis.encoder)
            problems_.add("axis.load_encoder", subject + ".load_encoder", "an axis that only measures has no motor to compare with",
                          "remove one of the two");
    }

    /// The other side of a gantry: a drive of its own, of the same type, exchanged as often.
    void check_follower(const AxisBinding& binding, const std::string& subject) {
        const auto here = subject + ".gantry.follower";
        const auto& follower = binding.follower;
        if (std::find(slaves_.begin(), slaves_.end(), follower.slave) == slaves_.end())
            return problems_.unknown("axis.gantry", here, "slave", follower.slave, slaves_);
        if (!taken_.insert({follower.slave, follower.drive_axis}).second)
            problems_.add("axis.gantry", here,
                          fmt::format("axis {} of slave '{}' already belongs to another axis", follower.drive_axis + 1, follower.slave),
                          "name the drive of the other side");
        if (!follower.profile || !binding.profile || follower.profile->name != binding.profile->name)
            problems_.add("axis.gantry", here, fmt::format("slave '{}' is another type of drive than '{}'", follower.slave, binding.slave),
                          "two types follow differently and rack the portal: use two of the same type");
        else if (follower.drive_axis >= binding.profile->axes)
            problems_.add("axis.gantry", subject + ".gantry.axis",
                          fmt::format("{} has no axis {}", binding.profile->name, follower.drive_axis + 1),
                          fmt::format("choose 1 to {}", binding.profile->axes));
        if (exchange_period_of(config_, binding.slave) != exchange_period_of(config_, follower.slave))
            problems_.add("axis.gantry", here, "the two sides are exchanged at different rates",
                          "give both slaves the same `sync_unit`: set-points must reach both drives alike");
        auto side = sides_of({binding}).back();
        for (const auto& slave : config_.bus.slaves)
            if (slave.name == follower.slave && slave.device && side.profile && side.drive_axis < side.profile->axes)
                check_mapping(slave, side, here);
    }

    void check_brake(const AxisBinding& binding, const std::string& subject) {
        const auto& brake = binding.axis.brake;
        const bool no_drive = binding.slave.empty() && binding.drive.empty();
        if (brake.by != axes::BrakeBy::drive && (no_drive || binding.axis.encoder))
            problems_.add("axis.brake", subject + ".brake",
                          no_drive ? "a virtual axis (without `slave`) has no motor that holds a load once the brake is open"
                                   : "an axis that only measures has no power to hold a load once the brake is open",
                          "give the brake to the axis whose drive holds the load");
        if (brake.by == axes::BrakeBy::output) return check_brake_output(binding, subject);
        if (!binding.brake_output.empty())
            problems_.add("axis.brake", subject + ".brake.output", "counts only where `by` is `output`",
                          "write `by: output`, or remove it");
        if (brake.by != axes::BrakeBy::object) return;
        if (!binding.profile || binding.slave.empty() || binding.profile->brake.object == axes::BrakeObject::none) {
            problems_.add(
                "axis.brake", subject + ".brake.by",
                binding.profile
                    ? fmt::format("{} has no object that works a brake: it works its own, or has no output for one", binding.profile->name)
                    : std::string("the axis has no drive"),
                "leave `brake` out where the drive works the brake; wire it to an output of the machine and write `by: output` where not");
            return;
        }
        const auto& needed = binding.profile->behaviour.output_control;
        const bool stored = needed.index == 0 || std::any_of(binding.stored.begin(), binding.stored.end(),
                                                             [&](const auto& one) { return one.object == needed && one.value == 1; });
        if (!stored)
            problems_.add(
                "axis.brake", subject + ".brake.by",
                fmt::format("{} obeys 60FEh only where {:04X}h is 1, which counts after a restart", binding.profile->name, needed.index),
                fmt::format("store it in the drive (`taktwerk drive set ... --store`, restart) and write it under `stored` of the slave: "
                            "{{ object: {:04X}h, value: 1 }}; then it is compared before the axis is enabled",
                            needed.index));
        for (const auto& slave : config_.bus.slaves)
            if (slave.name == binding.slave && slave.device) check_brake_mapping(slave, binding, subject);
    }

    void check_brake_output(const AxisBinding& binding, const std::string& subject) {
        std::vector<std::string> outputs;
        for (const auto& point : config_.io)
            if (point.direction == IoDirection::output) outputs.push_back(point.name);
        const auto& name = binding.brake_output;
        if (std::find(outputs.begin(), outputs.end(), name) == outputs.end()) {
            if (name.empty())
                problems_.add("axis.brake", subject + ".brake.output", "nothing says which output opens the brake",
                              "name one of `io.outputs`");
            else problems_.unknown("axis.brake", subject + ".brake.output", "output", name, outputs);
            return;
        }
        if (const auto bits = bits_of_point(config_, name, IoDirection::output); bits > 1)
            problems_.add("axis.brake", subject + ".brake.output",
                          fmt::format("output '{}' has {} bits: a brake is opened by one", name, bits), "name a digital output");
        if (!outputs_.insert(name).second)
            problems_.add("axis.brake", subject + ".brake.output", "this output already is another axis' or another wire's",
                          "give each axis its own");
        for (const auto& point : config_.io)
            if (point.direction == IoDirection::output && point.name == name && (point.safe_value != 0 || point.inverted))
                problems_.add("axis.brake", fmt::format("io.outputs.{}", name),
                              "an output that opens a brake must be off where nobody drives it, and off must mean closed",
                              "leave `safe` at 0 and `inverted` at false, and wire a brake that closes without current");
    }

    void check_brake_mapping(const ecat::SlaveConfig& slave, const AxisBinding& binding, const std::string& subject) {
        const std::uint8_t sub = binding.profile->brake.object == axes::BrakeObject::mask_opens ? 2 : 1;
        const auto index = static_cast<std::uint16_t>(0x60FE + binding.drive_axis * binding.profile->object_offset);
        const auto offered = ecat::pdos_of(*slave.device, slave.modules);
        const auto rx = mapped(slave.rx, offered.rx, offered.rx_assigned);
        const bool there = std::any_of(rx.begin(), rx.end(), [&](const auto& e) { return e.index == index && e.sub == sub; });
        if (!there && !rx.empty())
            problems_.add("axis.brake", subject + ".brake.by",
                          fmt::format("object {:04X}h:{:02} is not in the RxPDO of slave '{}'", index, sub, slave.name),
                          "add it under `pdo.rx` of the slave (docs/drives.md)");
    }

    /// A slave is on the cable, or it is not (present_slaves.hpp): one of its axes alone would be moved in earnest.
    void check_simulated(const AxisBinding& binding, const std::string& subject) {
        if (binding.slave.empty()) return;
        for (const auto& other : config_.axes)
            if (!other.axis.simulated && (other.slave == binding.slave || other.follower.slave == binding.slave))
                return problems_.add(
                    "axis.simulated", subject + ".simulated",
                    fmt::format("axis {} is on slave '{}', too, and is not simulated: the slave is there, and this axis would "
                                "be the real one",
                                other.axis.name, binding.slave),
                    "write `simulated: true` for all its axes, or `disabled: true` for this one");
    }

    /// What nobody would carry out: there is no drive, or one on a serial line, which always ramps first.
    void check_reactions(const AxisBinding& binding, const std::string& subject) {
        const bool on_line = !binding.drive.empty(), is_virtual = !on_line && binding.slave.empty();
        if (!on_line && !is_virtual) return;
        for (const auto& row : axes::reaction_bounds::rows) {
            const auto chosen = binding.axis.reactions.chosen(row.alarm);
            const bool quick = chosen == axes::ErrorReaction::quick_stop, off = chosen == axes::ErrorReaction::power_off;
            if (!quick && !(off && on_line)) continue;
            problems_.add("axis.reaction",
                          fmt::format("{}.reactions.{}", subject, find_alarm(axes::axis_alarms, axes::id(row.alarm))->name),
                          is_virtual ? "a virtual axis (without `slave`) has no drive that could stop it"
                                     : "a drive on a serial line has no quick stop of its own, and ramps before its power goes",
                          "choose `ramp_then_off`");
        }
    }

    /// A slave with a profile, and an axis of it that nobody else has.
    bool has_place(const AxisBinding& binding, const std::string& subject) {
        if (std::find(slaves_.begin(), slaves_.end(), binding.slave) == slaves_.end()) {
            problems_.unknown("axis.unknown_slave", subject + ".slave", "slave", binding.slave, slaves_);
            return false;
        }
        if (!taken_.insert({binding.slave, binding.drive_axis}).second)
            problems_.add("axis.drive_axis_taken", subject + ".axis",
                          fmt::format("axis {} of slave '{}' already belongs to another axis", binding.drive_axis + 1, binding.slave),
                          "give each axis an `axis` of its own");
        if (!binding.profile)
            problems_.add("axis.no_profile", subject + ".slave", fmt::format("slave '{}' has no drive profile", binding.slave),
                          "give the slave a `profile:`; a terminal can carry an axis that only measures (`encoder: true`)");
        return binding.profile != nullptr;
    }

    /// An amplifier on wires, with its encoder at a terminal.
    void check_analog_axis(const AxisBinding& binding, const std::string& subject) {
        check_analog(config_, binding, subject, outputs_, problems_);
        if (!config_.emergency_stop.input.empty()) check_stop_time(binding, subject);
        if (binding.encoder) return check_counter(config_, binding, subject, counters_, problems_);
        if (!binding.slave.empty() && std::find(slaves_.begin(), slaves_.end(), binding.slave) == slaves_.end())
            return problems_.unknown("axis.unknown_slave", subject + ".slave", "slave", binding.slave, slaves_);
        problems_.add("axis.analog", subject + ".slave",
                      binding.slave.empty() ? "no `slave` counts where the motor is"
                                            : fmt::format("slave '{}' is a drive, which closes its own loops", binding.slave),
                      "name the terminal that reads the motor's encoder, or the slave and the `object` that counts");
    }

    void check_on_drive(const AxisBinding& binding, const std::string& subject) {
        using namespace std::chrono_literals;
        const auto& profile = *binding.profile;
        if (binding.drive_axis >= profile.axes)
            problems_.add("axis.drive_axis", subject + ".axis",
                          fmt::format("{} has {} {}, there is no axis {}", profile.name, profile.axes, profile.axes == 1 ? "axis" : "axes",
                                      binding.drive_axis + 1),
                          profile.axes == 1 ? "remove `axis`" : fmt::format("choose 1 to {}", profile.axes));
        for (const auto& slave : config_.bus.slaves)
            if (slave.name == binding.slave && slave.device && binding.drive_axis < profile.axes) check_mapping(slave, binding, subject);
        if (exchange_period_of(config_, binding.slave) < profile.minimum_cycle_csp)
            problems_.add("axis.cycle_too_short", "cycle",
                          fmt::format("{} (axis {}) needs at least {} us in cyclic synchronous position mode", profile.name,
                                      binding.axis.name, profile.minimum_cycle_csp / 1us),
                          "lengthen `cycle`");
        if (binding.axis.homing.kind == axes::HomingKind::drive && !binding.axis.simulated) check_homing_method(binding, subject);
        if (!config_.emergency_stop.input.empty()) check_stop_time(binding, subject);
    }

    void check_mapping(const ecat::SlaveConfig& slave, const AxisBinding& binding, const std::string& subject) {
        const auto offered = ecat::pdos_of(*slave.device, slave.modules);
        const auto rx = mapped(slave.rx, offered.rx, offered.rx_assigned), tx = mapped(slave.tx, offered.tx, offered.tx_assigned);
        const auto carried = [&](std::uint16_t base) {  // as far as it is known
            const auto index = static_cast<std::uint16_t>(base + binding.drive_axis * binding.profile->object_offset);
            return rx.empty() || std::any_of(rx.begin(), rx.end(), [&](const auto& entry) { return entry.index == index; });
        };
        if (binding.axis.control.load.used() && !carried(0x60B2))
            problems_.add(
                "axis.not_mapped", subject + ".control.load",
                fmt::format("no torque offset (60B2h) is in the RxPDO of slave '{}': the drive would never hear of it", slave.name),
                "choose a PDO that has it, or add it under `pdo.rx` of the slave (docs/drives.md); or remove `load`");
        check_torque_limits(slave, binding, subject, carried);
        for (const auto& needed : needed_objects) {
            const auto& there = needed.output ? rx : tx;
            const auto index = static_cast<std::uint16_t>(needed.index + binding.drive_axis * binding.profile->object_offset);
            bool is_mapped = there.empty();
            for (const auto& entry : there) is_mapped = is_mapped || entry.index == index;
            if (!is_mapped)
                problems_.add("axis.not_mapped", subject + ".slave",
                              fmt::format("object {:04X}h ({}) is not in the {} of slave '{}'", index, needed.name,
                                          needed.output ? "RxPDO" : "TxPDO", slave.name),
                              fmt::format("map it: choose a PDO that has it, or add it under `pdo.{}` of the slave (docs/drives.md)",
                                          needed.output ? "rx" : "tx"));
        }
    }

    /// Limits of torque need an object that takes them: mapped, or else in the dictionary.
    template <class Carried>
    void check_torque_limits(const ecat::SlaveConfig& slave, const AxisBinding& binding, const std::string& subject,
                             const Carried& carried) {
        const auto& limits = binding.axis.limits;
        const double up = limits.torque_towards(1), down = limits.torque_towards(-1);
        if (std::isinf(up) && std::isinf(down)) return;
        const auto has = [&](std::uint16_t base) {
            const auto index = static_cast<std::uint16_t>(base + binding.drive_axis * binding.profile->object_offset);
            const auto& objects = slave.device->objects;
            return carried(base) || std::any_of(objects.begin(), objects.end(), [&](const auto& entry) { return entry.index == index; });
        };
        const bool each = has(0x60E0) && has(0x60E1);
        if (each || (up == down && has(0x6072))) return;
        const std::string field = limits.positive.torque > 0   ? ".limits.positive.torque"
                                  : limits.negative.torque > 0 ? ".limits.negative.torque"
                                                               : ".limits.torque";
        problems_.add("axis.no_torque_limit", subject + field,
                      has(0x6072)
                          ? fmt::format("slave '{}' has one torque limit for both directions (6072h), no 60E0h and 60E1h", slave.name)
                          : fmt::format("slave '{}' has no object for a torque limit: neither 6072h nor 60E0h and 60E1h", slave.name),
                      has(0x6072) ? "give the same limit for both as `limits.torque`" : "remove it, and set the limit at the drive itself");
    }

    void check_homing_method(const AxisBinding& binding, const std::string& subject) {
        const auto& profile = *binding.profile;
        bool documented = false;
        std::string list;
        for (const auto method : profile.homing_methods) {
            documented = documented || method == binding.axis.homing.method;
            list += fmt::format("{}{}", list.empty() ? "" : ", ", method);
        }
        if (!documented)
            problems_.add("axis.homing_method", subject + ".homing.method",
                          fmt::format("{} does not document homing method {}", profile.name, binding.axis.homing.method),
                          list.empty() ? "use another kind of homing" : fmt::format("choose one of {}", list));
    }

    void check_stop_time(const AxisBinding& binding, const std::string& subject) {
        const double needs = stop_seconds(binding.axis.limits), has = to_seconds(config_.emergency_stop.power_off_after);
        if (needs > has)
            problems_.add("machine.emergency_stop_time", subject + ".limits",
                          fmt::format("stopping from {} {}/s takes {:.2f} s, but power goes off {:.2f} s after an emergency stop",
                                      binding.axis.limits.velocity, binding.axis.unit, needs, has),
                          "raise `stop_deceleration` and `stop_jerk`, or `emergency_stop.power_off_after` (as the safety relay allows)");
    }

    const MachineConfig& config_;
    std::vector<Error>& errors_;
    Problems problems_;
    std::vector<std::string> slaves_;
    std::set<std::pair<std::string, int>> taken_;
    TakenCounters counters_;
    std::set<std::string> outputs_;  // that axes drive
};

}  // namespace

void check_axes(const MachineConfig& config, std::vector<Error>& errors) { AxisCheck{config, errors}.run(); }

}  // namespace taktwerk::runtime
