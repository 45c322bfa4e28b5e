#pragma once
// MC_MoveLinearAbsolute, MC_MoveLinearRelative, MC_MoveCircularAbsolute, MC_MoveCircularRelative, MC_MoveDirectAbsolute, MC_MoveDirectRelative, MC_GroupWaitTime: PLCopen Part 4 v2.0. Real-time safe.

#include <string_view>

#include "fb_library/groups/group_block.hpp"

namespace taktwerk::fb {

/// From the pins of a move.
template <class Block>
[[nodiscard]] constexpr axes::GroupCommand move_of(const Block& block, axes::GroupCommandKind kind, const MC_POS_REF& place) noexcept {
    axes::GroupCommand command{
        .kind = kind, .frame = block.CoordSystem, .buffer_mode = block.BufferMode, .transition = block.TransitionMode};
    command.dynamics = {block.Velocity, block.Acceleration, block.Deceleration, block.Jerk};
    command.transition_parameter = block.TransitionParameter.Parameter[0];
    // v2.0 says with TransitionVelocity what v1.0 says with mcBlending...: the same motion (G-049).
    if (block.BufferMode == mcBuffered && block.TransitionVelocity != mcTVZero)
        command.buffer_mode = static_cast<MC_BufferMode>(mcBlendingLow + (block.TransitionVelocity - mcTVLow));
    if constexpr (requires { block.OrientationMode; }) command.orientation = block.OrientationMode;
    command.wanted = detail::wanted_by(place);
    const auto& tcp = place.C.Tcp;
    if (block.CoordSystem == mcACS) command.target = place.A.Axes;
    else command.target = {tcp.X, tcp.Y, tcp.Z, tcp.RX, tcp.RY, tcp.RZ};
    return command;
}

struct MC_MoveLinearAbsolute : GroupCommandBlock<MC_MoveLinearAbsolute> {
    GroupRef AxesGroup{};
    bool Execute = false;
    MC_POS_REF Position{};
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_CoordSystem CoordSystem = mcACS;
    MC_BufferMode BufferMode = mcAborting;
    MC_TransitionVelocity TransitionVelocity = mcTVZero;
    MC_TransitionMode TransitionMode = mcTMNone;
    MC_TRANSITION_PARAMETER TransitionParameter{};
    MC_OrientationMode OrientationMode = mcLinear;

    bool Done = false, Busy = false, Active = false, CommandAccepted = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    CommandNumber CommandID{};

    static constexpr std::string_view summary = "Moves the tool's point, in ACS the axes, on a straight line to a position.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute, &Self::Position, &Self::Velocity, &Self::Acceleration,
                                 &Self::Deceleration, &Self::Jerk, &Self::CoordSystem, &Self::BufferMode, &Self::TransitionVelocity,
                                 &Self::TransitionMode, &Self::TransitionParameter, &Self::OrientationMode>(),
                         out<&Self::Done>("", "the set-point is at the position"),
                         grouped<&Self::Busy, &Self::Active, &Self::CommandAccepted, &Self::CommandAborted, &Self::Error, &Self::ErrorID,
                                 &Self::CommandID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept { return move_of(*this, axes::GroupCommandKind::linear_absolute, Position); }
};

struct MC_MoveLinearRelative : GroupCommandBlock<MC_MoveLinearRelative> {
    GroupRef AxesGroup{};
    bool Execute = false;
    MC_DISTANCE_REF Distance{};
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_CoordSystem CoordSystem = mcACS;
    MC_BufferMode BufferMode = mcAborting;
    MC_TransitionVelocity TransitionVelocity = mcTVZero;
    MC_TransitionMode TransitionMode = mcTMNone;
    MC_TRANSITION_PARAMETER TransitionParameter{};
    MC_OrientationMode OrientationMode = mcLinear;

    bool Done = false, Busy = false, Active = false, CommandAccepted = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    CommandNumber CommandID{};

