// What is decided before the cycle (which objects are mapped, what the drive can) and what the service side does.

#include "axes/drives/cia402/cia402_drive.hpp"

#include "axes/drives/cia402/words.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace taktwerk::axes::cia402 {

Cia402Drive::Cia402Drive(ecat::Master& bus, std::size_t slave, std::uint8_t axis, std::shared_ptr<const DriveProfile> profile,
                         Duration cycle, AxisWants wants)
    : place_(bus, slave, axis, profile->object_offset),
      profile_(std::move(profile)),
      interpolation_(profile_->csp_interpolates ? cycle : Duration{}),
      status_(*profile_),
      own_{wants.mode},
      alarm_(*profile_, profile_->alarm_detail_index ? place_.object(profile_->alarm_detail_index) : std::uint16_t{0}),
      settings_(*profile_, static_cast<std::uint16_t>(axis * profile_->object_offset), cycle, std::move(wants)) {
    auto& c = capabilities_;
    for (const auto mode : profile_->modes) c.modes = static_cast<std::uint16_t>(c.modes | (1u << static_cast<unsigned>(mode)));
    c.drive_homing = !profile_->homing_methods.empty() && c.has(DriveMode::homing);
    c.motor_has_encoder = profile_->encoder.present;
    c.position_bits = profile_->position_bits;
    c.minimum_cycle = profile_->minimum_cycle_csp;
    c.feedback_period = cycle;
    c.enable_delay = profile_->enable_delay;
    c.mode_change_delay = profile_->mode_rules.change_delay;
    c.mode_change_at_standstill = profile_->mode_rules.change_at_standstill;
    c.profile_replaces = !profile_->has(Quirk::pp_bit_5_blends);
    if (profile_->encoder.clear_turns.index != 0 || profile_->encoder.clear_turns_control != 0)
        c.services = static_cast<std::uint8_t>(c.services | 1u << static_cast<unsigned>(DriveService::clear_multi_turn));
    if (profile_->has(Quirk::probe_toggle_bits))
        for (auto& probe : probes_) probe.use_toggle_bits();
    c.reports_following = !profile_->has(Quirk::csp_bits_12_13_reserved);
}

