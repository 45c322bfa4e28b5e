#pragma once
// How many cases a property test draws: quick by default, more in a long run (`./dev soak`).

#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace taktwerk {

/// `usual` times TAKTWERK_SOAK_FACTOR from the environment (1 when it is not set). The seeds stay the test's own: the first
/// `usual` cases are the same in both runs.
[[nodiscard]] inline std::size_t property_cases(std::size_t usual) {
    const char* factor = std::getenv("TAKTWERK_SOAK_FACTOR");
    const unsigned long times = factor != nullptr ? std::strtoul(factor, nullptr, 10) : 1;
    return usual * (times > 0 ? times : 1);
}

/// Seed of the first program that a campaign of programs draws: TAKTWERK_PROGRAMS_FIRST from the environment (1 when it is not set). So a long campaign
/// goes in parts, and each part's result stays.
[[nodiscard]] inline std::uint64_t first_program() {
    const char* first = std::getenv("TAKTWERK_PROGRAMS_FIRST");
    return first != nullptr ? std::strtoull(first, nullptr, 10) : 1;
}

}  // namespace taktwerk
