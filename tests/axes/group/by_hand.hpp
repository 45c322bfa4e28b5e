#pragma once
// Frames once more, with nothing of what is tested: 3 x 3 matrices written out. RX RY RZ: turned about Z, the new Y, the new X.

#include <array>
#include <cmath>

namespace taktwerk::axes::test {

using Six = std::array<double, 6>;
struct HandFrame {
    std::array<std::array<double, 3>, 3> r{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    std::array<double, 3> o{};
};

inline HandFrame hand_frame(const Six& s) {
    const double cz = std::cos(s[5]), sz = std::sin(s[5]), cy = std::cos(s[4]), sy = std::sin(s[4]), cx = std::cos(s[3]),
                 sx = std::sin(s[3]);
    return {{{{cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx},
              {sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx},
              {-sy, cy * sx, cy * cx}}},
            {s[0], s[1], s[2]}};
}
/// `inner`, seen from `outer`, seen from where `outer` is.
inline HandFrame operator*(const HandFrame& outer, const HandFrame& inner) {
    HandFrame f;
    for (std::size_t i = 0; i < 3; ++i) {
        f.o[i] = outer.o[i];
        for (std::size_t k = 0; k < 3; ++k) f.o[i] += outer.r[i][k] * inner.o[k];
        for (std::size_t j = 0; j < 3; ++j) {
            f.r[i][j] = 0;
            for (std::size_t k = 0; k < 3; ++k) f.r[i][j] += outer.r[i][k] * inner.r[k][j];
        }
    }
    return f;
}
inline HandFrame back(const HandFrame& f) {
    HandFrame b;
    for (std::size_t i = 0; i < 3; ++i) {
        b.o[i] = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            b.r[i][k] = f.r[k][i];
            b.o[i] -= f.r[k][i] * f.o[k];
        }
    }
    return b;
}
/// Away from RY = +-90 degrees.
inline Six hand_six(const HandFrame& f) {
    return {f.o[0], f.o[1], f.o[2], std::atan2(f.r[2][1], f.r[2][2]), std::asin(-f.r[2][0]), std::atan2(f.r[1][0], f.r[0][0])};
}
/// Largest difference of places and of the matrices' elements: angles at a right angle are no measure.
inline double apart(const HandFrame& a, const HandFrame& b) {
    double most = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        most = std::max(most, std::abs(a.o[i] - b.o[i]));
        for (std::size_t k = 0; k < 3; ++k) most = std::max(most, std::abs(a.r[i][k] - b.r[i][k]));
    }
    return most;
}

}  // namespace taktwerk::axes::test
