#pragma once
// Where a group's path cannot be gone and what stands there, in words: for the log, answers, the page, commands. Not real-time.

#include <string>
#include <string_view>

#include "axes/group/path_types.hpp"
#include "runtime/snapshot.hpp"

namespace taktwerk::hmi {

/// "it enters the kept-free room 'post'; at X 120.000 Y 400.000 Z 50.000 mm; after 84.2 of 300.0 mm (28 %) of its way; line 12 of its text". Empty: nobody
/// can say. `group`: its place in the layout; `axes`: the members' indices by place, as they are now.
[[nodiscard]] std::string place_text(const axes::PathPlace& place, const runtime::MachineLayout& layout, std::size_t group,
                                     const std::array<axes::AxisRef, axes::most_members>& axes);

/// The room's name; empty: none.
[[nodiscard]] std::string_view room_name(std::uint8_t room, const runtime::MachineLayout& layout, std::size_t group);

/// As configured.
[[nodiscard]] std::array<axes::AxisRef, axes::most_members> members_of(const runtime::MachineLayout& layout, std::size_t group);

}  // namespace taktwerk::hmi
