#include "axes/group/tool_motion.hpp"

#include <numbers>

#include "axes/group/written_pose.hpp"
#include "axes/pose_math.hpp"

namespace taktwerk::axes {
namespace {

std::array<double, 3> three(const Eigen::Vector3d& v) noexcept { return {v.x(), v.y(), v.z()}; }

}  // namespace

Pose object_at(const FrameTrack& track, double way, double turn) noexcept {
    Pose moved;
    if (track.kind == FrameTrack::Kind::belt) moved.position[0] = way;
    else
        moved = pose_of(Eigen::Vector3d::Zero(),
                        Eigen::Quaterniond(Eigen::AngleAxisd(2 * std::numbers::pi * way / turn, Eigen::Vector3d::UnitZ())));
    return composed(composed(pose_of_numbers(track.origin), moved), pose_of_numbers(track.object));
}

Conveyance conveyance_of(const FrameTrack& track, const Pose& machine, double turn) noexcept {
    const Pose origin = composed(inverted(machine), pose_of_numbers(track.origin));
    Conveyance c;
    c.turns = track.kind == FrameTrack::Kind::table;
    c.axis = orientation_of(origin) * (c.turns ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX());
    c.centre = position_of(origin);
    c.angle = c.turns ? 2 * std::numbers::pi / turn : 0;
    return c;
}

ToolMotion carried_by(const Conveyance& frame, const MotionState& way, const ToolMotion& still) noexcept {
    ToolMotion out = still;
    if (!frame.turns) {
        out.position += frame.axis * way.position;
        out.velocity += frame.axis * way.velocity;
        out.acceleration += frame.axis * way.acceleration;
        return out;
    }
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(frame.angle * way.position, frame.axis));
    const Eigen::Vector3d spin = frame.axis * (frame.angle * way.velocity), faster = frame.axis * (frame.angle * way.acceleration);
    const Eigen::Vector3d arm = turn * (still.position - frame.centre), along = turn * still.velocity;
    out.position = frame.centre + arm;
    out.velocity = along + spin.cross(arm);
    out.acceleration = turn * still.acceleration + 2 * spin.cross(along) + faster.cross(arm) + spin.cross(spin.cross(arm));
    out.orientation = turn * still.orientation;
    const Eigen::Vector3d own = turn * still.turning;
    out.turning = own + spin;
    out.turning_faster = turn * still.turning_faster + faster + spin.cross(own);
    return out;
}

PathDerivatives drag_at(const Conveyance& frame, const Eigen::Vector3d& point) noexcept {
    PathDerivatives d;
    if (!frame.turns) {
        d.position[0] = three(frame.axis);
        return d;
    }
    // A circle, gone evenly.
    const Eigen::Vector3d spin = frame.axis * frame.angle, arm = point - frame.centre;
    const Eigen::Vector3d first = spin.cross(arm), second = spin.cross(first);
    d.position = {three(first), three(second), three(spin.cross(second))};
    d.turn[0] = three(spin);
    return d;
}

}  // namespace taktwerk::axes
