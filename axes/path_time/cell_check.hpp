#pragma once
// What a v2(s) uses of all limits over a cell: the curve is evaluated at the cell's ends and quarters; between them it is interpolated, where that is
// known to be near enough, else evaluated.

#include <cstdint>
#include <span>
#include <vector>

#include "axes/path_time/curve.hpp"
#include "axes/path_time/limit_use.hpp"

namespace taktwerk::axes {

/// v2 on a cell: at its ends, and Bernstein's coefficient between them.
struct CellSquares {
    double first = 0, middle = 0, last = 0;
};

struct CellUse {
    LimitUse peak;   ///< over the cell
    LimitUse nodes;  ///< at its ends: where the optimisation looks
};

class CellCheck {
public:
    /// Evaluates the curve for the cells between `nodes`; `breaks` ascending.
    void sample(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const std::vector<double>& nodes,
                const std::vector<double>& breaks);

    [[nodiscard]] const TimedCurvePoint& begin(std::size_t cell) const noexcept { return begins_[cell]; }
    [[nodiscard]] const TimedCurvePoint& middle(std::size_t cell) const noexcept { return middles_[cell]; }
    [[nodiscard]] const TimedCurvePoint& end(std::size_t cell) const noexcept { return ends_[cell]; }
    /// The curve jumps in its third derivative or limits at the beginning of the cell.
    [[nodiscard]] bool breaks_before(std::size_t cell) const noexcept { return traits_[cell].breaks_before; }
    [[nodiscard]] bool straight(std::size_t cell) const noexcept { return traits_[cell].straight; }

    /// Evaluates the curve where it has to.
    [[nodiscard]] CellUse use(std::size_t cell, const CellSquares& squares, double velocity_factor);

private:
    struct Traits {
        double begin = 0, length = 0;
        bool breaks_before = false, straight = false, limits_stay = false, quartered = false;
        LimitUse per_unit;                // straight: what the axes use per v, a, j of s
        LimitUse missed, missed_of_half;  // what interpolation over the cell, over its halves misses per v, v2, v3
    };
    enum class Between : std::uint8_t { halves, quarters, nothing };

    [[nodiscard]] Between between(std::size_t cell, double velocity);
    [[nodiscard]] CellUse look_directly(double begin, double length, const TimedCurvePoint& first, const TimedCurvePoint& last,
                                        const CellSquares& squares, double velocity_factor, int depth) const;
    void quarter(std::size_t cell);
    void judge(std::size_t cell);
    [[nodiscard]] CellUse straight_use(std::size_t cell, const CellSquares& squares, double velocity_factor) const;

    const TimedCurve* curve_ = nullptr;
    std::span<const PathAxisLimits> limits_;
    std::vector<TimedCurvePoint> begins_, quarters_, middles_, three_quarters_, ends_;
    std::vector<Traits> traits_;
};

}  // namespace taktwerk::axes
