#pragma once
// Whether an arm's tool comes to where it is to work, over the travels of its axes. Not real-time.

#include <optional>
#include <vector>

#include "axes/group/arm_reach.hpp"
#include "core/result.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// Nothing where arm_reach() says nothing.
[[nodiscard]] std::optional<axes::ArmReach> reach_of(const MachineConfig& config, const axes::AxisGroupConfig& group);

/// An arm that closes nowhere; each room to stay in that the point of no tool comes to; rooms kept free that leave it no place. Subjects name the room
/// ("groups.arm.workspace.cell"), or the group; the code is remark.reach.
[[nodiscard]] std::vector<Error> reach_remarks(const MachineConfig& config);

}  // namespace taktwerk::runtime
