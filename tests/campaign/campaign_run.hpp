#pragma once
// One run: a machine with two axes and a terminal, one fault at one moment, and how it ended. The same kind, phase and seed give the
// same run.

#include <string>
#include <vector>

#include "tests/campaign/expected_end.hpp"

namespace taktwerk::campaign {

enum class End : std::uint8_t { operational, degraded, failed, stopped, none };
inline constexpr std::array<std::string_view, 5> end_names{"operational", "operational without it", "failed", "stopped", "no end"};

struct RunResult {
    End end = End::none;
    std::vector<std::string> problems;  ///< what was not as documented; empty: all well
    std::string story;                  ///< for a failure: what was done, what was raised, what the bus noted
};

[[nodiscard]] RunResult run_fault(FaultKind kind, Phase phase, std::uint32_t seed);

}  // namespace taktwerk::campaign
