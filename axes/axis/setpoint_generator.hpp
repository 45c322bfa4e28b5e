#pragma once
// Where the set-point is now and where it goes. Advances in motion time: exactly one period per call.
//
// Two layers, each with a profile of its own. The base is the motion of the axis' command; a superimposed motion adds its contribution
// and takes nothing from the base, whose times stay what they are (P1-155). What a superimposed motion has covered stays as an offset between base
// and total until somebody folds it into the base. Without it the two are the same and cost nothing more.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "axes/planner/plan.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

class SetpointGenerator {
public:
    /// What the drive gets.
    [[nodiscard]] const MotionState& state() const noexcept { return state_; }
    /// Without what is superimposed: the coordinates of the command's goal.
    [[nodiscard]] const MotionState& base() const noexcept { return layered_ ? base_ : state_; }
    /// The part superimposed, in u from where it was folded last.
    [[nodiscard]] MotionState superimposed() const noexcept { return layered_ ? contribution() : MotionState{}; }
    [[nodiscard]] bool layered() const noexcept { return layered_; }
    [[nodiscard]] double jerk() const noexcept { return layered_ ? jerk_ + layer_.jerk_at(to_seconds(layer_elapsed_)) : jerk_; }

    // --- the base --------------------------------------------------------------------------------------------------------
    /// Stands at `position`, without any profile.
    void place(double position) noexcept {
        layered_ = false;
        set({position, 0, 0});
    }
    /// The same motion seen from another anchor: every position is `delta` more, the base's is `position`. A profile must follow before the
    /// next advance() where it moves.
    void rebase(double position) noexcept {
        const double delta = position - base().position;
        if (layered_) {
            base_.position = position;
            state_.position += delta;
        } else state_.position = position;
        moving_profile_ = false;
        jerk_ = 0;
    }
    /// Where something else than a profile (a master, a table over time, a fed set-point, the motor itself) has taken the base this cycle.
    void set(const MotionState& base, double jerk = 0) noexcept {
        moving_profile_ = false;
        jerk_ = jerk;
        set_base(base);
    }
    /// Takes the total as it was before the last advance(), without layers; a profile must follow.
    void restore(const MotionState& total) noexcept {
        layered_ = false;
        set(total);
    }
    /// `profile` begins at base(), `late` seconds ago.
    void run(const Profile& profile, double late = 0) noexcept {
        profile_ = profile;
        offset_ = late;
        elapsed_ = Duration{};
        time_ = late;
        piece_ = 0;
        moving_profile_ = true;
    }
    /// One period on.
    void advance(Duration period) noexcept {
        elapsed_ += period;
        time_ = offset_ + to_seconds(elapsed_);
        advance_superimposed(period);
        sample();
    }
    /// The same where there is nothing but the base.
    void advance_base(Duration period) noexcept {
        elapsed_ += period;
        time_ = offset_ + to_seconds(elapsed_);
        if (!moving_profile_) return;
        const auto now = profile_.sample(time_, piece_);
        piece_ = now.piece;
        jerk_ = now.jerk;
        state_ = now.state;
    }
    /// Takes the present time of the profile again, after run(profile, late).
    void sample() noexcept {
        if (moving_profile_) {
            const auto now = profile_.sample(time_, piece_);
            piece_ = now.piece;
            jerk_ = now.jerk;
            set_base(now.state);
        } else if (layered_) set_base(base_);
    }
    /// The profile has reached its end state (a velocity profile then moves on).
    [[nodiscard]] bool finished() const noexcept { return !moving_profile_ || time_ >= profile_.duration(); }
    /// Seconds since the profile reached its end; only when finished().
    [[nodiscard]] double overtime() const noexcept { return moving_profile_ ? time_ - profile_.duration() : 0.0; }
    [[nodiscard]] const MotionState& end() const noexcept { return moving_profile_ ? profile_.end() : base(); }
    /// The base goes to the profile's end state: where the next command of a queue begins.
    void go_to_end() noexcept { set_base(end()); }
    /// The total has neither velocity nor acceleration.
    [[nodiscard]] bool rests() const noexcept { return rests(state_); }
    /// Neither layer moves.
    [[nodiscard]] bool at_rest() const noexcept {
        if (!layered_) return rests(state_);
        return rests(base_) && rests(contribution());
    }
    /// Largest velocity that the base is going to have in the sense 1 or -1, u/s.
    [[nodiscard]] double base_speed(double sense) const noexcept {
        return finished() ? sense * base().velocity : profile_.top_velocity(sense, time_);
    }

