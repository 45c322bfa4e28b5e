#pragma once
// What is submitted to a group. A value: the latch of a block's inputs. Trivially copyable.

#include <cstdint>
#include <type_traits>
#include <variant>

#include "axes/axis/command.hpp"
#include "axes/group/equipment_settings.hpp"
#include "axes/group/frame_track.hpp"
#include "axes/group/group_types.hpp"
#include "axes/group/path_driver.hpp"
#include "axes/group/path_types.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

enum class GroupCommandKind : std::uint8_t {
    none,
    // in the queue
    linear_absolute,    ///< the tool's point on a straight line; in ACS: the axes
    linear_relative,    ///< target = distance
    circular_absolute,  ///< the tool's point on an arc (circle)
    circular_relative,
    direct_absolute,  ///< the axes on a straight line of their own, whatever the frame of the target
    direct_relative,
    path,         ///< a stored path, as it was prepared
    driven_path,  ///< the same, as fast as an axis goes (driver); it has no end of its own
    jog,          ///< target = direction by slot; goes on while it is held (HoldJog), never waits
    wait,         ///< duration
    halt,
    // beside it
    stop,       ///< locks the group while it is held (release_stop)
    interrupt,  ///< the commands stay, and go on with resume
    resume,     ///< MC_GroupContinue
    home,       ///< the members one after the other; target = the coordinates at their references
    disable,    ///< GroupDisabled once the group stands
    // no motion, but with a place between motions where `execution` asks for one
    set_frame,    ///< `frame` is at `target` from then on, seen from the world
    write_tool,   ///< `number` is `tool`
    track_frame,  ///< `frame` moves as `track` says
    // at once
    set_position,           ///< the group is at `target`
    set_position_relative,  ///< by `target` from where it is
};
/// It moves nothing.
[[nodiscard]] constexpr bool is_administrative(GroupCommandKind kind) noexcept { return kind >= GroupCommandKind::set_frame; }
/// Of those, what may wait for its turn.
[[nodiscard]] constexpr bool is_setting(GroupCommandKind kind) noexcept {
    return kind == GroupCommandKind::set_frame || kind == GroupCommandKind::write_tool || kind == GroupCommandKind::track_frame;
}
[[nodiscard]] constexpr bool goes_a_way(GroupCommandKind kind) noexcept {
    return kind >= GroupCommandKind::linear_absolute && kind <= GroupCommandKind::jog;
}
[[nodiscard]] constexpr bool is_relative(GroupCommandKind kind) noexcept {
    return kind == GroupCommandKind::linear_relative || kind == GroupCommandKind::jog || kind == GroupCommandKind::circular_relative ||
           kind == GroupCommandKind::direct_relative || kind == GroupCommandKind::set_position_relative;
}
[[nodiscard]] constexpr bool goes_stored_path(GroupCommandKind kind) noexcept {
    return kind == GroupCommandKind::path || kind == GroupCommandKind::driven_path;
}
[[nodiscard]] constexpr bool is_circular(GroupCommandKind kind) noexcept {
    return kind == GroupCommandKind::circular_absolute || kind == GroupCommandKind::circular_relative;
}
[[nodiscard]] constexpr bool has_place_in_queue(GroupCommandKind kind) noexcept {
    return kind >= GroupCommandKind::linear_absolute && kind <= GroupCommandKind::halt;
}

/// Of a path: u/s, u/s2, u/s3; 0 or less = not said.
struct PathDynamics {
    double velocity = 0, acceleration = 0, deceleration = 0, jerk = 0;
    friend bool operator==(const PathDynamics&, const PathDynamics&) = default;
};

/// What an arc goes by, beside its end: a point of its border, its centre (its plane is XY of the frame), or the normal of its plane with the radius
/// as its length; in the command's frame, relative as its target is. u
struct CirclePins {
    MC_CIRC_MODE mode = mcBORDER;
    bool clockwise = false;  ///< PathChoice, seen against the normal (G-039)
    double tolerance = 0;    ///< u, of centres: by how much the radii of begin and end may differ; 0 = a millionth of a unit
    std::array<double, 3> aux{};
    friend bool operator==(const CirclePins&, const CirclePins&) = default;
};

/// Whose hand a jog is in, and so by which dynamics it goes: a program's by those that were written for the group (MC_GroupWriteJoggingDynamics), a
/// person's by what the mode of the machine leaves each member, and by the group's set-up velocity of the tool's point.
enum class JogHand : std::uint8_t { program, person };

/// How far a jog goes at most from where it was pressed: u of the tool's point, rad of its turns; in ACS u of each member, 0 = as far as it can. And what
/// share of the jogging dynamics it takes (HoldJog).
struct JogPins {
    double linear = 0, angular = 0;
    double velocity = 1, acceleration = 1;
    JogHand hand = JogHand::program;
    friend bool operator==(const JogPins&, const JogPins&) = default;
};

