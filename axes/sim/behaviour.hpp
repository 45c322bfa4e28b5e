#pragma once
// Objects of a drive that change how it takes commands and what it shows: between the dictionary and the axis. Which objects they are
// comes from DriveProfile::behaviour and DriveProfile::units; values that take effect after a restart are those of power-on.
// Sources: SV-DA200 2.1, 3.1.2, 3.3.2, 4.6, 5.2, 5.3; SV33-E 5.4, 7.2, 8.1.

#include <array>
#include <cstdint>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/analogue_outputs.hpp"
#include "axes/sim/behaviour_value.hpp"
#include "axes/sim/cia402_axis.hpp"
#include "axes/sim/communication_watch.hpp"
#include "axes/sim/limit_switch_fault.hpp"
#include "axes/sim/mains_watch.hpp"
#include "axes/sim/output_terminals.hpp"
#include "axes/sim/position_targets.hpp"
#include "axes/sim/unit_choice.hpp"
#include "axes/sim/virtual_inputs.hpp"
#include "core/time.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class Behaviour {
public:
    explicit Behaviour(const DriveProfile& profile);

    void power_on(ecat::sim::ObjectDictionary& dictionary, Instant now);
    /// SYNC0 runs each `cycle`, and the drive's clock is in step with it.
    void synchronised(bool running, Duration cycle) noexcept { communication_.synchronised(running, cycle); }
    void exchange_due(const ecat::sim::ExchangeCause& cause, Instant now) noexcept { communication_.exchange_due(cause, now); }
    void operational(bool op, Instant now) noexcept { communication_.operational(op, now); }
    /// For tests of a clock that does not lock.
    void clock_locks(bool locks) noexcept { communication_.clock_locks(locks); }
    /// The mains have all of their phases.
    void mains_complete(bool complete) noexcept { mains_.complete(complete); }

    /// The objects as the axis is to understand them.
    void obey(AxisInputs& in, Cia402Axis& axis) noexcept;
    /// What the drive shows beside what every CiA 402 axis does.
    void show(AxisOutputs& out, const Cia402Axis& axis) noexcept;
    /// Looks for what does not come: process data, SYNC0, a phase of the mains.
    void watch(Cia402Axis& axis, Instant now) noexcept;

    /// What drives the terminals: bit n is output n + 1; nothing while the drive sets them itself.
    [[nodiscard]] std::uint32_t digital_outputs() const noexcept { return outputs_.driven(); }

private:
    void obey_limits(AxisInputs& in) const noexcept;
    void obey_probes(AxisInputs& in) const noexcept;

    // What the drive type is.
    bool torque_offset_not_in_torque_, clock_bit_8_, standstill_bit_14_;
    std::int64_t bus_control_value_;
    // The objects, by what they change.
    BehaviourValue bus_control_, limit_masks_, following_limit_;
    std::array<BehaviourValue, 2> probe_input_;
    UnitChoice units_;
    CommunicationWatch communication_;
    PositionTargets targets_;
    LimitSwitchFault limit_switches_;
    OutputTerminals outputs_;
    AnalogueOutputs analogue_;
    VirtualInputs inputs_;
    MainsWatch mains_;
};

}  // namespace taktwerk::axes::sim
