#pragma once
// Where the frames of a group stand: MC_SetCartesianTransform, MC_SetCoordinateTransform, MC_ReadCartesianTransform, MC_ReadCoordinateTransform.
// PLCopen Part 4 v2.0. Real-time safe. A command keeps the frame it was accepted with (G-029).

#include <string_view>

#include "fb_library/groups/group_block.hpp"
#include "fb_library/groups/group_equipment_types.hpp"

namespace taktwerk::fb {

/// As MC_SetCoordinateTransform, with six numbers. Of FCS, TCS, WCS and ACS not_supported: a tool is written by MC_GroupWriteToolData.
struct MC_SetCartesianTransform : GroupCommandBlock<MC_SetCartesianTransform> {
    GroupRef AxesGroup{};
    bool Execute = false;
    double TransX = 0, TransY = 0, TransZ = 0, RotAngle1 = 0, RotAngle2 = 0, RotAngle3 = 0;
    MC_CoordSystem CoordSystem = mcPCS;
    MC_ExecutionMode ExecutionMode = mcImmediately;

    bool Done = false, Busy = false, Active = false, CommandAccepted = false, CommandAborted = false;
    CommandNumber CommandID{};
    bool Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Says where a product's frame, or the machine, stands in the world.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), in<&Self::TransX>("u", "of its origin, in the world"),
                         in<&Self::TransY>("u", "likewise"), in<&Self::TransZ>("u", "likewise"),
                         in<&Self::RotAngle1>("rad", "RX: turned about the new X last"),
                         in<&Self::RotAngle2>("rad", "RY: then about the new Y"), in<&Self::RotAngle3>("rad", "RZ: first about Z"),
                         in<&Self::CoordSystem>("", "mcPCS, mcPCS_2 to mcPCS_8, mcMCS"), detail::when_set<&Self::ExecutionMode>(),
                         detail::frame_outcome<Self>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        return {.kind = axes::GroupCommandKind::set_frame,
                .frame = CoordSystem,
                .target = {TransX, TransY, TransZ, RotAngle1, RotAngle2, RotAngle3},
                .execution = ExecutionMode};
    }
};

struct MC_SetCoordinateTransform : GroupCommandBlock<MC_SetCoordinateTransform> {
    GroupRef AxesGroup{};
    bool Execute = false;
    MC_COORD_REF CoordTransform{};
    MC_CoordSystem CoordSystem = mcPCS;
    MC_ExecutionMode ExecutionMode = mcImmediately;

    bool Done = false, Busy = false, Active = false, CommandAccepted = false, CommandAborted = false;
    CommandNumber CommandID{};
    bool Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Says where a product's frame, or the machine, stands in the world.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), in<&Self::CoordTransform>("", "u, rad: seen from the world"),
                         in<&Self::CoordSystem>("", "mcPCS, mcPCS_2 to mcPCS_8, mcMCS"), detail::when_set<&Self::ExecutionMode>(),
                         detail::frame_outcome<Self>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        const auto& t = CoordTransform;
        return {.kind = axes::GroupCommandKind::set_frame,
                .frame = CoordSystem,
                .target = {t.X, t.Y, t.Z, t.RX, t.RY, t.RZ},
                .execution = ExecutionMode};
    }
};

/// What the next command in this frame would take. Of WCS 0; of ACS, FCS, TCS not_supported.
struct MC_ReadCartesianTransform : EnableBlock<MC_ReadCartesianTransform> {
    GroupRef AxesGroup{};
    bool Enable = false;
    MC_CoordSystem CoordSystem = mcPCS;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    double TransX = 0, TransY = 0, TransZ = 0, RotAngle1 = 0, RotAngle2 = 0, RotAngle3 = 0;

    static constexpr std::string_view summary = "Gives where a frame of the group stands in the world.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable, &Self::CoordSystem>(), reading<Self>(),
                         out<&Self::TransX>("u", "of its origin, in the world"), out<&Self::TransY>("u", "likewise"),
                         out<&Self::TransZ>("u", "likewise"), out<&Self::RotAngle1>("rad", "RX"), out<&Self::RotAngle2>("rad", "RY"),
                         out<&Self::RotAngle3>("rad", "RZ"));
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        const auto answer = detail::frame_of(ctx, AxesGroup, CoordSystem);
        const auto& six = answer.six;
        if (answer.error != ErrorId::none) return Reading::unless(answer.error);
        TransX = six[0], TransY = six[1], TransZ = six[2], RotAngle1 = six[3], RotAngle2 = six[4], RotAngle3 = six[5];
        return Reading::valid();
    }
    void clear() noexcept { TransX = TransY = TransZ = RotAngle1 = RotAngle2 = RotAngle3 = 0; }
};

/// Likewise.
struct MC_ReadCoordinateTransform : EnableBlock<MC_ReadCoordinateTransform> {
    GroupRef AxesGroup{};
    bool Enable = false;
    MC_CoordSystem CoordSystem = mcPCS;

    bool Valid = false, Busy = false, Error = false;
    ErrorId ErrorID{};
    MC_COORD_REF CoordTransform{};

    static constexpr std::string_view summary = "Gives where a frame of the group stands in the world.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Enable, &Self::CoordSystem>(), reading<Self>(),
                         out<&Self::CoordTransform>("", "u, rad: seen from the world"));
    }
    [[nodiscard]] Reading read(const MotionContext& ctx) noexcept {
        const auto answer = detail::frame_of(ctx, AxesGroup, CoordSystem);
        CoordTransform = detail::coordinates_of(answer.six);
        return Reading::unless(answer.error);
    }
    void clear() noexcept { CoordTransform = {}; }
};

}  // namespace taktwerk::fb
