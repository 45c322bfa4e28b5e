#pragma once
// A curve through points, twice continuously differentiable: the natural cubic spline over the length of the chords. Not real-time safe.

#include <span>
#include <vector>

#include "axes/path/path_element.hpp"
#include "core/result.hpp"

namespace taktwerk::axes {

/// One element from each point to the next; the first and last have no curvature at the ends of the spline. Two or more points.
/// Errors: path.spline_points (fewer, or two neighbours that coincide).
[[nodiscard]] Result<std::vector<PathElement>> spline_through(std::span<const PathVector> points);

}  // namespace taktwerk::axes
