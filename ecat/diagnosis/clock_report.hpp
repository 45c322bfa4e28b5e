#pragma once
// The distributed clocks as the slaves have them now: delays, offsets, difference, SYNC0 and SYNC1. Reads only.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/time.hpp"
#include "ecat/diagnosis/survey.hpp"

namespace taktwerk::ecat {

struct ClockReport {
    std::size_t position = 0;
    bool reference = false;  ///< the first slave with a clock: the others follow it
    bool clock_64bit = false;
    std::uint64_t system_time = 0;  ///< ns
    std::uint64_t offset = 0;       ///< ns: 0920h
    std::uint32_t delay = 0;        ///< ns from the reference: 0928h
    std::int32_t difference = 0;    ///< ns: 092Ch; positive: ahead
    bool cyclic = false, sync0 = false, sync1 = false;
    Duration sync0_cycle{}, sync1_cycle{};  ///< as programmed, also while off
    std::uint64_t start = 0;                ///< system time of the next (or first) SYNC0
    std::optional<Error> error;
};

/// One entry for each slave that has a clock, by position.
[[nodiscard]] Script<Result<std::vector<ClockReport>>> read_clocks(DatagramPort& port, const Survey& survey);

/// What stands out, in words; empty: nothing. `limit`: what a clock may be off.
[[nodiscard]] std::vector<std::string> clock_findings(const Survey& survey, const std::vector<ClockReport>& clocks, Duration limit);

}  // namespace taktwerk::ecat
