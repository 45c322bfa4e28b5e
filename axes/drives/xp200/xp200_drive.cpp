#include "axes/drives/xp200/xp200_drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "axes/port/find_alarm.hpp"

namespace taktwerk::axes::xp200 {

namespace {

using std::chrono::milliseconds;

constexpr Duration expected_turnaround = milliseconds{5};  // not stated (9.3)
constexpr double fastest_setting = 5000;                   // r/min, Pr137 to Pr144 (5.1.2)
constexpr double longest_ramp = 10000;                     // ms, Pr060 and Pr061 (5.1.1)

/// ms for 1000 r/min at `turns` r/min per s (4.3.4); 0 = leave.
std::int16_t ramp_ms(double turns) noexcept {
    if (!(turns > 0)) return 0;
    return static_cast<std::int16_t>(std::clamp(std::round(1e6 / turns), 1.0, longest_ramp));
}

}  // namespace

Xp200Drive::Xp200Drive(DriveConfig config, const modbus::LineSettings& line) : config_(std::move(config)), schedule_(config_) {
    const auto transaction = [&](std::size_t bytes) { return line.duration(bytes) + 2 * line.frame_gap() + expected_turnaround; };
    const Duration write = transaction(8 + 8), look = transaction(8 + 15);
    const auto& profile = *config_.profile;
    auto& c = capabilities_;
    c.setpoints = SetpointClass::low_dynamics;
    const auto asks_for = [&](std::uint16_t number, std::int64_t value) {
        for (const auto& parameter : config_.parameters)
            if (parameter.number == number && parameter.value == value) return true;
        return false;
    };
    // Torque needs CMODE to choose between speed and torque, and EMG that brakes: the only way out of a torque that is no running out (5.4.1, 5.4.2).
    const bool torque = asks_for(pr::control_mode, 5) && asks_for(pr::emergency_mode, 1);
    for (const auto mode : profile.modes)
        if (mode != DriveMode::profile_torque || torque)
            c.modes = static_cast<std::uint16_t>(c.modes | (1u << static_cast<unsigned>(mode)));
    c.digital_inputs = true;
    c.probes = 1;  // of the index pulse only (index_pulse.hpp)
    c.probe_edges = 0;
    c.position_bits = profile.position_bits;
    c.enable_delay = profile.enable_delay;
    c.mode_change_delay = profile.mode_rules.change_delay;
    c.mode_change_at_standstill = profile.mode_rules.change_at_standstill;
    c.velocity_limit = true;
    c.services = 1u << static_cast<unsigned>(DriveService::save_parameters);
    c.velocity_step = static_cast<double>(config_.counts_per_turn) / 60;
    c.feedback_period = 2 * look + 2 * write;
    c.command_latency = look + 3 * write;
    usual_latency_ = look / 2 + 2 * write;
    feedback_.has_inputs = true;
    feedback_.mode = DriveMode::profile_velocity;
    feedback_.power = PowerState::disabled;
}

// --- the cycle ----------------------------------------------------------------------------------------------------------------

const DriveFeedback& Xp200Drive::decode(Instant now) noexcept {
    const auto reading = samples_.read();
    const bool news = reading.is_new && reading.value->number != newest_.number;
    if (reading.is_new) newest_ = *reading.value;
    const auto& sample = newest_;
    auto& f = feedback_;
    f.fresh = news && sample.online;
    f.age = f.fresh ? 0 : std::min<std::uint32_t>(f.age, 0xFFFFFFFE) + 1;
    // A service thread that hangs is as silent as the line.
    f.online = sample.online && (sample.saving || now - sample.heard < 2 * config_.silence);
    f.fault = sample.alarm != 0;
    // Power that an order gave which has been taken back since is not the one that is wanted now: it will go.
    const bool enabled = wish_.power == PowerRequest::on ? sample.power_of == wish_.power_turn : sample.running;
    f.power = f.fault ? PowerState::fault : enabled ? PowerState::enabled : PowerState::disabled;
    f.mode = sample.torque_mode ? DriveMode::profile_torque : DriveMode::profile_velocity;
    f.error_code = sample.alarm;
    f.status_word = sample.outputs;
    f.setup_refused = sample.setup_refused;
    f.digital_inputs = sample.inputs;
    f.home_switch = sample.home;
    f.negative_limit = sample.negative_limit;
    f.positive_limit = sample.positive_limit;
    // Real speed is slightly above the limit where that holds it (5.4.1 Pr078).
    f.internal_limit = sample.torque_mode && wish_.speed_limit > 0 && std::abs(turns_per_minute(sample.velocity)) >= wish_.speed_limit;
    f.commands_acknowledged = sample.acknowledged == wish_.sequence;
    f.position_epoch = sample.epoch;
    const bool of_this_latch = sample.latch == wish_.latch && (wish_.latch & 1u) != 0;
    f.homing_error = of_this_latch && sample.no_index;
    auto& latch = f.probes[0];
    latch.armed = of_this_latch && sample.latch_armed;
    latch.latched = latch.armed && sample.latched;
    latch.count = latch.latched ? 1 : 0;
    latch.position = sample.latch_at;
    if (!f.fresh) return f;
    f.latched = sample.sampled;
    f.position = sample.position;
    f.velocity = sample.velocity;
    f.torque = sample.torque;
    return f;
}

void Xp200Drive::encode(const DriveCommand& command, Instant) noexcept {
    Wish next;
    next.power = command.power;
    next.reset = command.reset_fault;
    next.halt = command.halt || command.power != PowerRequest::on;
    next.torque_mode = command.mode == DriveMode::profile_torque;
    if (!next.halt && !next.torque_mode) {
        const double wanted = std::clamp(turns_per_minute(command.velocity), -fastest_setting, fastest_setting);
        // Whole turns per minute; one that lies between two stays with the one it has.
        constexpr double stay = 0.6;
        if (std::abs(wanted - speed_) > stay || (speed_ != 0 && std::abs(wanted) < 0.5))
            speed_ = static_cast<std::int16_t>(std::lround(wanted));
        next.speed = speed_;
    } else speed_ = 0;
    if (next.torque_mode && !next.halt)
        next.torque = static_cast<std::int16_t>(std::lround(std::clamp(100 * command.torque, -300.0, 300.0)));
    if (next.torque_mode && std::isfinite(command.velocity_limit))
        next.speed_limit =
            static_cast<std::int16_t>(std::clamp(std::round(turns_per_minute(command.velocity_limit)), 1.0, fastest_setting));
    next.up_ms = ramp_ms(turns_per_minute(command.acceleration));
    next.down_ms = ramp_ms(turns_per_minute(command.deceleration));
    if (feedback_.online && newest_.released && !newest_.running) seen_off_ = newest_.session;
    next.session = seen_off_;
    const auto& probe = command.probes[0];
    const bool waits = probe.armed && probe.index_pulse;
    next.latch = wish_.latch;
    if (waits != ((wish_.latch & 1u) != 0)) ++next.latch;
    next.power_turn = wish_.power_turn;
    if ((next.power == PowerRequest::on) != (wish_.power == PowerRequest::on)) ++next.power_turn;
    next.sequence = wish_.sequence;
    if (next.asks_the_same(wish_)) return;
    ++next.sequence;
    wish_ = next;
    wishes_.back() = next;
    wishes_.publish();
    feedback_.commands_acknowledged = false;
}

DriveAlarm Xp200Drive::alarm() const noexcept {
    DriveAlarm alarm;
    alarm.code = newest_.alarm;
    alarm.detail_known = true;
    if (alarm.code == 0) return alarm;
    const auto& profile = *config_.profile;
    const auto found = find_alarm(profile, {alarm.code, std::nullopt, ShownAlarm::As::fault});
    if (found.row) alarm.entry = static_cast<std::int32_t>(found.row - profile.alarms.data());
    alarm.resettable = found.resettable;
    alarm.whole_drive = found.whole_drive;
    alarm.kind = found.kind;
    return alarm;
}

bool Xp200Drive::supervised(Instant now) const noexcept {
    return newest_.online && newest_.released && now - newest_.heard < config_.silence && !newest_.setup_refused;
}

// --- the line's side ----------------------------------------------------------------------------------------------------------

std::optional<modbus::Request> Xp200Drive::next_request(Instant now) { return schedule_.next(*wishes_.read().value, now); }

bool Xp200Drive::urgent() noexcept { return schedule_.urgent(*wishes_.read().value); }

void Xp200Drive::take(const modbus::Answer& answer, Instant now) {
    schedule_.take(answer, now);
    if (auto done = schedule_.served())
        for (auto& open : open_)
            if (open.ticket == done->first) open.answer = done->second;
    samples_.back() = schedule_.sample();
    samples_.back().revision = ++revision_;
    samples_.publish();
}

void Xp200Drive::replay(const Sample& sample) noexcept {
    samples_.back() = sample;
    samples_.back().revision = ++revision_;
    samples_.publish();
}

ServiceTicket Xp200Drive::start(const modbus::Request& request) {
    const auto ticket = ++last_ticket_;
    if (!schedule_.queue({ticket, request})) return 0;
    open_.push_back({ticket, std::nullopt});
    return ticket;
}

ServiceTicket Xp200Drive::read_parameter(ParameterAddress address) {
    if (address.sub != 0) return 0;
    return start(modbus::read_parameters(config_.station, address.index, 1));
}

ServiceTicket Xp200Drive::write_parameter(ParameterAddress address, std::vector<std::byte> value) {
    const auto& rows = config_.profile->parameters;
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& p) { return p.address == address; });
    // Reserved parameters must not be written (9.4); those the schedule uses have one writer.
    if (row == rows.end() || row->change == ParameterChange::never || Settings::owns(address.index) || value.size() != 2) return 0;
    const auto word = static_cast<std::uint16_t>(std::to_integer<unsigned>(value[0]) | (std::to_integer<unsigned>(value[1]) << 8));
    return start(modbus::write_parameter(config_.station, address.index, word));
}

