#pragma once
// A motion given over time by a table: what MC_PositionProfile, MC_VelocityProfile and MC_AccelerationProfile follow. Made once, when the
// command begins, from the table and the state of that moment; afterwards the table may be edited, the running motion keeps its own.
//
//   position      cubic spline through the points: position, velocity and acceleration are continuous, from the state at the start (also
//                 a moving one) to rest at the last point. Two knots of its own, inside the first and the last interval, take up the
//                 conditions at the ends (Biagiotti, Melchiorri: Trajectory Planning, 4.4.4).
//   velocity      straight lines from the velocity at the start through the points; then the last velocity is kept.
//   acceleration  steps: the value of a row holds while its time runs; then acceleration 0, the velocity reached is kept.
//
// In all three each piece has a constant jerk, so it is evaluated exactly and its extremes are known in closed form.

#include <cstddef>
#include <span>
#include <vector>

#include "axes/planner/motion.hpp"
#include "axes/tables/motion_tables.hpp"
#include "axes/words/types.hpp"

namespace taktwerk::axes {

/// value(t) = value * table(t / time) + offset.
struct CurveScale {
    double time = 1;  ///< > 0
    double value = 1;
    double offset = 0;  ///< u, u/s, u/s2
    double behind = 0;  ///< s of the table: the rows up to there are left out, the next one keeps the rest of its time
};

/// What the curve must keep. Tables of velocities and accelerations have corners: their jerk is not limited.
struct CurveLimits {
    MotionLimits motion;
    double position_min, position_max;  ///< u, local
    double forward = motion.velocity,
           backward = motion.velocity;  ///< u/s, >= 0, in each sense: less where something else moves the axis too
};

class TimeCurve {
public:
    /// Room for tables of so many rows. Not real-time.
    void reserve(std::size_t rows);

    // Real-time safe, linear in the rows. Errors: invalid_table (no rows, too many, times that do not rise, a number that is not finite),
    // invalid_position and invalid_velocity (a first row without time that is not where the axis is, within `tolerance`).
    [[nodiscard]] ErrorId make_position(const MotionState& from, std::span<const TimePoint> table, const CurveScale& scale,
                                        double tolerance) noexcept;
    [[nodiscard]] ErrorId make_velocity(const MotionState& from, std::span<const TimePoint> table, const CurveScale& scale,
                                        double tolerance) noexcept;
    [[nodiscard]] ErrorId make_acceleration(const MotionState& from, std::span<const TimePoint> table, const CurveScale& scale) noexcept;

    /// Over the whole curve: invalid_velocity, invalid_dynamics, beyond_software_limit. Where the direction turns inside a piece the lower
    /// one of acceleration and deceleration holds for the piece. Real-time safe, linear.
    [[nodiscard]] ErrorId check(const CurveLimits& limits) const noexcept;

    /// s
    [[nodiscard]] double duration() const noexcept { return duration_; }
    [[nodiscard]] const MotionState& end() const noexcept { return end_; }
    /// Largest velocity that is still to come in the sense 1 or -1 after the last at(), u/s. Cheap, for every cycle.
    [[nodiscard]] double top_velocity(double sense) const noexcept;
    /// `t` must not fall from call to call. After duration(): moving on at the end's velocity. Real-time safe.
    [[nodiscard]] MotionState at(double t) noexcept;
    [[nodiscard]] double jerk_at(double t) noexcept;

private:
    struct Piece {
        double begin = 0, duration = 0;  // s
        MotionState start;
        double jerk = 0;
        double top_behind = 0, low_behind = 0;  // u/s, largest and smallest velocity from its end on
    };
    void note_tops() noexcept;
    void clear() noexcept;
    void add(double duration, const MotionState& start, double jerk) noexcept;
    void seek(double t) noexcept;
    [[nodiscard]] static double top_of(const Piece& piece, double sense) noexcept;
    [[nodiscard]] ErrorId check_piece(const Piece& piece, const CurveLimits& limits) const noexcept;

    std::vector<Piece> pieces_;
    std::vector<double> diagonal_, right_;  // of the spline's equations
    std::size_t room_ = 0, cursor_ = 0;
    double duration_ = 0;
    double asked_ = 0;  // s, of the last at()
    MotionState end_;
    bool smooth_ = false;
};

}  // namespace taktwerk::axes
