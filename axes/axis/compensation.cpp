#include "axes/axis/compensation.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {

namespace {

/// On the line through two points, by a key of each.
double between(double x, double x0, double y0, double x1, double y1) noexcept { return y0 + (y1 - y0) * ((x - x0) / (x1 - x0)); }

double corrected(const PitchPoint& point) noexcept { return point.position + point.correction; }

}  // namespace

double pitch_correction(std::span<const PitchPoint> points, double position) noexcept {
    if (points.empty()) return 0;
    const auto above = std::upper_bound(points.begin(), points.end(), position,
                                        [](double value, const PitchPoint& point) { return value < point.position; });
    if (above == points.begin()) return points.front().correction;
    if (above == points.end()) return points.back().correction;
    const auto& below = *(above - 1);
    return between(position, below.position, below.correction, above->position, above->correction);
}

double pitch_inverse(std::span<const PitchPoint> points, double motor) noexcept {
    if (points.empty()) return motor;
    const auto above = std::upper_bound(points.begin(), points.end(), motor,
                                        [](double value, const PitchPoint& point) { return value < corrected(point); });
    if (above == points.begin()) return motor - points.front().correction;
    if (above == points.end()) return motor - points.back().correction;
    const auto& below = *(above - 1);
    return between(motor, corrected(below), below.position, corrected(*above), above->position);
}

void Compensation::step(double position, double velocity, bool referenced, Duration period) noexcept {
    const double most = config_.velocity * to_seconds(period);
    const auto approach = [most](double from, double to) { return from + std::clamp(to - from, -most, most); };
    if (velocity != 0) wanted_ = velocity < 0 ? -config_.backlash : 0;
    backlash_ = approach(backlash_, wanted_);

    if (config_.pitch.empty()) return;
    const double full = referenced ? pitch_correction(config_.pitch, position) : 0;
    if (referenced != referenced_) {  // homed, or no longer: what is missing comes slowly, not at once
        referenced_ = referenced;
        missing_ = full - pitch_;
    }
    missing_ = approach(missing_, 0);
    pitch_ = full - missing_;
}

double Compensation::load(double motor) const noexcept {
    const double along = motor - backlash_ + missing_;
    return referenced_ ? pitch_inverse(config_.pitch, along) : along;
}

}  // namespace taktwerk::axes
