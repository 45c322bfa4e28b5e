#pragma once
// A point whose value people have put in place of the real one. Plain data.

#include <cstddef>
#include <cstdint>

#include "runtime/io_point.hpp"

namespace taktwerk::runtime {

inline constexpr std::size_t max_forces = 64;  ///< of a machine at a time

struct ForcedPoint {
    IoDirection direction = IoDirection::input;
    std::uint16_t index = 0;   ///< among the points of that direction
    std::uint32_t client = 0;  ///< who; it ends with him
    double value = 0;          ///< in the unit of the point
};

}  // namespace taktwerk::runtime
