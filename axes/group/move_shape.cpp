#include "axes/group/move_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "axes/group/jog_shape.hpp"
#include "axes/group/motion_target.hpp"
#include "axes/group/room_check.hpp"
#include "axes/group/written_pose.hpp"
#include "axes/path/arc.hpp"
#include "axes/pose_math.hpp"

namespace taktwerk::axes {
namespace {

/// Length of a radian of orientation: pose paths count turns in it.
constexpr double turn_lever = 1;

bool turns(const Kinematics& arm) noexcept {
    const auto which = arm.commands();
    return which[3] || which[4] || which[5];
}

ErrorId error_of(const Miss& miss) noexcept {
    switch (miss.fault) {
        case KinematicFault::none: return ErrorId::none;
        case KinematicFault::joint_limit: return ErrorId::beyond_software_limit;
        case KinematicFault::singular: return ErrorId::singular_path;
        default: return ErrorId::out_of_reach;
    }
}

ErrorId within(const MemberVector& at, const MoveSpace& space) noexcept {
    for (std::size_t i = 0; i < space.members; ++i) {
        const double digits = 1e-12 * std::max(1.0, std::abs(at[i]));
        if (at[i] > space.limits[i].high + digits || at[i] < space.limits[i].low - digits) return ErrorId::beyond_software_limit;
    }
    return space.arm != nullptr ? error_of(space.arm->limits_of(joints_of(at))) : ErrorId::none;
}

/// Whether the arm puts the members where they stand. Those of a beam that is askew it does not: they would jump onto the path.
bool same_place(const MemberVector& a, const MemberVector& b, std::size_t members) noexcept {
    constexpr double digits = 1e-8;  // of a way through the arm and back, 0.01 from a singularity
    for (std::size_t i = 0; i < members; ++i)
        if (!(std::abs(a[i] - b[i]) <= digits * std::max(1.0, std::abs(b[i])))) return false;
    return true;
}

Configuration any_turns(Branch branch) noexcept {
    Configuration c;
    c.branch = branch;
    return c;
}

MoveShape refused(ErrorId error) {
    MoveShape shape;
    shape.error = error;
    return shape;
}

PathSection whole(const MoveShape& shape) {
    PathSection section;
    section.element = shape.element;
    section.chart = shape.chart;
    section.length = shape.element.length();
    return section;
}

/// The members on a straight line of their own.
MoveShape joint_line(const MemberVector& to, const CarriedTool& carried, const MoveEnd& from, const MoveSpace& space) {
    MoveShape shape;
    shape.error = within(to, space);
    if (shape.error != ErrorId::none) return shape;
    PathVector a = PathVector::Zero(), b = PathVector::Zero();
    for (std::size_t i = 0; i < space.members; ++i) {
        a[static_cast<Eigen::Index>(i)] = from.members[i];
        b[static_cast<Eigen::Index>(i)] = to[i];
    }
    shape.end.members = to;
    if (space.arm != nullptr) shape.end.configuration = any_turns(space.arm->configuration(joints_of(to)).branch);
    shape.empty = a == b;
    if (shape.empty) return shape;
    shape.element = PathElement::line(a, b);
    shape.members = {from.members};
    RunSection run;
    run.carried = carried;
    shape.error = refuse_room(whole(shape), run, space);
    return shape;
}

/// The command's frame; TCS is the tool's as the move before leaves it (G-075).
Pose frame_of(const GroupOrder& move, const Pose& start) noexcept { return move.command.frame == mcTCS ? start : move.place.frame; }

Pose goal_of(const GroupOrder& move, const Pose& start, const Kinematics& arm) noexcept {
    const Pose frame_pose = frame_of(move, start);
    const Pose given = pose_of_six(move.command.target);
    if (!is_relative(move.command.kind)) {
        Pose goal = composed(frame_pose, given);
        if (keeps_turn(move.command, arm)) goal.orientation = start.orientation;
        return goal;
    }
    // A distance in the directions of its frame; its turns are about the tool's point, in the frame's directions too.
    const Eigen::Quaterniond frame = orientation_of(frame_pose);
    const Eigen::Quaterniond turn = frame * orientation_of(given) * frame.conjugate();
    return pose_of(position_of(start) + frame * position_of(given), turn * orientation_of(start));
}

Eigen::Vector3d seen_in(const GroupOrder& move, const Pose& start, const std::array<double, 3>& point) noexcept {
    const Eigen::Vector3d p(point[0], point[1], point[2]);
    const Pose frame = frame_of(move, start);
    return position_of(is_relative(move.command.kind) ? start : frame) + orientation_of(frame) * p;
}

Result<PathElement> arc_of(const GroupOrder& move, const Pose& start, const PathVector& from, const PathVector& to) {
    const auto& circle = move.command.circle;
    const auto sense = circle.clockwise ? ArcSense::clockwise : ArcSense::counter_clockwise;
    const Eigen::Quaterniond frame = orientation_of(frame_of(move, start));
    const Eigen::Vector3d aux(circle.aux[0], circle.aux[1], circle.aux[2]);
    switch (circle.mode) {
        case mcBORDER: return arc_over_border(from, seen_in(move, start, circle.aux), to);
        case mcCENTER:
            return arc_about_centre(from, seen_in(move, start, circle.aux), to, frame * Eigen::Vector3d::UnitZ(), sense,
                                    std::max(circle.tolerance, 1e-6));
        case mcRADIUS: break;
    }
    return arc_of_radius(from, to, frame * aux, sense);
}

/// Everywhere along it: reached by the same way of the arm, inside the limits, not singular.
void walk(MoveShape& shape, const CarriedTool& carried, const MoveEnd& from, const MoveSpace& space) {
    constexpr int least = 64, most = 2048;
    const double length = shape.element.length();
    const double size = std::max(shape.element.feature(length / 2) / 2, length / most);
    walk_along(shape, carried, from, space, std::clamp(static_cast<int>(std::min(length / size, 1.0 * most)), least, most));
}

}  // namespace

PathChart chart_at(const Pose& pose, const Kinematics& arm) noexcept { return {pose.orientation, turns(arm) ? turn_lever : 0}; }

void walk_along(MoveShape& shape, const CarriedTool& carried, const MoveEnd& from, const MoveSpace& space, int steps) {
    const PathSection all = whole(shape);
    RunSection run;
    run.through_arm = true;
    run.carried = carried;
    run.configuration = from.configuration;
    MemberVector near = from.members;
    for (int i = 0; i <= steps; ++i) {
        const WayPoint w = way_point(all, run, all.length * i / steps, space.arm, space.members, near);
        shape.error = error_of(w.miss);
        if (shape.error == ErrorId::none && space.arm->singularity(joints_of(w.q)).measure < least_singularity)
            shape.error = ErrorId::singular_path;
        if (shape.error == ErrorId::none) shape.error = within(w.q, space);
        if (shape.error == ErrorId::none && i == 0 && !same_place(w.q, from.members, space.members)) shape.error = ErrorId::out_of_reach;
        if (shape.error != ErrorId::none) return;
        shape.members.push_back(near = w.q);
    }
    shape.end = {near, from.configuration};
    shape.error = refuse_room(all, run, space);
}

MoveShape shape_of(const GroupOrder& move, const MoveEnd& from, const MoveSpace& space) {
    const auto kind = move.command.kind;
    if (kind == GroupCommandKind::jog) return jog_shape(move, from, space);
    const bool direct = kind == GroupCommandKind::direct_absolute || kind == GroupCommandKind::direct_relative;
    if (move.command.frame == mcACS) {
        MemberVector to = move.target;
        if (is_relative(kind))
            for (std::size_t i = 0; i < space.members; ++i) to[i] += from.members[i];
        return joint_line(to, move.place.carried, from, space);
    }
    if (space.arm == nullptr) return refused(ErrorId::no_kinematics);
    const Pose& tool = move.place.carried.tool;
    const ForwardResult here = space.arm->forward(joints_of(from.members), tool);
    if (!here.miss.ok()) return refused(error_of(here.miss));
    const Pose start = here.pose, goal = goal_of(move, start, *space.arm);
    // A path keeps the way the arm stands (G-042): one that is told to end otherwise is none.
    const auto& wanted = move.command.wanted;
    if (!direct && !answers(from.configuration.branch, wanted.branch)) return refused(ErrorId::out_of_reach);
    Configuration asked = direct ? wanted : from.configuration;
    const AxisSolution there = space.arm->inverse(goal, tool, asked, joints_of(from.members));
    if (!there.ok()) return refused(error_of(there.miss));
    if (direct) return joint_line(members_of(there.axes), move.place.carried, from, space);

    MoveShape shape;
    shape.through_arm = true;
    shape.chart = chart_at(start, *space.arm);
    const Eigen::Vector3d turn = rotation_between(orientation_of(start), orientation_of(goal));
    if (turn.norm() > std::numbers::pi - 1e-9) return refused(ErrorId::half_turn);  // G-043: which way round is nobody's choice
    PathVector a = PathVector::Zero(), b = PathVector::Zero();
    a.head<3>() = position_of(start);
    b.head<3>() = position_of(goal);
    b.segment<3>(3) = shape.chart.lever * turn;
    if (is_circular(kind)) {
        auto arc = arc_of(move, start, a, b);
        if (!arc.ok()) return refused(ErrorId::invalid_arc);
        shape.element = arc.value();
    } else {
        // Nothing but the last digits of going through the arm and back.
        shape.empty = (b - a).norm() <= 1e-12 * std::max(1.0, a.norm());
        shape.end = from;
        if (shape.empty) return shape;
        shape.element = PathElement::line(a, b);
    }
    walk(shape, move.place.carried, from, space);
    return shape;
}

ErrorId refuse_blend(const PathSection& blend, const RunSection& at, const MoveEnd& near, const MoveSpace& space) {
    if (const auto error = refuse_room(blend, at, space); error != ErrorId::none) return error;
    if (!at.through_arm) return ErrorId::none;  // between two lines inside the limits it is inside
    constexpr int steps = 16;
    for (int i = 0; i <= steps; ++i) {
        const WayPoint w = way_point(blend, at, blend.begin + blend.length * i / steps, space.arm, space.members, near.members);
        if (const auto error = error_of(w.miss); error != ErrorId::none) return error;
        if (space.arm->singularity(joints_of(w.q)).measure < least_singularity) return ErrorId::singular_path;
        if (const auto error = within(w.q, space); error != ErrorId::none) return error;
    }
    return ErrorId::none;
}

}  // namespace taktwerk::axes
