#pragma once
// What the cycle knows of a bus in operation and of each slave: plain numbers for everybody above.

#include <cstdint>

#include "core/time.hpp"
#include "ecat/dc/cycle_servo.hpp"
#include "ecat/ring/ring_state.hpp"
#include "ecat/wire/al_status.hpp"

namespace taktwerk::ecat {

/// Slaves that come and go together (hot connect).
enum class GroupPresence : std::uint8_t {
    absent,
    joining,  ///< plugged in and known; its slaves are on their way to OP
    present,  ///< all of them are in OP, and their process data is exchanged
};
[[nodiscard]] constexpr const char* name(GroupPresence presence) noexcept {
    return presence == GroupPresence::present ? "present" : presence == GroupPresence::joining ? "joining" : "absent";
}

/// What the cycle knows about a slave's process data. Trivially copyable.
struct SlaveHealth {
    AlState al_state = AlState::unknown;
    bool al_error = false;
    std::uint16_t al_status_code = 0;
    std::uint16_t emergency_code = 0;  ///< of its last emergency; 0: none, or the slave has taken it back
    std::uint8_t error_register = 0;   ///< 1001h, of that emergency
    bool fresh = false;                ///< its inputs were exchanged in the last receive(), with the right working counter
    bool due = true;                   ///< its sync unit was to be exchanged in that cycle; false between the instants of a slower unit
    std::uint32_t age = 0;             ///< exchanges missed since they were, in periods of its sync unit
    Instant latched{};                 ///< when its inputs were latched (SYNC0 instant, or frame time); of the last fresh exchange
};

/// Counters since start; never reset by the master.
struct BusStatistics {
    std::uint64_t frames_sent = 0, frames_received = 0, frames_lost = 0, frames_late = 0, frames_rejected = 0;
    std::uint64_t frames_foreign = 0;  ///< EtherCAT frames of another master on the cable
    std::uint64_t working_counter_errors = 0, send_errors = 0;
    std::uint16_t slaves_answering = 0;  ///< in the last cyclic frame that came back
    std::uint32_t lost_in_a_row = 0;
    std::int64_t dc_difference_ns = 0;   ///< worst 092Ch seen in the last service round
    Duration round_trip{};               ///< of the last answered cyclic frame
    std::int64_t dc_offset_ns = 0;       ///< reference clock minus machine time, smoothed; 0 without DC
    std::int64_t dc_drift_ppb = 0;       ///< how fast dc_offset_ns changes, ns per s: what the servo follows
    std::int64_t dc_phase_error_ns = 0;  ///< how much later than it should the last frame left, in the reference's time
    Duration dc_correction{};            ///< of the period that follows: what the servo asks for
    /// From the arrival of a cycle's last byte at a slave to the SYNC0 that is to find it, measured by the reference clock; the
    /// least of all slaves, in the last cycle and since OP. Below 0: too late. 0 while no slave runs SYNC0.
    std::int64_t sync0_margin_ns = 0, sync0_margin_least_ns = 0;
    DcLock dc_lock = DcLock::none;  ///< of the master's cycle to the reference clock
    RingState ring;                 ///< of the two interfaces; RingShape::none where there is one
    std::uint64_t dc_rejected = 0;  ///< reference times that were missing or implausible
};

}  // namespace taktwerk::ecat
