#pragma once
// Distributed clocks, the arithmetic: what the latched times say about delays, offsets, and when SYNC0 starts. Pure functions.
// Source: ETG.1000.4 (DC), reference/ethercat-masters.md section 5 (start sequence 3 and 5).
//
// Writing 0900h latches, as the frame passes: at each port the local time at which the frame arrived there (0900h + 4p, 32
// bit), and at the processing unit the local time at which it was processed (0918h, 64 bit). Every slave has its own clock;
// only differences inside one slave mean anything until the offsets are written.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/time.hpp"

namespace taktwerk::ecat {

/// What one slave latched, in the order of the cable. Slaves without DC are left out: their transit counts as cable.
struct LatchedTimes {
    std::uint32_t port0 = 0;  ///< ns, local clock, wraps: frame comes in
    std::uint32_t port1 = 0;  ///< ns: the same frame comes back from the slaves behind; unused at the end of the line
    bool port1_open = false;  ///< somebody is behind
    std::uint64_t unit = 0;   ///< ns: 0918h
};

/// Time the frame needed from this slave to the end of the line and back. 0 at the end. 32-bit wrap is harmless.
[[nodiscard]] constexpr std::uint32_t round_trip_behind(const LatchedTimes& slave) noexcept {
    return slave.port1_open ? slave.port1 - slave.port0 : 0u;
}

/// Propagation delay from the first slave (the reference clock, 0) to each, ns: for register 0928h. A line.
///     delay(i) = delay(i-1) + (round trip behind i-1  -  round trip behind i) / 2
[[nodiscard]] std::vector<std::uint32_t> line_delays(std::span<const LatchedTimes> slaves);

/// System time offsets (0920h): local time + offset = system time. `reference_time`: the system time that the first slave shall
/// have had when it latched. All slaves see the frame; slave i sees it delay(i) later than the reference.
[[nodiscard]] std::vector<std::uint64_t> system_offsets(std::span<const LatchedTimes> slaves, std::span<const std::uint32_t> delays,
                                                        std::uint64_t reference_time);

/// The first SYNC0: the first instant `shift` after a start of a bus cycle that is at least `margin` after `now`. All in
/// system time; cycles start at multiples of `cycle` (plus `phase`, 0 <= phase < cycle).
///     start = ceil((now + margin - phase - shift) / cycle) * cycle + phase + shift
[[nodiscard]] std::uint64_t sync0_start(std::uint64_t now, Duration margin, Duration cycle, Duration phase, Duration shift) noexcept;

/// The SYNC0 instant at or after `t`, and the one at or before it, given any SYNC0 instant `start`. ns.
[[nodiscard]] constexpr std::int64_t next_sync0(std::int64_t t, std::int64_t start, std::int64_t cycle) noexcept {
    const std::int64_t into = ((t - start) % cycle + cycle) % cycle;
    return into == 0 ? t : t + (cycle - into);
}
[[nodiscard]] constexpr std::int64_t last_sync0(std::int64_t t, std::int64_t start, std::int64_t cycle) noexcept {
    return t - ((t - start) % cycle + cycle) % cycle;
}

}  // namespace taktwerk::ecat
