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
    NotOffered{"MC_SetKinTransform", "not_supported: the kinematics is configured with the group"},
    NotOffered{"MC_SetCartesianTransform", "not_supported: there are no product frames yet"},
    NotOffered{"MC_SetCoordinateTransform", "not_supported: there are no product frames yet"},
    NotOffered{"MC_ReadKinTransform", "not_supported: the kinematics is configured with the group"},
    NotOffered{"MC_ReadCartesianTransform", "not_supported: there are no product frames yet"},
    NotOffered{"MC_ReadCoordinateTransform", "not_supported: there are no product frames yet"},
    NotOffered{"MC_ReadDHParameters", "not_supported: no group has a serial arm yet"},
    NotOffered{"MC_ReadJointInfo", "not_supported: no group has a serial arm yet"},
    NotOffered{"MC_GroupSetPosition", "not_supported: MC_SetPosition of each axis in GroupStandby"},
    NotOffered{"MC_GroupReadActualAcceleration", "not_supported: nobody measures it; MC_GroupReadAcceleration gives the set value"},
    NotOffered{"MC_PathSelect", "not_supported: stored paths come with the path planner"},
    NotOffered{"MC_MovePath", "not_supported: stored paths come with the path planner"},
    NotOffered{"MC_GroupReadRigidBodyDynamic", "not_supported: there is no dynamic model that would read it"},
    NotOffered{"MC_GroupWriteRigidBodyDynamic", "not_supported: there is no dynamic model that would read it"},
    NotOffered{"MC_GroupWriteToolData", "not_supported: tools come with the kinematics"},
    NotOffered{"MC_GroupReadToolData", "not_supported: tools come with the kinematics"},
    NotOffered{"MC_GroupSelectTool", "not_supported: tools come with the kinematics"},
    NotOffered{"MC_GroupReadTool", "not_supported: tools come with the kinematics"},
    NotOffered{"MC_GroupWritePayloadData", "not_supported: there is no dynamic model that would read it"},
    NotOffered{"MC_GroupReadPayloadData", "not_supported: there is no dynamic model that would read it"},
    NotOffered{"MC_GroupSelectPayload", "not_supported: there is no dynamic model that would read it"},
    NotOffered{"MC_GroupReadPayload", "not_supported: there is no dynamic model that would read it"},
    NotOffered{"MC_GroupTransformPosition", "not_supported: comes with the kinematics"},
    NotOffered{"MC_SyncAxisToGroup", "not_supported: an axis cannot follow the length of a path yet; a group has no track that MC_GearIn could read"},
    NotOffered{"MC_SyncGroupToAxis", "not_supported: there are no stored paths whose parameter a master could drive"},
    NotOffered{"MC_SetDynCoordTransform", "not_supported: moving frames are not written yet"},
    NotOffered{"MC_TrackConveyorBelt", "not_supported: moving frames are not written yet"},
    NotOffered{"MC_TrackRotaryTable", "not_supported: moving frames are not written yet"},
};
// clang-format on

}  // namespace taktwerk::fb
