#pragma once
// What every piece of cyclic code is handed: the time of this scan, constant while it lasts.

#include <cstdint>

#include "core/time.hpp"

namespace taktwerk {

struct CycleContext {
    Instant now{};            ///< start of this scan: what timers (TON, ...) use
    Duration period{};        ///< of the calling task
    std::uint64_t cycle = 0;  ///< scans of the calling task since start
};

}  // namespace taktwerk
