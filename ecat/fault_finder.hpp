#pragma once
// From what the cycle and the watch see of each slave to the conditions of alarms.hpp: what holds now, said once. A cable that
// breaks takes everybody behind it along; that is one condition, named at the first slave behind the break, and it stands until
// the last of them is back in OP. Allocates when it is made; look() is real-time safe and belongs to the cycle.
//
//   no frame comes back          link_down or frames_lost, nothing else: nothing else is known
//   slaves do not answer         slave_lost, or cable_broken where it is more than one behind the same place
//   the cycle counts fewer slaves than it can name (a moment after a break): slaves_missing
//   a slave leaves OP by a watchdog or for want of frames, right after this computer sent none    starved_slave_left_op
//   a slave answers, but not as it should    slave_left_op, working_counter_wrong, station_address_lost, other_device, ...
//
// Slaves whose loss stops only their own axes (LossPolicy::stop_own_axes) have conditions of their own with another reaction.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/alarm.hpp"
#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// One slave as it is seen now.
struct SlaveCondition {
    AlState al_state = AlState::unknown;
    bool al_error = false;
    std::uint16_t al_status_code = 0;
    std::uint32_t age = 0;  ///< cycles since its process data was exchanged
    Presence presence = Presence::answers;
    ReturnTrouble trouble = ReturnTrouble::none;
    std::uint32_t attempts = 0;
    bool mailbox_silent = false;
};

/// The bus as a whole.
struct BusCondition {
    bool link_up = true;
    std::uint32_t lost_in_a_row = 0;
    std::uint16_t slaves_answering = 0;
    std::uint32_t reference_times_missing = 0;  ///< in a row
    std::int64_t dc_difference_ns = 0;
    bool foreign_master = false;
    Duration stall{};  ///< so long this computer sent nothing a moment ago; 0: it was in time
};

/// A slave as it was configured and found. In the order of positions, so that parents come before their children.
struct FaultSlave {
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::size_t index = 0;      ///< in the configuration
    std::size_t parent = none;  ///< in this order: the next configured slave towards the master
    LossPolicy on_loss = LossPolicy::stop_machine;
    bool reference = false;  ///< its clock is the bus' clock
};

/// The configured slaves of a bus that was scanned.
[[nodiscard]] std::vector<FaultSlave> fault_slaves(const Bus& bus);

class FaultFinder {
public:
    /// `expected`: slaves that answer to a broadcast when all is well. `limit`: cycles without exchange until it is a fault.
    FaultFinder(std::vector<FaultSlave> slaves, std::uint16_t expected, std::uint32_t limit);

    /// Of the slave with this index in the configuration; written before look().
    [[nodiscard]] SlaveCondition& condition(std::size_t index) noexcept { return states_[order_[index]].seen; }
    void look(const BusCondition& bus) noexcept;
    /// What held at the last look().
    [[nodiscard]] std::span<const AlarmFact> facts() const noexcept { return facts_; }

private:
    struct State {
        SlaveCondition seen;
        bool lost = false;
        std::size_t gone_with = FaultSlave::none;  ///< the first slave behind the break that took it away; until it is back in OP
        Duration fell_after_stall{};               ///< this computer's own, right before the slave left OP; while it is out of OP
        std::uint8_t cycles_down = 0;      ///< not in OP for so many, up to `cycles_of_a_fall`
        std::uint16_t fell_code = 0;               ///< why, as it said first: the way back clears it
        std::size_t group = 0, largest_group = 0;  ///< slaves gone with this one, now and at most
        bool group_stops_machine = false;
    };
    void raise(AlarmId id, AlarmSource source, std::size_t index, double a = 0, double b = 0) noexcept;
    /// Returns how many slaves are missing that cannot be named yet.
    std::size_t find_lost(std::uint16_t answering) noexcept;
    void form_groups() noexcept;
    void raise_groups() noexcept;
    void raise_slave(std::size_t at, bool counted_out) noexcept;
    /// A slave that answers, but not from OP: whose doing was it?
    void raise_left_op(std::size_t at) noexcept;
    void raise_unnamed(std::size_t unnamed) noexcept;
    [[nodiscard]] bool stale(const State& state) const noexcept { return state.seen.age >= limit_; }

    std::vector<FaultSlave> slaves_;
    std::vector<State> states_;       ///< as slaves_
    std::vector<std::size_t> order_;  ///< configuration index -> place in slaves_
    std::vector<AlarmFact> facts_;    ///< capacity for all there can be
    std::uint16_t expected_;
    std::uint32_t limit_;
};

}  // namespace taktwerk::ecat
