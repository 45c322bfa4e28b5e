#pragma once
// What an axis with an absolute encoder must remember so that it knows its coordinates after power was off.

#include <cstdint>

#include "axes/axis/axis_config.hpp"

namespace taktwerk::axes {

/// Counts are the drive's, unwrapped beyond the range of its encoder.
struct RetainedPosition {
    bool homed = false;
    double shift = 0;         ///< u: program coordinate of count 0; whole turns of a modulo axis included
    std::int64_t counts = 0;  ///< where it was last
    bool at_rest = false;     ///< it stood there; otherwise it may have gone on before power went
    friend bool operator==(const RetainedPosition&, const RetainedPosition&) = default;
};

/// Two gearings that give the same counts the same coordinates.
[[nodiscard]] inline bool same_coordinates(const Gearing& a, const Gearing& b) noexcept {
    return a.counts_per_revolution == b.counts_per_revolution && a.motor_revolutions == b.motor_revolutions &&
           a.load_revolutions == b.load_revolutions && a.feed == b.feed && a.inverted == b.inverted;
}

/// The position nearest to `last` that reads as `raw` on an encoder which begins anew after `range` counts. Right as long as the axis moved
/// less than half of that range meanwhile: what is further cannot be told from what is nearer.
[[nodiscard]] constexpr std::int64_t unwrapped_near(std::int64_t last, std::int64_t raw, std::int64_t range) noexcept {
    std::int64_t away = (raw - last) % range;
    if (away * 2 > range) away -= range;
    else if (away * 2 < -range) away += range;
    return last + away;
}

}  // namespace taktwerk::axes
