#pragma once
// How far the tool's point is from where it was told to be, and whether that lasts. Real-time safe.

#include "axes/group/group_config.hpp"
#include "axes/group/group_members.hpp"
#include "axes/group/group_view.hpp"

namespace taktwerk::axes {

/// u, between set-point and actual values of one instant (each member's following error). Without an arm, or where its axes have no pose: of the
/// members as one point. `view` knows the tool already (see_tool()).
[[nodiscard]] double path_deviation(const GroupView& view, const GroupMembers& members, const Kinematics* arm, const Pose& tool) noexcept;

class PathDeviationWatch {
public:
    explicit PathDeviationWatch(const PathFollowing& allowed) noexcept : allowed_(allowed) {}

    /// Each cycle. True: it has been beyond the window for longer than that is allowed.
    [[nodiscard]] bool beyond(double deviation, Duration period) noexcept {
        const bool out = allowed_.window > 0 && deviation > allowed_.window;
        since_ = out ? since_ + period : Duration{};
        return out && since_ > allowed_.time;
    }

private:
    PathFollowing allowed_;
    Duration since_{};
};

}  // namespace taktwerk::axes
