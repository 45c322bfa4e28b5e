#pragma once
// Points in space, as the tests of paths write them.

#include "axes/path/path_vector.hpp"

namespace taktwerk::axes {

inline PathVector at(double x, double y, double z = 0) {
    PathVector v = PathVector::Zero();
    v.head<3>() << x, y, z;
    return v;
}

}  // namespace taktwerk::axes
