#pragma once
// The path of a measurement before it begins: where the axis will go, how fast, for how long; or why it will not. A pure function, real-time
// safe: the service side shows it, the cycle decides by it.

#include <cstddef>
#include <cstdint>
#include <limits>

#include "axes/excitation/measure_order.hpp"

namespace taktwerk::axes {

/// What the axis allows now. u, u/s, u/s2, u/s3, s.
struct ExcitationBounds {
    double start = 0;                                            ///< where it stands
    double velocity = 0;                                         ///< limit of the axis and of the mode
    double usual_velocity = 0;                                   ///< for who names none: the slow jogging speed
    double acceleration = 0;                                     ///< in whichever direction it is least, deceleration included
    double stop = 0;                                             ///< deceleration of a stop
    double jerk = 0;                                             ///< infinity = none
    double stop_jerk = std::numeric_limits<double>::infinity();  ///< of a stop, where it is less
    double position_min = -std::numeric_limits<double>::infinity();
    double position_max = std::numeric_limits<double>::infinity();
    double revolution = 0;  ///< u per turn of the motor; 0 = unknown
    double cycle = 0;       ///< s
};

enum class ExcitationRefusal : std::uint8_t {
    none,
    no_kind,       ///< there is no such measurement
    bad_number,    ///< negative, not finite
    below_limit,   ///< its path would pass position_min; `needed` u are needed, `room` u are there
    above_limit,   ///< likewise position_max
    too_short,     ///< `needed` u of distance until there is something to measure
    too_long,      ///< it would take `duration` s
    frequency,     ///< from_hz, to_hz: not rising, or above `needed` Hz
    too_many,      ///< more than `needed` repetitions
    no_velocity,   ///< the override leaves none
    short_period,  ///< cogging: `needed` u at this velocity
};

/// One move of a plan.
struct ExcitationLeg {
    double target = 0, velocity = 0, acceleration = 0;
    double rest = 0;  ///< s, afterwards
};
/// One tone of a plan.
struct ExcitationTone {
    double frequency = 0;  ///< Hz
    double amplitude = 0;  ///< u
    double rise = 0;       ///< s, to the full amplitude, and back
    double settle = 0;     ///< s, of hold, until the answer has forgotten the rise
    double hold = 0;       ///< s
};

class ExcitationPlan {
public:
    static constexpr double share = 0.9;    ///< of each limit, at most
    static constexpr double longest = 300;  ///< s
    static constexpr std::uint16_t most_count = 200;
    static constexpr double settle = 0.3;         ///< s of rest after a move
    static constexpr double highest_share = 0.2;  ///< of the cycle's frequency that a sweep reaches

    ExcitationPlan() = default;
    ExcitationPlan(const MeasureOrder& order, const ExcitationBounds& bounds) noexcept;

    [[nodiscard]] ExcitationRefusal refusal() const noexcept { return refusal_; }
    /// The order with every number that it left open.
    [[nodiscard]] const MeasureOrder& order() const noexcept { return order_; }
    [[nodiscard]] const ExcitationBounds& bounds() const noexcept { return bounds_; }
    [[nodiscard]] double lowest() const noexcept { return lowest_; }    ///< u
    [[nodiscard]] double highest() const noexcept { return highest_; }  ///< u
    [[nodiscard]] double margin() const noexcept { return margin_; }    ///< u: must be free beyond both
    [[nodiscard]] double jerk() const noexcept { return jerk_; }
    [[nodiscard]] double duration() const noexcept { return duration_; }  ///< s, nearly
    [[nodiscard]] double needed() const noexcept { return needed_; }
    [[nodiscard]] double room() const noexcept { return room_; }

    [[nodiscard]] bool of_tones() const noexcept { return order_.kind == MeasureKind::sweep; }
    [[nodiscard]] std::size_t legs() const noexcept;
    /// `i` below legs().
    [[nodiscard]] ExcitationLeg leg(std::size_t i) const noexcept;
    [[nodiscard]] ExcitationTone tone(std::size_t i) const noexcept;

private:
    void fill_in() noexcept;
    [[nodiscard]] bool usable() noexcept;
    void measure_path() noexcept;
    [[nodiscard]] double time_of_move(double way, double velocity, double acceleration) const noexcept;
    [[nodiscard]] double way_of_ramps(double velocity, double acceleration) const noexcept;
    [[nodiscard]] double start_of(double velocity) const noexcept;
    [[nodiscard]] double reach(std::size_t pair, double velocity) const noexcept;

    MeasureOrder order_;
    ExcitationBounds bounds_;
    ExcitationRefusal refusal_ = ExcitationRefusal::no_kind;
    double lowest_ = 0, highest_ = 0, margin_ = 0, jerk_ = 0, duration_ = 0, needed_ = 0, room_ = 0;
};

}  // namespace taktwerk::axes
