#include "axes/sim/behaviour.hpp"

#include "axes/sim/object_table.hpp"
#include "axes/sim/status_bit.hpp"

namespace taktwerk::axes::sim {

namespace {

constexpr std::int64_t zero_torque_ignored = 1, zero_speed_ignored = 2, velocity_offset_used = 16;

}  // namespace

Behaviour::Behaviour(const DriveProfile& profile)
    : torque_offset_not_in_torque_(profile.has(Quirk::torque_offset_not_in_torque)),
      clock_bit_8_(profile.has(Quirk::clock_bit_8)),
      standstill_bit_14_(profile.has(Quirk::standstill_bit_14)),
      bus_control_value_(profile.behaviour.bus_control_value),
      bus_control_(profile, profile.behaviour.bus_control),
      limit_masks_(profile, profile.behaviour.limit_masks),
      following_limit_(profile, profile.behaviour.following_limit),
      probe_input_{BehaviourValue(profile, profile.behaviour.probe_input[0]), BehaviourValue(profile, profile.behaviour.probe_input[1])},
      units_(profile),
      communication_(profile),
      targets_(profile),
      limit_switches_(profile),
      outputs_(profile),
      analogue_(profile),
      inputs_(profile),
      mains_(profile) {}

void Behaviour::power_on(ecat::sim::ObjectDictionary& dictionary, Instant now) {
    for (auto* value : {&bus_control_, &limit_masks_, &following_limit_, &probe_input_[0], &probe_input_[1]}) value->power_on(dictionary);
    units_.power_on(dictionary);
    communication_.power_on(dictionary, now);
    targets_.power_on(dictionary);
    outputs_.power_on(dictionary);
    analogue_.power_on(dictionary);
    inputs_.power_on(dictionary);
    mains_.power_on(dictionary);
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
    targets_.obey(in, axis, communication_);
    if (torque_offset_not_in_torque_ && mode::of_torque(in.mode)) in.torque_offset = 0;
    if (limit_masks_.present() && (limit_masks_.get() & velocity_offset_used) == 0) in.velocity_offset = 0;
    limit_switches_.watch(in, targets_, axis);
    outputs_.obey(axis);
    inputs_.watch(in, axis);
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

void Behaviour::show(AxisOutputs& out, const Cia402Axis& axis) noexcept {
    targets_.show(out.demand);
    const auto& variant = units_.variant();
    if (clock_bit_8_ && communication_.locked()) out.status |= status_bit(8);
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
    analogue_.show();
}

void Behaviour::watch(Cia402Axis& axis, Instant now) noexcept {
    communication_.watch(axis, now);
    mains_.watch(axis);
}

}  // namespace taktwerk::axes::sim
