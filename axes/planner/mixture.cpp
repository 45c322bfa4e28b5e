#include "axes/planner/mixture.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {

namespace {

/// Walks along the stretches of a motion.
class Walk {
public:
    explicit Walk(const Motion& motion) noexcept : parts_{motion.forward.stretches(), motion.backward.stretches()} { settle(); }

    [[nodiscard]] bool done() const noexcept { return part_ == 2; }
    /// What is left of the present stretch, s; jumps of velocity passed since the last call are collected in `step`.
    [[nodiscard]] double left() const noexcept { return stretch().duration - inside_; }
    [[nodiscard]] double acceleration() const noexcept { return stretch().acceleration + inside_ * stretch().jerk; }
    [[nodiscard]] double jerk() const noexcept { return stretch().jerk; }
    [[nodiscard]] double take_step() noexcept {
        const double step = step_;
        step_ = 0;
        return step;
    }
    void go(double t) noexcept { inside_ += t; }
    void next() noexcept {
        inside_ = 0;
        ++index_;
        settle();
    }

private:
    [[nodiscard]] const Stretch& stretch() const noexcept { return parts_[part_][index_]; }
    void settle() noexcept {
        while (part_ < 2) {
            if (index_ == parts_[part_].size()) {
                ++part_;
                index_ = 0;
                continue;
            }
            step_ += stretch().velocity_step;
            if (stretch().duration > 0) return;
            ++index_;
        }
    }

    std::array<std::span<const Stretch>, 2> parts_;
    std::size_t part_ = 0;
    std::size_t index_ = 0;
    double inside_ = 0;
    double step_ = 0;
};

struct VelocityRange {
    double low;
    double high;
};

VelocityRange velocities(double v, const Motion& motion) noexcept {
    VelocityRange range{v, v};
    const auto see = [&](double x) noexcept { range = {std::min(range.low, x), std::max(range.high, x)}; };
    for (const auto& part : {motion.forward.stretches(), motion.backward.stretches()}) {
        for (const Stretch& s : part) {
            v += s.velocity_step;
            see(v);
            if (!(s.duration > 0)) continue;
            const double flat = s.jerk != 0 ? -s.acceleration / s.jerk : 0;  // where the acceleration passes 0
            if (flat > 0 && flat < s.duration) see(v + flat * s.acceleration / 2);
            v += s.duration * (s.acceleration + s.duration * (s.jerk / 2));
            see(v);
        }
    }
    return range;
}

}  // namespace

Walked walk(double v, const Motion& motion) noexcept {
    Walked walked{0, 0, std::abs(v)};
    for (const auto& part : {motion.forward.stretches(), motion.backward.stretches()}) {
        for (const Stretch& s : part) {
            v += s.velocity_step;
            if (!(s.duration > 0)) continue;
            const double way = s.duration * (v + s.duration * (s.acceleration / 2 + s.duration * (s.jerk / 6)));
            walked.travel += way;
            walked.path += std::abs(way);
            v += s.duration * (s.acceleration + s.duration * (s.jerk / 2));
            walked.top = std::max(walked.top, std::abs(v));
        }
    }
    return walked;
}

bool keeps_direction(double v0, const Motion& a, const Motion& b) noexcept {
    const VelocityRange x = velocities(v0, a);
    const VelocityRange y = velocities(v0, b);
    const double slack = 1e-12 * std::max({-x.low, x.high, -y.low, y.high});
    return std::min(x.low, y.low) >= -slack || std::max(x.high, y.high) <= slack;
}

Motion mixture(const Motion& a, const Motion& b, double share) noexcept {
    Chain all;
    Walk x{a};
    Walk y{b};
    while (!x.done() && !y.done()) {
        const double t = std::min(x.left(), y.left());
        const bool x_ends = x.left() <= t;
        const bool y_ends = y.left() <= t;
        const double step = (1 - share) * x.take_step() + share * y.take_step();
        all.add({t, (1 - share) * x.acceleration() + share * y.acceleration(), (1 - share) * x.jerk() + share * y.jerk(), step}, 1);
        if (x_ends) x.next();
        else x.go(t);
        if (y_ends) y.next();
        else y.go(t);
    }
    all.add({0, 0, 0, (1 - share) * x.take_step() + share * y.take_step()}, 1);

    // The second half counts back from the end.
    Motion mixed;
    const auto stretches = all.stretches();
    for (std::size_t i = 0; i < stretches.size(); ++i) (i < stretches.size() / 2 ? mixed.forward : mixed.backward).add(stretches[i], 1);
    return mixed;
}

}  // namespace taktwerk::axes
