#pragma once
// The stretch of the axis in which a probe's event counts (MC_TouchProbe: WindowOnly, FirstPosition, LastPosition). Pure. Real-time safe.

#include <cmath>

#include "axes/axis/command_details.hpp"

namespace taktwerk::axes {

/// `position` on the circle of `modulo`: in [0, modulo).
[[nodiscard]] inline double on_circle(double position, double modulo) noexcept {
    const double rest = std::fmod(position, modulo);
    return rest < 0 ? rest + modulo : rest;
}

/// Both borders included, in positive sense (P1-246). `modulo` u; 0 = linear. On a modulo axis the window begins at `first` and ends where
/// `last` comes next: first > last goes over the zero (P1-250), a whole turn or more is everywhere.
[[nodiscard]] inline bool in_window(const ProbeDetails& probe, double position, double modulo) noexcept {
    if (!probe.window_only) return true;
    if (modulo <= 0) return probe.first <= position && position <= probe.last;
    if (probe.last - probe.first >= modulo) return true;
    const double first = on_circle(probe.first, modulo), last = on_circle(probe.last, modulo), here = on_circle(position, modulo);
    return first <= last ? first <= here && here <= last : here >= first || here <= last;
}

/// invalid_position: not finite, or a window on a linear axis that holds nothing.
[[nodiscard]] inline ErrorId check_window(const ProbeDetails& probe, double modulo) noexcept {
    if (!probe.window_only) return ErrorId::none;
    const bool usable = std::isfinite(probe.first) && std::isfinite(probe.last) && (modulo > 0 || probe.first <= probe.last);
    return usable ? ErrorId::none : ErrorId::invalid_position;
}

}  // namespace taktwerk::axes
