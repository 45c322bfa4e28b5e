#pragma once
// The calendar clock, for the stamps of messages and the age of commands. Never for control.

#include <chrono>
#include <cstdint>

namespace taktwerk::hmi {

/// us since 1970 (LCM's utime).
[[nodiscard]] inline std::int64_t wall_utime() {
    return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace taktwerk::hmi
