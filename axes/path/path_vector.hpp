#pragma once
// Points of a path: up to eight numbers of one metric space, so that one length and one set of curves serve positions, orientations and
// joints alike. A Cartesian path has x, y, z [u] and the rotation vector of its chart (path_chart.hpp), which the lever makes a length;
// a joint path has its joints, as they are. What a path does not use is 0.

#include <Eigen/Core>

namespace taktwerk::axes {

inline constexpr int path_dimensions = 8;

using PathVector = Eigen::Matrix<double, path_dimensions, 1>;

/// A point and its derivatives by the length s.
struct PathPoint {
    PathVector at = PathVector::Zero();
    PathVector first = PathVector::Zero();
    PathVector second = PathVector::Zero();
    PathVector third = PathVector::Zero();
};

}  // namespace taktwerk::axes
