#pragma once
// An axis as its slaves see it: its place, its units and limits, and whom it follows itself.

#include <cstdint>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/axis_motion.hpp"
#include "axes/axis/command_kinds.hpp"
#include "axes/axis/coupling_links.hpp"
#include "axes/axis/homing_runs.hpp"
#include "axes/axis/measured.hpp"
#include "axes/axis/motion_scene.hpp"
#include "axes/coupling/master_track.hpp"

namespace taktwerk::axes {

class MasterSide {
public:
    MasterSide(const AxisBody& body, const Measured& measured, const AxisMotion& motion, const HomingRuns& runs,
               const CouplingLinks& links) noexcept
        : body_(body), measured_(measured), motion_(motion), runs_(runs), links_(links) {}

    [[nodiscard]] MasterTrack::Reading reading(MC_Source source) const noexcept;
    [[nodiscard]] MasterList masters() const noexcept;
    /// Those of the coupling that runs.
    [[nodiscard]] MasterList running_masters() const noexcept;
    /// Depth first from `master` along all couplings that run or wait, and along paths that an axis drives. Each axis is looked at once.
    [[nodiscard]] bool is_followed_by(const MasterSide& master) const noexcept;

    [[nodiscard]] const AxisUnits& units() const noexcept { return body_.units; }
    [[nodiscard]] const AxisConfig& config() const noexcept { return body_.config; }
    /// False: masters() is empty. Cheap.
    [[nodiscard]] bool may_follow() const noexcept {
        return links_.state.shown || couples(body_.queue.active().command.kind) || body_.queue.waiting() > 0;
    }

private:
    const AxisBody& body_;
    const Measured& measured_;
    const AxisMotion& motion_;
    const HomingRuns& runs_;
    const CouplingLinks& links_;

    mutable std::uint32_t walks_ = 0;  // of is_followed_by
    mutable std::uint64_t walk_ = 0;   // the last one that came by here
    mutable const MasterSide* walk_back_ = nullptr;
};

}  // namespace taktwerk::axes
