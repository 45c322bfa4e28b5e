#pragma once
// Bits of 6041h, by the number that the manuals give them.

#include <cstdint>

namespace taktwerk::axes::sim {

[[nodiscard]] constexpr std::uint16_t status_bit(unsigned n) noexcept { return static_cast<std::uint16_t>(1u << n); }

}  // namespace taktwerk::axes::sim
