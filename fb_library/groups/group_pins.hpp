#pragma once
// Pins that mean the same on every group block, so that their unit and note stand once: as motion/shared_pins.hpp. u is the unit of the
// group's axes, of their path where they have one.

#include <array>
#include <string_view>

#include "fb_library/groups/group_types.hpp"
#include "fb_library/motion/shared_pins.hpp"

namespace taktwerk::fb {

namespace detail {

inline constexpr std::array group_pins{
    SharedPin{"AxesGroup", PinDirection::in_out, "", "group acted on"},
    SharedPin{"Execute", PinDirection::in, "", "a rising edge starts"},
    SharedPin{"Enable", PinDirection::in, "", "works while TRUE"},
    SharedPin{"IdentInGroup", PinDirection::in, "", "which member: 1 to 16"},
    SharedPin{"Position", PinDirection::in, "", "where to: A in ACS, else C"},
    SharedPin{"Distance", PinDirection::in, "", "how far: A in ACS, else C"},
    SharedPin{"Velocity", PinDirection::in, "u/s", "along the path; 0 or less = the group's default"},
    SharedPin{"Acceleration", PinDirection::in, "u/s2", "along the path; 0 or less = the group's default"},
    SharedPin{"Deceleration", PinDirection::in, "u/s2", "along the path; 0 or less = the group's default, of a stop what the axes can"},
    SharedPin{"Jerk", PinDirection::in, "u/s3", "along the path; 0 or less = the group's default, of a stop what the axes can"},
    SharedPin{"CoordSystem", PinDirection::in, "", "in which frame"},
    SharedPin{"BufferMode", PinDirection::in, "",
              "when the command takes effect; mcBlending...: as mcBuffered, with the corner rounded by TransitionMode"},
    SharedPin{"TransitionVelocity", PinDirection::in, "", "how fast the corner may be passed; no effect with mcTMNone"},
    SharedPin{"TransitionMode", PinDirection::in, "", "how the corner before this command is rounded; mcTMNone: not at all"},
    SharedPin{"TransitionParameter", PinDirection::in, "", "of TransitionMode: u of a distance or a deviation, 0 to 1 of a velocity"},
    SharedPin{"OrientationMode", PinDirection::in, "", "mcLinear; no other yet"},
    SharedPin{"Source", PinDirection::in, "", "which value"},
    SharedPin{"Busy", PinDirection::out, "", "not finished"},
    SharedPin{"Active", PinDirection::out, "", "this command controls the group"},
    SharedPin{"CommandAccepted", PinDirection::out, "", "the command has its place in the queue"},
    SharedPin{"CommandAborted", PinDirection::out, "", "another command took over"},
    SharedPin{"CommandID", PinDirection::out, "", "the command's number; 0 = not accepted"},
    SharedPin{"Error", PinDirection::out, "", "refused, or ended by an error of the group"},
    SharedPin{"ErrorID", PinDirection::out, "", "why"},
};

template <auto M>
consteval Pin group_pin() {
    Pin pin = detail::pin<M>({}, {}, {});
    for (const SharedPin& known : group_pins)
        if (known.name == pin.name) return pin.direction = known.direction, pin.unit = known.unit, pin.doc = known.doc, pin;
    throw "no group pin has this name";  // not a constant: the build stops here
}

}  // namespace detail

/// A run of pins by the notes above.
template <auto... Members>
consteval std::array<Pin, sizeof...(Members)> grouped() {
    return {detail::group_pin<Members>()...};
}

}  // namespace taktwerk::fb
