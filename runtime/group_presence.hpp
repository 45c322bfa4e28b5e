#pragma once
// The groups of hot connect: their names and numbers, and what the bus says of them in the words of the axes.

#include <string>
#include <string_view>
#include <vector>

#include "axes/words/types.hpp"
#include "ecat/master.hpp"

namespace taktwerk::runtime {

/// As the bus counts them.
[[nodiscard]] std::vector<std::string> group_names(const ecat::BusConfig& bus);
/// -1: there is none of that name, as for a slave that is always there.
[[nodiscard]] int group_index(const ecat::Master& bus, std::string_view name) noexcept;

/// `group`: below 0 for what is always there. Real-time safe.
[[nodiscard]] axes::Presence presence_of(const ecat::Master& bus, int group) noexcept;

}  // namespace taktwerk::runtime
