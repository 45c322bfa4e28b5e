#pragma once
// Arcs of G2 and G3 in their plane: the true circle through both ends that comes nearest to what the words say. Pure; no allocation. Lengths in mm.

#include <cstdint>

namespace taktwerk::gcode {

struct PlanePoint {
    double first = 0, second = 0;  ///< the plane's axes in their order: XY (G17), ZX (G18), YZ (G19)
};

enum class ArcTurn : std::uint8_t { clockwise, counter_clockwise };  ///< seen from the positive end of the plane's normal: G2, G3

struct ArcTolerance {
    /// How far the two radii may differ: `absolute`, or what is less of `relative` times the radius and a hundred times `absolute` (the structure of LinuxCNC's limits). CAM systems write
    /// three decimals; 5 um is what these make of a circle at most, with reserve.
    double absolute_mm = 0.005, relative = 0.001;
    [[nodiscard]] double limit(double radius) const noexcept;
};

/// Points nearer than this are one: what sums of relative moves leave.
inline constexpr double same_point_mm = 1e-6;

struct PlaneArc {
    PlanePoint centre;
    double angle = 0;  ///< rad, positive counter-clockwise; at most a full turn
};

struct ArcAnswer {
    enum class Kind : std::uint8_t { found, zero_radius, radii, ends, same_point, too_far } kind = Kind::found;
    PlaneArc arc{};
    double a = 0,
           b = 0;  ///< radii: from start and end; ends: their distance, how far off the circle is; too_far: the ends' distance, the radius
};

/// Ends that are one point: a full circle. Radii that differ within the tolerance: the centre moves along the chord to where they are equal, so both ends are met without a step.
[[nodiscard]] ArcAnswer arc_about(PlanePoint from, PlanePoint to, PlanePoint centre, ArcTurn turn, const ArcTolerance& tolerance) noexcept;
/// A positive radius: the arc of at most half a turn; a negative one: the other.
[[nodiscard]] ArcAnswer arc_with_radius(PlanePoint from, PlanePoint to, double radius, ArcTurn turn,
                                        const ArcTolerance& tolerance) noexcept;

}  // namespace taktwerk::gcode
