#pragma once
// Values of the elementary types as bits and as text, and one type's value as another's: what a file can hold and an edited program may ask
// for. Pure functions, not real-time (they allocate).

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "fb_library/pins/pin.hpp"

namespace taktwerk::runtime {

/// Bytes that a value of the type has in memory; 0 for what has no meaning outside the machine (handles).
[[nodiscard]] std::size_t size_of(fb::PinKind type) noexcept;
/// "DINT", ...; ENUM is "ENUM".
[[nodiscard]] std::string_view word(fb::PinKind type) noexcept;
[[nodiscard]] std::optional<fb::PinKind> find_type(std::string_view word) noexcept;

/// `bits`: the value's bytes in memory, little-endian, zeros above them. Numbers read back as the very same; of what is no number (NaN) only
/// that it is none.
[[nodiscard]] std::string text_of(fb::PinKind type, std::uint64_t bits);
[[nodiscard]] std::optional<std::uint64_t> bits_of(fb::PinKind type, std::string_view text) noexcept;

struct Converted {
    std::uint64_t bits = 0;
    bool rounded = false;  ///< LREAL to REAL: not the very same number
};
/// The same number in another type. Nothing where that type does not hold it: a fraction in an integer, 300 in a USINT, a number in a TIME.
[[nodiscard]] std::optional<Converted> converted(fb::PinKind from, std::uint64_t bits, fb::PinKind to) noexcept;

}  // namespace taktwerk::runtime
