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
/// its station address, so that nobody copies its wrong time.
[[nodiscard]] Script<Result<void>> restore_clock(Bus& bus, BusSlave& slave);
/// Until 092Ch of every slave is inside clock_limit. Sends the reference time itself while the cycle does not.
[[nodiscard]] Script<Result<void>> await_clocks(Bus& bus);
/// Start, cycle and activation of SYNC0, in the phase of the master's send(). Nothing for slaves without `dc`.
[[nodiscard]] Script<Result<void>> start_sync0(Bus& bus, BusSlave& slave);
[[nodiscard]] Script<Result<void>> stop_sync0(Bus& bus, BusSlave& slave);

/// SYNC0 after the start of the bus cycle for this slave.
[[nodiscard]] Duration sync0_shift(const BusConfig& bus, const SlaveConfig& slave) noexcept;

}  // namespace taktwerk::ecat
