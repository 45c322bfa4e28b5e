#pragma once
// Types of the pins of group blocks. Those that the standard leaves to the vendor are ours: docs/motion/group-decisions.md.

#include <array>
#include <cstdint>
#include <string_view>

#include "axes/group/group_access.hpp"
#include "fb_library/motion/motion_types.hpp"
#include "fb_library/pins/pin.hpp"

namespace taktwerk::fb {

using axes::GroupRef;

using axes::MC_CoordSystem;
using enum axes::MC_CoordSystem;
using axes::MC_TransitionMode;
using axes::mcPCS_1;
using enum axes::MC_TransitionMode;
using axes::MC_TransitionVelocity;
using enum axes::MC_TransitionVelocity;
using axes::MC_CIRC_MODE;
using enum axes::MC_CIRC_MODE;
using axes::MC_CIRC_PATHCHOICE;
using enum axes::MC_CIRC_PATHCHOICE;
using axes::MC_OrientationMode;
using enum axes::MC_OrientationMode;
using axes::MC_PATH_REQUEST;
using axes::MC_PATH_SYNC_MODE;
using enum axes::MC_PATH_SYNC_MODE;
using enum axes::MC_PATH_REQUEST;

/// One number a member, by IdentInGroup from 1 on.
using AxisValues = axes::JointVector;

/// Which member: 1 to 16.
struct IdentInGroup {
    std::uint8_t number = 0;
    constexpr IdentInGroup() noexcept = default;
    constexpr IdentInGroup(std::uint8_t value) noexcept
        : number(value) {}                                               // NOLINT(google-explicit-constructor): a literal may be assigned
    constexpr operator std::uint8_t() const noexcept { return number; }  // NOLINT(google-explicit-constructor): it is a number
};
/// Names a command of a group; 0 = none was accepted.
struct CommandNumber {
    std::uint32_t id = 0;
    constexpr operator std::uint32_t() const noexcept { return id; }  // NOLINT(google-explicit-constructor): it is a number
};
/// The number of an axis or of a group in the machine's configuration, from 1 on; 0 = none.
struct AxisNumber {
    std::uint16_t number = 0;
};
struct GroupNumber {
    std::uint16_t number = 0;
};

/// A place of the tool's point: u, and intrinsic z-y'-x'' in rad.
struct MC_CART_REF {
    double X = 0, Y = 0, Z = 0, RX = 0, RY = 0, RZ = 0;
};
/// Which way of an arm to reach it: with ConfigValid; else the one that is nearest. TRUE: in front, elbow up, wrist not flipped. Of an arm
/// without such a choice a flag means nothing.
struct MC_CONFIG_DATA {
    bool ConfigValid = false, Shoulder = false, Elbow = false, Wrist = false;
};
/// Which turn each rotary joint stands in, with ConfigValid: 0 for (-180, 180] degrees, 1 for (180, 540], ...
struct MC_TURN_INFO {
    std::array<std::int8_t, axes::most_members> ATurns{};
};
struct MC_CART_POS_REF {
    MC_CART_REF Tcp;
    MC_CONFIG_DATA Cfg;
    MC_TURN_INFO TurnInfo;
    std::array<double, 10> AuxiliaryAxes{};
};
struct MC_AXES_POS_REF {
    AxisValues Axes{};
};
/// CoordSystem says which of the two counts: `A` in ACS, else `C`.
struct MC_POS_REF {
    MC_CART_POS_REF C;
    MC_AXES_POS_REF A;
};
/// A distance, in the same form.
struct MC_DISTANCE_REF : MC_POS_REF {};

/// Parameter[0] is the one that the transition mode asks for.
struct MC_TRANSITION_PARAMETER {
    std::array<double, 5> Parameter{};
};

struct MC_GROUP_SWLIMITS {
    struct Limits {
        double SWLimitPos = 0, SWLimitNeg = 0;  ///< u
    };
    std::array<Limits, axes::most_members> Axes{};
};

/// A stored path of the machine, and how it is to be gone.
struct MC_PATH_REF {
    axes::PathRef Path{};
    axes::PathOptions Options{};
};
/// A path that MC_PathSelect has prepared.
struct MC_PATH_DATA_REF {
    axes::PathRef path{};
    std::uint32_t ticket = 0;
};

enum MC_CommandState : std::uint8_t { mcAccepted, mcActive };

namespace detail {
inline constexpr std::array<std::string_view, 13> coord_system_names{
    "mcACS", "mcMCS", "mcWCS", "mcPCS", "mcFCS", "mcTCS", "mcPCS_2", "mcPCS_3", "mcPCS_4", "mcPCS_5", "mcPCS_6", "mcPCS_7", "mcPCS_8"};
inline constexpr std::array<std::string_view, 5> transition_mode_names{"mcTMNone", "mcTMStartVelocity", "mcTMConstantVelocity",
                                                                       "mcTMCornerDistance", "mcTMMaxCornerDeviation"};
inline constexpr std::array<std::string_view, 5> transition_velocity_names{"mcTVZero", "mcTVLow", "mcTVPrevious", "mcTVNext", "mcTVHigh"};
inline constexpr std::array<std::string_view, 4> orientation_mode_names{"mcLinear", "mcJointInterpolated", "mcFixed", "mcPathBased"};
inline constexpr std::array<std::string_view, 3> circ_mode_names{"mcBORDER", "mcCENTER", "mcRADIUS"};
inline constexpr std::array<std::string_view, 2> circ_path_choice_names{"mcClockwise", "mcCounterClockwise"};
inline constexpr std::array<std::string_view, 15> path_request_names{
    "mcPathNothing",        "mcPathStop",         "mcPathOptionalStop", "mcPathBlockStop",
    "mcPathResume",         "mcPathToolPrepare",  "mcPathToolChange",   "mcPathSpindleClockwise",
    "mcPathSpindleCounter", "mcPathSpindleSpeed", "mcPathSpindleOff",   "mcPathMist",
    "mcPathFlood",          "mcPathCoolantOff",   "mcPathUser"};
inline constexpr std::array<std::string_view, 2> command_state_names{"mcAccepted", "mcActive"};
inline constexpr std::array<std::string_view, 2> path_sync_mode_names{"mcNonPeriodic", "mcPeriodic"};
}  // namespace detail

// clang-format off
template <> struct PinTypeOf<GroupRef> { static constexpr PinType value{PinKind::HANDLE, "AXES_GROUP_REF"}; };
template <> struct PinTypeOf<IdentInGroup> { static constexpr PinType value{PinKind::USINT, "IDENT_IN_GROUP_REF"}; };
template <> struct PinTypeOf<CommandNumber> { static constexpr PinType value{PinKind::UDINT, "MC_COMMAND_ID"}; };
template <> struct PinTypeOf<AxisNumber> { static constexpr PinType value{PinKind::UINT, "AXIS_ID"}; };
template <> struct PinTypeOf<GroupNumber> { static constexpr PinType value{PinKind::UINT, "AXES_GROUP_ID"}; };
template <> struct PinTypeOf<AxisValues> { static constexpr PinType value{PinKind::STRUCT, "ARRAY OF LREAL"}; };
template <> struct PinTypeOf<MC_POS_REF> { static constexpr PinType value{PinKind::STRUCT, "MC_POS_REF"}; };
template <> struct PinTypeOf<MC_DISTANCE_REF> { static constexpr PinType value{PinKind::STRUCT, "MC_DISTANCE_REF"}; };
template <> struct PinTypeOf<MC_TRANSITION_PARAMETER> { static constexpr PinType value{PinKind::STRUCT, "MC_TRANSITION_PARAMETER"}; };
template <> struct PinTypeOf<MC_GROUP_SWLIMITS> { static constexpr PinType value{PinKind::STRUCT, "MC_GROUP_SWLIMITS"}; };
template <> struct PinTypeOf<MC_CoordSystem> { static constexpr PinType value{PinKind::ENUM, "MC_COORD_SYSTEM", detail::coord_system_names}; };
template <> struct PinTypeOf<MC_TransitionMode> { static constexpr PinType value{PinKind::ENUM, "MC_TRANSITION_MODE", detail::transition_mode_names}; };
template <> struct PinTypeOf<MC_TransitionVelocity> { static constexpr PinType value{PinKind::ENUM, "MC_TRANSITION_VELOCITY", detail::transition_velocity_names}; };
template <> struct PinTypeOf<MC_OrientationMode> { static constexpr PinType value{PinKind::ENUM, "MC_ORIENTATION_MODE", detail::orientation_mode_names}; };
template <> struct PinTypeOf<MC_CIRC_MODE> { static constexpr PinType value{PinKind::ENUM, "MC_CIRC_MODE", detail::circ_mode_names}; };
template <> struct PinTypeOf<MC_CIRC_PATHCHOICE> { static constexpr PinType value{PinKind::ENUM, "MC_CIRC_PATHCHOICE", detail::circ_path_choice_names}; };
template <> struct PinTypeOf<MC_PATH_REF> { static constexpr PinType value{PinKind::STRUCT, "MC_PATH_REF"}; };
template <> struct PinTypeOf<MC_PATH_DATA_REF> { static constexpr PinType value{PinKind::STRUCT, "MC_PATH_DATA_REF"}; };
template <> struct PinTypeOf<MC_PATH_REQUEST> { static constexpr PinType value{PinKind::ENUM, "MC_PATH_REQUEST", detail::path_request_names}; };
template <> struct PinTypeOf<MC_PATH_SYNC_MODE> { static constexpr PinType value{PinKind::ENUM, "MC_PATH_SYNC_MODE", detail::path_sync_mode_names}; };
template <> struct PinTypeOf<MC_CommandState> { static constexpr PinType value{PinKind::ENUM, "MC_COMMAND_STATE", detail::command_state_names}; };
// clang-format on

namespace detail {

/// What a position says of how the arm shall stand.
[[nodiscard]] constexpr axes::Configuration wanted_by(const MC_POS_REF& position) noexcept {
    axes::Configuration c;
    const auto& cfg = position.C.Cfg;
    if (!cfg.ConfigValid) return c;
    c.branch = {cfg.Shoulder ? axes::Shoulder::front : axes::Shoulder::back, cfg.Elbow ? axes::Elbow::up : axes::Elbow::down,
                cfg.Wrist ? axes::Wrist::no_flip : axes::Wrist::flip};
    for (std::size_t i = 0; i < axes::max_joints; ++i) c.turns[i] = position.C.TurnInfo.ATurns[i];
    return c;
}

}  // namespace detail

/// The view of a group; nullptr for an invalid handle, and where no groups are seen.
[[nodiscard]] inline const axes::GroupView* view_of(const MotionContext& ctx, GroupRef group) noexcept {
    return ctx.groups != nullptr ? ctx.groups->view(group) : nullptr;
}

}  // namespace taktwerk::fb
