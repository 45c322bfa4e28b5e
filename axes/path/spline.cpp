#include "axes/path/spline.hpp"

namespace taktwerk::axes {

Result<std::vector<PathElement>> spline_through(std::span<const PathVector> points) {
    const std::size_t n = points.size();
    const auto refuse = [](const char* what) {
        return Error{"path.spline_points", "", what, "give two or more points, each different from the one before"};
    };
    if (n < 2) return refuse("a spline needs two points");
    std::vector<double> h;
    for (std::size_t i = 0; i + 1 < n; ++i) {
        h.push_back((points[i + 1] - points[i]).norm());
        if (!(h.back() > 0)) return refuse("two neighbouring points of the spline coincide");
    }
    // Second derivatives m at the points: h[i-1] m[i-1] + 2 (h[i-1] + h[i]) m[i] + h[i] m[i+1] = 6 (slope behind - slope before), m = 0 at the ends.
    std::vector<PathVector> m(n, PathVector::Zero()), right(n, PathVector::Zero());
    std::vector<double> diagonal(n, 1);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        diagonal[i] = 2 * (h[i - 1] + h[i]);
        right[i] = 6 * ((points[i + 1] - points[i]) / h[i] - (points[i] - points[i - 1]) / h[i - 1]);
        if (i > 1) {
            const double factor = h[i - 1] / diagonal[i - 1];
            diagonal[i] -= factor * h[i - 1];
            right[i] -= factor * right[i - 1];
        }
    }
    for (std::size_t i = n - 1; i-- > 1;) m[i] = (right[i] - h[i] * m[i + 1]) / diagonal[i];
    std::vector<PathElement> elements;
    for (std::size_t i = 0; i + 1 < n; ++i) {
        std::array<PathVector, 6> c;
        c.fill(PathVector::Zero());
        c[0] = points[i];
        c[1] = points[i + 1] - points[i] - h[i] * h[i] / 6 * (2 * m[i] + m[i + 1]);
        c[2] = h[i] * h[i] / 2 * m[i];
        c[3] = h[i] * h[i] / 6 * (m[i + 1] - m[i]);
        elements.push_back(PathElement::quintic(Quintic(c)));
    }
    return elements;
}

}  // namespace taktwerk::axes
