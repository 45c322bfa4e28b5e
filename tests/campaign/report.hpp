#pragma once
// docs/fault-campaign.md: the documented ends, and how many runs of the last long campaign ended in each way.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "tests/campaign/campaign_run.hpp"

namespace taktwerk::campaign {

using Counts = std::map<std::pair<FaultKind, Phase>, std::array<std::uint32_t, end_names.size()>>;

/// The part that depends on the table alone: it is compared in each run.
[[nodiscard]] std::string documented_part();
/// The part that tells of runs: kept as the last regeneration left it.
[[nodiscard]] std::string counted_part(const Counts& counts, std::size_t seeds);
/// What stands between the two.
inline constexpr std::string_view counted_heading = "## Runs\n";

}  // namespace taktwerk::campaign
