#pragma once
// What somebody who writes a cam wants to hear before it runs: where velocity or acceleration step between its segments, and which laws cannot
// join their points. Not real-time.

#include <cstddef>
#include <span>
#include <vector>

#include "axes/tables/cam_table.hpp"

namespace taktwerk::axes {

/// Velocity or acceleration (du/dM, d2u/dM2) differ on both sides of a point. Where the velocity steps nothing is said of the acceleration.
struct CamStep {
    enum class Of : std::uint8_t { velocity, acceleration };
    Of of = Of::velocity;
    std::size_t point = 0;  ///< index; 0 is the wrap of a periodic cam, from its last point to its first
    double before = 0, behind = 0;
};

/// Steps of more than a hundred-thousandth of the cam's largest velocity at its points, or a thousandth of its largest acceleration. Of a cam
/// that is not periodic only inside: what comes before and behind it is not known. Nothing of points that cannot be followed.
[[nodiscard]] std::vector<CamStep> steps_of(std::span<const CamPoint> points, bool periodic);

/// The points whose segment has a law that cannot join it to the next one. The master has to rise.
[[nodiscard]] std::vector<std::size_t> misfits_of(std::span<const CamPoint> points);

}  // namespace taktwerk::axes
