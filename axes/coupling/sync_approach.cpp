#include "axes/coupling/sync_approach.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {

CurvePoint as_curve(const EndlessMotion& slave, double position, double master_velocity, double master_acceleration) noexcept {
    // A slope is a quotient of velocities; a master that crawls would make it anything.
    constexpr double steepest = 1000;
    if (!(std::abs(slave.velocity) <= steepest * std::abs(master_velocity)) || master_velocity == 0) return {position, 0, 0};
    const double slope = slave.velocity / master_velocity;
    return {position, slope, (slave.acceleration - slope * master_acceleration) / (master_velocity * master_velocity)};
}

void SyncApproach::set(const EndlessPlace& start, double master_feed, double length, const CurvePoint& begin,
                       const CurvePoint& end) noexcept {
    start_ = start;
    feed_ = master_feed;
    length_ = length;
    const double v0 = begin.slope * length, v1 = end.slope * length;
    const double a0 = begin.curvature * length * length, a1 = end.curvature * length * length;
    const double position = end.position - begin.position - v0 - a0 / 2, velocity = v1 - v0 - a0, acceleration = a1 - a0;
    c_[0] = begin.position;
    c_[1] = v0;
    c_[2] = a0 / 2;
    c_[3] = 10 * position - 4 * velocity + acceleration / 2;
    c_[4] = -15 * position + 7 * velocity - acceleration;
    c_[5] = 6 * position - 3 * velocity + acceleration / 2;
}

CurvePoint SyncApproach::point(double x) const noexcept {
    return {c_[0] + x * (c_[1] + x * (c_[2] + x * (c_[3] + x * (c_[4] + x * c_[5])))),
            (c_[1] + x * (2 * c_[2] + x * (3 * c_[3] + x * (4 * c_[4] + x * 5 * c_[5])))) / length_,
            (2 * c_[2] + x * (6 * c_[3] + x * (12 * c_[4] + x * 20 * c_[5]))) / (length_ * length_)};
}

SyncApproach::Value SyncApproach::at(const EndlessMotion& master) const noexcept {
    const double x = part(master.place);
    if (x < 0) return {c_[0] + x * c_[1], c_[1] / length_ * master.velocity, c_[1] / length_ * master.acceleration};
    const auto p = point(std::min(x, 1.0));
    return {p.position, p.slope * master.velocity, p.slope * master.acceleration + p.curvature * master.velocity * master.velocity};
}

SyncApproach::Peaks SyncApproach::peaks(double master_velocity) const noexcept {
    constexpr int samples = 64;
    Peaks most;
    for (int i = 0; i <= samples; ++i) {
        const double x = static_cast<double>(i) / samples;
        const auto p = point(x);
        const double third = (6 * c_[3] + x * (24 * c_[4] + x * 60 * c_[5])) / (length_ * length_ * length_);
        most.jerk = std::max(most.jerk, std::abs(third * master_velocity * master_velocity * master_velocity));
        most.velocity = std::max(most.velocity, std::abs(p.slope * master_velocity));
        most.acceleration = std::max(most.acceleration, std::abs(p.curvature * master_velocity * master_velocity));
    }
    return most;
}

double choose_image(double image, double modulo, double natural, double sense, MC_SyncMode mode) noexcept {
    if (!(modulo > 0)) return image;
    const double turns = (natural - image) / modulo;
    switch (mode) {
        case mcShortest: return image + std::round(turns) * modulo;
        case mcCatchUp: return image + (sense < 0 ? std::floor(turns) : std::ceil(turns)) * modulo;
        case mcSlowDown: return image + (sense < 0 ? std::ceil(turns) : std::floor(turns)) * modulo;
    }
    return image;
}

double choose_sync_point(double point, double modulo, double master, double distance, double sense) noexcept {
    if (!(modulo > 0)) return point;
    const double turns = (sense * (master - point) + distance) / modulo;
    return point + sense * (std::floor(turns) + 1) * modulo;
}

}  // namespace taktwerk::axes
