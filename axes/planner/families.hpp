#pragma once
// The two families of extremal motions, each a curve with one parameter (mathematics.md says why these are all). Internal to the
// planner. Both are written for a push upwards; mirroring and reversing time give the others.

#include "axes/planner/bracketed_root.hpp"
#include "axes/planner/measured_climb.hpp"
#include "axes/planner/motion_frame.hpp"
#include "axes/planner/ramp.hpp"

namespace taktwerk::axes {

/// A root that was found: parameter, time at constant velocity, total time.
struct Found {
    bool found = false;
    double parameter = 0;
    double cruise = 0;
    double duration = std::numeric_limits<double>::infinity();
    int looked_at = 0;  ///< members of the family
};

/// Climb to a highest velocity c, where the acceleration is 0, cruise there if c is the limit, and descend to the end. The parameter is
/// the acceleration x that a climb from rest by c - c0 peaks at, c0 being the higher of the released velocities of both ends: near c0 the
/// way is then linear in x or of third order. Without a jerk limit it is c - c0 itself.
class PeakFamily {
public:
    explicit PeakFamily(const Problem& problem) noexcept;

    /// Both halves for one parameter. The second half runs in the frame mirrored and reversed, in which it climbs too.
    struct Motion {
        Ramp up;
        Ramp back;
        double peak_velocity;
    };
    [[nodiscard]] Motion at(double x) const noexcept;
    /// The parameter of the last member, which reaches the velocity limit.
    [[nodiscard]] double widest() const noexcept { return widest_; }

    /// The end of the first half and the beginning of the second are one stretch, unless both are jumps.
    [[nodiscard]] bool falls_gradually() const noexcept { return problem_.limits.down.ease > 0; }

    /// What at(x) comes to.
    struct Measured {
        MeasuredClimb up;
        MeasuredClimb back;
        double peak_velocity;
        [[nodiscard]] double travel() const noexcept { return up.travel + back.travel; }
        [[nodiscard]] double path() const noexcept { return up.path + back.path; }
        [[nodiscard]] double duration() const noexcept { return up.duration + back.duration; }
    };
    [[nodiscard]] Measured measured(double x) const noexcept;

    /// The fastest motion over the problem's way, if it takes less than `longest`: the first member whose way grows through it. The way is
    /// known to `known_to`: a member that misses it by no more will do.
    [[nodiscard]] Found over_way(double known_to, double longest) const noexcept;
    /// The motion that takes `time`: it goes further up than any other of that duration.
    /// A time outside the family's by no more than `slack` is taken for its end.
    [[nodiscard]] Found in_time(double time, double slack) const noexcept;

private:
    /// The highest velocity that belongs to x; square: of x.
    struct Top {
        double velocity;
        double square;
    };
    [[nodiscard]] Top top(double x) const noexcept {
        if (x != widest_) return {floor_velocity_ + excess(x), ease_ > 0 ? x * x : x};
        const double velocity = std::max(problem_.limits.up.velocity, floor_velocity_);
        return {velocity, square_of(velocity - floor_velocity_)};
    }
    /// A climb from one of the ends: what does not depend on x.
    struct End {
        double v = 0;
        double a = 0;
        double lowest = 0;
        double held_square = 0;  ///< a^2 where a > 0
        double square = 0;       ///< x^2 of a climb from the released velocity to c0
    };
    [[nodiscard]] static Climb climb(const End& end, const Top& top) noexcept {
        const double square = end.square + top.square;
        return {end.v, end.a, top.velocity, 0, end.lowest, square + end.held_square, square};
    }
    [[nodiscard]] End end_at(double v, double a, double released, double excess) const noexcept;

    [[nodiscard]] double excess(double x) const noexcept { return ease_ > 0 ? x * (x * ease_ / 2) : x; }
    /// Without a jerk limit the parameter is the gain of velocity itself, and stands for its square.
    [[nodiscard]] double square_of(double excess) const noexcept { return excess * square_per_excess_; }
    [[nodiscard]] double parameter(double excess) const noexcept { return ease_ > 0 ? std::sqrt(square_of(excess)) : excess; }
    [[nodiscard]] double excess_slope(double x) const noexcept { return ease_ > 0 ? x * ease_ : 1; }
    [[nodiscard]] double way_slope(double x, const Measured& m) const noexcept;
    /// Both ends.
    [[nodiscard]] bool at_rest() const noexcept { return start_.v == 0 && start_.a == 0 && end_.v == 0 && end_.a == 0; }
    struct Step {
        double guess;
        double enough;
    };
    [[nodiscard]] Step step_over(double missing) const noexcept;
    [[nodiscard]] double looked_up(double guess, double low, double high) const noexcept;

    const Problem& problem_;
    FrameLimits back_limits_;
    End start_;
    End end_;                    // backwards in time
    double floor_velocity_ = 0;  // c0
    double ease_ = 0;            // of rise and fall together
    double square_per_excess_ = 1;
    double widest_ = 0;  // x at the velocity limit
};

/// For an end with acceleration a1 > 0 that is reached without ever losing all of it: climb over a peak, fall to a trough t >= 0, rise
/// to a1. The parameter is a1 - t; the duration grows with it.
class TroughFamily {
public:
    explicit TroughFamily(const Problem& problem) noexcept;

    [[nodiscard]] bool exists() const noexcept { return exists_; }
    /// The parameter of the last member, whose trough is the lowest.
    [[nodiscard]] double widest() const noexcept { return widest_; }

    struct Motion {
        Ramp up;
        Stretch last;
        double trough;
        double last_travel;
        [[nodiscard]] double travel() const noexcept { return up.travel() + last_travel; }
        [[nodiscard]] double path() const noexcept { return up.path() + std::abs(last_travel); }
        [[nodiscard]] double duration() const noexcept { return up.duration() + last.duration; }
    };
    [[nodiscard]] Motion at(double u) const noexcept;

    [[nodiscard]] Found over_way(double known_to, double longest) const noexcept;
    [[nodiscard]] Found in_time(double time, double slack) const noexcept;

    /// d way / d time along the family: falls and then rises with the parameter's trough.
    [[nodiscard]] double rate(const Motion& m) const noexcept;

private:
    [[nodiscard]] double time_slope(const Motion& m) const noexcept;
    [[nodiscard]] double slowest_trough() const noexcept;
    [[nodiscard]] double holding_trough() const noexcept;

    const Problem& problem_;
    double square_ = 0;  // peak^2 - trough^2
    double widest_ = 0;
    bool exists_ = false;
};

}  // namespace taktwerk::axes
