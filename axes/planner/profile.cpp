#include "axes/planner/profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace taktwerk::axes {

Profile::Profile(const MotionState& state) noexcept : start_{state.position, state.velocity, 0}, end_{state.position, state.velocity, 0} {
    pieces_[0] = {};
}

Profile::Profile(const MotionState& start, std::span<const Stretch> forward, std::span<const Stretch> backward,
                 const MotionState& end) noexcept
    : start_{start}, end_{end} {
    pieces_[0] = {};
    MotionState state = start;
    for (const Stretch& s : forward) {
        state.velocity += s.velocity_step;
        if (!(s.duration > 0) || count_ == max_pieces) continue;
        state.acceleration = s.acceleration;
        pieces_[static_cast<std::size_t>(count_++)] = {duration_ + s.duration, duration_,      s.jerk,
                                                       state.position,         state.velocity, state.acceleration};
        state = travel(state, s.jerk, s.duration);
        duration_ += s.duration;
    }

    const int first_backward = count_;
    for (const Stretch& s : backward) {
        if (!(s.duration > 0) || count_ == max_pieces) continue;
        duration_ += s.duration;
        pieces_[static_cast<std::size_t>(count_++)] = {duration_, duration_, s.jerk, 0, 0, 0};
    }
    state = end;
    int i = count_;
    for (std::size_t k = backward.size(); k-- > 0 && i >= first_backward;) {
        const Stretch& s = backward[k];
        if (s.duration > 0) {
            if (--i < first_backward) break;
            // The acceleration arrives exactly where the last stretch leads to the end's; without a jerk limit it may end elsewhere.
            const double arrives = s.end_acceleration();
            const bool continues =
                std::abs(arrives - state.acceleration) <= 1e-12 * (std::abs(s.acceleration) + std::abs(s.duration * s.jerk));
            if (!continues || s.jerk == 0) state.acceleration = arrives;
            pieces_[static_cast<std::size_t>(i)].set_anchor(state);
            state = travel(state, s.jerk, -s.duration);
        }
        state.velocity -= s.velocity_step;
    }
}

bool Profile::append(const Profile& next) noexcept {
    if (count_ + next.count_ > max_pieces) return false;
    for (int i = 0; i < next.count_; ++i) {
        Piece piece = next.pieces_[static_cast<std::size_t>(i)];
        piece.end_time += duration_;
        piece.anchor_time += duration_;
        pieces_[static_cast<std::size_t>(count_++)] = piece;
    }
    duration_ += next.duration_;
    end_ = next.end_;
    return true;
}

double Profile::top_velocity(double sense, double from) const noexcept {
    double speed = std::max(sense * at(from).velocity, sense * end_.velocity);
    for (int i = 0; i < count_; ++i) {
        const double begin = std::max(piece_begin(i), from);
        const double end = piece_end(i);
        if (end <= from) continue;
        speed = std::max(speed, sense * on_piece(i, end).velocity);
        const Piece& piece = pieces_[static_cast<std::size_t>(i)];
        if (piece.jerk == 0) continue;
        const double top = piece.anchor_time - piece.acceleration / piece.jerk;  // where the acceleration is 0
        if (top > begin && top < end) speed = std::max(speed, sense * on_piece(i, top).velocity);
    }
    return speed;
}

}  // namespace taktwerk::axes