Result<void> Cia402Drive::resolve() {
    const auto missing = [&](std::uint16_t index, const char* what, const char* pdo, const char* list) {
        return Error{
            "drive.not_mapped", place_.subject(), fmt::format("object {:04X}h ({}) is not in its {}", place_.object(index), what, pdo),
            fmt::format("map {:04X}h: choose a PDO that has it, or add it to a variable one under `pdo.{}` of the slave (docs/drives.md)",
                        place_.object(index), list)};
    };
    const auto no_output = [&](std::uint16_t index, const char* what) { return missing(index, what, "RxPDO", "rx"); };
    const auto no_input = [&](std::uint16_t index, const char* what) { return missing(index, what, "TxPDO", "tx"); };

    if (!place_.find_output(out_.control, 0x6040, 0, false)) return no_output(0x6040, "controlword");
    const bool undescribed = profile_->assumes(AssumedPart::process_data);
    const bool sends_mode = place_.find_output(out_.mode, 0x6060, 0, true), shows_mode = place_.find_input(in_.mode, 0x6061, 0, true);
    if (!sends_mode && !undescribed) return no_output(0x6060, "modes of operation");
    if (!place_.find_output(out_.target_position, 0x607A, 0, true) && capabilities_.has(DriveMode::cyclic_position) && !undescribed)
        return no_output(0x607A, "target position");
    if (!place_.find_input(in_.status, 0x6041, 0, false)) return no_input(0x6041, "statusword");
    if (!shows_mode && !undescribed) return no_input(0x6061, "modes of operation display");
    if (auto taken = take_own_modes(sends_mode, shows_mode); !taken) return taken;
    if (!place_.find_input(in_.position, 0x6064, 0, true)) return no_input(0x6064, "position actual value");

    (void)place_.find_output(out_.target_velocity, 0x60FF, 0, true);
    (void)place_.find_output(out_.target_torque, 0x6071, 0, true);
    capabilities_.velocity_feed_forward = place_.find_output(out_.velocity_offset, 0x60B1, 0, true);
    capabilities_.torque_feed_forward = place_.find_output(out_.torque_offset, 0x60B2, 0, true);
    find_torque_limits();
    capabilities_.velocity_limit = place_.find_output(out_.velocity_limit, 0x607F, 0, false);
    capabilities_.digital_outputs = place_.find_output(out_.digital, 0x60FE, 1, false);
    const bool mask = place_.find_output(out_.digital_mask, 0x60FE, 2, false);
    capabilities_.brake = (profile_->brake.object == BrakeObject::output_bit && capabilities_.digital_outputs) ||
                          (profile_->brake.object == BrakeObject::mask_opens && mask);
    (void)place_.find_output(out_.profile_velocity, 0x6081, 0, false);
    (void)place_.find_output(out_.profile_acceleration, 0x6083, 0, false);
    (void)place_.find_output(out_.profile_deceleration, 0x6084, 0, false);
    (void)place_.find_output(out_.torque_slope, 0x6087, 0, false);

    (void)place_.find_input(in_.velocity, 0x606C, 0, true);
    (void)place_.find_input(in_.torque, 0x6077, 0, true);
    (void)place_.find_input(in_.error, 0x603F, 0, false);
    capabilities_.digital_inputs = place_.find_input(in_.digital, 0x60FD, 0, false);
    feedback_.has_inputs = capabilities_.digital_inputs;
    // A clock that nobody synchronises never shows in bit 8.
    const auto clock_bit = profile_->has(Quirk::clock_bit_8) && !place_.slave().dc ? bit_clock : std::uint16_t{0};
    status_.await(static_cast<std::uint16_t>(profile_->enable_status_bits & ~clock_bit));
    find_probes();
    find_homing_setup();
    drop_modes_without_target();
    if (auto moved = check_own_mode(); !moved) return moved;
    capabilities_.profile_buffer = capabilities_.has(DriveMode::profile_position) ? profile_->profile_buffer : std::uint8_t{0};
    find_ramps();
    collect_starting_values();
    return {};
}

void Cia402Drive::find_probes() {
    capabilities_.probes = capabilities_.probe_edges = 0;
    if (!place_.find_output(out_.probe_function, 0x60B8, 0, false) || !place_.find_input(in_.probe_status, 0x60B9, 0, false)) return;
    static constexpr std::uint16_t positions[2][2] = {{0x60BA, 0x60BB}, {0x60BC, 0x60BD}};
    for (std::size_t probe = 0; probe < 2; ++probe) {
        const bool rising = place_.find_input(in_.probe_position[probe][0], positions[probe][0], 0, true);
        const bool falling = place_.find_input(in_.probe_position[probe][1], positions[probe][1], 0, true);
        if ((!rising && !falling) || probe >= profile_->probes) continue;
        capabilities_.probes = static_cast<std::uint8_t>(probe + 1);
        capabilities_.probe_edges =
            static_cast<std::uint8_t>(capabilities_.probe_edges | ((rising ? 1u : 0u) | (falling ? 2u : 0u)) << (2 * probe));
    }
}

/// Settings can be written per run where the drive has all four objects and none of them is overwritten by each frame.
void Cia402Drive::find_homing_setup() {
    static constexpr std::pair<std::uint16_t, std::uint8_t> wanted[HomingSetup::count] = {
        {0x6098, 0}, {0x6099, 1}, {0x6099, 2}, {0x609A, 0}};
    capabilities_.homing_per_run = false;
    const auto& slave = place_.slave();
    if (!capabilities_.drive_homing || !slave.device) return;
    std::array<HomingSetup::Object, HomingSetup::count> objects;
    HomingSetup::Values at_start{};
    for (std::size_t i = 0; i < HomingSetup::count; ++i) {
        const auto [base, sub] = wanted[i];
        const auto index = place_.object(base);
        if (place_.bus().maps_output(place_.number(), index, sub)) return;
        const auto& entries = slave.device->objects;
        const auto entry =
            std::find_if(entries.begin(), entries.end(), [&, s = sub](const auto& e) { return e.index == index && e.sub == s; });
        if (entry == entries.end()) return;
        objects[i] = {index, sub, static_cast<std::uint8_t>(ecat::bit_size(entry->type) / 8), entry->access != ecat::Access::wo};
        for (const auto& sdo : slave.startup)
            if (sdo.index == index && sdo.sub == sub) at_start[i] = sdo.value;
    }
    homing_setup_.configure(objects, at_start);
    capabilities_.homing_per_run = true;
}

