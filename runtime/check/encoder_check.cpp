#include "runtime/check/encoder_check.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "ecat/description/module_pdos.hpp"
#include "runtime/check/mapped_objects.hpp"

namespace taktwerk::runtime {

namespace {

const ecat::SlaveConfig* slave_named(const MachineConfig& config, const std::string& name) {
    const auto found = std::ranges::find(config.bus.slaves, name, &ecat::SlaveConfig::name);
    return found == config.bus.slaves.end() ? nullptr : &*found;
}

/// Bits of the position as far as they are known without the bus; 0: they are not.
unsigned check_mapped(const ecat::SlaveConfig& slave, const axes::EncoderChannel& channel, const std::string& subject, Problems& problems) {
    if (!slave.device) return 0;
    const auto& at = channel.position;
    const auto offered = ecat::pdos_of(*slave.device, slave.modules);
    const auto tx = mapped(slave.tx, offered.tx, offered.tx_assigned);
    for (const auto& entry : tx)
        if (entry.index == at.index && entry.sub == at.sub) return entry.bits;
    if (!tx.empty())
        problems.add(
            "axis.not_mapped", subject + ".slave",
            fmt::format("object {:04X}h:{:02X} ({}) is not in the TxPDO of slave '{}'", at.index, at.sub, channel.name, slave.name),
            "choose a PDO that has it under `pdo.tx` of the slave");
    return 0;
}

/// Between two exchanges it may count less than half of what it can: else nobody knows which way it turned.
void check_speed(const MachineConfig& config, const AxisBinding& binding, const std::string& subject, unsigned bits, Problems& problems) {
    if (bits == 0 || bits >= 64) return;
    const auto& axis = binding.axis;
    const double period = to_seconds(exchange_period_of(config, binding.slave)), half = std::ldexp(1.0, static_cast<int>(bits) - 1);
    const double counts_per_unit = std::abs(axis.gearing.counts_per_unit());  // negative where it is inverted
    const double fastest = half / (counts_per_unit * period);
    const auto compare = [&](const char* key, double velocity) {
        if (!(velocity >= fastest)) return;
        problems.add(
            "axis.encoder", subject + key,
            fmt::format("at {:g} {}/s it counts {:.0f} from one exchange to the next ({:g} ms), and beyond half of its {} bits ({:.0f}) "
                        "nobody knows which way it turned",
                        velocity, axis.unit, velocity * counts_per_unit * period, period * 1e3, bits, half),
            fmt::format("stay below {:.3g} {}/s, exchange the terminal more often, or choose one with a wider counter", fastest,
                        axis.unit));
    };
    compare(".limits.velocity", axis.limits.velocity);
    if (!binding.analog) compare(".simulation.velocity", std::abs(binding.simulation.velocity));
}

/// The axis arms them for its touch probe in each cycle; an output beside it would latch in between.
void check_latch_outputs(const MachineConfig& config, const AxisBinding& binding, Problems& problems) {
    for (const auto* latch : {&binding.encoder->index, &binding.encoder->rising, &binding.encoder->falling})
        for (const auto& point : config.io)
            if (latch->there() && point.direction == IoDirection::output && point.slave == binding.slave && !point.beside &&
                axes::ParameterAddress{point.index, point.sub} == latch->arm)
                problems.add("axis.encoder", fmt::format("io.outputs.{}", point.name),
                             fmt::format("axis {} works this latch of its encoder", binding.axis.name),
                             "remove the output: MC_TouchProbe and the homing of the axis arm it");
}

void check_turned_by(const MachineConfig& config, const AxisBinding& binding, const std::string& subject, Problems& problems) {
    const auto& by = binding.simulation.turned_by;
    if (by.empty()) return;
    std::vector<std::string> motors;
    for (const auto& other : config.axes)
        if ((other.profile && !other.slave.empty()) || other.analog) motors.push_back(other.axis.name);
    if (std::find(motors.begin(), motors.end(), by) == motors.end())
        problems.unknown("axis.simulation", subject + ".simulation.turned_by", "axis with a motor", by, motors);
    if (binding.simulation.velocity != 0)
        problems.add("axis.simulation", subject + ".simulation.velocity", fmt::format("axis {} turns it (`turned_by`), not a velocity", by),
                     "keep one of the two");
}

}  // namespace

void check_counter(const MachineConfig& config, const AxisBinding& binding, const std::string& subject, TakenCounters& taken,
                   Problems& problems) {
    const auto& channel = *binding.encoder;
    const auto& at = channel.position;
    const auto* slave = slave_named(config, binding.slave);
    if (slave == nullptr) {
        std::vector<std::string> slaves;
        for (const auto& one : config.bus.slaves) slaves.push_back(one.name);
        return problems.unknown("axis.unknown_slave", subject + ".slave", "slave", binding.slave, slaves);
    }
    if (!taken.insert({binding.slave, {at.index, at.sub}}).second)
        problems.add("axis.drive_axis_taken", subject + ".slave",
                     fmt::format("'{}' of slave '{}' already is another axis", channel.name, binding.slave),
                     "give each axis a position of its own: `axis: 2`");
    const unsigned bits = check_mapped(*slave, channel, subject, problems);
    if (bits == 1 || (bits != 0 && channel.bits > bits))
        problems.add("axis.encoder", subject + ".counter_bits", fmt::format("'{}' has {} bits", channel.name, bits),
                     bits == 1 ? "name an input that counts" : fmt::format("write `counter_bits: {}`, or fewer", bits));
    else check_speed(config, binding, subject, channel.bits != 0 ? channel.bits : bits, problems);
    if (channel.incremental && binding.axis.memory.absolute)
        problems.add(
            "axis.encoder", subject + ".position_memory.absolute",
            fmt::format("'{}' of slave '{}' is an incremental counter: it begins at 0 with each supply, and the axis would take that "
                        "for where it is",
                        channel.name, binding.slave),
            "remove it, and give the axis a reference after each start; absolute are encoders with SSI, BiSS or EnDat");
    check_latch_outputs(config, binding, problems);
}

void check_measuring_axis(const MachineConfig& config, const AxisBinding& binding, const std::string& subject, Problems& problems) {
    if (!binding.axis.encoder)
        problems.add("axis.encoder", subject + ".slave", fmt::format("slave '{}' is a terminal that counts", binding.slave),
                     "write `encoder: true`");
    if (binding.axis.homing.kind != axes::HomingKind::none)
        problems.add("axis.homing", subject + ".homing", "an axis that only measures moves to no reference",
                     "remove `homing`; a program sets its position (MC_SetPosition), or where the index passes "
                     "(MC_StepReferenceFlyingRefPulse)");
    check_turned_by(config, binding, subject, problems);
}

std::vector<Error> measuring_remarks(const AxisBinding& binding, const std::string& subject) {
    std::vector<Error> found;
    const auto& axis = binding.axis;
    const auto in_vain = [&](bool written, const char* key, const char* why) {
        if (!written) return;
        found.push_back({"remark.encoder_in_vain", subject + key, fmt::format("has no effect: the axis only measures, {}", why),
                         "remove it, or `encoder: true` where the axis is to move"});
    };
    const auto& control = axis.control;
    in_vain(control.mode != axes::ControlMode::position || control.kv > 0 || control.integral.used() || control.load.used() ||
                control.torque_feed_forward != 0 || control.rated_acceleration != 0 || control.output_limit != 0,
            ".control", "and nothing is controlled");
    in_vain(std::isfinite(axis.following.window), ".following_error", "and follows no set-point");
    in_vain(std::isfinite(axis.limits.position_min) || std::isfinite(axis.limits.position_max), ".limits.position",
            "and nothing watches whether it leaves them; a program can compare its position");
    return found;
}

}  // namespace taktwerk::runtime
