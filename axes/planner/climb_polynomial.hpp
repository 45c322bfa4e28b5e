#pragma once
// The way of a climb that ends without acceleration, as a polynomial in its peak (mathematics.md, "The way of a climb"). Where much cancels it
// loses digits: it says where to look, the climb itself says whether it is there. Internal to the planner.

#include <cmath>

#include "axes/planner/motion_frame.hpp"

namespace taktwerk::axes {

class ClimbPolynomial {
public:
    /// From (v, a), on one side of velocity 0 and with a jerk limit. With p the peak that would be reached without the limit of the acceleration, p^2 is `lowest_square`
    /// where the parameter x is 0, and grows by x^2.
    ClimbPolynomial(double v, double a, double lowest_square, const FrameLimits& limits) noexcept
        : lowest_square_{lowest_square}, bound_{limits.up.speeding_up} {
        const double rise = limits.up.ease;
        const double fall = limits.down.ease;
        const double both = rise + fall;
        const double ahead = v - a * a * (rise / 2);
        cubic_ = both * (rise + 2 * fall) * (1.0 / 6);
        linear_ = both * ahead;
        constant_ = a * rise * (a * a * (rise * (1.0 / 3)) - v);
        hold_velocity_ = ahead + bound_ * bound_ * (rise / 2 + fall);
        hold_per_square_ = both / (2 * bound_);
    }

    struct Way {
        double way;
        double slope;  ///< over x^2
    };
    [[nodiscard]] Way at(double x_square) const noexcept {
        const double square = lowest_square_ + x_square;
        const double most = bound_ * bound_;
        if (square <= most) {
            const double p = std::sqrt(square);
            return {p * (cubic_ * square + linear_) + constant_, (3 * cubic_ * square + linear_) / (2 * p)};
        }
        const double hold = (square - most) * hold_per_square_;
        return {bound_ * (cubic_ * most + linear_) + constant_ + hold * (hold_velocity_ + hold * (bound_ / 2)),
                (hold_velocity_ + hold * bound_) * hold_per_square_};
    }

private:
    double lowest_square_;
    double bound_;
    double cubic_;
    double linear_;
    double constant_;
    double hold_velocity_;
    double hold_per_square_;
};

}  // namespace taktwerk::axes
