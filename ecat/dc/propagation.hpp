#pragma once
// Distributed clocks, the arithmetic: what the latched times say about delays, offsets, and when SYNC0 starts. Pure functions.
// Source: ETG.1000.4 (DC), reference/ethercat-masters.md section 5 (start sequence 3 and 5).
//
// Writing 0900h latches, as the frame passes: at each port the local time at which the frame arrived there (0900h + 4p, 32
// bit), and at the processing unit the local time at which it was processed (0918h, 64 bit). Every slave has its own clock;
// only differences inside one slave mean anything until the offsets are written.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "ecat/topology/topology.hpp"

namespace taktwerk::ecat {

/// What one slave latched.
struct LatchedTimes {
    bool dc = false;                                    ///< it has a clock; the rest is then valid
    std::array<std::uint32_t, ports_per_slave> port{};  ///< ns, local clock, wraps; of closed ports anything
    std::uint64_t unit = 0;                             ///< ns: 0918h
};

/// Through its processing unit a frame takes this much longer than past it (from an exit to the next, or back to the entry).
/// 40 ns in the controllers of the ET1100's family (tDiff of its data sheet); 0918h and 0928h count at the processing unit.
inline constexpr Duration processing_difference = std::chrono::nanoseconds{40};

/// What one hop (out of a slave, through the cable) is taken for where nothing measured it.
inline constexpr Duration assumed_hop = std::chrono::nanoseconds{600};

struct PropagationDelays {
    std::vector<std::uint32_t> ns;       ///< by position, from the reference: for 0928h; 0 for slaves without a clock
    std::vector<std::size_t> estimated;  ///< positions with a clock whose delay nothing could measure
};

/// Propagation delays from the reference, the first slave with a clock, to all others, along the way that a frame takes through
/// the tree. `slaves`: by position, as many as the topology has.
///
/// A slave with a clock measures each of its branches: from the arrival at one port to that at the next (in the order of time,
/// so that it does not matter which socket the cable from the master is in). What the clocks inside the branch account for
/// themselves is subtracted; the rest are the hops between them, there and back. Slaves without a clock count as cable. The
/// hops share the rest evenly: exact for a line between two clocks as long as both ways take the same time, a good guess where
/// two branches part at a slave without a clock. Where such a slave stands before all clocks, nothing measures what lies between
/// the branches behind it: assumed_hop, reported in `estimated` (put a slave with a clock first).
[[nodiscard]] PropagationDelays propagation_delays(const Topology& topology, std::span<const LatchedTimes> slaves);

/// System time offset (0920h) of a slave: local time + offset = system time. `reference_time`: the system time that the reference
/// shall have had when it latched; the slave saw the same frame `delay` later, at its local time `unit` (0918h). Modulo 2^64.
[[nodiscard]] constexpr std::uint64_t system_offset(std::uint64_t unit, std::uint32_t delay, std::uint64_t reference_time) noexcept {
    return reference_time + delay - unit;
}

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

/// SYNC0 of one slave, followed from cycle to cycle: no division while time goes on by a period or less. One thread.
class Sync0Pulse {
public:
    /// As next_sync0(); `cycle` stays the same.
    [[nodiscard]] std::int64_t next(std::int64_t t, std::int64_t start, std::int64_t cycle) noexcept {
        if (start == start_ && t > next_ - cycle && t <= next_ + cycle) {
            if (t > next_) next_ += cycle;
        } else {
            start_ = start;
            next_ = next_sync0(t, start, cycle);
        }
        return next_;
    }
    /// As last_sync0().
    [[nodiscard]] std::int64_t last(std::int64_t t, std::int64_t start, std::int64_t cycle) noexcept {
        return next(t + 1, start, cycle) - cycle;
    }

private:
    std::int64_t start_ = 0, next_ = std::numeric_limits<std::int64_t>::min() / 2;
};

}  // namespace taktwerk::ecat
