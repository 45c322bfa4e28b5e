#pragma once
// Pins that mean the same on every motion block, so that their unit and note stand once. A block still lists its own members, in the
// standard's order:
//
//     template <class Self>
//     static consteval auto pins() {
//         return pin_table(shared<&Self::Axis, &Self::Execute>(), in<&Self::Position>("u", "target"),
//                          shared<&Self::Deceleration, &Self::Jerk, &Self::BufferMode>(), out<&Self::Done>("", "standing"), outcome<Self>());
//     }

#include <array>
#include <string_view>

#include "fb_library/pins/pin.hpp"

namespace taktwerk::fb {

namespace detail {

struct SharedPin {
    std::string_view name;
    PinDirection direction;
    std::string_view unit, doc;
};

inline constexpr std::array shared_pins{
    SharedPin{"Axis", PinDirection::in_out, "", "axis acted on"},
    SharedPin{"Master", PinDirection::in_out, "", "leading axis; taken at the edge"},
    SharedPin{"Slave", PinDirection::in_out, "", "following axis: the one acted on"},
    SharedPin{"Execute", PinDirection::in, "", "a rising edge starts"},
    SharedPin{"Enable", PinDirection::in, "", "works while TRUE"},
    SharedPin{"ContinuousUpdate", PinDirection::in, "", "TRUE at the edge: changed inputs count as long as it stays TRUE"},
    SharedPin{"Acceleration", PinDirection::in, "u/s2", "0 = the axis' default"},
    SharedPin{"Deceleration", PinDirection::in, "u/s2", "0 = the axis' default"},
    SharedPin{"Jerk", PinDirection::in, "u/s3", "0 = the axis' default"},
    SharedPin{"BufferMode", PinDirection::in, "", "when the command takes effect"},
    SharedPin{"ExecutionMode", PinDirection::in, "", "at once, or after the commands that already wait for the axis"},
    SharedPin{"Busy", PinDirection::out, "", "not finished"},
    SharedPin{"Active", PinDirection::out, "", "this command controls the axis"},
    SharedPin{"CommandAborted", PinDirection::out, "", "another command took over, or power went off"},
    SharedPin{"Error", PinDirection::out, "", "refused, or ended by an axis error"},
    SharedPin{"ErrorID", PinDirection::out, "", "why"},
};

template <auto M>
consteval Pin shared_pin() {
    Pin pin = detail::pin<M>({}, {}, {});
    for (const SharedPin& known : shared_pins)
        if (known.name == pin.name) return pin.direction = known.direction, pin.unit = known.unit, pin.doc = known.doc, pin;
    throw "no shared pin has this name";  // not a constant: the build stops here
}

}  // namespace detail

/// A run of pins by the notes above.
template <auto... Members>
consteval std::array<Pin, sizeof...(Members)> shared() {
    return {detail::shared_pin<Members>()...};
}

/// What ends the table of an Execute block: Busy, Active, CommandAborted (whichever of the two it has), Error, ErrorID.
template <class Block>
consteval auto outcome() {
    constexpr auto error = shared<&Block::Error, &Block::ErrorID>();
    constexpr auto busy = detail::shared_pin<&Block::Busy>();
    if constexpr (requires { &Block::Active; }) return pin_table(busy, shared<&Block::Active, &Block::CommandAborted>(), error);
    else if constexpr (requires { &Block::CommandAborted; }) return pin_table(busy, shared<&Block::CommandAborted>(), error);
    else return pin_table(busy, error);
}

/// What follows the inputs of a reading block: Valid, Busy, Error, ErrorID.
template <class Block>
consteval auto reading() {
    return pin_table(out<&Block::Valid>("", "outputs are valid"), out<&Block::Busy>("", "reading"), out<&Block::Error>("", "cannot read"),
                     shared<&Block::ErrorID>());
}

}  // namespace taktwerk::fb
