#pragma once
// From what the cycle and the watch see of each slave to the conditions of alarms.hpp: what holds now, said once. A cable that
// breaks takes everybody behind it along; that is one condition, named at the first slave behind the break, and it stands until
// the last of them is back in OP. Allocates when it is made; look() is real-time safe and belongs to the cycle.
//
//   no frame comes back          link_down or frames_lost, nothing else: nothing else is known; it stands until all who fell by it are back
//   slaves do not answer         slave_lost, or cable_broken where it is more than one behind the same place
//   the cycle counts fewer slaves than it can name (a moment after a break): slaves_missing, and nobody is named before all are
//   slaves leave OP by a watchdog or for want of frames, right after this computer sent none      starved_slave_left_op, one for all
//   the same after frames that did not come back, although for less than the limit                 frames_lost, one for all
//   slaves leave OP without an error of their own: somebody sent them there                       foreign_command, one for all
//   a slave answers, but not as it should    slave_left_op, working_counter_wrong, station_address_lost, other_device, ...
//   slaves that share a sync unit are not exchanged    sync_unit_not_exchanged, until it is known who of them is out: that one's alarm, alone
//
// In this order suspicion falls: on this computer, on another master, on the cable, and only then on the slave. The broadcast says at
// once that somebody left OP and whether an error is why; who it was and the code of the error the watch reads some milliseconds later.
//
// Two interfaces are a ring: a break takes nobody away, is named by its two ends, and is said when a second frame has seen it. Where the
// clocks behind it count as unsynchronised each slave that runs SYNC0 there has a condition that stops its axes.
//
// Slaves whose loss stops only their own axes (LossPolicy::stop_own_axes) have conditions of their own with another reaction.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/alarm.hpp"
#include "ecat/alarm_set.hpp"
#include "ecat/bus_config.hpp"
#include "ecat/cycle/bus_phase.hpp"
#include "ecat/cycle/cycle_link.hpp"
#include "ecat/ring/ring_state.hpp"
#include "ecat/wire/al_status.hpp"

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
    bool taken_down = false;  ///< by this master itself, to set it up again
    BusAlarmSet seen{};       ///< what the scripts see of it
    CableErrors cable{};
    std::uint16_t emergency_code = 0;  ///< 0: none
    std::uint8_t error_register = 0;
};

/// The bus as a whole.
struct BusCondition {
    bool link_up = true;
    std::uint32_t lost_in_a_row = 0;
    std::uint16_t slaves_answering = 0;
    std::uint16_t guests = 0;                   ///< of them are not always there
    std::uint32_t reference_times_missing = 0;  ///< in a row
    std::int64_t dc_difference_ns = 0;
    BusAlarmSet seen{};        ///< what the scripts see
    Duration stall{};          ///< so long this computer sent nothing a moment ago; 0: it was in time
    std::uint32_t gap = 0;     ///< so many cycles in a row were not answered a moment ago; 0: no two
    std::uint16_t states = 0;  ///< OR of the AL states of all slaves, with the error bit; 0: not all of them answered
    bool out_of_lock = false;  ///< some slave runs SYNC0, and the cycle is not locked to the reference clock
    std::int64_t dc_phase_error_ns = 0;
    RingState ring{};
    std::uint16_t reference_station = 0;  ///< whose clock is the bus' now; 0: that of FaultSlave::reference
    bool ramp_down = false;               ///< slaves that a broken ring cuts off from the reference count as unsynchronised
};

/// A slave as it was configured and found. In the order of positions, so that parents come before their children.
struct FaultSlave {
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::size_t index = 0;      ///< in the configuration
    std::size_t parent = none;  ///< in this order: the next configured slave towards the master
    LossPolicy on_loss = LossPolicy::stop_machine;
    bool reference = false;             ///< its clock is the bus' clock
    bool synchronised = false;          ///< it runs SYNC0
    std::uint16_t position = 0;         ///< on the cable
    std::size_t unit = none;            ///< the sync unit that it shares with others, by any number; none: it has its own
    std::uint32_t watchdog_cycles = 2;  ///< without a frame until its watchdog of process data trips
    Duration watchdog{};                ///< the same as a time
    std::uint16_t station = 0;
    bool exchanges = true;  ///< it has process data; else its age says nothing
    bool guest = false;     ///< it comes and goes with its group: being gone is no fault
    [[nodiscard]] bool alone() const noexcept { return unit == none; }
};

class FaultFinder {
public:
    /// `expected`: slaves that answer to a broadcast when all is well, besides BusCondition::guests. `limit`: cycles without exchange until it is a fault.
    FaultFinder(std::vector<FaultSlave> slaves, std::uint16_t expected, std::uint32_t limit);

