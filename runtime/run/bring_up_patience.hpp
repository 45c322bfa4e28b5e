#pragma once
// How long a bus may take to come up. Not for the cycle path.

#include <algorithm>
#include <cstddef>

#include "core/time.hpp"

namespace taktwerk::runtime {

/// Beyond what one slave may take. Each answer of a slave costs a cycle, and reading a long EEPROM takes some 35 cycles of its share
/// (docs/performance.md): three times that, or 0.2 s, for each. `cycle` > 0.
[[nodiscard]] inline Duration patience_with(std::size_t slaves, Duration cycle) {
    constexpr Duration least = std::chrono::milliseconds{200};
    constexpr int cycles = 100;
    return static_cast<std::int64_t>(slaves) * std::max<Duration>(least, cycles * cycle);
}

}  // namespace taktwerk::runtime
