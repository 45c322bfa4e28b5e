#pragma once
// The objects of one axis in the dictionary of its drive, by the tables of object_table.hpp and what its profile names beside them: they are
// looked up at power-on and copied at each exchange.

#include <cstdint>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/axis_objects.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class AxisEntries {
public:
    explicit AxisEntries(const DriveProfile& profile);

    /// `offset` of this axis from the first.
    void power_on(ecat::sim::ObjectDictionary& dictionary, unsigned offset);
    /// What the master wrote; commands count in OP only. Real-time safe.
    void take(AxisInputs& in, bool operational) const noexcept;
    /// Real-time safe.
    void show(const AxisOutputs& out) const noexcept;

private:
    using Entry = ecat::sim::Entry;

    std::vector<Entry*> commands_, settings_, answers_;  ///< in the order of object_table.hpp; null: this drive has it not
    ParameterAddress homing_timeout_address_, emergency_torque_address_;
    double homing_timeout_unit_;  ///< s
    Entry *homing_timeout_ = nullptr, *emergency_torque_ = nullptr;
    std::vector<ParameterAddress> stop_addresses_;
    std::vector<Entry*> stop_values_;  ///< in the order of the profile's stops
};

}  // namespace taktwerk::axes::sim