struct GroupCommand {
    GroupCommandKind kind = GroupCommandKind::none;
    MC_CoordSystem frame = mcACS;
    MC_BufferMode buffer_mode = mcAborting;
    MC_TransitionMode transition = mcTMNone;
    double transition_parameter = 0;  ///< >= 0: u for a distance or deviation, a factor of a velocity
    MC_OrientationMode orientation = mcLinear;
    CirclePins circle{};
    JointVector target{};  ///< ACS: by place. Other frames: X Y Z [u], RX RY RZ [rad]. jog: -1 to 1 each
    JogPins jog{};
    PathDynamics dynamics{};
    Configuration wanted{};  ///< which way of the arm reaches a target in another frame than ACS; a path keeps the one it begins with
    Duration duration{};
    MC_ExecutionMode execution = mcImmediately;  ///< of set_frame, write_tool
    std::uint8_t number = 0;                     ///< of the tool
    Tool tool{};
    FrameTrack track{};              ///< of track_frame; its reference and number are the group's
    PathRef path{};                  ///< path, driven_path
    std::uint32_t ticket = 0;        ///< of its selection
    PathDriver driver{};             ///< of driven_path
    const void* instance = nullptr;  ///< the block that gave it, to be named to people; never followed
    friend bool operator==(const GroupCommand&, const GroupCommand&) = default;
};
static_assert(std::is_trivially_copyable_v<GroupCommand>);

/// MC_GroupWriteSWLimits, by place: all members or none. An infinite value leaves a limit as it is. u
struct WriteSoftwareLimits {
    JointVector high{}, low{};
};
/// MC_GroupWriteParameter, mcDynamicsMode: later commands say velocity, acceleration, ... in percent (0 to 100) of the reference dynamics.
struct SetDynamicsMode {
    bool percent = false;
};

// --- at once, no motion -----------------------------------------------------------------------------------------------------

/// MC_AddAxisToGroup; `ident` from 1 to most_members.
struct AddMember {
    AxisRef axis{};
    std::uint8_t ident = 0;
};
/// MC_RemoveAxisFromGroup.
struct RemoveMember {
    std::uint8_t ident = 0;
};
/// MC_UngroupAllAxes.
struct RemoveAllMembers {};
/// MC_GroupEnable.
struct EnableGroup {};
/// MC_GroupWriteDefaultDynamics, MC_GroupWriteReferenceDynamics: negative = stays as it is.
struct WriteDynamics {
    enum class Which : std::uint8_t { default_dynamics, reference_dynamics } which = Which::default_dynamics;
    PathDynamics dynamics{};
};
/// What percents of dynamics are of, and whether commands say percents (mcDynamicsMode).
struct ReferenceDynamics {
    PathDynamics of{};
    bool percent = false;
    friend bool operator==(const ReferenceDynamics&, const ReferenceDynamics&) = default;
};
/// How a group is jogged: the tool's point, and each member by its place. 0 = not said.
struct JoggingDynamics {
    PathDynamics path{};
    JointVector velocity{}, acceleration{}, deceleration{}, jerk{};  ///< u/s, u/s2, u/s3
    friend bool operator==(const JoggingDynamics&, const JoggingDynamics&) = default;
};
/// MC_GroupWriteJoggingDynamics: negative = stays as it is.
struct WriteJoggingDynamics {
    JoggingDynamics dynamics{};
};
/// Who jogs says so in each cycle, or the group stops after the least jog lease of its members. A direction of 0 stops it; another direction than the
/// one that is gone stops first.
struct HoldJog {
    CommandId id = 0;
    JointVector direction{};                ///< -1 to 1 each, as GroupCommand::target
    double velocity = 1, acceleration = 1;  ///< of the jogging dynamics: 0 to 1; above 0 to 1
};
/// MC_SyncAxisToGroup: `slave` follows the length of the path from now on (group_slaves.hpp).
struct FollowPath {
    AxisRef slave{};
    std::int32_t numerator = 1, denominator = 1;          ///< u of the slave per u of the path
    double acceleration = 0, deceleration = 0, jerk = 0;  ///< until it is in sync; 0 or less = the slave's limits
    const void* instance = nullptr;                       ///< the block that gave it, to be named to people; never followed
};
/// AddMember ... | MC_GroupSetOverride | of jogging, limits, dynamics | of tools and loads
using GroupSetting =
    std::variant<AddMember, RemoveMember, RemoveAllMembers, EnableGroup, WriteDynamics, Override, WriteJoggingDynamics, HoldJog,
                 WriteSoftwareLimits, SetDynamicsMode, FollowPath, SelectTool, SelectPayload, WritePayload, WriteBodies>;

}  // namespace taktwerk::axes