    /// Of the slave with this index in the configuration; written before look().
    [[nodiscard]] SlaveCondition& condition(std::size_t index) noexcept { return states_[order_[index]].seen; }
    void look(const BusCondition& bus) noexcept;
    /// What holds of a bus that is not in OP: only that.
    [[nodiscard]] static std::span<const AlarmFact> facts_before_op(BusPhase phase) noexcept;
    /// What held at the last look(), of a bus in OP.
    [[nodiscard]] std::span<const AlarmFact> facts() const noexcept { return facts_; }

private:
    /// Of a slave that is out of OP: what came before it. Empty as long as it is in OP.
    struct Fall {
        Duration stall{};              ///< this computer sent nothing for so long
        std::uint32_t gap = 0;         ///< so many cycles in a row no frame came back
        bool by_command = false;       ///< it names no error of its own
        bool restarted = false;        ///< it did not answer to its address meanwhile: its controller began anew
        bool read = false;             ///< the watch has asked it
        std::uint8_t cycles_down = 0;  ///< up to `cycles_of_a_fall`
        std::uint16_t code = 0;        ///< why, as it said first: the way back clears it
        [[nodiscard]] bool now() const noexcept { return cycles_down > 0; }
    };
    /// Slaves that fell by one thing outside of them.
    struct Fallen {
        std::size_t count = 0, most = 0;  ///< now, and at most since the first fell
        Duration stall{};
        std::uint32_t gap = 0;
    };
    struct State {
        SlaveCondition seen;
        bool lost = false;
        bool counted = false;                      ///< silent at its address, and on the cable: nobody was missing meanwhile
        bool stale_in_op = false;                  ///< it was not exchanged while everybody was in OP: for want of frames it falls by that
        std::size_t gone_with = FaultSlave::none;  ///< the first slave behind the break that took it away; until it is back in OP
        Fall fall;
        std::size_t group = 0, largest_group = 0;  ///< slaves gone with this one, now and at most
        bool group_stops_machine = false;
    };
    /// Slaves whose process data is valid or not together: the working counter does not say whose is missing.
    struct SharedUnit {
        std::vector<std::size_t> members;  ///< in slaves_
        bool stops_machine = false;        ///< the loss of one of them does
    };
    void raise(BusAlarm alarm, AlarmSource source, std::size_t index, double a = 0, double b = 0) noexcept;
    /// Frames, cables, slaves and the reference clock.
    void look_at_slaves(const BusCondition& bus) noexcept;
    void raise_emergency(std::size_t index) noexcept;
    void look_at_ring(const BusCondition& bus) noexcept;
    /// Returns how many slaves are missing that cannot be named yet. As long as there are some nobody new is named: whoever of them is found
    /// first is seldom the one that took the others along.
    std::size_t find_lost(std::uint16_t answering, std::uint16_t expected) noexcept;
    void form_groups() noexcept;
    void raise_groups() noexcept;
    void raise_slave(std::size_t at, bool counted_out) noexcept;
    void raise_units() noexcept;
    /// It fell because its process data did not reach it, although frames came back: or nothing is known that says otherwise.
    [[nodiscard]] static bool fell_unexchanged(const State& state) noexcept;
    /// Why the slave is not exchanged is known, and said of it.
    [[nodiscard]] bool is_out(const State& state) const noexcept;
    void note_falls(const BusCondition& bus) noexcept;
    /// What many slaves fell by is said once.
    void raise_falls(const BusCondition& bus) noexcept;
    /// A slave that answers, but not from OP, and nothing outside of it explains that.
    void raise_left_op(std::size_t at) noexcept;
    /// A slave that has all it needs, and does not take part; also while this master sets it up again.
    void raise_not_exchanged(std::size_t at) noexcept;
    [[nodiscard]] Fallen* fallen_with(std::size_t at) noexcept;
    /// So many cycles without an answer, and so long without a frame of ours, explain that this slave fell.
    [[nodiscard]] std::uint32_t explaining_gap(std::size_t at) const noexcept;
    [[nodiscard]] Duration explaining_stall(std::size_t at) const noexcept;
    /// It was the synchronisation that failed, which bears less than the watchdog does.
    [[nodiscard]] static bool lost_synchronisation(const Fall& fall) noexcept;
    /// Its way back has ended: it answers, and nothing between it and the master is the reason.
    [[nodiscard]] static bool stuck(const SlaveCondition& slave) noexcept;
    /// Another device stands in its place, without an address: nobody is missing.
    [[nodiscard]] bool replaced(const State& state) const noexcept {
        return state.seen.trouble == ReturnTrouble::other_device && missing_ == 0;
    }
    void raise_unnamed(std::size_t unnamed, std::uint16_t expected) noexcept;
    [[nodiscard]] bool stale(const State& state) const noexcept { return state.seen.age >= limit_; }

    std::vector<FaultSlave> slaves_;
    std::vector<State> states_;       ///< as slaves_
    std::vector<std::size_t> order_;  ///< configuration index -> place in slaves_
    std::vector<SharedUnit> units_;   ///< FaultSlave::unit numbers them
    std::vector<AlarmFact> facts_;    ///< capacity for all there can be
    std::uint16_t expected_;
    std::uint32_t limit_;
    std::array<Fallen, 2> starved_, commanded_;  ///< stop_machine, stop_own_axes
    Fallen silenced_;
    BusAlarm silence_;  ///< link_down or frames_lost, which was last
    std::uint32_t silence_cycles_ = 0, linked_cycles_ = 0;
    bool was_silent_ = false;
    std::uint32_t broken_for_ = 0;  ///< cycles in which the ring was seen broken, in a row
    std::size_t missing_ = 0;       ///< at the last look
    bool crowded_ = false;          ///< more slaves answer than are known: somebody was plugged in a moment ago
    bool uninvited_ = false;        ///< and slaves that are in order are not exchanged since
    std::uint32_t naming_for_ = 0;  ///< cycles since that number changed
    bool naming_ = false;           ///< somebody is missing, and not all who are are known
};

}  // namespace taktwerk::ecat
