#pragma once
// A slave on its master: relation + a difference that runs down, inside the slave's limits. One per axis, real-time safe.
//
// However a coupling begins, changes or is disturbed, the slave goes on from the state it has: what it lacks becomes the difference
// motion, which runs down to nothing. A gear first catches up with the velocity (catch_up.hpp) and the distance lost stays lost; then it
// is locked by place too, and what holds the slave back afterwards is made up. In sync means: no difference left.
//
// The slave's own limits are kept in every cycle: a relation that asks for more velocity or acceleration (a straight cam with corners,
// a master too fast) is not followed further than they allow; the slave falls behind, is not in sync, and makes it up. So |velocity|
// stays below the limit, and its change in a cycle below acceleration times period, whatever the master does.
//
// What the slave makes up is planned from the acceleration that it has itself, towards a relation that keeps its own as far as
// the slave can follow that, and again as soon as the relation does otherwise: an acceleration that the master had is none that the slave
// would have to take away.

#include <algorithm>
#include <cstdint>
#include <variant>

#include "axes/coupling/cam_curve.hpp"
#include "axes/coupling/catch_up.hpp"
#include "axes/coupling/difference.hpp"
#include "axes/coupling/follower_limits.hpp"
#include "axes/coupling/gear_line.hpp"
#include "axes/coupling/gear_sum.hpp"
#include "axes/coupling/sync_approach.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// The slave's own coordinates: local u from its anchor (axes/axis/units.hpp).
struct SlaveFrame {
    std::int64_t anchor = 0;  ///< feeds
    double feed = 1;          ///< u
    [[nodiscard]] double local(const EndlessPlace& place) const noexcept {
        return static_cast<double>(place.feeds - anchor) * feed + place.local;
    }
    [[nodiscard]] EndlessPlace place(double local) const noexcept { return {anchor, local}; }
};

/// What a slave has to come to: the velocity (the distance lost stays, as MC_GearIn wants it), or the place.
enum class RunDown : std::uint8_t { velocity, position };

class Follower {
public:
    using Relation = std::variant<GearLine, GearSum, CamCurve>;

    /// The relation counts from the next step() on; what it lacks runs down as `target` says.
    void begin(const Relation& relation, RunDown target, const FollowerLimits& limits) noexcept;
    /// As begin(), but first over `approach` (positions in local u of `frame` as it is now) to the sync point.
    void begin(const Relation& relation, const SyncApproach& approach, const SlaveFrame& frame, const FollowerLimits& limits) noexcept;
    /// They may change at any time.
    void set_limits(const FollowerLimits& limits) noexcept { limits_ = limits; }

    /// The slave's next state in local coordinates. `before`: its state one period ago, in the same ones. The masters are where they are now.
    [[nodiscard]] MotionState step(const EndlessMotion& first, const EndlessMotion& second, const MotionState& before,
                                   const SlaveFrame& frame, Duration period) noexcept;

    [[nodiscard]] bool in_sync() const noexcept { return in_sync_; }
    /// On the way to the sync point.
    [[nodiscard]] bool approaching() const noexcept { return approaching_; }
    /// The last step was held back by the axis' limits.
    [[nodiscard]] bool held_back() const noexcept { return held_back_; }
    /// nullptr while another relation is followed.
    [[nodiscard]] const CamCurve* cam() const noexcept { return std::get_if<CamCurve>(&relation_); }

private:
    [[nodiscard]] MotionState wanted(const EndlessMotion& first, const EndlessMotion& second, const SlaveFrame& frame) noexcept;
    [[nodiscard]] bool possible(const MotionState& wanted, const MotionState& before, double period) const noexcept;
    [[nodiscard]] MotionState kept_inside(const MotionState& wanted, const MotionState& before, double period) const noexcept;
    [[nodiscard]] bool foreseen(const MotionState& relation) const noexcept;
    [[nodiscard]] Plan plan_from(const MotionState& before, const MotionState& goal, double acceleration, double period) const noexcept;
    [[nodiscard]] MotionState catch_up(const MotionState& relation, const MotionState& before, double period) noexcept;
    void make_up(const MotionState& before, const MotionState& relation, double period) noexcept;
    void look_for_a_sooner_way(const MotionState& before, const MotionState& relation, double period) noexcept;

    Relation relation_;
    SyncApproach approach_;
    EndlessPlace approach_origin_;  // of the approach's positions
    RunDown target_ = RunDown::velocity;
    FollowerLimits limits_;
    CatchUp catch_up_;
    Difference difference_;
    double trend_ = 0;             // of the relation
    MotionState goal_;             // what the difference is planned beside: the relation as far as the slave can follow it
    double room_ = 0;              // u/s that were left then between it and the forward limit
    double own_acceleration_ = 0;  // of the difference, one period ago
    bool exact_ = true;            // it was the relation
    bool fresh_ = false;           // the next step is the first one
    bool approaching_ = false, in_sync_ = false, held_back_ = false;
};

}  // namespace taktwerk::axes
