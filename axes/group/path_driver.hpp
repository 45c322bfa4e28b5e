#pragma once
// What drives a path in place of its own planning, as it was asked for: MC_SyncGroupToAxis. Plain data.
//
//     length of the path = way of the master * denominator / numerator, counted from where the group had come up to it

#include <cstdint>

#include "axes/words/types.hpp"

namespace taktwerk::axes {

/// What comes behind the end of a path that an axis drives: nothing, or its beginning.
enum MC_PATH_SYNC_MODE : std::uint8_t { mcNonPeriodic, mcPeriodic };

struct PathDriver {
    AxisRef master{};
    std::int32_t numerator = 1, denominator = 1;  ///< u of the master for u of the path; neither is 0
    MC_PATH_SYNC_MODE mode = mcNonPeriodic;
    friend bool operator==(const PathDriver&, const PathDriver&) = default;
};

/// Of a group whose path an axis drives.
struct PathDriverView {
    AxisRef axis{};        ///< invalid: none does
    bool in_sync = false;  ///< the path's length is locked to the axis by place
};

}  // namespace taktwerk::axes
