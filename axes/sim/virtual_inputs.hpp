#pragma once
// Inputs of a drive that are objects: what matters to the bus is that one of them may enable the drive too. Source: SV33-E 5.4 (E.418).

#include <cstdint>
#include <vector>

#include "axes/sim/behaviour_value.hpp"
#include "axes/sim/cia402_axis.hpp"

namespace taktwerk::axes::sim {

class VirtualInputs {
public:
    explicit VirtualInputs(const DriveProfile& profile);

    void power_on(ecat::sim::ObjectDictionary& dictionary);
    /// Enabled from the bus while an input of the drive enables it too; it lasts until one of them lets go.
    void watch(const AxisInputs& in, Cia402Axis& axis) noexcept;

private:
    [[nodiscard]] bool enable() const noexcept;

    std::int64_t servo_enable_;  ///< the function that enables
    BehaviourValue count_, levels_;
    std::vector<BehaviourValue> functions_;
    bool enabled_twice_ = false;  ///< as the axis was told
};

}  // namespace taktwerk::axes::sim
