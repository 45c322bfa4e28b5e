#pragma once
// A machine of config/machines/ as `taktwerk run --simulate` builds it, with a second program that does what no program should.

#include <array>
#include <string>
#include <string_view>

#include "runtime/machine_config.hpp"

namespace taktwerk::whole {

/// What the campaign draws from. Those that are left out: hot connect has a campaign of its own (docs/hot-connect-campaign.md), and machines whose only axes
/// count without a drive have nothing to lose.
inline constexpr std::array<std::string_view, 16> machine_names{
    "demo",       "five-drives",    "minimal", "serial-axis", "portal",   "winder",       "flying_shear", "press_feed",
    "print_mark", "indexing_table", "vice",    "scara",       "engraver", "delta-picker", "dispensing",   "palletizer"};

/// Throws std::runtime_error with all problems of the file. Nothing happens in it by itself; what it keeps goes to `folder`.
[[nodiscard]] runtime::MachineConfig load(std::string_view name, const std::string& folder);

}  // namespace taktwerk::whole