    static constexpr std::string_view summary =
        "Moves the tool's point, in ACS the axes, on a straight line by a distance from where the command begins.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute, &Self::Distance, &Self::Velocity, &Self::Acceleration,
                                 &Self::Deceleration, &Self::Jerk, &Self::CoordSystem, &Self::BufferMode, &Self::TransitionVelocity,
                                 &Self::TransitionMode, &Self::TransitionParameter, &Self::OrientationMode>(),
                         out<&Self::Done>("", "the distance is covered"),
                         grouped<&Self::Busy, &Self::Active, &Self::CommandAccepted, &Self::CommandAborted, &Self::Error, &Self::ErrorID,
                                 &Self::CommandID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept { return move_of(*this, axes::GroupCommandKind::linear_relative, Distance); }
};

/// From the pins of an arc. Of AuxPoint only the place counts, its orientation does not.
template <class Block>
[[nodiscard]] constexpr axes::GroupCommand circle_of(const Block& block, axes::GroupCommandKind kind) noexcept {
    auto command = move_of(block, kind, block.EndPoint);
    const auto& aux = block.AuxPoint.C.Tcp;
    command.circle = {
        .mode = block.CircMode, .clockwise = block.PathChoice == mcClockwise, .tolerance = block.Tolerance, .aux = {aux.X, aux.Y, aux.Z}};
    return command;
}
template <class Block>
consteval auto circle_pins() {
    return std::array{in<&Block::CircMode>("", "mcBORDER, mcCENTER, mcRADIUS: what AuxPoint is"),
                      in<&Block::AuxPoint>("", "as Position: a point of the arc; its centre; the plane's normal, as long as the radius"),
                      in<&Block::EndPoint>("", "as Position: C, in CoordSystem"),
                      in<&Block::PathChoice>("", "seen against the normal; mcBORDER: without effect"),
                      in<&Block::Tolerance>("u", "mcCENTER: by how much the radii of begin and end may differ")};
}

struct MC_MoveCircularAbsolute : GroupCommandBlock<MC_MoveCircularAbsolute> {
    GroupRef AxesGroup{};
    bool Execute = false;
    MC_CIRC_MODE CircMode = mcBORDER;
    MC_POS_REF AuxPoint{}, EndPoint{};
    MC_CIRC_PATHCHOICE PathChoice = mcClockwise;
    double Tolerance = 0;
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_CoordSystem CoordSystem = mcACS;
    MC_BufferMode BufferMode = mcAborting;
    MC_TransitionVelocity TransitionVelocity = mcTVZero;
    MC_TransitionMode TransitionMode = mcTMNone;
    MC_TRANSITION_PARAMETER TransitionParameter{};
    MC_OrientationMode OrientationMode = mcLinear;

    bool Done = false, Busy = false, Active = false, CommandAccepted = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    CommandNumber CommandID{};

    static constexpr std::string_view summary = "Moves the tool's point on an arc to a position.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup, &Self::Execute>(), circle_pins<Self>(),
            grouped<&Self::Velocity, &Self::Acceleration, &Self::Deceleration, &Self::Jerk, &Self::CoordSystem, &Self::BufferMode,
                    &Self::TransitionVelocity, &Self::TransitionMode, &Self::TransitionParameter, &Self::OrientationMode>(),
            out<&Self::Done>("", "the set-point is at EndPoint"),
            grouped<&Self::Busy, &Self::Active, &Self::CommandAccepted, &Self::CommandAborted, &Self::Error, &Self::ErrorID,
                    &Self::CommandID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept { return circle_of(*this, axes::GroupCommandKind::circular_absolute); }
};

struct MC_MoveCircularRelative : GroupCommandBlock<MC_MoveCircularRelative> {
    GroupRef AxesGroup{};
    bool Execute = false;
    MC_CIRC_MODE CircMode = mcBORDER;
    MC_POS_REF AuxPoint{}, EndPoint{};
    MC_CIRC_PATHCHOICE PathChoice = mcClockwise;
    double Tolerance = 0;
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_CoordSystem CoordSystem = mcACS;
    MC_BufferMode BufferMode = mcAborting;
    MC_TransitionVelocity TransitionVelocity = mcTVZero;
    MC_TransitionMode TransitionMode = mcTMNone;
    MC_TRANSITION_PARAMETER TransitionParameter{};
    MC_OrientationMode OrientationMode = mcLinear;

    bool Done = false, Busy = false, Active = false, CommandAccepted = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    CommandNumber CommandID{};

