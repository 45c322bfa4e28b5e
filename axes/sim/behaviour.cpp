#include "axes/sim/behaviour.hpp"

#include <algorithm>
#include <cmath>

#include "axes/sim/communication_error.hpp"
#include "axes/sim/object_table.hpp"
#include "axes/sim/status_bit.hpp"

namespace taktwerk::axes::sim {

namespace {

constexpr std::int64_t zero_torque_ignored = 1, zero_speed_ignored = 2, velocity_offset_used = 16;

AlarmCode alarm_of(const DriveProfile& profile, DriveAlarmKind kind, AlarmCode otherwise) {
    for (const auto& row : profile.alarms)
        if (row.kind == kind) return {row.code, row.resettable, row.detail};
    return otherwise;
}

bool of_position(std::int64_t mode) noexcept { return mode == mode::cyclic_position || mode == mode::profile_position; }

}  // namespace

Behaviour::Behaviour(const DriveProfile& profile)
    : torque_offset_not_in_torque_(profile.has(Quirk::torque_offset_not_in_torque)),
      limit_stop_is_fault_(profile.has(Quirk::limit_stop_is_fault)),
      clock_bit_8_(profile.has(Quirk::clock_bit_8)),
      standstill_bit_14_(profile.has(Quirk::standstill_bit_14)),
      bus_control_value_(profile.behaviour.bus_control_value),
      servo_enable_function_(profile.behaviour.virtual_inputs.servo_enable),
      lost_data_alarm_(alarm_of(profile, DriveAlarmKind::communication, {0x7500})),
      lost_sync_alarm_(alarm_of(profile, DriveAlarmKind::sync_lost, lost_data_alarm_)),
      negative_limit_alarm_(alarm_of(profile, DriveAlarmKind::negative_limit, {0x5444})),
      positive_limit_alarm_(alarm_of(profile, DriveAlarmKind::positive_limit, {0x5443})),
      bus_control_(profile, profile.behaviour.bus_control),
      absolute_targets_(profile, profile.behaviour.absolute_targets),
      limit_masks_(profile, profile.behaviour.limit_masks),
      lost_cycles_(profile, profile.behaviour.lost_target_cycles),
      lost_time_(profile, profile.behaviour.lost_data_time),
      sync_type_(profile, profile.behaviour.sync_type),
      output_control_(profile, profile.behaviour.output_control),
      following_limit_(profile, profile.behaviour.following_limit),
      sync_losses_(profile, profile.behaviour.sync_losses),
      sync_deviation_(profile, profile.behaviour.sync_deviation),
      phase_detection_(profile, profile.behaviour.phase_detection),
      inputs_count_(profile, profile.behaviour.virtual_inputs.enable),
      input_levels_(profile, profile.behaviour.virtual_inputs.levels),
      probe_input_{BehaviourValue(profile, profile.behaviour.probe_input[0]), BehaviourValue(profile, profile.behaviour.probe_input[1])},
      units_(profile),
      brake_object_(profile.brake.object) {
    for (const auto& function : profile.behaviour.virtual_inputs.functions) input_functions_.emplace_back(profile, function);
    for (const auto& output : profile.behaviour.analogue_outputs)
        analogue_.push_back({{profile, output.value}, {profile, output.selection}, {profile, output.gain}, output.monitor});
    if (profile.behaviour.state.error_sub_code.index == 0) return;
    lost_data_alarm_.detail = communication_error::general;
    lost_sync_alarm_.detail = communication_error::sync;
}

void Behaviour::power_on(ecat::sim::ObjectDictionary& dictionary, Instant now) {
    for (auto* value :
         {&bus_control_, &absolute_targets_, &limit_masks_, &lost_cycles_, &lost_time_, &sync_type_, &output_control_, &following_limit_,
          &sync_losses_, &sync_deviation_, &phase_detection_, &inputs_count_, &input_levels_, &probe_input_[0], &probe_input_[1]})
        value->power_on(dictionary);
    for (auto& function : input_functions_) function.power_on(dictionary);
    for (auto& a : analogue_) {
        for (auto* value : {&a.value, &a.selection, &a.gain}) value->power_on(dictionary);
        a.monitor = a.monitor_object.index ? dictionary.find(a.monitor_object.index, a.monitor_object.sub) : nullptr;
    }
    units_.power_on(dictionary);
    outputs_ = dictionary.find(0x60FE, 1);
    output_mask_ = dictionary.find(0x60FE, 2);
    following_ = operational_ = sync0_ = fresh_ = false;
    sync_watch_.restart({});
    data_at_ = sync_at_ = now;
}

void Behaviour::operational(bool op, Instant now) noexcept {
    operational_ = op;
    data_at_ = sync_at_ = now;
}

void Behaviour::exchange_due(const ecat::sim::ExchangeCause& cause, Instant now) noexcept {
    fresh_ = cause.outputs;
    if (cause.outputs) data_at_ = now;
    if (!cause.sync0) return;
    sync_at_ = now;
    sync_watch_.signal(now, sync_deviation());
}

void Behaviour::obey(AxisInputs& in, Cia402Axis& axis) noexcept {
    units_.choose();
    if (units_.present()) axis.velocity_unit(units_.velocity_scale());
    if (bus_control_.present() && bus_control_.get() != bus_control_value_) {
        in.control = 0;
        in.mode = mode::none;
    }
    if (following_limit_.present()) axis.following_limit(static_cast<double>(following_limit_.get()));
    obey_limits(in);
    units_.convert(in);
    obey_probes(in);
    obey_position(in, axis);
    if (torque_offset_not_in_torque_ && mode::of_torque(in.mode)) in.torque_offset = 0;
    if (limit_masks_.present() && (limit_masks_.get() & velocity_offset_used) == 0) in.velocity_offset = 0;
    if (limit_stop_is_fault_) stop_at_limits(in, axis);
    if (brake_object_ != BrakeObject::none) obey_brake(axis);
    watch_enable(in, axis);
}

/// CiA 402-2, 60FEh bit 0; SV-DA200 4.7, where P4.28 = 1 lets it.
void Behaviour::obey_brake(Cia402Axis& axis) noexcept {
    constexpr std::int64_t brake = 1;
    if (output_control_.present() && output_control_.get() != 1) return;
    const bool masked = output_mask_ != nullptr && (output_mask_->get() & brake) != 0;
    if (brake_object_ == BrakeObject::mask_opens) axis.brake_by_bus(masked);
    else if (outputs_ != nullptr && (output_mask_ == nullptr || masked)) axis.brake_by_bus((outputs_->get() & brake) == 0);
}

/// Targets that come as increments, and those that do not come.
void Behaviour::obey_position(AxisInputs& in, const Cia402Axis& axis) noexcept {
    if (!absolute_targets_.present() && !lost_cycles_.present()) return;
    const bool follows = axis.state() == Cia402Axis::State::enabled && in.mode == mode::cyclic_position;
    const bool increments = absolute_targets_.present() && absolute_targets_.get() == 0;
    if (!follows) {
        following_ = false;
        return;
    }
    if (!following_) {
        following_ = true;
        increments_ = demand_;
        targets_.restart(increments ? increments_ : in.target_position);
    }
    if (increments) {
        if (fresh_) increments_ += in.target_position;
        in.target_position = increments_;
    }
    // Without SYNC0 there is a cycle only where there are data.
    in.target_position = targets_.target(in.target_position, fresh_ || !sync0_, sync0_ ? lost_cycles_.get() : 0);
}

void Behaviour::obey_limits(AxisInputs& in) const noexcept {
    const auto masks = limit_masks_.get();
    // A drive whose manual says nothing of zeros is taken to ignore them.
    const bool torque_ignored = !limit_masks_.present() || ((masks & zero_torque_ignored) != 0 && !units_.variant().zero_limits_count);
    for (auto* limit : {&in.torque_limit, &in.torque_limit_positive, &in.torque_limit_negative})
        if (*limit == 0 && torque_ignored) *limit = AxisInputs::no_limit;
    if (in.maximum_velocity != zero_speed_limit) return;
    // A zero holds the motor (SV33-E 8.5.6), or is ignored as the masks say; those speak of the torque modes (SV-DA200 2.1 notes 8 and 10).
    const bool speed_ignored = limit_masks_.present() && ((masks & zero_speed_ignored) != 0 || !mode::of_torque(in.mode));
    constexpr std::int64_t no_limit = 0, as_good_as_zero = 1;  // for the axis
    in.maximum_velocity = speed_ignored ? no_limit : as_good_as_zero;
}

void Behaviour::obey_probes(AxisInputs& in) const noexcept {
    for (unsigned i = 0; i < probe_input_.size(); ++i) {
        const unsigned shift = 8 * i;
        const bool index = (in.probe_function >> shift & 4u) != 0;
        const bool dead = index ? !units_.variant().index_probe : probe_input_[i].present() && probe_input_[i].get() != 0;
        if (dead) in.probe_function = static_cast<std::uint16_t>(in.probe_function & ~(0xFFu << shift));
    }
}

/// Running onto a limit switch, or pressing on against it. Whoever stands there may be enabled, to drive away.
void Behaviour::stop_at_limits(const AxisInputs& in, Cia402Axis& axis) noexcept {
    const bool negative = axis.plant().negative_limit(), positive = axis.plant().positive_limit();
    if (axis.state() == Cia402Axis::State::enabled && of_position(in.mode)) {
        const bool cyclic = in.mode == mode::cyclic_position && following_;
        if (positive && (!at_positive_limit_ || (cyclic && in.target_position > demand_))) axis.raise(positive_limit_alarm_);
        else if (negative && (!at_negative_limit_ || (cyclic && in.target_position < demand_))) axis.raise(negative_limit_alarm_);
    }
    at_negative_limit_ = negative;
    at_positive_limit_ = positive;
}

void Behaviour::show(AxisOutputs& out, const Cia402Axis& axis) noexcept {
    demand_ = out.demand;
    const auto& variant = units_.variant();
    if (clock_bit_8_ && sync0_ && watches_sync() && clock_locks_) out.status |= status_bit(8);
    if (standstill_bit_14_ && axis.stands()) out.status |= status_bit(14);
    if (variant.cyclic_bit_12 && mode::cyclic(out.mode) && axis.state() == Cia402Axis::State::enabled) out.status |= status_bit(12);
    out.status = static_cast<std::uint16_t>(out.status & ~variant.status_hidden);
    // The drive's inputs 1 and 2 are those of the probes; SV-DA200 4.6.
    if (units_.present()) {
        const unsigned first = variant.index_before_inputs ? 17 : 16;
        for (unsigned i = 0; i < 2; ++i)
            if (axis.probe_input(i)) out.digital_inputs |= 1u << (first + i);
        if (variant.index_before_inputs && axis.at_index_pulse()) out.digital_inputs |= 1u << 16;
    }
    set_analogue_outputs();
}

void Behaviour::set_analogue_outputs() noexcept {
    for (auto& a : analogue_) {
        if (!a.monitor) continue;
        const auto gain = a.gain.get();
        const double volts = a.selection.get() == 0 && gain != 0 ? static_cast<double>(a.value.get()) / static_cast<double>(gain) : 0;
        a.monitor->set(std::llround(volts * 1000));
    }
}

void Behaviour::watch(Cia402Axis& axis, Instant now) noexcept {
    watch_data(axis, now);
    watch_sync(axis, now);
    watch_mains(axis);
}

void Behaviour::watch_data(Cia402Axis& axis, Instant now) noexcept {
    if (!operational_ || !lost_time_.present() || lost_time_.get() <= 0) return;
    const bool enabled = axis.state() == Cia402Axis::State::enabled || axis.state() == Cia402Axis::State::quick_stop;
    const Duration patience = std::chrono::milliseconds{lost_time_.get()};
    if (!enabled) {  // watched only from enabling on
        data_at_ = sync_at_ = now;
        return;
    }
    if (sync0_ && watches_sync() && now - sync_at_ > patience) axis.raise(lost_sync_alarm_);
    else if (now - data_at_ > patience) axis.raise(lost_data_alarm_);
}

/// SV33-E 5.4, E.D32.
void Behaviour::watch_sync(Cia402Axis& axis, Instant now) noexcept {
    if (!operational_ || !sync0_ || !sync_losses_.present()) return;
    if (sync_watch_.lost(now, sync_deviation()) > sync_losses_.get()) axis.raise(lost_sync_alarm_);
}

/// SV33-E 5.4 E.217, 5.5 A.222, P08.00. What "1: fault and warning" means is not stated; here it warns until the motor gets its power.
void Behaviour::watch_mains(Cia402Axis& axis) noexcept {
    if (!phase_detection_.present()) return;
    const auto detection = phase_missing_ ? phase_detection_.get() : 2;
    const bool fault = detection == 0 || (detection == 1 && (phase_fault_ || axis.powered()));
    const bool warning = detection == 1 && !fault;
    if (fault != phase_fault_) axis.cause(DriveAlarmKind::phase_lost, phase_fault_ = fault);
    if (warning != phase_warned_) axis.cause(DriveAlarmKind::phase_warning, phase_warned_ = warning);
}

/// SV33-E 5.4, E.418: enabled from the bus while an input of the drive enables it too; it lasts until one of them lets go.
void Behaviour::watch_enable(const AxisInputs& in, Cia402Axis& axis) noexcept {
    constexpr unsigned enable_operation = 0x0F;
    const bool twice = enabled_by_input() && (in.control & enable_operation) == enable_operation;
    if (twice != enabled_twice_) axis.cause(DriveAlarmKind::enabled_twice, enabled_twice_ = twice);
}

bool Behaviour::enabled_by_input() const noexcept {
    if (inputs_count_.get() != 1) return false;
    for (std::size_t i = 0; i < input_functions_.size(); ++i)
        if (input_functions_[i].get() == servo_enable_function_ && (input_levels_.get() >> i & 1) != 0) return true;
    return false;
}

std::uint32_t Behaviour::digital_outputs() const noexcept {
    const bool by_bus = output_control_.present() && output_control_.get() == 1;
    return by_bus && outputs_ ? static_cast<std::uint32_t>(outputs_->get() >> 16) & 0xFu : 0;
}

}  // namespace taktwerk::axes::sim
