#include "axes/path/path_element.hpp"

#include <cmath>
#include <limits>

#include "core/math.hpp"

namespace taktwerk::axes {
namespace {

constexpr double arc_feature = 0.25;  // rad
constexpr double course_parts = 12;

}  // namespace

PathElement PathElement::line(const PathVector& from, const PathVector& to) noexcept {
    PathElement e;
    e.kind_ = Kind::line;
    e.length_ = (to - from).norm();
    e.start_ = from;
    e.first_ = (to - from) / e.length_;
    return e;
}

PathElement PathElement::arc(const PathVector& centre, const PathVector& a, const PathVector& b, const PathVector& drift,
                             double angle) noexcept {
    PathElement e;
    e.kind_ = Kind::arc;
    e.rate_ = 1 / std::sqrt(a.squaredNorm() + drift.squaredNorm());
    e.length_ = angle / e.rate_;
    e.start_ = centre;
    e.first_ = a;
    e.second_ = b;
    e.drift_ = drift;
    return e;
}

PathElement PathElement::quintic(const Quintic& curve) noexcept {
    PathElement e;
    e.kind_ = Kind::quintic;
    e.length_ = curve.length();
    e.quintic_ = curve;
    return e;
}

PathElement PathElement::course(const PathPoint& from, const PathPoint& to, double length) noexcept {
    PathElement e;
    e.kind_ = Kind::course;
    e.length_ = length;
    e.quintic_ = Quintic(from, to, length);
    return e;
}

PathElement PathElement::shifted(const PathVector& by) const noexcept {
    PathElement e = *this;
    e.start_ += by;
    e.quintic_.shift(by);
    return e;
}

PathPoint PathElement::at(double s) const noexcept {
    PathPoint p;
    switch (kind_) {
        case Kind::line:
            p.at = start_ + s * first_;
            p.first = first_;
            break;
        case Kind::arc: {
            const double angle = s * rate_, cosine = math::cos(angle), sine = math::sin(angle);
            const PathVector out = cosine * first_ + sine * second_, along = cosine * second_ - sine * first_;
            p.at = start_ + out + angle * drift_;
            p.first = rate_ * (along + drift_);
            p.second = -rate_ * rate_ * out;
            p.third = -rate_ * rate_ * rate_ * along;
            break;
        }
        case Kind::quintic: return quintic_.at(s);
        case Kind::course: return quintic_.by_parameter(s / length_, length_);
    }
    return p;
}

double PathElement::feature(double s) const noexcept {
    switch (kind_) {
        case Kind::line: break;
        case Kind::arc: return arc_feature / rate_;
        case Kind::quintic: return quintic_.feature(s);
        case Kind::course: return length_ / course_parts;
    }
    return std::numeric_limits<double>::infinity();
}

}  // namespace taktwerk::axes
