#pragma once
// From the planner of a stored path to its group in the cycle: what is to be done beside motion, and where.

#include <cstdint>

#include "axes/group/path_types.hpp"

namespace taktwerk::axes {

/// Of a stored path: what is to be done in front of a part of a run. In their order.
struct PathNote {
    enum class Kind : std::uint8_t { tell, dwell, ask, end, fault } kind = Kind::tell;
    std::uint32_t life = 0;
    CommandId id = 0;
    std::uint32_t run = 0, part = 0;  ///< all but `tell`: in front of the run, at rest
    std::uint32_t line = 0, number = 0;
    double seconds = 0;
    PathRequest request{};
    PathPlace place{};
};

}  // namespace taktwerk::axes