    /// The hardest that the base has from here on: magnitudes, u/s2 and u/s3.
    struct Ramps {
        double acceleration = 0, jerk = 0;
    };
    [[nodiscard]] Ramps base_ramps() const noexcept {
        Ramps most{std::abs(base().acceleration), moving_profile_ ? 0.0 : std::abs(jerk_)};
        if (finished()) return most;
        for (int i = piece_; i < profile_.piece_count(); ++i) {
            most.jerk = std::max(most.jerk, std::abs(profile_.piece_jerk(i)));
            const double begin = std::max(profile_.piece_begin(i), time_);
            for (const double at : {begin, std::max(begin, profile_.piece_end(i))})
                most.acceleration = std::max(most.acceleration, std::abs(profile_.on_piece(i, at).acceleration));
        }
        return most;
    }

    // --- the superimposed layer ------------------------------------------------------------------------------------------
    /// `profile` begins at superimposed().
    void superimpose(const Profile& profile) noexcept {
        if (!layered_) base_ = state_;
        layered_ = true;
        layer_ = profile;
        layer_elapsed_ = Duration{};
        layer_origin_ = 0;  // what was folded is out of the contribution, and so out of the profile's coordinates
    }
    /// Way since the last superimpose(), u.
    [[nodiscard]] double superimposed_way() const noexcept {
        return layered_ ? layer_.at(to_seconds(layer_elapsed_)).position - layer_.start().position : 0.0;
    }
    /// For a base that is set in each cycle: before set().
    void advance_superimposed(Duration period) noexcept {
        if (layered_) layer_elapsed_ += period;
    }
    [[nodiscard]] bool superimposed_finished() const noexcept { return !layered_ || to_seconds(layer_elapsed_) >= layer_.duration(); }
    /// Largest velocity that the contribution has or is going to have in the sense 1 or -1, u/s; 0 when it is over.
    [[nodiscard]] double superimposed_top(double sense) const noexcept {
        return superimposed_finished() ? 0.0 : std::max(0.0, layer_.top_velocity(sense, to_seconds(layer_elapsed_)));
    }
    /// The contribution moved already before the last advance() by `period`.
    [[nodiscard]] bool superimposed_has_moved(Duration period) const noexcept {
        return layered_ && (layer_elapsed_ > period || !rests(layer_.start()));
    }
    /// How far the contribution still goes, u.
    [[nodiscard]] double superimposed_rest() const noexcept {
        return layered_ ? layer_.end().position - layer_.at(to_seconds(layer_elapsed_)).position : 0.0;
    }
    /// The way covered so far becomes part of the base; what still moves goes on. A profile of the base must follow where it moves. Returns the way.
    double fold_covered() noexcept {
        if (!layered_) return 0;
        const double covered = contribution().position;
        layer_origin_ += covered;
        base_.position = state_.position;
        moving_profile_ = false;
        if (superimposed_finished()) layered_ = false;
        return covered;
    }
    /// One motion again: the total. A profile must follow where it moves.
    void fold() noexcept {
        if (!layered_) return;
        layered_ = moving_profile_ = false;
        jerk_ = 0;
    }

private:
    /// Both are 0 or -0: asked in every cycle, and the comparison of bits is half of that of numbers.
    [[nodiscard]] static bool rests(const MotionState& state) noexcept {
        const auto bits = std::bit_cast<std::uint64_t>(state.velocity) | std::bit_cast<std::uint64_t>(state.acceleration);
        return bits << 1 == 0;
    }
    [[nodiscard]] MotionState contribution() const noexcept {
        auto part = layer_.at(to_seconds(layer_elapsed_));
        part.position -= layer_origin_;
        return part;
    }
    void set_base(const MotionState& base) noexcept {
        if (!layered_) {
            state_ = base;
            return;
        }
        base_ = base;
        const auto part = contribution();
        state_ = {base.position + part.position, base.velocity + part.velocity, base.acceleration + part.acceleration};
    }

    MotionState state_;
    double jerk_ = 0;  // of the base
    Duration elapsed_{};
    double offset_ = 0;
    double time_ = 0;  // s, of the profile: both together
    int piece_ = 0;    // of the profile, at that time
    bool moving_profile_ = false;
    bool layered_ = false;
    Profile profile_;

    MotionState base_;  // only while layered
    Profile layer_;
    Duration layer_elapsed_{};
    double layer_origin_ = 0;  // of the layer's profile: what has been folded
};

}  // namespace taktwerk::axes
