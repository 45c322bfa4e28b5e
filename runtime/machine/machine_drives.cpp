#include "runtime/machine/machine_drives.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "axes/axis/alarms.hpp"
#include "axes/drives/cia402/own_modes.hpp"
#include "axes/sim/virtual_drive.hpp"
#include "fb_library/gcode_path/gcode_path.hpp"
#include "runtime/relaxed_supervision.hpp"

namespace taktwerk::runtime {

namespace {

std::size_t slave_named(const ecat::Master& bus, const std::string& name) {
    auto found = MachineDrives::no_slave;
    for (std::size_t s = 0; s < bus.slave_count(); ++s)
        if (!name.empty() && bus.slave(s).name == name) found = s;
    return found;
}

std::vector<std::vector<std::size_t>> drives_of_several_axes(const std::vector<std::size_t>& axis_slave, std::size_t slaves) {
    std::vector<std::vector<std::size_t>> out(slaves);
    for (std::size_t axis = 0; axis < axis_slave.size(); ++axis)
        if (axis_slave[axis] != MachineDrives::no_slave) out[axis_slave[axis]].push_back(axis);
    std::erase_if(out, [](const auto& drive) { return drive.size() < 2; });
    return out;
}

}  // namespace

MachineDrives::MachineDrives(MachineBody& body, const std::vector<modbus::SerialLine*>& lines, std::vector<Error>& errors)
    : body_(body), serial_(body, lines, errors), analog_(body) {
    build_ports();
    build_axes();
    shared_ = drives_of_several_axes(slave_of_, body.bus.slave_count());
}

void MachineDrives::build_ports() {
    auto& bus = body_.bus;
    const auto& config = body_.config;
    for (std::size_t i = 0; i < config.axes.size(); ++i) {
        const auto& binding = config.axes[i];
        const auto slave = slave_named(bus, binding.slave);
        slave_of_.push_back(slave);
        if (auto on_line = serial_.drive_of(i)) {
            ports_.push_back(std::move(on_line));
        } else if (slave == no_slave) {
            ports_.push_back(std::make_unique<axes::sim::VirtualDrive>(config.cycle));
        } else if (binding.encoder) {
            ports_.push_back(at_encoder(slave, binding));
        } else if (binding.axis.gantry.on) {
            const auto sides = sides_of({binding});
            auto both = std::make_unique<axes::gantry::GantryPort>(
                on_bus_drive(slave, sides[0]), on_bus_drive(slave_named(bus, sides[1].slave), sides[1]), binding.follower.mirrored);
            gantries_.push_back(both.get());
            ports_.push_back(std::move(both));
        } else {
            ports_.push_back(on_bus_drive(slave, binding));
        }
    }
}

/// The axis only measures, or its motor hangs on wires.
std::unique_ptr<axes::DrivePort> MachineDrives::at_encoder(std::size_t slave, const AxisBinding& binding) {
    auto encoder = std::make_unique<axes::encoder::EncoderPort>(body_.bus, slave, *binding.encoder, binding.axis.memory.absolute);
    encoders_.push_back(encoder.get());
    if (!binding.analog) return encoder;
    return analog_.add(binding, std::move(encoder));
}

std::unique_ptr<axes::DrivePort> MachineDrives::on_bus_drive(std::size_t slave, const AxisBinding& side) {
    auto drive = std::make_unique<axes::cia402::Cia402Drive>(
        body_.bus, slave, side.drive_axis, side.profile, ecat::exchange_period(body_.bus_config, body_.bus.slave(slave)),
        axes::cia402::AxisWants{side.axis.gearing.counts_per_revolution, side.stored, axes::cia402::own_mode(side.axis)});
    bus_drives_.push_back(drive.get());
    return drive;
}

void MachineDrives::build_axes() {
    const auto& config = body_.config;
    body_.axes.reserve(config.axes.size());
    for (std::size_t i = 0; i < config.axes.size(); ++i) {
        auto axis = config.axes[i].axis;
        axis.patience.feedback =
            static_cast<std::uint16_t>(std::min<std::uint32_t>(supervised_limit(config, axis.patience.feedback), 60000));
        if (axis.load_encoder.on)
            axis.load_encoder.input = static_cast<std::uint16_t>(body_.io.find(IoDirection::input, config.axes[i].load_input));
        if (axis.brake.by == axes::BrakeBy::output)
            if (const int output = body_.io.find(IoDirection::output, config.axes[i].brake_output); output >= 0)
                brakes_.push_back({i, static_cast<std::size_t>(output)});
        body_.axes.emplace_back(axis, *ports_[i], config.cycle, static_cast<std::uint16_t>(i), &body_.views[i]);
    }
    std::vector<std::unique_ptr<axes::PathMaker>> paths;
    for (const auto& path : config.paths) paths.push_back(std::make_unique<gcode::GcodePathMaker>(path.text, path.options));
    body_.axis_groups.build(config.axis_groups, body_.axes, config.cycle, std::move(paths));
    body_.requests = WatchedRequests{body_.axes, &body_.axis_groups};
}

void MachineDrives::hold_brake_outputs() noexcept {
    for (const auto& brake : brakes_) {
        const auto state = body_.views[brake.axis].brake;
        body_.io.outputs()[brake.output] = state == axes::BrakeState::open || state == axes::BrakeState::opening ? 1 : 0;
    }
}

std::string MachineDrives::gantry_side(std::size_t axis) const {
    const auto& binding = body_.config.axes[axis];
    for (const auto* gantry : gantries_)
        if (gantry == ports_[axis].get())
            return fmt::format("slave '{}'", gantry->of_the_follower() ? binding.follower.slave : binding.slave);
    return {};
}

void MachineDrives::step(Instant now) {
    serial_.step(now);
    for (auto& port : ports_) port->step(now);
}

Result<void> MachineDrives::resolve() {
    for (auto* drive : bus_drives_)
        if (auto ok = drive->resolve(); !ok) return ok;
    for (auto* encoder : encoders_)
        if (auto ok = encoder->resolve(); !ok) return ok;
    analog_.join_capabilities();
    for (auto* gantry : gantries_) gantry->join_capabilities();
    return {};
}

// TSVM 7.1: some alarms have no axis. Whichever axis shows one, the others behind the same slave must not go on; those that show it too
// stop by themselves.
void MachineDrives::stop_axes_of_faulted_drives() noexcept {
    for (const auto& drive : shared_)
        for (const auto faulted : drive) {
            const auto alarm = ports_[faulted]->alarm();
            if (!alarm.whole_drive || alarm.warning) continue;
            for (const auto other : drive)
                if (other != faulted && ports_[other]->alarm().code == 0)
                    body_.axes[other].stop_for_error(axes::id(axes::AxisAlarm::drive_fault), true);
        }
}

}  // namespace taktwerk::runtime
