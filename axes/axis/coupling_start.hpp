#pragma once
// How a coupling begins: where, and with which relation between the places of master and slave.
//
// A relation is made for the instant one period ago: that is where the slave is. The masters have been planned already, so they are
// taken back by one period.

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/coupling_state.hpp"
#include "axes/coupling/follower_limits.hpp"

namespace taktwerk::axes {

class Aim;
class Conduct;
class CouplingLinks;
class MasterSide;
class SuperimposedMotion;

class CouplingStart {
public:
    CouplingStart(AxisBody& body, AxisMotion& motion, SuperimposedMotion& addition, Aim& aim, CouplingLinks& links,
                  Conduct& conduct) noexcept
        : body_(body), motion_(motion), addition_(addition), aim_(aim), links_(links), conduct_(conduct) {}

    /// Sync point and start, as places of the master: what numbers mean is settled now, whatever MC_SetPosition does later.
    void find_start(Link& link) noexcept;
    /// The master has crossed the start in its sense since the last cycle, or was on it at the beginning.
    [[nodiscard]] bool starts_now(Link& link) const noexcept;
    [[nodiscard]] FollowerLimits follower_limits(const AxisCommand& command) const noexcept;
    ErrorId engage(Duration period) noexcept;

private:
    [[nodiscard]] EndlessPlace cam_origin(const CamDetails& cam, const PreparedCam& table, const MasterSide& master,
                                          const EndlessPlace& entry) const noexcept;
    ErrorId begin_gear(const Link& link) noexcept;
    ErrorId begin_sum(const Link& link) noexcept;
    [[nodiscard]] ErrorId approach_to(const Link& link, const EndlessMotion& master, double master_feed, const CurvePoint& end,
                                      SyncApproach& approach) const noexcept;
    ErrorId begin_gear_in_pos(const Link& link, const EndlessMotion& first) noexcept;
    ErrorId begin_cam(Link& link, const EndlessMotion& first) noexcept;

    AxisBody& body_;
    AxisMotion& motion_;
    SuperimposedMotion& addition_;
    Aim& aim_;
    CouplingLinks& links_;
    Conduct& conduct_;
};

}  // namespace taktwerk::axes
