#pragma once
// Distributed clocks as scripts: latch, delays, offsets, waiting for the drift control, SYNC0. Arithmetic: ecat/dc/.
//
// The system time of a Taktwerk bus is the master's machine time (its epoch is the machine's): the reference clock, the first
// slave with DC, is set to it once and then runs by itself; the cycle measures how far the two drift apart (CycleLink).

#include "ecat/bringup/bus.hpp"

namespace taktwerk::ecat {

/// How far a clock may be off before SAFEOP; SV33-E supervises 3000 ns (P0A.32).
inline constexpr Duration clock_limit = std::chrono::microseconds{1};

/// Finds the reference, latches, writes 0928h and 0920h of every slave with DC. Does nothing on a bus without DC.
[[nodiscard]] Script<Result<void>> setup_clocks(Bus& bus);
/// A slave came back with a clock that started anew: offset again, delay as before. For the reference: before it answers to
/// its station address, so that nobody copies its wrong time. One that stands before the present reference becomes the reference.
[[nodiscard]] Script<Result<void>> restore_clock(Bus& bus, BusSlave& slave);
/// While it lives the cycle gives the reference time to nobody: the slaves' clocks run by themselves.
class ClockHold {
public:
    explicit ClockHold(Bus& bus) : bus_(bus) { bus_.link.clock_holds.fetch_add(1); }
    ~ClockHold() { bus_.link.clock_holds.fetch_sub(1); }
    ClockHold(const ClockHold&) = delete;
    ClockHold& operator=(const ClockHold&) = delete;

private:
    Bus& bus_;
};

/// Until 092Ch of every slave is inside clock_limit. Sends the reference time itself while the cycle does not.
[[nodiscard]] Script<Result<void>> await_clocks(Bus& bus);
/// Until the master's cycle is locked to the reference. After five seconds a phase error below an eighth of the cycle is let pass
/// (the alarm dc_not_locked stands then); Error bus.dc_not_locked otherwise. Returns at once where no slave runs SYNC0.
[[nodiscard]] Script<Result<void>> await_lock(Bus& bus);
/// start_sync0() for those slaves that are configured for this moment.
[[nodiscard]] Script<Result<void>> start_sync_before_safeop(Bus& bus, BusSlave& slave);
[[nodiscard]] Script<Result<void>> start_sync_in_safeop(Bus& bus, BusSlave& slave);
/// Start, cycle and activation of SYNC0 (and SYNC1 behind it), in the phase of the master's send(), from the slave's clock as just
/// read. Nothing for slaves without `dc`.
[[nodiscard]] Script<Result<void>> start_sync0(Bus& bus, BusSlave& slave);
[[nodiscard]] Script<Result<void>> stop_sync0(Bus& bus, BusSlave& slave);

/// SYNC0 after the start of the bus cycle for this slave.
[[nodiscard]] Duration sync0_shift(const BusConfig& bus, const SlaveConfig& slave) noexcept;

}  // namespace taktwerk::ecat
