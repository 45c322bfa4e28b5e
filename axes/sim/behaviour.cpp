#include "axes/sim/behaviour.hpp"

#include <algorithm>
#include <cmath>

#include "axes/sim/communication_error.hpp"

namespace taktwerk::axes::sim {

namespace {

constexpr std::uint16_t bit(unsigned n) { return static_cast<std::uint16_t>(1u << n); }
constexpr std::int64_t zero_torque_ignored = 1, zero_speed_ignored = 2, velocity_offset_used = 16;
constexpr double rated_rpm = 3000;  // of the motor that a time of acceleration refers to; no object tells it

AlarmCode alarm_of(const DriveProfile& profile, DriveAlarmKind kind, AlarmCode otherwise) {
    for (const auto& row : profile.alarms)
        if (row.kind == kind) return {row.code, row.resettable, row.detail};
    return otherwise;
}

bool of_position(std::int64_t mode) noexcept { return mode == mode::cyclic_position || mode == mode::profile_position; }

}  // namespace

void BehaviourValue::power_on(ecat::sim::ObjectDictionary& dictionary, const DriveProfile& profile, ParameterAddress object) {
    entry_ = object.index ? dictionary.find(object.index, object.sub) : nullptr;
    at_power_on_ = entry_ ? entry_->get() : 0;
    latched_ = false;
    for (const auto& p : profile.parameters)
        if (p.address.index == object.index && p.address.sub == object.sub) latched_ = p.effect == ParameterEffect::after_restart;
}

Behaviour::Behaviour(const DriveProfile& profile)
    : profile_(profile),
      lost_data_alarm_(alarm_of(profile, DriveAlarmKind::communication, {0x7500})),
      lost_sync_alarm_(alarm_of(profile, DriveAlarmKind::sync_lost, lost_data_alarm_)),
      negative_limit_alarm_(alarm_of(profile, DriveAlarmKind::negative_limit, {0x5444})),
      positive_limit_alarm_(alarm_of(profile, DriveAlarmKind::positive_limit, {0x5443})),
      velocity_scale_(profile.velocity_counts_per_unit) {
    if (profile.behaviour.state.error_sub_code.index == 0) return;
    lost_data_alarm_.detail = communication_error::general;
    lost_sync_alarm_.detail = communication_error::sync;
}

void Behaviour::power_on(ecat::sim::ObjectDictionary& dictionary, Instant now) {
    const auto& b = profile_.behaviour;
    const auto on = [&](BehaviourValue& value, ParameterAddress object) { value.power_on(dictionary, profile_, object); };
    on(bus_control_, b.bus_control);
    on(absolute_targets_, b.absolute_targets);
    on(limit_masks_, b.limit_masks);
    on(lost_cycles_, b.lost_target_cycles);
    on(lost_time_, b.lost_data_time);
    on(sync_type_, b.sync_type);
    on(output_control_, b.output_control);
    on(following_limit_, b.following_limit);
    on(unit_, profile_.units.object);
    on(turn_, profile_.units.counts_per_revolution);
    for (std::size_t i = 0; i < probe_input_.size(); ++i) on(probe_input_[i], b.probe_input[i]);
    analogue_.clear();
    for (const auto& output : b.analogue_outputs) {
        auto& a = analogue_.emplace_back();
        on(a.value, output.value);
        on(a.selection, output.selection);
        on(a.gain, output.gain);
        a.monitor = output.monitor.index ? dictionary.find(output.monitor.index, output.monitor.sub) : nullptr;
    }
    outputs_ = dictionary.find(0x60FE, 1);
    following_ = operational_ = sync0_ = fresh_ = false;
    data_at_ = sync_at_ = now;
}

void Behaviour::operational(bool op, Instant now) noexcept {
    operational_ = op;
    data_at_ = sync_at_ = now;
}

void Behaviour::choose_units(Cia402Axis& axis) noexcept {
    if (!unit_.present()) return;
    for (const auto& v : profile_.units.variants)
        if (v.value == unit_.get()) variant_ = v;
    const auto turn = turn_.present() && turn_.get() > 0 ? static_cast<double>(turn_.get()) : 1.0;
    velocity_scale_ = variant_.velocity == VelocityUnit::rpm ? 60.0 / turn : profile_.velocity_counts_per_unit;
    axis.velocity_unit(velocity_scale_);
}

void Behaviour::exchange_due(const ecat::sim::ExchangeCause& cause, Instant now) noexcept {
    fresh_ = cause.outputs;
    if (cause.outputs) data_at_ = now;
    if (cause.sync0) sync_at_ = now;
}

void Behaviour::obey(AxisInputs& in, Cia402Axis& axis) noexcept {
    choose_units(axis);
    if (bus_control_.present() && bus_control_.get() != profile_.behaviour.bus_control_value) {
        in.control = 0;
        in.mode = mode::none;
    }
    if (following_limit_.present()) axis.following_limit(static_cast<double>(following_limit_.get()));
    obey_limits(in);
    obey_units(in);
    obey_probes(in);
    obey_position(in, axis);
    if (profile_.has(Quirk::torque_offset_not_in_torque) && mode::of_torque(in.mode)) in.torque_offset = 0;
    if (limit_masks_.present() && (limit_masks_.get() & velocity_offset_used) == 0) in.velocity_offset = 0;
    if (profile_.has(Quirk::limit_stop_is_fault)) stop_at_limits(in, axis);
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
    const bool torque_ignored = !limit_masks_.present() || ((masks & zero_torque_ignored) != 0 && !variant_.zero_limits_count);
    for (auto* limit : {&in.torque_limit, &in.torque_limit_positive, &in.torque_limit_negative})
        if (*limit == 0 && torque_ignored) *limit = AxisInputs::no_limit;
    // As a number 0 stands for "no limit" in the axis: a limit of 0 that counts is as good as one count a second.
    if (limit_masks_.present() && in.maximum_velocity == 0 && (masks & zero_speed_ignored) == 0 && mode::of_torque(in.mode))
        in.maximum_velocity = 1;
}

void Behaviour::obey_units(AxisInputs& in) const noexcept {
    if (!unit_.present()) return;
    in.homing.fast /= velocity_scale_;
    in.homing.slow /= velocity_scale_;
    if (variant_.acceleration == AccelerationUnit::time && in.homing.acceleration > 0) {
        const double rated = rated_rpm / 60.0 * static_cast<double>(std::max<std::int64_t>(1, turn_.get()));
        in.homing.acceleration = rated / (in.homing.acceleration / 1000.0);
    }
}

void Behaviour::obey_probes(AxisInputs& in) const noexcept {
    for (unsigned i = 0; i < probe_input_.size(); ++i) {
        const unsigned shift = 8 * i;
        const bool index = (in.probe_function >> shift & 4u) != 0;
        const bool dead = index ? !variant_.index_probe : probe_input_[i].present() && probe_input_[i].get() != 0;
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
    if (profile_.has(Quirk::clock_bit_8) && sync0_ && watches_sync() && clock_locks_) out.status |= bit(8);
    if (profile_.has(Quirk::standstill_bit_14) && axis.stands()) out.status |= bit(14);
    // The drive's inputs 1 and 2 are those of the probes; SV-DA200 4.6.
    if (unit_.present()) {
        const unsigned first = variant_.index_before_inputs ? 17 : 16;
        for (unsigned i = 0; i < 2; ++i)
            if (axis.probe_input(i)) out.digital_inputs |= 1u << (first + i);
        if (variant_.index_before_inputs && axis.at_index_pulse()) out.digital_inputs |= 1u << 16;
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

std::uint32_t Behaviour::digital_outputs() const noexcept {
    const bool by_bus = output_control_.present() && output_control_.get() == 1;
    return by_bus && outputs_ ? static_cast<std::uint32_t>(outputs_->get() >> 16) & 0xFu : 0;
}

}  // namespace taktwerk::axes::sim
