#pragma once
// The encoder's index pulse (Z, C-phase): one each revolution of the motor, wherever the drive counts zero.

#include <cmath>
#include <optional>

namespace taktwerk::axes::sim {

/// One pulse stands at `at`, the others a whole number of `every` [counts] from it.
struct IndexPulses {
    double at = 0, every = 0;  ///< every 0: there are none

    /// The pulse that is passed on the way from `before` to `after`, the last one if there are several.
    [[nodiscard]] std::optional<double> between(double before, double after) const noexcept {
        if (!(every > 0) || before == after) return std::nullopt;
        const double from = (before - at) / every, to = (after - at) / every;
        const double pulse = to > from ? std::floor(to) : std::ceil(to);
        if (to > from ? pulse <= from : pulse >= from) return std::nullopt;  // a motor that starts on a pulse has not passed it
        return at + pulse * every;
    }
};

}  // namespace taktwerk::axes::sim
