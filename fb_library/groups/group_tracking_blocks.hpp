#pragma once
// Frames that move with an axis: MC_TrackConveyorBelt, MC_TrackRotaryTable. PLCopen Part 4 v2.0. Real-time safe. They move nothing: a command in that frame does
// (docs/motion/tracking.md).

#include <string_view>

#include "fb_library/groups/group_block.hpp"
#include "fb_library/groups/group_equipment_types.hpp"

namespace taktwerk::fb {

namespace detail {

/// mcAborting: at once; mcBuffered: behind all that wait. The group refuses the others.
[[nodiscard]] constexpr axes::GroupCommand track_command(axes::FrameTrack::Kind kind, AxisRef master, const MC_COORD_REF& origin,
                                                         const MC_COORD_REF& object, MC_CoordSystem frame, MC_BufferMode mode) noexcept {
    axes::GroupCommand command{.kind = axes::GroupCommandKind::track_frame, .frame = frame, .buffer_mode = mode};
    command.execution = mode == mcAborting ? mcImmediately : mcQueued;
    command.track.kind = kind;
    command.track.master = master;
    command.track.origin = six_of(origin);
    command.track.object = six_of(object);
    return command;
}
template <auto M>
consteval auto when_tracked() {
    return in<M>("", "mcAborting: at once; mcBuffered: behind the commands that wait, with the position that the axis has now");
}

}  // namespace detail

struct MC_TrackConveyorBelt : GroupCommandBlock<MC_TrackConveyorBelt> {
    GroupRef AxesGroup{};
    AxisRef ConveyorBelt{};
    bool Execute = false;
    MC_COORD_REF ConveyorBeltOrigin{}, InitialObjectPosition{};
    MC_CoordSystem CoordSystem = mcPCS;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Lets a product's frame go with a belt.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup>(),
                         in_out<&Self::ConveyorBelt>("", "the belt's axis or encoder: 1 u of it is 1 u of way"), grouped<&Self::Execute>(),
                         in<&Self::ConveyorBeltOrigin>("", "u, rad: seen from the world; the belt runs along its X"),
                         in<&Self::InitialObjectPosition>("", "u, rad: of the object at the rising edge, seen from the origin"),
                         in<&Self::CoordSystem>("", "mcPCS, mcPCS_2 to mcPCS_8"), detail::when_tracked<&Self::BufferMode>(),
                         out<&Self::Done>("", "later commands in the frame go with the belt"),
                         grouped<&Self::Busy, &Self::Active, &Self::CommandAborted, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        return detail::track_command(axes::FrameTrack::Kind::belt, ConveyorBelt, ConveyorBeltOrigin, InitialObjectPosition, CoordSystem,
                                     BufferMode);
    }
};

struct MC_TrackRotaryTable : GroupCommandBlock<MC_TrackRotaryTable> {
    GroupRef AxesGroup{};
    AxisRef RotaryTable{};
    bool Execute = false;
    MC_COORD_REF RotaryTableOrigin{}, InitialObjectPosition{};
    MC_CoordSystem CoordSystem = mcPCS;
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    static constexpr std::string_view summary = "Lets a product's frame turn with a table.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup>(), in_out<&Self::RotaryTable>("", "the table's axis: its modulo is one turn"),
                         grouped<&Self::Execute>(),
                         in<&Self::RotaryTableOrigin>("", "u, rad: seen from the world; the table turns about its Z"),
                         in<&Self::InitialObjectPosition>("", "u, rad: of the object at the rising edge, seen from the origin"),
                         in<&Self::CoordSystem>("", "mcPCS, mcPCS_2 to mcPCS_8"), detail::when_tracked<&Self::BufferMode>(),
                         out<&Self::Done>("", "later commands in the frame turn with the table"),
                         grouped<&Self::Busy, &Self::Active, &Self::CommandAborted, &Self::Error, &Self::ErrorID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        return detail::track_command(axes::FrameTrack::Kind::table, RotaryTable, RotaryTableOrigin, InitialObjectPosition, CoordSystem,
                                     BufferMode);
    }
};

}  // namespace taktwerk::fb
