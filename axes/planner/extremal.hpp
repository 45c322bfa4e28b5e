#pragma once
// A member of one of the six extremal curves, in the coordinates of the problem. Internal to the planner.

#include <array>
#include <cstddef>
#include <span>

#include "axes/planner/families.hpp"
#include "axes/planner/motion_frame.hpp"
#include "axes/planner/profile.hpp"

namespace taktwerk::axes {

/// Stretches in order, at most what a profile takes.
class Chain {
public:
    [[nodiscard]] std::span<const Stretch> stretches() const noexcept { return {items_.data(), count_}; }
    void clear() noexcept { count_ = 0; }
    /// `sign` mirrors it. A stretch that neither lasts nor jumps is left out.
    void add(Stretch s, double sign) noexcept {
        if ((!(s.duration > 0) && s.velocity_step == 0) || count_ == items_.size()) return;
        items_[count_++] = {s.duration, sign * s.acceleration, sign * s.jerk, sign * s.velocity_step};
    }
    /// Takes over the first stretch of `next` where it goes on with the same jerk from where this chain ends.
    void join(Chain& next) noexcept {
        if (count_ == 0 || next.count_ == 0) return;
        Stretch& last = items_[count_ - 1];
        const Stretch& first = next.items_[0];
        if (last.jerk != first.jerk || first.jerk == 0 || first.velocity_step != 0) return;
        last.duration += first.duration;
        for (std::size_t i = 1; i < next.count_; ++i) next.items_[i - 1] = next.items_[i];
        --next.count_;
    }

private:
    std::array<Stretch, Profile::max_pieces> items_;  // the first count_
    std::size_t count_ = 0;
};

/// The part counted from the start and the part counted back from the end.
struct Motion {
    Chain forward;
    Chain backward;

    void clear() noexcept {
        forward.clear();
        backward.clear();
    }
};

enum class Curve : unsigned char { peak_up, peak_down, trough_up, trough_down, early_trough_up, early_trough_down };

struct Extremal {
    Curve curve = Curve::peak_up;
    Found found;
};

/// Can the motion begin, or end, with any acceleration taken away inside the limits? Where it cannot, only motions come into question whose
/// acceleration keeps its sign.
struct Ends {
    bool start_releases = true;
    bool end_releases = true;
};

struct FastestMotion {
    Found found;
    Motion motion;
};

/// The fastest motion over the problem's way, known to `rounding`. Always found where both ends release.
[[nodiscard]] FastestMotion fastest(const Problem& problem, double rounding, const Ends& ends) noexcept;

/// The motion of duration `time` whose way is the longest of all, or the shortest. Times known to `slack`.
[[nodiscard]] Extremal furthest(const Problem& problem, double time, double slack) noexcept;
[[nodiscard]] Extremal least_far(const Problem& problem, double time, double slack) noexcept;

/// Its stretches.
[[nodiscard]] Motion motion_of(const Problem& problem, const Extremal& extremal) noexcept;

/// Appends a climb of the frame that is mirrored by `sign`, then runs forwards; or, for a climb of the mirrored and reversed
/// frame (the second half of a peak), the descent it is in forward time.
void add_climb(Chain& chain, const Ramp& ramp, double sign) noexcept;
void add_descent(Chain& chain, const Ramp& back, double sign) noexcept;

}  // namespace taktwerk::axes