/// What of a profile's speed and ramps goes by SDO: the drive has it and it is not mapped.
void Cia402Drive::find_ramps() {
    const auto& device = place_.slave().device;
    if (!device) return;
    const auto use = [&](RampWriter::Ramp ramp, const MappedOutput& mapped, std::uint16_t base) {
        if (mapped.mapped()) return;
        for (const auto& entry : device->objects)
            if (entry.index == place_.object(base) && entry.sub == 0) ramps_.use(ramp, entry.index, ecat::bit_size(entry.type) / 8u);
    };
    use(RampWriter::velocity, out_.profile_velocity, 0x6081);
    use(RampWriter::acceleration, out_.profile_acceleration, 0x6083);
    use(RampWriter::deceleration, out_.profile_deceleration, 0x6084);
    use(RampWriter::torque_slope, out_.torque_slope, 0x6087);
}

/// Mapped ones go with each frame. Else those that the drive has are written when they change: one for each direction where it has them.
void Cia402Drive::find_torque_limits() {
    const bool both_ways = place_.find_output(out_.torque_max, 0x6072, 0, false);
    const bool positive = place_.find_output(out_.torque_positive, 0x60E0, 0, false);
    const bool negative = place_.find_output(out_.torque_negative, 0x60E1, 0, false);
    capabilities_.torque_limit_per_direction = positive && negative;
    capabilities_.torque_limits = both_ways || (positive && negative);
    const auto& slave = place_.slave();
    if (positive || negative || both_ways || !slave.device) return;
    const auto writable = [&](std::uint16_t base) -> std::optional<TorqueLimitWriter::Object> {
        for (const auto& entry : slave.device->objects) {
            if (entry.index != place_.object(base) || entry.sub != 0 || entry.access == ecat::Access::ro) continue;
            const std::size_t bytes = std::min<std::size_t>(ecat::bit_size(entry.type) / 8u, 4);
            TorqueLimitWriter::Object limit{entry.index, bytes, (std::int64_t{1} << (8 * bytes)) - 1};
            if (entry.maximum) limit.high = std::min(limit.high, *entry.maximum);
            if (entry.value > 0) limit.at_start = entry.value;
            for (const auto& sdo : slave.startup)
                if (sdo.index == entry.index && sdo.sub == 0) limit.at_start = sdo.value;
            return limit;
        }
        return std::nullopt;
    };
    const auto up = writable(0x60E0), down = writable(0x60E1), either = writable(0x6072);
    capabilities_.torque_limit_per_direction = up && down;
    if (up && down) {
        torque_limits_.use(0, *up);
        torque_limits_.use(1, *down);
    } else if (either) {
        torque_limits_.use(0, *either);
    }
    capabilities_.torque_limits_written = torque_limits_.used();
}

void Cia402Drive::drop_modes_without_target() noexcept {
    const auto needs = [&](DriveMode mode, const MappedOutput& target) {
        if (!target.mapped()) capabilities_.modes = static_cast<std::uint16_t>(capabilities_.modes & ~(1u << static_cast<unsigned>(mode)));
    };
    needs(DriveMode::cyclic_position, out_.target_position);
    needs(DriveMode::profile_position, out_.target_position);
    needs(DriveMode::profile_velocity, out_.target_velocity);
    needs(DriveMode::cyclic_velocity, out_.target_velocity);
    needs(DriveMode::profile_torque, out_.target_torque);
    needs(DriveMode::cyclic_torque, out_.target_torque);
}

