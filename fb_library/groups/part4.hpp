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
    NotOffered{"MC_GroupHome", "not_supported: homing of members in order is not written yet; MC_Home of each axis in GroupStandby"},
    NotOffered{"MC_SetKinTransform", "not_supported: the arm is configured with the group, checked before the machine starts and the same for all that is planned; MC_ReadKinTransform gives it"},
    NotOffered{"MC_GroupReadActualAcceleration", "not_supported: nobody measures it; MC_GroupReadAcceleration gives the set value"},
    NotOffered{"MC_GroupReadParameter", "not_supported: the meaning of mcTransitionReferencePoint is disputed among our sources, and mcPercentage is not written yet"},
    NotOffered{"MC_GroupWriteParameter", "not_supported: as MC_GroupReadParameter"},
    NotOffered{"MC_GroupWriteReferenceDynamics", "not_supported: there is no mcPercentage yet that would read it"},
    NotOffered{"MC_GroupReadReferenceDynamics", "not_supported: there is no mcPercentage yet"},
    NotOffered{"MC_GroupWriteSWLimits", "not_supported: MC_WriteParameter of each axis; writing all or none is not written yet"},
    NotOffered{"MC_SyncAxisToGroup", "not_supported: couplings to a path are not written yet"},
    NotOffered{"MC_SyncGroupToAxis", "not_supported: couplings to a path are not written yet"},
    NotOffered{"MC_SetDynCoordTransform", "not_supported: moving frames are not written yet"},
    NotOffered{"MC_TrackConveyorBelt", "not_supported: moving frames are not written yet"},
    NotOffered{"MC_TrackRotaryTable", "not_supported: moving frames are not written yet"},
};
// clang-format on

}  // namespace taktwerk::fb
