#pragma once
// Whether the data carries the answer.

#include <cstdint>
#include <string_view>

namespace taktwerk::axes::measuring {

enum class Doubt : std::uint8_t {
    none,
    no_samples,         ///< the measurement ended before there was anything
    ended_early,        ///< only a part of it was driven
    lost_samples,       ///< more than one in a hundred is missing
    nothing_to_see,     ///< the answer is smaller than what the encoder or the torque resolves
    saturated,          ///< the torque was at its limit
    too_little_motion,  ///< the causes cannot be told apart with this excitation
};
/// "" for none.
[[nodiscard]] constexpr std::string_view word(Doubt doubt) noexcept {
    switch (doubt) {
        case Doubt::none: return "";
        case Doubt::no_samples: return "no_samples";
        case Doubt::ended_early: return "ended_early";
        case Doubt::lost_samples: return "lost_samples";
        case Doubt::nothing_to_see: return "nothing_to_see";
        case Doubt::saturated: return "saturated";
        case Doubt::too_little_motion: return "too_little_motion";
    }
    return "";
}

/// A number with its standard deviation, both in the unit of the number. `known` is false where the data does not carry it.
struct Estimate {
    double value = 0;
    double deviation = 0;
    bool known = false;
};

}  // namespace taktwerk::axes::measuring
