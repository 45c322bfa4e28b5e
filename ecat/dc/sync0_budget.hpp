#pragma once
// The time between the start of a cycle and SYNC0, and what has to fit into it. Pure.

#include <cstddef>

#include "core/time.hpp"

namespace taktwerk::ecat {

/// 100 Mbit/s: a byte takes 80 ns on the wire. Outputs are valid when the last byte of their frame is through.
inline constexpr Duration wire_time_of_byte = std::chrono::nanoseconds{80};
/// From slave to slave: controller, two PHYs, some cable. Assumed, and meant as more than most need: what a real bus needs its propagation
/// delays tell (0928h, `taktwerk bus dc`).
inline constexpr Duration usual_hop = std::chrono::microseconds{1};
/// Preamble, start of frame, FCS and the gap to the next frame.
inline constexpr std::size_t wire_overhead = 24;

/// What a slave costs a frame there and back at the very least, E-bus terminals with short ways among them. Assumed, and meant as less than
/// any needs: it only decides what is refused as impossible.
inline constexpr Duration least_hop_both_ways = std::chrono::nanoseconds{300};

/// From the departure of the first bit until `bytes` of frames are through the last of `slaves` slaves.
[[nodiscard]] constexpr Duration flight_time(std::size_t bytes, std::size_t frames, std::size_t slaves) noexcept {
    return static_cast<std::int64_t>(bytes + frames * wire_overhead) * wire_time_of_byte + static_cast<std::int64_t>(slaves) * usual_hop;
}

}  // namespace taktwerk::ecat
