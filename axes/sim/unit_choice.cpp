#include "axes/sim/unit_choice.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes::sim {

namespace {

constexpr double rated_rpm = 3000;  // of the motor that a time of acceleration refers to; no object tells it
constexpr double at_once = 1e12;    // counts/s2: what a time of 0 comes to

}  // namespace

UnitChoice::UnitChoice(const DriveProfile& profile)
    : unit_(profile, profile.units.object),
      turn_(profile, profile.units.counts_per_revolution),
      variants_(profile.units.variants),
      counts_per_unit_(profile.velocity_counts_per_unit),
      velocity_scale_(profile.velocity_counts_per_unit) {}

void UnitChoice::power_on(ecat::sim::ObjectDictionary& dictionary) {
    unit_.power_on(dictionary);
    turn_.power_on(dictionary);
}

void UnitChoice::choose() noexcept {
    if (!present()) return;
    for (const auto& v : variants_)
        if (v.value == unit_.get()) variant_ = v;
    const auto turn = turn_.present() && turn_.get() > 0 ? static_cast<double>(turn_.get()) : 1.0;
    velocity_scale_ = variant_.velocity == VelocityUnit::rpm ? 60.0 / turn : counts_per_unit_;
}

/// A time is that from standstill to rated speed.
double UnitChoice::acceleration_of(double raw) const noexcept {
    if (variant_.acceleration == AccelerationUnit::counts) return raw;
    const double rated = rated_rpm / 60.0 * static_cast<double>(std::max<std::int64_t>(1, turn_.get()));
    return raw > 0 ? std::min(at_once, rated / (raw / 1000.0)) : at_once;
}

void UnitChoice::convert(AxisInputs& in) const noexcept {
    if (!present()) return;
    in.homing.fast /= velocity_scale_;
    in.homing.slow /= velocity_scale_;
    in.homing.acceleration = acceleration_of(in.homing.acceleration);
    in.profile_acceleration = std::llround(acceleration_of(static_cast<double>(in.profile_acceleration)));
    in.profile_deceleration = std::llround(acceleration_of(static_cast<double>(in.profile_deceleration)));
}

}  // namespace taktwerk::axes::sim
