#include "ecat/dc/propagation.hpp"

namespace taktwerk::ecat {

std::vector<std::uint32_t> line_delays(std::span<const LatchedTimes> slaves) {
    std::vector<std::uint32_t> delays(slaves.size(), 0);
    for (std::size_t i = 1; i < slaves.size(); ++i) {
        const auto before = static_cast<std::int64_t>(round_trip_behind(slaves[i - 1]));
        const auto here = static_cast<std::int64_t>(round_trip_behind(slaves[i]));
        // Quantised clocks of two slaves can make a short cable look negative.
        const std::int64_t step = before > here ? (before - here) / 2 : 0;
        delays[i] = delays[i - 1] + static_cast<std::uint32_t>(step);
    }
    return delays;
}

std::vector<std::uint64_t> system_offsets(std::span<const LatchedTimes> slaves, std::span<const std::uint32_t> delays,
                                          std::uint64_t reference_time) {
    std::vector<std::uint64_t> offsets(slaves.size(), 0);
    for (std::size_t i = 0; i < slaves.size(); ++i) offsets[i] = reference_time + delays[i] - slaves[i].unit;  // modulo 2^64
    return offsets;
}

std::uint64_t sync0_start(std::uint64_t now, Duration margin, Duration cycle, Duration phase, Duration shift) noexcept {
    const std::int64_t origin = (phase + shift).count();
    const std::int64_t earliest = static_cast<std::int64_t>(now) + margin.count();
    const std::int64_t period = cycle.count();
    return static_cast<std::uint64_t>(next_sync0(earliest, origin, period));
}

}  // namespace taktwerk::ecat
