#include "apps/machine/master_gone.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "axes/drives/xp200/registers.hpp"
#include "axes/port/parameter_text.hpp"
#include "runtime/check/position_loop_check.hpp"

namespace taktwerk::apps {
namespace {

using axes::DriveProfile;
using axes::StopBy;
using axes::StopCause;
using axes::StopThen;

/// What decides a stop here, and who says so.
struct Setting {
    std::optional<std::int64_t> value;
    std::string from;
};

Setting setting(const ecat::SlaveConfig& slave, const runtime::AxisBinding& axis, axes::ParameterAddress object) {
    const auto index = static_cast<std::uint16_t>(object.index + axis.drive_axis * axis.profile->object_offset);
    for (auto sdo = slave.startup.rbegin(); sdo != slave.startup.rend(); ++sdo)
        if (sdo->index == index && sdo->sub == object.sub) return {sdo->value, sdo->origin.empty() ? "start-up list" : sdo->origin};
    for (const auto& stored : axis.stored)
        if (stored.object == object) return {stored.value, "stored in the drive"};
    for (const auto& row : axis.profile->parameters) {
        if (row.address != object) continue;
        switch (row.factory) {
            case axes::FactoryValue::stated: return {row.value, "the factory's value, nobody writes it"};
            case axes::FactoryValue::assumed: return {row.value, "assumed, its manual prints none and nobody writes it"};
            case axes::FactoryValue::unknown: return {std::nullopt, "its manual prints no factory value and nobody writes it"};
        }
    }
    return {std::nullopt, "not in the drive's description"};
}

std::string named(const DriveProfile& profile, axes::ParameterAddress object) {
    for (const auto& row : profile.parameters)
        if (row.address == object) return axes::name_of(row);
    return axes::object_text(object);
}

std::string words(const DriveProfile& profile, const axes::StopWay& way) {
    std::string text;
    switch (way.by) {
        case StopBy::coast: text = "the power goes off, the motor coasts"; break;
        case StopBy::dynamic_brake: text = "the power goes off, the shorted windings brake"; break;
        case StopBy::ramp: text = "it brakes along 6084h"; break;
        case StopBy::quick_ramp: text = "it brakes along 6085h"; break;
        case StopBy::torque_slope: text = "its torque goes to 0 along 6087h"; break;
        case StopBy::emergency_torque:
            text = fmt::format("it brakes at once with the torque of {}, not along a ramp", named(profile, profile.stops.emergency_torque));
            break;
        case StopBy::zero_speed: text = "it brakes at once with all its torque"; break;
    }
    switch (way.then) {
        case StopThen::free: return way.by == StopBy::coast ? text : text + ", then the power goes off";
        case StopThen::lock: return text + ", then it stays energised and holds its position";
        case StopThen::clamp: return text + ", then it stays energised at speed 0";
        case StopThen::dynamic_brake: return way.by == StopBy::dynamic_brake ? text : text + ", then the windings stay shorted";
    }
    return text;
}

/// As the profile has it of this drive, in the mode that the axis runs in; never what an option means elsewhere.
std::string stop_of(const ecat::SlaveConfig& slave, const runtime::AxisBinding& axis, StopCause cause, const std::string& what,
                    const std::string& otherwise) {
    const auto& profile = *axis.profile;
    const auto mode =
        axis.axis.control.mode == axes::ControlMode::velocity ? axes::DriveMode::cyclic_velocity : axes::DriveMode::cyclic_position;
    for (const auto& option : profile.stops.options) {
        if (option.cause != cause) continue;
        const auto way_for = [&](std::optional<std::int64_t> value) {
            return std::find_if(option.ways.begin(), option.ways.end(), [&](const axes::StopWay& way) {
                const bool fits = way.modes.empty() || std::find(way.modes.begin(), way.modes.end(), mode) != way.modes.end();
                return fits && (!value || way.value == *value);
            });
        };
        if (option.object.index == 0) {
            const auto way = way_for(std::nullopt);
            return way == option.ways.end() ? fmt::format("{}: {}", what, otherwise) : fmt::format("{}: {}", what, words(profile, *way));
        }
        const auto found = setting(slave, axis, option.object);
        const auto object = named(profile, option.object);
        if (!found.value) return fmt::format("{} ({}): nobody knows; {}", what, object, found.from);
        const auto way = way_for(found.value);
        return fmt::format("{} ({}) = {}: {} [{}]", what, object, *found.value,
                           way == option.ways.end() ? "a value that its manual does not describe" : words(profile, *way), found.from);
    }
    return fmt::format("{}: {}", what, otherwise);
}

/// What it announces by itself when the process data end; its fault reaction follows.
std::string loss_of(const DriveProfile& profile) {
    for (const auto& alarm : profile.alarms)
        if (alarm.kind == axes::DriveAlarmKind::communication)
            return fmt::format("the drive's own alarm for it is {} ({})",
                               alarm.panel.empty() ? fmt::format("{:04X}h", alarm.code) : alarm.panel, alarm.english);
    return "whether the drive announces it, its manual does not say";
}

std::string_view unstated_stop(axes::DriveStop stop) {
    return stop == axes::DriveStop::coast ? "taken to coast, its manual does not say"
                                          : "taken to brake and then go off, its manual does not say how";
}

std::optional<std::int64_t> parameter(const axes::xp200::DriveConfig& drive, std::uint16_t number) {
    for (const auto& p : drive.parameters)
        if (p.number == number) return p.value;
    if (drive.profile)
        for (const auto& row : drive.profile->parameters)
            if (row.address.index == number) return row.value;
    return std::nullopt;
}

/// A drive on a serial line: it does not notice that nobody speaks any more.
std::vector<std::string> line_gone(const runtime::MachineConfig& config, const runtime::AxisBinding& axis) {
    namespace pr = axes::xp200::pr;
    std::vector<std::string> out{"its line falls silent, which the drive does not notice: it goes on at the speed selected last [XP200 9]"};
    for (const auto& line : config.serial)
        for (const auto& entry : line.drives) {
            if (entry.drive.name != axis.drive) continue;
            if (entry.watchdog_output.empty()) {
                out.emplace_back("nothing stops it here: `unsupervised_line: accepted` says that something else does");
                continue;
            }
            Duration watchdog{};
            for (const auto& point : config.io)
                for (const auto& slave : config.bus.slaves)
                    if (point.name == entry.watchdog_output && point.direction == runtime::IoDirection::output && slave.name == point.slave)
                        watchdog = runtime::sm_watchdog(config, slave);
            out.push_back(
                fmt::format("output '{}' falls {:g} ms after the last process data by its terminal's own watchdog; when only the line is "
                            "silent, the runtime drops it after {:g} ms",
                            entry.watchdog_output, to_seconds(watchdog) * 1e3, to_seconds(entry.drive.silence) * 1e3));
            const bool ramps = parameter(entry.drive, pr::emergency_mode) == 1;
            out.push_back(ramps ? fmt::format("that is EMG: it stays enabled and brakes in {} ms for 1000 r/min (Pr164 = 1, Pr063), if "
                                              "Pr164 counts in speed control: "
                                              "its manual marks it for position control [XP200 5.4]",
                                              parameter(entry.drive, pr::stop_time).value_or(0))
                                : "that is EMG: the current is cut and it coasts (Pr164 = 0) [XP200 5.4.2]");
        }
    return out;
}

}  // namespace

std::vector<std::string> master_gone(const runtime::MachineConfig& config, const runtime::AxisBinding& axis) {
    std::vector<std::string> out;
    if (axis.slave.empty() && axis.drive.empty()) return {"no drive: nothing moves"};
    if (axis.axis.disabled) return {"left out: its drive is never enabled"};
    if (!axis.drive.empty()) return line_gone(config, axis);
    const auto slave =
        std::find_if(config.bus.slaves.begin(), config.bus.slaves.end(), [&](const auto& s) { return s.name == axis.slave; });
    if (slave == config.bus.slaves.end()) return out;
    out.push_back(fmt::format("after {:g} ms without process data the slave's watchdog takes it out of OP",
                              to_seconds(runtime::sm_watchdog(config, *slave)) * 1e3));
    if (axis.analog) {
        const auto setpoint = runtime::watchdog_of_output(config, axis.analog->setpoint);
        const auto enable = runtime::watchdog_of_output(config, axis.analog->enable);
        out.push_back(
            fmt::format("the watchdogs of its terminals take the set-point ('{}') away after {:g} ms and the enable ('{}') after {:g} "
                        "ms: until then it runs on, then it brakes or coasts as the amplifier is set",
                        setpoint.slave, to_seconds(setpoint.watchdog) * 1e3, enable.slave, to_seconds(enable.watchdog) * 1e3));
    }
    if (!axis.profile) return out;
    out.push_back(loss_of(*axis.profile));
    const auto shown = [&](std::uint16_t index) {
        return std::any_of(axis.profile->parameters.begin(), axis.profile->parameters.end(), [&](const auto& row) {
            return row.address == axes::ParameterAddress{index, 0};
        });
    };
    out.push_back(stop_of(*slave, axis, StopCause::fault, "at a fault", std::string(unstated_stop(axis.profile->stops.fault))));
    out.push_back(stop_of(*slave, axis, StopCause::quick_stop, "at a quick stop",
                          shown(0x605A) ? "its manual does not say what the values of 605Ah do" : "its manual does not describe it"));
    return out;
}

}  // namespace taktwerk::apps
