#include "runtime/world/world.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/present_slaves.hpp"
#include "runtime/relaxed_supervision.hpp"

namespace taktwerk::runtime {

namespace {

axes::sim::PlantConfig plant_of(const AxisBinding& binding) {
    const auto& simulation = binding.simulation;
    const double scale = binding.axis.gearing.counts_per_unit();
    const auto counts = [&](double u) { return u * scale; };
    axes::sim::PlantConfig plant;
    plant.counts_per_revolution = binding.axis.gearing.counts_per_revolution;
    plant.inertia = simulation.inertia;
    plant.viscous_friction = simulation.viscous_friction;
    plant.coulomb_friction = simulation.coulomb_friction;
    plant.load_torque = simulation.load_torque * (scale < 0 ? -1.0 : 1.0);
    plant.rated_torque = simulation.rated_torque;
    plant.breakaway_torque = simulation.breakaway_torque;
    plant.elastic = simulation.elastic;
    plant.cogging = simulation.cogging;
    plant.gains = simulation.gains;
    plant.start = counts(simulation.start);
    // On an inverted axis the drive's negative end is the axis' positive one.
    const bool inverted = scale < 0;
    const auto& low_stop = inverted ? simulation.positive_stop : simulation.negative_stop;
    const auto& high_stop = inverted ? simulation.negative_stop : simulation.positive_stop;
    const auto& low_limit = inverted ? simulation.positive_limit : simulation.negative_limit;
    const auto& high_limit = inverted ? simulation.negative_limit : simulation.positive_limit;
    if (low_stop) plant.negative_stop = counts(*low_stop);
    if (high_stop) plant.positive_stop = counts(*high_stop);
    if (low_limit) plant.negative_limit = counts(*low_limit);
    if (high_limit) plant.positive_limit = counts(*high_limit);
    if (simulation.home_from && simulation.home_to) {
        plant.home_from = std::min(counts(*simulation.home_from), counts(*simulation.home_to));
        plant.home_to = std::max(counts(*simulation.home_from), counts(*simulation.home_to));
        plant.home_every = std::abs(counts(binding.axis.modulo));  // a cam on a load that turns passes once a turn
    }
    plant.index_pulse = counts(simulation.index_pulse);
    plant.battery = simulation.battery;
    if (const auto& marks = simulation.marks; marks.every > 0) {
        const double begin = counts(marks.first), end = counts(marks.first + marks.length);
        plant.probe[0] = {std::min(begin, end), std::max(begin, end), std::abs(counts(marks.every))};
    }
    return plant;
}

/// Configured slaves in cable order: fixed positions first, those by alias fill the gaps.
std::vector<const ecat::SlaveConfig*> cable_order(const std::vector<ecat::SlaveConfig>& slaves) {
    std::vector<const ecat::SlaveConfig*> order(slaves.size(), nullptr);
    for (const auto& slave : slaves)
        if (slave.position && *slave.position < order.size()) order[*slave.position] = &slave;
    for (const auto& slave : slaves) {
        if (slave.position && *slave.position < slaves.size()) continue;
        for (auto& place : order)
            if (!place) {
                place = &slave;
                break;
            }
    }
    return order;
}

/// Number of the event `drive_fault` of an analog axis; any other, but 0, is an error of its encoder.
constexpr std::int64_t analog_amplifier_fault = 1;

/// Whoever has a statusword is played as a drive.
bool is_drive(const ecat::DeviceDescription& device) {
    return std::ranges::any_of(device.objects, [](const auto& object) { return object.index == 0x6041; });
}

unsigned bits_of(const ecat::DeviceDescription& device, const axes::ParameterAddress& object) {
    for (const auto& pdo : device.tx_pdos)
        for (const auto& entry : pdo.entries)
            if (entry.index == object.index && entry.sub == object.sub) return entry.bits;
    return 32;
}

double counts_per_unit_of(const MachineConfig& config, const std::string& axis) {
    for (const auto& binding : config.axes)
        if (binding.axis.name == axis) return binding.axis.gearing.counts_per_unit();
    return 1;
}

bool is_bit(const ecat::DeviceDescription& device, const IoPoint& point) {
    const auto has = [&](const std::vector<ecat::PdoDescription>& pdos) {
        for (const auto& pdo : pdos)
            for (const auto& entry : pdo.entries)
                if (entry.index == point.index && entry.sub == point.sub) return entry.bits == 1;
        return false;
    };
    return has(device.tx_pdos) || has(device.rx_pdos);
}

}  // namespace

World::World(const MachineConfig& config, Instant start)
    : modbus_(config), network_(start), transport_(network_), start_(start), events_(config.simulation.events) {
    std::stable_sort(events_.begin(), events_.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
    const auto sides = sides_of(config.axes);
    std::vector<axes::sim::PlantConfig> plants;
    for (const auto& binding : config.axes) plants.push_back(plant_of(binding));
    serial_.build(config, plants, start);
    const auto present = present_slaves(config);
    const auto install = [&](const ecat::SlaveConfig& slave, std::unique_ptr<ecat::sim::DeviceModel> model,
                             ecat::sim::SlaveOptions options) {
        const auto& wires = config.simulation.slaves;
        const auto wire = std::find_if(wires.begin(), wires.end(), [&](const SlaveSimulation& w) { return w.slave == slave.name; });
        if (wire != wires.end() && wire->drift_ppm) options.drift_ppm = *wire->drift_ppm;
        // A parent that is not there (all its axes `simulated: true`) is bridged: the cable comes from the slave before.
        auto* parent = wire != wires.end() ? find(wire->behind) : nullptr;
        auto* before = slaves_.empty() ? nullptr : slaves_.back().slave;
        if (parent == nullptr) parent = before;
        const unsigned port = wire != wires.end() ? wire->port : 1;
        const bool branch = parent != nullptr && network_.port_free(*parent, port);
        auto& added = branch ? network_.add_behind(*parent, port, slave.device, std::move(model), options)
                             : network_.add(slave.device, std::move(model), options);
        if (wire != wires.end()) network_.set_cable_delay(added, ecat::sim::cable_delay(wire->cable));
        slaves_.push_back({slave.name, &added});
    };
    for (const auto* slave : cable_order(present)) {
        ecat::sim::SlaveOptions options;
        options.name = slave->name;
        options.alias = slave->alias.value_or(0);
        options.device_id = slave->device_id;
        options.ethernet.mac.back() = static_cast<std::byte>(slaves_.size() + 1);
        if (!is_drive(*slave->device)) {
            auto model = std::make_unique<ecat::sim::PlainDevice>(*slave->device);
            auto* device = model.get();
            install(*slave, std::move(model), options);
            add_encoders(config, *slave,
                         {[device](axes::ParameterAddress at, std::int64_t value) { device->set(at.index, at.sub, value); },
                          [device](axes::ParameterAddress at) { return device->get(at.index, at.sub); }});
            for (const auto& point : config.io)
                if (point.slave == slave->name) points_.push_back({point, device, nullptr, is_bit(*slave->device, point)});
            continue;
        }
        std::vector<axes::sim::Cia402Device::AxisSetup> setups;
        std::vector<std::string> names;
        const axes::DriveProfile* profile = nullptr;
        for (const auto& binding : sides)
            if (binding.slave == slave->name && binding.profile) profile = binding.profile.get();  // what only reads it has none
        static const axes::DriveProfile plain;                                                     // a drive no axis uses still answers
        if (!profile) profile = &plain;
        setups.resize(profile->axes);
        names.resize(profile->axes);
        for (auto& setup : setups) setup.motor.counts_per_revolution = setup.plant.counts_per_revolution;
        for (const auto& binding : sides) {
            if (binding.slave != slave->name || binding.encoder || binding.drive_axis >= profile->axes) continue;
            auto& setup = setups[binding.drive_axis];
            setup.plant = plant_of(binding);
            setup.motor.counts_per_revolution = setup.plant.counts_per_revolution;
            setup.motor.absolute_encoder = binding.axis.memory.absolute;
            // Three motor turns of following error, and set-points within 6000 turns/min: what a drive of this class guards.
            setup.motor.following_error_limit = 3.0 * static_cast<double>(setup.plant.counts_per_revolution);
            setup.motor.maximum_velocity = 100.0 * static_cast<double>(setup.plant.counts_per_revolution);
            setup.motor.overspeed = profile->overspeed_limit * setup.motor.maximum_velocity;
            names[binding.drive_axis] = binding.axis.name;
            options.drift_ppm = binding.simulation.clock_drift_ppm;
        }
        auto played = *profile;
        // Without real time a drive that counts missed frames (TSVM 7.1.1) would count the stalls of this computer.
        played.missed_frames_allowed = static_cast<std::uint8_t>(std::min(255u, supervised_limit(config, played.missed_frames_allowed)));
        auto model = std::make_unique<axes::sim::Cia402Device>(played, setups);
        for (std::size_t i = 0; i < names.size(); ++i)
            if (!names[i].empty()) axes_.push_back({names[i], &model->axis(i), model.get(), i});
        for (const auto& binding : sides)
            if (binding.slave == slave->name)
                for (const auto& setting : binding.stored) model->commission(binding.drive_axis, setting.object, setting.value);
        for (const auto& point : config.io)
            if (point.slave == slave->name) points_.push_back({point, nullptr, model.get(), false});
        auto* servo = model.get();
        install(*slave, std::move(model), options);
        add_encoders(config, *slave,
                     {[servo](axes::ParameterAddress at, std::int64_t value) { servo->hold(at.index, at.sub, value); },
                      [](axes::ParameterAddress) { return std::int64_t{0}; }});
    }
    for (const auto& binding : config.axes)
        if (binding.axis.brake.by == axes::BrakeBy::output) brakes_.push_back({binding.axis.name, binding.brake_output});
    for (const auto& binding : config.axes)
        if (binding.analog) analogs_.push_back({binding.axis.name, *binding.analog, binding.brake_output, AnalogMotor(binding)});
    for (const auto& binding : config.axes)
        if (const auto& load = binding.axis.load_encoder; load.on) {
            const double counts = load.inverted ? -load.counts_per_unit : load.counts_per_unit;
            loads_.push_back({binding.axis.name, binding.load_input, counts / binding.axis.gearing.counts_per_unit(), counts, 0});
        }
    close_ring(config);
    groups_.build(config);
    for (const auto& point : config.io)
        if (point.direction == IoDirection::input && point.simulated) set_input_value(point.name, *point.simulated);
}

/// The second interface's cable goes into port 1 of the last slave in the line, whatever hangs beside it.
void World::close_ring(const MachineConfig& config) {
    if (!config.bus.ring || slaves_.empty()) return;
    const auto last =
        std::find_if(slaves_.rbegin(), slaves_.rend(), [this](const SlavePlace& place) { return network_.port_free(*place.slave, 1); });
    if (last == slaves_.rend()) return;
    second_ = std::make_unique<ecat::LoopbackTransport>(network_.close_ring(*last->slave));
    transport_.set_other_end(*second_);
    second_->set_other_end(transport_);
    ring_ = std::make_unique<ecat::RingTransport>(transport_, *second_, ecat::ring_patience(config.bus));
}

/// What a cable that breaks is carrying, and what has passed it already: none of it comes home.
void World::lose_under_way() {
    if (!ring_) return;
    transport_.lose_under_way(network_.now());
    second_->lose_under_way(network_.now());
}

ecat::sim::SimSlave* World::find(std::string_view slave) const noexcept {
    for (const auto& place : slaves_)
        if (place.name == slave) return place.slave;
    return nullptr;
}

const World::AxisPlace* World::place(std::string_view axis) const noexcept {
    for (const auto& place : axes_)
        if (place.name == axis) return &place;
    return nullptr;
}

axes::sim::Cia402Axis* World::drive(std::string_view axis) noexcept {
    const auto* found = place(axis);
    return found ? found->axis : nullptr;
}

bool World::is_single_bit(std::string_view input) const noexcept {
    if (modbus_.is_single_bit(input)) return true;
    for (const auto& point : points_)
        if (point.config.name == input && point.config.direction == IoDirection::input) return point.single_bit;
    return false;
}

void World::set_input_value(std::string_view name, std::int64_t value) {
    if (modbus_.set_input(name, value)) return;
    for (auto& point : points_) {
        if (point.config.name != name || point.config.direction != IoDirection::input) continue;
        if (point.device) point.device->set(point.config.index, point.config.sub, point.single_bit ? value != 0 : value);
        else point.drive->hold(point.config.index, point.config.sub, value);
    }
}

void World::set_input_fault(std::string_view name, bool holds) {
    for (auto& point : points_) {
        const auto& status = point.config.status;
        if (point.config.name != name || point.config.direction != IoDirection::input || !point.device || status.empty()) continue;
        const auto error = std::ranges::find(status, PointStatus::Kind::error, &PointStatus::kind);
        const auto& chosen = error != status.end() ? *error : status.front();
        point.device->set(chosen.index, chosen.sub, holds ? 1 : 0);
    }
}

std::int64_t World::output_value(std::string_view name) const {
    if (const auto word = modbus_.output(name)) return *word;
    for (const auto& point : points_)
        if (point.device && point.config.name == name && point.config.direction == IoDirection::output)
            return point.device->get(point.config.index, point.config.sub);
    return 0;
}

void World::set_slave_power(std::string_view slave, bool on) {
    if (auto* device = modbus_.device(slave)) device->set_power(on);
    if (auto* there = find(slave)) network_.set_power(*there, on);
}

void World::set_cable(std::string_view slave, bool plugged) {
    if (auto* there = find(slave)) network_.set_cable(*there, plugged);
    if (!plugged) lose_under_way();
}

void World::set_ring_cable(bool plugged) {
    network_.set_ring_cable(plugged);
    if (!plugged) lose_under_way();
}

void World::happen(const SimulationEvent& event) {
    using Kind = SimulationEvent::Kind;
    if (serial_.happen(event)) return;
    switch (event.kind) {
        case Kind::input: set_input_value(event.target, event.value); break;
        case Kind::input_fault: set_input_fault(event.target, event.value != 0); break;
        case Kind::slave_power: set_slave_power(event.target, event.value != 0); break;
        case Kind::drive_fault:
            if (const auto* axis = place(event.target)) axis->device->raise(axis->index, static_cast<std::uint16_t>(event.value));
            if (auto* motor = analog_motor(event.target)) motor->raise(event.value == analog_amplifier_fault);
            set_encoder_fault(event.target,
                              event.value != 0 && (analog_motor(event.target) == nullptr || event.value != analog_amplifier_fault));
            break;
        case Kind::main_power:
            if (auto* motor = analog_motor(event.target)) motor->main_power(event.value != 0);
            if (const auto* axis = place(event.target)) axis->device->main_power(event.value != 0);
            break;
        case Kind::serial_line: break;
        case Kind::group: groups_.connect(event.target, event.value != 0); break;
        case Kind::jam:
            if (auto* axis = drive(event.target)) axis->jam(event.value == 0);
            if (auto* motor = analog_motor(event.target)) motor->jam(event.value == 0);
            break;
    }
}

void World::slip(std::string_view axis, double u) {
    for (auto& load : loads_)
        if (load.axis == axis) load.slipped += u * load.counts_per_unit;
}

/// Of the slave that was installed last. What counts at a drive and is turned by nothing else is the drive's own.
void World::add_encoders(const MachineConfig& config, const ecat::SlaveConfig& slave, const TurnedEncoder::Device& device) {
    for (const auto& binding : config.axes)
        if (const bool turns = !binding.simulation.turned_by.empty() || binding.simulation.velocity != 0 || binding.analog;
            binding.encoder && binding.slave == slave.name && (turns || !is_drive(*slave.device)))
            encoders_.push_back({TurnedEncoder(binding, device, bits_of(*slave.device, binding.encoder->position)), slaves_.back().slave,
                                 counts_per_unit_of(config, binding.simulation.turned_by)});
}

void World::turn_encoders(Instant now) {
    for (auto& [encoder, terminal, counts_per_unit] : encoders_) {
        auto* motor = encoder.turned_by().empty() ? nullptr : drive(encoder.turned_by());
        const auto* own = analog_motor(encoder.axis());
        const auto* other = analog_motor(encoder.turned_by());
        const double u = own != nullptr     ? own->shown()
                         : other != nullptr ? other->position()
                         : motor != nullptr ? motor->plant().position() / counts_per_unit
                                            : encoder.by_itself(now - start_);
        encoder.turn(u, terminal->powered());
    }
}

/// At what it was given in the cycle before, up to now.
void World::run_analog_motors(Instant now) {
    const Duration time = now - run_until_.value_or(now);
    run_until_ = now;
    for (auto& [axis, wires, brake, motor] : analogs_) {
        double volts = 0;
        for (const auto& point : points_)
            if (point.config.name == wires.setpoint && point.config.direction == IoDirection::output)
                volts = point.config.line.value_of(output_value(wires.setpoint));
        if (!wires.reset.empty() && output(wires.reset)) motor.raise(false);
        motor.run(volts, output(wires.enable), !brake.empty() && !output(brake), time);
        for (const auto& [name, contact] :
             {std::pair{&wires.ready, motor.ready()}, std::pair{&wires.fault, motor.fault()},
              std::pair{&wires.negative_limit, motor.negative_limit()}, std::pair{&wires.positive_limit, motor.positive_limit()},
              std::pair{&wires.home_switch, motor.home_switch()}})
            if (!name->empty()) set_wired(*name, contact);
    }
}

/// What the machine shall see of it.
void World::set_wired(const std::string& name, bool seen) {
    for (const auto& point : points_)
        if (point.config.name == name && point.config.direction == IoDirection::input) set_input(name, seen != point.config.inverted);
}

void World::set_encoder_fault(std::string_view axis, bool holds) {
    for (auto& place : encoders_)
        if (place.encoder.axis() == axis) place.encoder.fail(holds);
}

AnalogMotor* World::analog_motor(std::string_view axis) noexcept {
    for (auto& place : analogs_)
        if (place.axis == axis) return &place.motor;
    return nullptr;
}

void World::apply_events(Instant now) {
    for (const auto& brake : brakes_)
        if (auto* motor = drive(brake.axis)) motor->brake_by_bus(output(brake.output));
    for (const auto& load : loads_)
        if (auto* motor = drive(load.axis))
            set_input_value(load.input, std::llround(motor->plant().position() * load.counts_per_count + load.slipped));
    run_analog_motors(now);
    turn_encoders(now);
    groups_.step();
    while (next_event_ < events_.size() && start_ + events_[next_event_].at <= now) happen(events_[next_event_++]);
    if (also) also(now);
    serial_.wire([this](const std::string& point) { return output(point); });
}

}  // namespace taktwerk::runtime
