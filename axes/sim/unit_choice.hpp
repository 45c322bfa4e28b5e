#pragma once
// The object that chooses a drive's units, and what they make of its set-points and settings: a simulated axis reckons in counts, counts/s
// and counts/s2. Source: SV-DA200 2.1 note 3 (P4.25).

#include <vector>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/axis_objects.hpp"
#include "axes/sim/behaviour_value.hpp"

namespace taktwerk::axes::sim {

class UnitChoice {
public:
    explicit UnitChoice(const DriveProfile& profile);

    void power_on(ecat::sim::ObjectDictionary& dictionary);
    /// False: this drive has one set of units, and all below leaves things as they are.
    [[nodiscard]] bool present() const noexcept { return unit_.present(); }
    /// Reads the object.
    void choose() noexcept;
    [[nodiscard]] const UnitVariant& variant() const noexcept { return variant_; }
    /// raw 606Ch, 60FFh = counts/s times this.
    [[nodiscard]] double velocity_scale() const noexcept { return velocity_scale_; }
    /// Speeds of homing and all accelerations; other speeds are the axis' own to scale.
    void convert(AxisInputs& in) const noexcept;

private:
    [[nodiscard]] double acceleration_of(double raw) const noexcept;

    BehaviourValue unit_, turn_;
    std::vector<UnitVariant> variants_;
    double counts_per_unit_;  ///< of velocity, from the profile
    UnitVariant variant_{};
    double velocity_scale_ = 1;
};

}  // namespace taktwerk::axes::sim
