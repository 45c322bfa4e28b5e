#pragma once
// A planned motion: a few pieces of constant jerk, evaluated exactly at any time. Plan on events, sample per cycle.

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "axes/planner/motion.hpp"

namespace taktwerk::axes {

/// One piece of motion: `acceleration` at its beginning, then constant `jerk` for `duration`. s, u/s2, u/s3.
/// Without a jerk limit the acceleration jumps from one stretch to the next; otherwise it continues. Without an acceleration limit the
/// velocity jumps as well, by `velocity_step` before the stretch; a stretch of no duration is such a jump alone. (Before a cruise it
/// takes the rounding errors of the velocity away.)
/// Without initial values: a search looks at dozens of motions, and their arrays are not to be filled with zeros each time.
struct Stretch {
    double duration;
    double acceleration;
    double jerk;
    double velocity_step;

    [[nodiscard]] double end_acceleration() const noexcept { return acceleration + duration * jerk; }
};

/// A motion from a start state to an end state. A value: trivially copyable, allocates nothing, real-time safe.
///
/// The pieces towards the end count back from the end state, so position, velocity and acceleration arrive at the target to
/// the last bit; start and target meet somewhere inside with an error of a few units in the last place.
class Profile {
public:
    /// Two to brake into the limits and seven for each of the two legs of a reversal; three more for a ramp appended.
    static constexpr int max_pieces = 19;

    /// Stands still at position 0.
    Profile() noexcept { pieces_[0] = {}; }

    /// Moves on with `state` from time 0, at its velocity, without acceleration.
    explicit Profile(const MotionState& state) noexcept;

    /// From `start` through `forward` (counted from the start) and then `backward` (counted back from `end`). Together at most
    /// max_pieces; what does not fit, or lasts no time, is left out. The two must meet: that is the planner's business.
    Profile(const MotionState& start, std::span<const Stretch> forward, std::span<const Stretch> backward, const MotionState& end) noexcept;

    /// Goes on with `next`, which begins in this profile's end state. False, and nothing done, where its pieces do not fit.
    bool append(const Profile& next) noexcept;

    /// The state `t` seconds after the start. At or before 0: the start state. At duration(): the end state, exactly. Later: moving on
    /// with the end's velocity, without acceleration (a move to rest holds its target exactly).
    [[nodiscard]] MotionState at(double t) const noexcept { return sample(t, 0).state; }

    struct Sample {
        MotionState state;
        double jerk = 0;  ///< from the right, u/s3; 0 from duration() on
        int piece = 0;    ///< where the search for a later time may begin
    };
    /// at(t) and jerk_at(t) in one. `from`: Sample::piece of an earlier time, or 0: who samples cycle by cycle does not search.
    [[nodiscard]] Sample sample(double t, int from) const noexcept {
        if (t == duration_) return {end_, 0, from};
        if (t > duration_) return {{end_.position + end_.velocity * (t - duration_), end_.velocity, 0}, 0, from};
        int i = from;
        while (t >= pieces_[static_cast<std::size_t>(i)].end_time) ++i;
        return {t > 0 ? on_piece(i, t) : start_, piece_jerk(i), i};
    }

    /// s, >= 0.
    [[nodiscard]] double duration() const noexcept { return duration_; }
    [[nodiscard]] const MotionState& start() const noexcept { return start_; }
    [[nodiscard]] const MotionState& end() const noexcept { return end_; }

    /// The jerk at `t`, from the right; 0 from duration() on. u/s3.
    [[nodiscard]] double jerk_at(double t) const noexcept { return sample(t, 0).jerk; }

    /// The largest velocity on the way in the sense 1 or -1, from the time `from` on; negative where it always goes the other way. u/s.
    [[nodiscard]] double top_velocity(double sense, double from = 0) const noexcept;
    /// The largest |velocity| on the way. u/s.
    [[nodiscard]] double max_speed() const noexcept { return std::max(top_velocity(1), top_velocity(-1)); }

    [[nodiscard]] int piece_count() const noexcept { return count_; }
    /// When piece i begins and ends, i in [0, piece_count()). s.
    [[nodiscard]] double piece_begin(int i) const noexcept { return i == 0 ? 0.0 : pieces_[static_cast<std::size_t>(i - 1)].end_time; }
    [[nodiscard]] double piece_end(int i) const noexcept { return pieces_[static_cast<std::size_t>(i)].end_time; }
    [[nodiscard]] double piece_jerk(int i) const noexcept { return pieces_[static_cast<std::size_t>(i)].jerk; }
    /// State on piece i at time t (meant for its begin and end, where without a jerk limit the neighbour's acceleration differs).
    [[nodiscard]] MotionState on_piece(int i, double t) const noexcept {
        const Piece& piece = pieces_[static_cast<std::size_t>(i)];
        return travel(piece.anchor(), piece.jerk, t - piece.anchor_time);
    }

private:
    struct Piece {
        double end_time;     // s since the start
        double anchor_time;  // where the anchor is known exactly: the piece's begin or its end
        double jerk;
        double position;  // of the anchor
        double velocity;
        double acceleration;

        [[nodiscard]] MotionState anchor() const noexcept { return {position, velocity, acceleration}; }
        void set_anchor(const MotionState& s) noexcept {
            position = s.position;
            velocity = s.velocity;
            acceleration = s.acceleration;
        }
    };

    [[nodiscard]] static MotionState travel(const MotionState& from, double jerk, double t) noexcept {
        return {from.position + t * (from.velocity + t * (from.acceleration / 2 + t * (jerk / 6))),
                from.velocity + t * (from.acceleration + t * (jerk / 2)), from.acceleration + t * jerk};
    }

    double duration_ = 0;
    int count_ = 0;
    MotionState start_;
    MotionState end_;
    std::array<Piece, max_pieces> pieces_;  // the first count_, and the first one always: a time before the start asks for it
};

}  // namespace taktwerk::axes
