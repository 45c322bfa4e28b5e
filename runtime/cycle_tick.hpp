#pragma once
// The wake-up of a cycle, as its thread tells it to the machine.

#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::runtime {

/// What the caller knows about this wake-up.
struct CycleTick {
    Instant scheduled{};       ///< the grid point
    Instant woken{};           ///< when the thread really ran
    std::uint32_t missed = 0;  ///< grid points skipped since the last cycle
};

}  // namespace taktwerk::runtime