void Cia402Drive::collect_starting_values() {
    starting_.clear();
    const auto& slave = place_.slave();
    if (!slave.device) return;
    for (const auto& entry : slave.device->objects) {
        if (!place_.bus().maps_output(place_.number(), entry.index, entry.sub)) continue;
        auto value = entry.value;
        for (const auto& sdo : slave.startup)
            if (sdo.index == entry.index && sdo.sub == entry.sub) value = sdo.value;
        const auto signal = place_.bus().output(place_.number(), entry.index, entry.sub);
        if (signal && value != 0) starting_.add(*signal, value);
        if (entry.index == place_.object(0x607F) && entry.sub == 0) starting_.velocity_limit(value);
    }
    for (const auto& found : place_.bus().found_outputs(place_.number())) {
        const auto signal = place_.bus().output(place_.number(), found.index, found.sub);
        if (signal) starting_.add(*signal, found.value);
        if (found.index == place_.object(0x607F) && found.sub == 0) starting_.velocity_limit(found.value);
    }
}

DriveAlarm Cia402Drive::alarm() const noexcept { return alarm_.alarm(); }

void Cia402Drive::step(Instant) {
    alarm_.step(place_.bus(), place_.number());
    ramps_.step(place_.bus(), place_.number());
    if (torque_limits_.used()) torque_limits_.step(place_.bus(), place_.number());
    if (capabilities_.homing_per_run) homing_setup_.step(place_.bus(), place_.number());
    settings_.step(place_.bus(), place_.number());
}

ServiceTicket Cia402Drive::read_parameter(ParameterAddress address) {
    return place_.bus().upload(place_.number(), place_.object(address.index), address.sub);
}

ServiceTicket Cia402Drive::write_parameter(ParameterAddress address, std::vector<std::byte> value) {
    // The next frame would overwrite it, and some drives take that badly (SV33-E 6.2.8, TSVM 5.2.5).
    if (place_.bus().maps_output(place_.number(), place_.object(address.index), address.sub)) return 0;
    // Units that change under a moving axis would make its next set-point another one (SV-DA200 2.1 note 1: at once).
    // So would another gear (SV33-E 6091h).
    const auto& units = profile_->units.object;
    if (enabled_.load(std::memory_order_relaxed) && ((units.index != 0 && address == units) || settings_.part_of_scale(address))) return 0;
    const auto ticket = place_.bus().download(place_.number(), place_.object(address.index), address.sub, value);
    settings_.changed(address);  // read again, behind this write
    return ticket;
}

ServiceTicket Cia402Drive::start_service(DriveService service) {
    if (service != DriveService::clear_multi_turn || !capabilities_.has(service) || !turns_.permitted()) return 0;
    const auto address = profile_->encoder.clear_turns;
    if (address.index == 0) {
        turns_.begin(true);
        return TurnClearing::by_control_word;
    }
    std::size_t bytes = 2;
    if (const auto& device = place_.slave().device)
        for (const auto& entry : device->objects)
            if (entry.index == place_.object(address.index) && entry.sub == address.sub) bytes = ecat::bit_size(entry.type) / 8;
    std::vector<std::byte> value;
    for (std::size_t i = 0; i < bytes; ++i)
        value.push_back(static_cast<std::byte>(static_cast<std::uint64_t>(profile_->encoder.clear_turns_value) >> (8 * i) & 0xFFu));
    const auto ticket = write_parameter(address, std::move(value));
    if (ticket != 0) turns_.begin(false);
    return ticket;
}

std::optional<Result<ServiceAnswer>> Cia402Drive::service_answer(ServiceTicket ticket) {
    if (ticket == TurnClearing::by_control_word) {
        if (turns_.pulsing()) return std::nullopt;
        return Result<ServiceAnswer>{ServiceAnswer{}};
    }
    auto answer = place_.bus().poll(ticket);
    if (!answer) return std::nullopt;
    if (!answer->ok()) return Result<ServiceAnswer>{answer->error()};
    return Result<ServiceAnswer>{std::move(answer->value().data)};
}

Instant Cia402Drive::setpoint_effective(Instant send_time) const noexcept { return place_.effective(send_time) + interpolation_; }

}  // namespace taktwerk::axes::cia402
