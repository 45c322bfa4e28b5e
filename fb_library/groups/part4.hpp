#pragma once
// The blocks of PLCopen Part 4 that are not offered, each with the reason: what docs/conformance/plcopen-part4.md says of them.

#include <array>
#include <string_view>

namespace taktwerk::fb {

struct NotOffered {
    std::string_view block, reason;
};

// clang-format off
inline constexpr std::array not_offered{
    NotOffered{"MC_SetKinTransform", "not_supported: the arm is configured with the group, checked before the machine starts and the same for all that is planned; MC_ReadKinTransform gives it"},
    NotOffered{"MC_GroupReadActualAcceleration", "not_supported: nobody measures it; MC_GroupReadAcceleration gives the set value"},
    NotOffered{"MC_SetDynCoordTransform", "not_supported: a frame fixed to another group's tool moves in six ways at once, and only one that a single number moves is joined and left without a jump"},
};
// clang-format on

}  // namespace taktwerk::fb
