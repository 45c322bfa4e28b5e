#pragma once
// The way to a sync point as a function of the master's position: a polynomial of fifth order from the slave's state to the position,
// slope and curvature that the relation has at the sync point. Because the master's position drives it, it meets the point
// however the master's velocity changes. Real-time safe.

#include <cstdint>

#include "axes/coupling/endless.hpp"
#include "axes/words/types.hpp"

namespace taktwerk::axes {

/// A point of a curve over the master's position: u, u/u, u/u2.
struct CurvePoint {
    double position = 0, slope = 0, curvature = 0;
};

/// What a motion is as a curve over a master that moves: nothing but the position where the master stands (|velocity| too small).
[[nodiscard]] CurvePoint as_curve(const EndlessMotion& slave, double position, double master_velocity, double master_acceleration) noexcept;

class SyncApproach {
public:
    SyncApproach() noexcept = default;
    /// From `begin` at the master's place `start` to `end` at `length` u further (signed, not 0).
    void set(const EndlessPlace& start, double master_feed, double length, const CurvePoint& begin, const CurvePoint& end) noexcept;

    /// The slave's position [u, as in the points] and its motion. Before the start: the tangent there; behind the end: the end.
    struct Value {
        double position = 0, velocity = 0, acceleration = 0;
    };
    [[nodiscard]] Value at(const EndlessMotion& master) const noexcept;
    [[nodiscard]] bool passed(const EndlessPlace& master) const noexcept { return part(master) >= 1; }

    /// Largest velocity, acceleration and jerk of the slave, were the master to keep `master_velocity`. From 64 samples: within 1 % or so.
    struct Peaks {
        double velocity = 0, acceleration = 0, jerk = 0;
    };
    [[nodiscard]] Peaks peaks(double master_velocity) const noexcept;

private:
    [[nodiscard]] double part(const EndlessPlace& master) const noexcept { return way(start_, master, feed_) / length_; }
    [[nodiscard]] CurvePoint point(double part) const noexcept;

    EndlessPlace start_;
    double feed_ = 1, length_ = 1;
    double c_[6] = {};  // over the part of the way, 0..1
};

/// Which of the places `image + k * modulo` a slave goes to that would be at `natural` if it did not hurry: the nearest (shortest), the
/// next one ahead in the sense of `sense` (catch up), the last one behind (slow down). modulo 0: `image` itself.
[[nodiscard]] double choose_image(double image, double modulo, double natural, double sense, MC_SyncMode mode) noexcept;

/// The first place `point + k * modulo` that lies more than `distance` (>= 0) ahead of `master` in the sense of `sense` (1 or -1).
/// modulo 0: `point` itself.
[[nodiscard]] double choose_sync_point(double point, double modulo, double master, double distance, double sense) noexcept;

}  // namespace taktwerk::axes
