#pragma once
// Is the cycle that was asked for realistic here? By what was measured, and by what was found. Pure.

#include <optional>
#include <string>
#include <vector>

#include "apps/doctor/clock_watch.hpp"
#include "apps/doctor/finding.hpp"
#include "apps/doctor/lateness.hpp"

namespace taktwerk::apps {

struct Measured {
    LatenessPlan plan;
    Lateness lateness;
    std::optional<RoundTrips> trips;
    std::string no_trips{};  ///< why there are none, where an interface was named
    ClockFacts clocks;
};

struct Verdict {
    Severity fitness = Severity::good;
    std::string words;                       ///< one line
    std::optional<Duration> shortest_cycle;  ///< usual one that these figures allow
};

/// What of a cycle is gone when its outputs are at the drives: lateness (p99.9), computing, round trip (p99.9). Half a cycle is room: that is where
/// SYNC0 stands by default.
[[nodiscard]] double used_us(const Measured& measured, const Wanted& wanted);
/// Of what was measured alone, as findings.
[[nodiscard]] std::vector<Finding> measured_findings(const Measured& measured, const Wanted& wanted);
/// `findings`: all of them, those of measured_findings() too.
[[nodiscard]] Verdict verdict(const std::vector<Finding>& findings, const Measured* measured, const Wanted& wanted);

/// "1 ms", "250 us".
[[nodiscard]] std::string time_text(Duration time);

}  // namespace taktwerk::apps
