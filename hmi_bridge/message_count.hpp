#pragma once
// Times and counters as messages carry them: signed 64 bits, times in ns.

#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::hmi {

[[nodiscard]] constexpr std::int64_t count(Duration d) noexcept { return d.count(); }
[[nodiscard]] constexpr std::int64_t count(Instant t) noexcept { return t.time_since_epoch().count(); }
[[nodiscard]] constexpr std::int64_t count(std::uint64_t n) noexcept { return static_cast<std::int64_t>(n); }

}  // namespace taktwerk::hmi
