#pragma once
// One curve of a path by its length: a straight line, an arc or helix, a quintic; or a polynomial of a length that is not its own. A value; real-time safe
// once made.

#include <cstdint>

#include "axes/path/path_vector.hpp"
#include "axes/path/quintic.hpp"

namespace taktwerk::axes {

class PathElement {
public:
    enum class Kind : std::uint8_t { line, arc, quintic, course };

    PathElement() = default;
    /// From a point to another, which differ.
    [[nodiscard]] static PathElement line(const PathVector& from, const PathVector& to) noexcept;
    /// x(f) = centre + cos(f) a + sin(f) b + f drift, f from 0 to `angle` > 0 [rad]; a and b of one length and all three at right angles.
    [[nodiscard]] static PathElement arc(const PathVector& centre, const PathVector& a, const PathVector& b, const PathVector& drift,
                                         double angle) noexcept;
    [[nodiscard]] static PathElement quintic(const Quintic& curve) noexcept;
    /// The polynomial of the fifth degree in s with these points and derivatives at s = 0 and s = `length`: |dx/ds| is what they say. For joints of paths
    /// whose lengths are of two kinds.
    [[nodiscard]] static PathElement course(const PathPoint& from, const PathPoint& to, double length) noexcept;

    /// The same curve elsewhere.
    [[nodiscard]] PathElement shifted(const PathVector& by) const noexcept;

    [[nodiscard]] Kind kind() const noexcept { return kind_; }
    [[nodiscard]] double length() const noexcept { return length_; }
    /// s in [0, length()].
    [[nodiscard]] PathPoint at(double s) const noexcept;
    /// The length around s on which its derivatives change little; infinite on a line.
    [[nodiscard]] double feature(double s) const noexcept;

private:
    Kind kind_ = Kind::line;
    double length_ = 0;
    double rate_ = 0;                        // arc: d(angle)/ds
    PathVector start_ = PathVector::Zero();  // line: where it begins; arc: the centre
    PathVector first_ = PathVector::Zero();  // line: its direction; arc: a
    PathVector second_ = PathVector::Zero();
    PathVector drift_ = PathVector::Zero();
    Quintic quintic_;
};

}  // namespace taktwerk::axes