    static constexpr std::string_view summary = "Moves the tool's point on an arc, whose points count from where the command begins.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(
            grouped<&Self::AxesGroup, &Self::Execute>(), circle_pins<Self>(),
            grouped<&Self::Velocity, &Self::Acceleration, &Self::Deceleration, &Self::Jerk, &Self::CoordSystem, &Self::BufferMode,
                    &Self::TransitionVelocity, &Self::TransitionMode, &Self::TransitionParameter, &Self::OrientationMode>(),
            out<&Self::Done>("", "the set-point is at the end of the arc"),
            grouped<&Self::Busy, &Self::Active, &Self::CommandAccepted, &Self::CommandAborted, &Self::Error, &Self::ErrorID,
                    &Self::CommandID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept { return circle_of(*this, axes::GroupCommandKind::circular_relative); }
};

struct MC_MoveDirectAbsolute : GroupCommandBlock<MC_MoveDirectAbsolute> {
    GroupRef AxesGroup{};
    bool Execute = false;
    MC_POS_REF Position{};
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_CoordSystem CoordSystem = mcACS;
    MC_BufferMode BufferMode = mcAborting;
    MC_TransitionVelocity TransitionVelocity = mcTVZero;
    MC_TransitionMode TransitionMode = mcTMNone;
    MC_TRANSITION_PARAMETER TransitionParameter{};

    bool Done = false, Busy = false, Active = false, CommandAccepted = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    CommandNumber CommandID{};

    static constexpr std::string_view summary = "Moves all axes to a position, beginning and ending together, on a line of the axes.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute, &Self::Position, &Self::Velocity, &Self::Acceleration,
                                 &Self::Deceleration, &Self::Jerk, &Self::CoordSystem, &Self::BufferMode, &Self::TransitionVelocity,
                                 &Self::TransitionMode, &Self::TransitionParameter>(),
                         out<&Self::Done>("", "the set-point is at the position"),
                         grouped<&Self::Busy, &Self::Active, &Self::CommandAccepted, &Self::CommandAborted, &Self::Error, &Self::ErrorID,
                                 &Self::CommandID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept { return move_of(*this, axes::GroupCommandKind::direct_absolute, Position); }
};

struct MC_MoveDirectRelative : GroupCommandBlock<MC_MoveDirectRelative> {
    GroupRef AxesGroup{};
    bool Execute = false;
    MC_DISTANCE_REF Distance{};
    double Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;
    MC_CoordSystem CoordSystem = mcACS;
    MC_BufferMode BufferMode = mcAborting;
    MC_TransitionVelocity TransitionVelocity = mcTVZero;
    MC_TransitionMode TransitionMode = mcTMNone;
    MC_TRANSITION_PARAMETER TransitionParameter{};

    bool Done = false, Busy = false, Active = false, CommandAccepted = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    CommandNumber CommandID{};

    static constexpr std::string_view summary = "Moves all axes by a distance, beginning and ending together, on a line of the axes.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute, &Self::Distance, &Self::Velocity, &Self::Acceleration,
                                 &Self::Deceleration, &Self::Jerk, &Self::CoordSystem, &Self::BufferMode, &Self::TransitionVelocity,
                                 &Self::TransitionMode, &Self::TransitionParameter>(),
                         out<&Self::Done>("", "the distance is covered"),
                         grouped<&Self::Busy, &Self::Active, &Self::CommandAccepted, &Self::CommandAborted, &Self::Error, &Self::ErrorID,
                                 &Self::CommandID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept { return move_of(*this, axes::GroupCommandKind::direct_relative, Distance); }
};

/// The group stays in GroupMoving meanwhile.
struct MC_GroupWaitTime : GroupCommandBlock<MC_GroupWaitTime> {
    GroupRef AxesGroup{};
    bool Execute = false;
    taktwerk::Duration Duration{};
    MC_BufferMode BufferMode = mcAborting;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};
    CommandNumber CommandID{};

    static constexpr std::string_view summary = "Waits in its turn between the commands of a group.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(grouped<&Self::AxesGroup, &Self::Execute>(), in<&Self::Duration>("", "how long; Done not earlier"),
                         grouped<&Self::BufferMode>(), out<&Self::Done>("", "the time is over"),
                         grouped<&Self::Busy, &Self::Active, &Self::CommandAborted, &Self::Error, &Self::ErrorID, &Self::CommandID>());
    }
    [[nodiscard]] axes::GroupCommand command() const noexcept {
        return {.kind = axes::GroupCommandKind::wait, .buffer_mode = BufferMode, .duration = Duration};
    }
};

}  // namespace taktwerk::fb
