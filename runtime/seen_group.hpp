#pragma once
// What leaves the cycle of a group of axes: the part of axes::GroupView that people look at. Its members' positions stand with the axes of the same
// snapshot. Plain data.

#include <array>
#include <cstdint>
#include <type_traits>

#include "axes/group/group_view.hpp"
#include "core/time.hpp"

namespace taktwerk::runtime {

struct SeenGroup {
    axes::GroupState state = axes::GroupState::GroupDisabled;
    std::uint16_t error = 0;     ///< alarm id or ErrorId that led to GroupErrorStop, until it is reset; 0 = none
    axes::AxisRef error_axis{};  ///< whose error that is, or which member left; invalid: nobody's alone
    bool interrupted = false;    ///< stands, and MC_GroupContinue goes on
    bool held = false;           ///< ... and it was a person who interrupted it
    bool resetting = false, powered = false, online = false, in_position = false;

    std::array<axes::AxisRef, axes::most_members> members{};  ///< by place; invalid: none
    /// Of a member's set-point, as fractions of what a path may take of that axis: 1 = at the limit. The jerk is that from cycle to cycle.
    struct Use {
        float velocity = 0, acceleration = 0, jerk = 0;
    };
    std::array<Use, axes::most_members> use{};  ///< by place

    /// The tool's point in the machine (MCS): X Y Z [the group's unit], RX RY RZ [deg]; its speed in a second.
    struct Tool {
        bool known = false;  ///< there are kinematics, their joints are members, and the numbers are in reach; else the rest means nothing
        std::array<double, 6> set{}, actual{};
        double speed = 0, actual_speed = 0;
    };
    Tool tool;

    /// Along the path of the active command; lengths in the group's unit.
    struct Along {
        double velocity = 0, acceleration = 0;
        std::uint16_t members = 0;  ///< places of those whose own ways its length is, in their units; 0: it is the way of the tool's point
        axes::PathLimiter limiter = axes::PathLimiter::none;
        std::uint8_t limiting_place = 0;  ///< PathLimiter::axis: whose limit
        double tool_limit = 0;            ///< of the tool's point in set-up mode, whoever moves it; 0: none holds
        double to_go = 0, progress = 0;   ///< length left, and 0 to 1
        Duration remaining{};             ///< as planned now; 0 where nobody can say
    };
    Along along;

    /// What stands around it, seen from the world: X Y Z [the group's unit], RX RY RZ [rad]; a product's that moves, where it is now.
    struct Frames {
        axes::SixNumbers machine{};
        std::array<axes::SixNumbers, axes::product_frames> product{};
        std::array<axes::AxisRef, axes::product_frames> leader{};  ///< with whose way it moves; invalid: it stands
    };
    Frames frames;

    /// The frame that moves and that it goes with, also with no command.
    struct Track {
        axes::FrameTrack::Kind kind = axes::FrameTrack::Kind::none;
        axes::AxisRef axis{};
        bool in_sync = false;
        double lag = 0;  ///< of the tool's point behind it, in the group's unit
    };
    Track track;
    double path_deviation = 0;  ///< by which the tool's point is not where it should be, while it moves; in the group's unit

    axes::JogEnd jog_end = axes::JogEnd::none;  ///< why the last jog could not go on, until something else moves the group
    axes::PathHindrance jog_hindrance{};        ///< of that
    axes::GroupRefusal refusal{};               ///< the last one of a program's command, until another motion begins

    axes::GroupCommandKind active_kind = axes::GroupCommandKind::none;
    axes::CommandId active = 0;
    const void* block = nullptr;  ///< never followed
    std::uint8_t queued = 0;
    double override_factor = 1;     ///< of MC_GroupSetOverride
    double operators_override = 1;  ///< beside it: the smallest of the group's and its members'
};
static_assert(std::is_trivially_copyable_v<SeenGroup>);

}  // namespace taktwerk::runtime
