#pragma once
// Arcs as commands give them: over a point of the border, about a centre, with a radius. PLCopen Part 4, MC_MoveCircularAbsolute/Relative, CircMode.
// Numbers of `from` and `to` beyond the position (rotation vector, further axes) change evenly with the angle.

#include <cstdint>

#include <Eigen/Core>

#include "axes/path/path_element.hpp"
#include "core/result.hpp"

namespace taktwerk::axes {

/// The sense seen against the normal: with the normal pointing at the viewer, counter_clockwise is the mathematical one.
enum class ArcSense : std::uint8_t { counter_clockwise, clockwise };

/// Through `border` to `to`: the plane and the sense follow. Errors: path.arc_points (two of the three coincide, or they lie on a line; a full circle has no such form).
[[nodiscard]] Result<PathElement> arc_over_border(const PathVector& from, const Eigen::Vector3d& border, const PathVector& to);

/// About `centre`. `normal`: of the plane, any length; zero: it follows from the points, and the shorter way is counter-clockwise. Radii that differ by at most
/// `tolerance` [u] are reconciled by moving the centre on the perpendicular of the chord. from = to (within tolerance) is a full circle, which needs a normal.
/// Errors: path.arc_radii (they differ by more), path.arc_plane (half or full circle without a normal, or a normal that is not one), path.arc_points.
[[nodiscard]] Result<PathElement> arc_about_centre(const PathVector& from, const Eigen::Vector3d& centre, const PathVector& to,
                                                   const Eigen::Vector3d& normal, ArcSense sense, double tolerance);

/// With the radius |normal| in the plane across `normal`: the arc of at most half a circle in the given sense.
/// Errors: path.arc_radius (less than half the chord), path.arc_plane (the chord does not lie across the normal), path.arc_points.
[[nodiscard]] Result<PathElement> arc_of_radius(const PathVector& from, const PathVector& to, const Eigen::Vector3d& normal,
                                                ArcSense sense);

}  // namespace taktwerk::axes
