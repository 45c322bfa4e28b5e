#pragma once
// Where the tool's point is, and how fast, of the members' values. Real-time safe.

#include "axes/group/group_view.hpp"

namespace taktwerk::axes {

class Kinematics;
struct Pose;

/// Fills what the view has of the tool, whose point `tool` is seen from the flange; of a group without all joints of its arm nothing is known.
void see_tool(GroupView& view, const Kinematics* arm, const Pose& tool) noexcept;

}  // namespace taktwerk::axes
