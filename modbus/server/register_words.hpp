#pragma once
// Between a number and the registers that show it. Chapter 4.2 of the specification: inside a register the high byte comes first; which of two
// registers comes first it leaves open.

#include <array>
#include <cstdint>

#include "modbus/server/served_register.hpp"

namespace taktwerk::modbus::server {

/// The registers of one number in the order of their addresses; of a bit, 0 or 1 in the first.
using RegisterWords = std::array<std::uint16_t, 2>;

/// A whole number is the nearest one; what the type cannot hold shows as the end of its range, and what is not a number as 8000h or 8000 0000h of a
/// signed type, FFFFh or FFFF FFFFh of an unsigned one. float32: the nearest, infinity and NaN as such. A bit: not 0 (and not NaN). A bit inside of a
/// register stands in its place. Real-time safe.
[[nodiscard]] RegisterWords words_of(const ServedRegister& to, double number) noexcept;
/// A bit inside of a register: 0 or 1.
[[nodiscard]] double number_of(const ServedRegister& from, const RegisterWords& words) noexcept;

}  // namespace taktwerk::modbus::server