ServiceTicket Xp200Drive::start_service(DriveService service) {
    // Disabled, nothing forced on, Pr098 = 0: else what is stored would enable or move at the next power-on (9.6.6).
    if (service != DriveService::save_parameters || !schedule_.saved_would_be_harmless()) return 0;
    return start(modbus::save(config_.station));
}

std::optional<Result<ServiceAnswer>> Xp200Drive::service_answer(ServiceTicket ticket) {
    const auto open = std::find_if(open_.begin(), open_.end(), [&](const Open& o) { return o.ticket == ticket; });
    if (open == open_.end() || !open->answer) return std::nullopt;
    const auto answer = *open->answer;
    open_.erase(open);
    const auto subject = fmt::format("drive '{}' register {}", config_.name, answer.request.address);
    if (answer.outcome == modbus::Outcome::exception)
        return Result<ServiceAnswer>{Error{"drive.refused", subject,
                                           fmt::format("the drive says: {}", modbus::name(answer.response.exception)),
                                           "check number and range in the drive's table"}};
    if (answer.outcome != modbus::Outcome::answered)
        return Result<ServiceAnswer>{Error{"drive.silent", subject, std::string(modbus::name(answer.outcome)), "check the line"}};
    ServiceAnswer bytes;
    for (const auto word : answer.response.values()) {
        bytes.push_back(static_cast<std::byte>(word & 0xFF));
        bytes.push_back(static_cast<std::byte>(word >> 8));
    }
    return Result<ServiceAnswer>{std::move(bytes)};
}

}  // namespace taktwerk::axes::xp200
