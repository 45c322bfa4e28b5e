#include "axes/tables/cam_law.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace taktwerk::axes {

namespace {

constexpr double pi = std::numbers::pi;

/// The root of a x^2 + b x + c in (0, 1) where the ends differ in sign; a negative number where they do not.
double root_between_0_and_1(double a, double b, double c) noexcept {
    const double at_1 = a + b + c;
    if (!((c < 0 && at_1 > 0) || (c > 0 && at_1 < 0))) return -1;
    const double q = -(b + std::copysign(std::sqrt(std::fmax(b * b - 4 * a * c, 0)), b)) / 2;
    const double one = q != 0 ? c / q : -1, other = a != 0 ? q / a : -1;
    return one > 0 && one < 1 ? one : other;
}

bool turns(const LawEnd& end) noexcept { return end.velocity == 0 && end.acceleration != 0; }

}  // namespace

/// A velocity that changes from 0 to 1 over 0 <= x <= 1, its way and its derivatives.
CamLawCurve::Course CamLawCurve::course(Form form, double x) noexcept {
    switch (form) {
        case Form::constant: return {x * x / 2, x, 1, 0};
        case Form::half_wave: {
            const double s = std::sin(pi * x), c = std::cos(pi * x);
            return {(x - s / pi) / 2, (1 - c) / 2, pi / 2 * s, pi * pi / 2 * c};
        }
        case Form::quarter_wave: {
            const double s = std::sin(pi / 2 * x), c = std::cos(pi / 2 * x);
            return {2 / pi * (1 - c), s, pi / 2 * c, -pi * pi / 4 * s};
        }
        case Form::skewed: {  // up to x = 1/4, down from there on
            if (x < 0.25) {
                const double s = std::sin(2 * pi * x), c = std::cos(2 * pi * x);
                return {x / 4 - s / (8 * pi), (1 - c) / 4, pi / 2 * s, pi * pi * c};
            }
            const double angle = 2 * pi / 3 * (x - 0.25), s = std::sin(angle), c = std::cos(angle);
            return {x / 4 - 1 / (8 * pi) + 9 / (8 * pi) * (1 - c), 0.25 + 0.75 * s, pi / 2 * c, -pi * pi / 3 * s};
        }
        case Form::trapezoid: break;
    }
    // The second half mirrors the first one: velocity(1 - x) = 1 - velocity(x).
    constexpr double top = 2 * pi / (pi + 2);
    const bool mirrored = x > 0.5;
    const double y = mirrored ? 1 - x : x;
    Course out;
    if (y < 0.25) {
        const double s = std::sin(2 * pi * y), c = std::cos(2 * pi * y);
        out = {top * (y / (2 * pi) - s / (4 * pi * pi)), top * (1 - c) / (2 * pi), top * s, top * 2 * pi * c};
    } else {
        const double flat = y - 0.25;
        out = {top * (1 / (8 * pi) - 1 / (4 * pi * pi) + flat / (2 * pi) + flat * flat / 2), top * (1 / (2 * pi) + flat), top, 0};
    }
    if (mirrored) out = {out.way + x - 0.5, 1 - out.velocity, out.acceleration, -out.jerk};
    return out;
}

/// course(form, 1).way
double CamLawCurve::mean_of(Form form) noexcept {
    switch (form) {
        case Form::quarter_wave: return 2 / pi;
        case Form::skewed: return 0.25 + 1 / pi;
        default: return 0.5;
    }
}

bool CamLawCurve::set(CamSegment law, double width, const LawEnd& from, const LawEnd& to) noexcept {
    *this = {};
    const double mean = (to.slave - from.slave) / width;
    begin_ = from.slave, end_ = to.slave;
    first_.from = from.velocity, second_.from = to.velocity;
    switch (law) {
        case CamSegment::quadratic_parabola: first_.form = Form::constant; break;
        case CamSegment::inclined_sine: first_.form = Form::half_wave; break;
        case CamSegment::modified_trapezoid: first_.form = Form::trapezoid; break;
        case CamSegment::simple_sine: first_.form = Form::quarter_wave; break;
        case CamSegment::modified_sine: first_.form = Form::skewed; break;
        case CamSegment::harmonic_combination:
            width_ = width;
            if (!turn(mean, from, to)) {
                width_ = 0;
                return false;
            }
            break;
        default: return false;
    }
    if (law != CamSegment::harmonic_combination) {
        second_.form = first_.form;
        if (mean_of(first_.form) == 0.5) join_with_least_peak(mean);
        else join(mean);
    }
    const bool usable = std::isfinite(first_.rate) && std::isfinite(second_.rate) && std::isfinite(first_.by) && std::isfinite(second_.by);
    width_ = usable ? width : 0;
    return usable;
}

