#pragma once
// Types of the pins of frames, tools, loads and arms. Those that the standard leaves to the vendor are ours: docs/motion/group-decisions.md.

#include <array>
#include <cstdint>
#include <string_view>

#include "fb_library/groups/group_pins.hpp"

namespace taktwerk::fb {

/// A frame seen from another one: u, and intrinsic z-y'-x'' in rad.
struct MC_COORD_REF {
    double X = 0, Y = 0, Z = 0, RX = 0, RY = 0, RZ = 0;
};
/// A rigid body. CenterOfGravity is also the orientation of the principal axes. kg, kg m2.
struct MC_RIGID_BODY_DYNAMIC_REF {
    MC_CART_REF CenterOfGravity{};
    double Mass = 0, IX = 0, IY = 0, IZ = 0;
};
/// ToolFrame: the tool's point, seen from the flange; the body in the frame of the tool's point.
struct MC_TOOL_REF {
    MC_COORD_REF ToolFrame{};
    MC_RIGID_BODY_DYNAMIC_REF RigidBodyDynamic{};
};
/// The first RigidBodyCount count.
using RigidBodies = std::array<MC_RIGID_BODY_DYNAMIC_REF, axes::GroupEquipment::most_bodies>;

/// Of the running command, or of the next one.
enum class MC_ToolSource : std::uint8_t { mcActive, mcSelected };

/// The arm of a group, as configured.
struct MC_KIN_REF {
    std::uint8_t Kind = 0;  ///< 0 cartesian, 1 beam_gantry, 2 core_xy, 3 scara, 4 palletizer, 5 rotary_delta, 6 linear_delta, 7 six joints
    std::uint8_t Joints = 0;
    bool ClosedForm = false;  ///< its inverse is a formula; else a few steps of Newton's method end it
    MC_COORD_REF Base{};      ///< seen from the machine
};
/// Denavit and Hartenberg's rows, from the base on; rad and u.
struct MC_DHParameters {
    struct Row {
        double Theta = 0, D = 0, A = 0, Alpha = 0;
    };
    bool Modified = false;  ///< Craig's convention; else the classic one
    std::array<Row, 6> Joint{};
};
struct MC_JointInfo {
    struct Info {
        bool Rotary = false;
        bool Clockwise = false;   ///< it counts against the arm's picture
        double ZeroPosition = 0;  ///< rad or u: the arm's own where the joint says 0
    };
    std::uint8_t Joints = 0;
    std::array<Info, 6> Joint{};
};

// clang-format off
template <> struct PinTypeOf<MC_COORD_REF> { static constexpr PinType value{PinKind::STRUCT, "MC_COORD_REF"}; };
template <> struct PinTypeOf<MC_RIGID_BODY_DYNAMIC_REF> { static constexpr PinType value{PinKind::STRUCT, "MC_RIGID_BODY_DYNAMIC_REF"}; };
template <> struct PinTypeOf<RigidBodies> { static constexpr PinType value{PinKind::STRUCT, "ARRAY OF MC_RIGID_BODY_DYNAMIC_REF"}; };
template <> struct PinTypeOf<MC_TOOL_REF> { static constexpr PinType value{PinKind::STRUCT, "MC_TOOL_REF"}; };
template <> struct PinTypeOf<MC_KIN_REF> { static constexpr PinType value{PinKind::STRUCT, "MC_KIN_REF"}; };
template <> struct PinTypeOf<MC_DHParameters> { static constexpr PinType value{PinKind::STRUCT, "MC_DHParameters"}; };
template <> struct PinTypeOf<MC_JointInfo> { static constexpr PinType value{PinKind::STRUCT, "MC_JointInfo"}; };
namespace detail { inline constexpr std::array<std::string_view, 2> tool_source_names{"mcActive", "mcSelected"}; }
template <> struct PinTypeOf<MC_ToolSource> { static constexpr PinType value{PinKind::ENUM, "MC_TOOL_SOURCE", detail::tool_source_names}; };
// clang-format on

namespace detail {

template <auto M>
consteval auto when_set() {
    return in<M>("", "at once, after the running command, or after all that wait; the commands behind have it");
}
/// Done to ErrorID of a block that sets a frame.
template <class Block>
consteval auto frame_outcome() {
    return pin_table(out<&Block::Done>("", "later commands have it"),
                     grouped<&Block::Busy, &Block::Active, &Block::CommandAccepted, &Block::CommandAborted, &Block::CommandID,
                             &Block::Error, &Block::ErrorID>());
}

[[nodiscard]] constexpr MC_COORD_REF coordinates_of(const axes::SixNumbers& s) noexcept { return {s[0], s[1], s[2], s[3], s[4], s[5]}; }
[[nodiscard]] constexpr MC_CART_REF place_of_six(const axes::SixNumbers& s) noexcept { return {s[0], s[1], s[2], s[3], s[4], s[5]}; }
[[nodiscard]] constexpr axes::SixNumbers six_of(const MC_COORD_REF& c) noexcept { return {c.X, c.Y, c.Z, c.RX, c.RY, c.RZ}; }
[[nodiscard]] constexpr axes::SixNumbers six_of(const MC_CART_REF& c) noexcept { return {c.X, c.Y, c.Z, c.RX, c.RY, c.RZ}; }
[[nodiscard]] constexpr axes::RigidBody written_of(const MC_RIGID_BODY_DYNAMIC_REF& body) noexcept {
    return {body.Mass, six_of(body.CenterOfGravity), {body.IX, body.IY, body.IZ}};
}
[[nodiscard]] constexpr MC_RIGID_BODY_DYNAMIC_REF pin_of(const axes::RigidBody& body) noexcept {
    return {place_of_six(body.centre), body.mass, body.inertia[0], body.inertia[1], body.inertia[2]};
}

/// A number of a tool or payload as pins have it; what is no number of one is 255, which nobody defines.
[[nodiscard]] constexpr std::uint8_t number_of(std::int16_t pin) noexcept {
    return pin >= 0 && pin < 255 ? static_cast<std::uint8_t>(pin) : std::uint8_t{255};
}

/// nullptr for an invalid handle, and where no groups are seen.
[[nodiscard]] inline const axes::GroupEquipment* equipment_of(const MotionContext& ctx, GroupRef group) noexcept {
    return ctx.groups != nullptr ? ctx.groups->equipment(group) : nullptr;
}
[[nodiscard]] inline axes::SixAnswer frame_of(const MotionContext& ctx, GroupRef group, MC_CoordSystem frame) noexcept {
    const auto* known = equipment_of(ctx, group);
    if (known == nullptr) return {ErrorId::invalid_group, {}};
    if (frame == mcWCS) return {};
    const auto* six = known->frames.find(frame);
    return six != nullptr ? axes::SixAnswer{ErrorId::none, *six} : axes::SixAnswer{ErrorId::not_supported, {}};
}

}  // namespace detail

}  // namespace taktwerk::fb
