#pragma once
// The words of a group of axes: states, frames, ways to blend. PLCopen Part 4's spellings, with mc (docs/motion/group-decisions.md).

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "axes/words/types.hpp"

namespace taktwerk::axes {

/// A member's place is its IdentInGroup - 1, from 0 on.
inline constexpr std::size_t most_members = 16;
/// Members that one path can move.
inline constexpr std::size_t most_moved_members = 8;
/// One number a place; those of places without a member mean nothing. u, u/s, ... of each axis.
using JointVector = std::array<double, most_members>;

enum class GroupState : std::uint8_t { GroupDisabled, GroupStandby, GroupHoming, GroupMoving, GroupStopping, GroupErrorStop };
inline constexpr std::size_t group_state_count = 6;
[[nodiscard]] std::string_view name(GroupState state) noexcept;

/// In which coordinates a position is meant: the axes themselves, the machine, the world, a product (eight of them; mcPCS is the first), flange or
/// fixture, the tool.
enum MC_CoordSystem : std::uint8_t {
    mcACS,
    mcMCS,
    mcWCS,
    mcPCS,
    mcFCS,
    mcTCS,
    mcPCS_2,
    mcPCS_3,
    mcPCS_4,
    mcPCS_5,
    mcPCS_6,
    mcPCS_7,
    mcPCS_8
};
inline constexpr MC_CoordSystem mcPCS_1 = mcPCS;
inline constexpr std::size_t product_frames = 8;
[[nodiscard]] constexpr bool is_product(MC_CoordSystem frame) noexcept { return frame == mcPCS || (frame >= mcPCS_2 && frame <= mcPCS_8); }
/// From 0 on; only of products.
[[nodiscard]] constexpr std::size_t product_index(MC_CoordSystem frame) noexcept { return frame == mcPCS ? 0 : frame - mcPCS_2 + 1u; }
/// The curve at a joint of two motions.
enum MC_TransitionMode : std::uint8_t { mcTMNone, mcTMStartVelocity, mcTMConstantVelocity, mcTMCornerDistance, mcTMMaxCornerDeviation };
/// What became of that curve (G-060).
enum class CornerPassed : std::uint8_t {
    none,      ///< none was asked for
    as_asked,  ///< ... or none is there to be rounded
    smaller,   ///< less room than it wants, or it came late
    stood,     ///< none can be passed there: at rest
};
/// v2.0: how fast that joint is passed.
enum MC_TransitionVelocity : std::uint8_t { mcTVZero, mcTVLow, mcTVPrevious, mcTVNext, mcTVHigh };
/// How the tool turns on the way.
enum MC_OrientationMode : std::uint8_t { mcLinear, mcJointInterpolated, mcFixed, mcPathBased };

/// Why a jog could not go on, or not begin: the distance that was asked for, a limit of a member, the arm's own (its joints' limits, its reach, rods that
/// do not meet), a singularity, a room of the workspace, an orientation that the arm cannot take.
enum class JogEnd : std::uint8_t { none, distance, member_limit, reach, singularity, workspace, orientation };

/// What AuxPoint of an arc is.
enum MC_CIRC_MODE : std::uint8_t { mcBORDER, mcCENTER, mcRADIUS };
/// Which way round, seen against the normal of the arc's plane.
enum MC_CIRC_PATHCHOICE : std::uint8_t { mcClockwise, mcCounterClockwise };

}  // namespace taktwerk::axes
