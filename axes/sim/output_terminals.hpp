#pragma once
// Digital outputs that the master sets, the holding brake among them, as far as the drive's setting lets it. Sources: CiA 402-2, 60FEh;
// SV-DA200 4.7 (P4.28).

#include <cstdint>

#include "axes/sim/behaviour_value.hpp"
#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

class OutputTerminals {
public:
    explicit OutputTerminals(const DriveProfile& profile)
        : control_(profile, profile.behaviour.output_control), brake_(profile.brake.object) {}

    void power_on(ecat::sim::ObjectDictionary& dictionary);
    /// The brake, where it can be worked from the bus.
    void obey(Cia402Axis& axis) noexcept;
    /// What drives the terminals: bit n is output n + 1; nothing while the drive sets them itself.
    [[nodiscard]] std::uint32_t driven() const noexcept;

private:
    BehaviourValue control_;
    BrakeObject brake_;
    const ecat::sim::Entry *outputs_ = nullptr, *mask_ = nullptr;
};

}  // namespace taktwerk::axes::sim
