#pragma once
// Which object of the dictionary is which number of a simulated axis: one line per object. Source: CiA 402-2.

#include <cstdint>
#include <span>

#include "axes/sim/axis_objects.hpp"

namespace taktwerk::axes::sim {

/// An object that the master writes. Objects that a drive lacks are left at their default.
struct InputObject {
    std::uint16_t index;
    std::uint8_t sub;
    void (*take)(AxisInputs& in, std::int64_t value);
};

/// 607Fh was written 0: what that means is the drive's (behaviour.cpp). A drive without 607Fh has 0 in AxisInputs, no limit.
inline constexpr std::int64_t zero_speed_limit = -1;

/// An object that the drive answers.
struct OutputObject {
    std::uint16_t index;
    std::uint8_t sub;
    std::int64_t (*value)(const AxisOutputs& out);
};

/// Commands and set-points: outputs of the bus, valid in OP only.
[[nodiscard]] std::span<const InputObject> command_objects() noexcept;
/// Settings: valid whenever they were written.
[[nodiscard]] std::span<const InputObject> setting_objects() noexcept;
[[nodiscard]] std::span<const OutputObject> answer_objects() noexcept;

}  // namespace taktwerk::axes::sim