/// The velocity in the middle follows from the way.
void CamLawCurve::join(double mean) noexcept {
    const double rest = 1 - inflection_, one = mean_of(first_.form), other = mean_of(second_.form);
    const double middle =
        (mean - inflection_ * (1 - one) * first_.from - rest * (1 - other) * second_.from) / (inflection_ * one + rest * other);
    first_.by = middle - first_.from;
    second_.by = middle - second_.from;
    first_.rate = first_.by / inflection_;
    second_.rate = second_.by / rest;
}

/// Both changes at the same rate r: with d = mean - (v0 + v1)/2 and D = v1 - v0 the way asks for r^2 - 4 d r - D^2 = 0, and D = r (2 inflection - 1).
/// From d = 0 on (the mean velocity fits) one change is enough, and the inflection lies at an end.
void CamLawCurve::join_with_least_peak(double mean) noexcept {
    const double more = mean - (first_.from + second_.from) / 2, difference = second_.from - first_.from;
    const double rate = 2 * more + std::copysign(std::hypot(difference, 2 * more), more);
    inflection_ = rate != 0 ? (1 + difference / rate) / 2 : 0.5;
    first_.rate = second_.rate = rate;
    first_.by = rate * inflection_;
    second_.by = rate * (1 - inflection_);
}

/// The inflection lies where the acceleration at the turning point becomes the one that was asked for.
bool CamLawCurve::turn(double mean, const LawEnd& from, const LawEnd& to) noexcept {
    const bool at_begin = turns(from), at_end = turns(to);
    if (!at_begin && !at_end) return false;
    if (at_begin && at_end) {
        // The middle is pi/2 of the mean; from.acceleration = middle / inflection * pi/2 / width.
        first_.form = second_.form = Form::quarter_wave;
        inflection_ = mean * pi * pi / (4 * width_ * from.acceleration);
    } else {
        // Seen with the turning point at the end; its part of the width is y: middle = pull y, and the way asks for
        // (1 - y) (v (1 - one) + one * pull y) + other * pull y^2 = mean.
        const double v = at_end ? from.velocity : -to.velocity, way = at_end ? mean : -mean;
        const double pull = -(at_end ? to : from).acceleration * width_ * 2 / pi;
        const double one = mean_of(Form::skewed), other = mean_of(Form::quarter_wave);
        const double y = root_between_0_and_1(pull * (other - one), one * pull - (1 - one) * v, (1 - one) * v - way);
        first_.form = at_end ? Form::skewed : Form::quarter_wave;
        second_.form = at_end ? Form::quarter_wave : Form::skewed;
        inflection_ = at_end ? 1 - y : y;
    }
    if (!(inflection_ > 0 && inflection_ < 1)) return false;
    join(mean);
    return true;
}

LawValue CamLawCurve::at(double x) const noexcept {
    const double z = x / width_;
    if (z < inflection_ || inflection_ >= 1) {
        const auto change = course(first_.form, z / inflection_);
        return {begin_ + width_ * (first_.from * z + first_.by * inflection_ * change.way), first_.from + first_.by * change.velocity,
                first_.rate * change.acceleration / width_, first_.rate / inflection_ * change.jerk / (width_ * width_)};
    }
    const double rest = 1 - inflection_, left = 1 - z;
    const auto change = course(second_.form, left / rest);
    return {end_ - width_ * (second_.from * left + second_.by * rest * change.way), second_.from + second_.by * change.velocity,
            -second_.rate * change.acceleration / width_, second_.rate / rest * change.jerk / (width_ * width_)};
}

LawValue normalised_law(CamSegment law, double z) noexcept {
    switch (law) {
        case CamSegment::linear: return {z, 1, 0, 0};
        case CamSegment::quintic:
            return {z * z * z * (10 + z * (-15 + z * 6)), z * z * (30 + z * (-60 + z * 30)), z * (60 + z * (-180 + z * 120)),
                    60 + z * (-360 + z * 360)};
        default: break;
    }
    CamLawCurve curve;
    return curve.set(law, 1, {}, {.slave = 1}) ? curve.at(z) : LawValue{};
}

LawPeaks peaks_of(CamSegment law) noexcept {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    switch (law) {
        case CamSegment::linear: return {1, infinite, infinite};
        case CamSegment::quadratic_parabola: return {2, 4, infinite};
        case CamSegment::simple_sine: return {pi / 2, pi * pi / 2, infinite};
        case CamSegment::inclined_sine: return {2, 2 * pi, 4 * pi * pi};
        case CamSegment::quintic: return {1.875, 10 / std::sqrt(3.0), 60};
        case CamSegment::modified_trapezoid: return {2, 8 * pi / (pi + 2), 32 * pi * pi / (pi + 2)};
        case CamSegment::modified_sine: return {4 * pi / (pi + 4), 4 * pi * pi / (pi + 4), 16 * pi * pi * pi / (pi + 4)};
        default: return {};
    }
}

}  // namespace taktwerk::axes
