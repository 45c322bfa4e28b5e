#pragma once
// A path as its timing sees it: a function from the path's length s to the axes, with three derivatives, and what limits the path itself.
// Where q comes from (a line in space, a kinematics behind it) is nobody's business here.

#include <array>
#include <cstdint>

namespace taktwerk::axes {

/// Axes that one path may move.
inline constexpr int max_path_axes = 8;

/// What the path itself is limited to at a point, in the unit of s: u/s, u/s2, u/s3. Magnitudes > 0, infinity allowed.
struct PathLimits {
    double velocity = 0;
    double acceleration = 0;
    double deceleration = 0;
    double jerk = 0;
};

/// An axis' limits, the same in both directions: u/s, u/s2, u/s3. All > 0 and finite.
struct PathAxisLimits {
    double velocity = 0;
    double acceleration = 0;
    double jerk = 0;
};

/// dq/ds, d2q/ds2, d3q/ds3 of each axis at a point, and the path's own limits there.
struct TimedCurvePoint {
    std::array<double, max_path_axes> first{};
    std::array<double, max_path_axes> second{};
    std::array<double, max_path_axes> third{};
    PathLimits path{};
};

/// Which derivative counts at a place where they jump.
enum class CurveSide : std::uint8_t { before, after };

/// A path that is twice continuously differentiable between begin() and end(): q, q' and q'' are continuous, q''' may jump at breakpoints.
/// Pure: the same s gives the same bits. Any thread, no allocation.
class TimedCurve {
public:
    TimedCurve() = default;
    TimedCurve(const TimedCurve&) = default;
    TimedCurve& operator=(const TimedCurve&) = default;
    virtual ~TimedCurve() = default;

    [[nodiscard]] virtual int axes() const noexcept = 0;
    [[nodiscard]] virtual double begin() const noexcept = 0;
    [[nodiscard]] virtual double end() const noexcept = 0;

    [[nodiscard]] virtual TimedCurvePoint at(double s, CurveSide side) const noexcept = 0;

    /// The first place behind `s` at which q''' or a limit jumps; end() where there is none.
    [[nodiscard]] virtual double next_break(double s) const noexcept = 0;

    /// A number of the part that holds s, if s is no break: it comes back with every set-point, so that nobody searches, or takes the wrong side of a break.
    [[nodiscard]] virtual std::uint32_t part_at(double s) const noexcept = 0;

    /// The first place behind `s` that can only be passed at rest; end() where there is none.
    [[nodiscard]] virtual double next_stop(double s) const noexcept = 0;

    /// The length around s on which the derivatives change little: how finely time has to be planned there. Infinite where they are constant.
    [[nodiscard]] virtual double feature(double s, CurveSide side) const noexcept = 0;
};

}  // namespace taktwerk::axes
