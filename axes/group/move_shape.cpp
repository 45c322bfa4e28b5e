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

/// Why a place cannot be gone.
struct Refusal {
    ErrorId error = ErrorId::none;
    PathHindrance at{};
};

ErrorId error_of(const Miss& miss) noexcept {
    switch (miss.fault) {
        case KinematicFault::none: return ErrorId::none;
        case KinematicFault::joint_limit: return ErrorId::beyond_software_limit;
        case KinematicFault::singular: return ErrorId::singular_path;
        default: return ErrorId::out_of_reach;
    }
}

Refusal refusal_of(const Miss& miss) noexcept {
    Refusal refusal{error_of(miss), {}};
    if (miss.fault == KinematicFault::joint_limit && miss.joint >= 0) refusal.at.place = static_cast<std::uint8_t>(miss.joint);
    return refusal;
}

Refusal within(const MemberVector& at, const MoveSpace& space) noexcept {
    for (std::size_t i = 0; i < space.members; ++i) {
        const double digits = 1e-12 * std::max(1.0, std::abs(at[i]));
        const auto& limits = space.limits[i];
        if (at[i] <= limits.high + digits && at[i] >= limits.low - digits) continue;
        Refusal refusal{ErrorId::beyond_software_limit, {}};
        refusal.at.place = static_cast<std::uint8_t>(i);
        refusal.at.limit_known = true;
        refusal.at.position = at[i];
        refusal.at.limit = at[i] > limits.high ? limits.high : limits.low;
        return refusal;
    }
    return space.arm != nullptr ? refusal_of(space.arm->limits_of(joints_of(at))) : Refusal{};
}

/// The first place of a way that is refused with this, between one that is not and one that is.
template <class Look>
double first_refused(double good, double bad, Refusal& refusal, const Look& look) {
    constexpr int halvings = 40;
    for (int i = 0; i < halvings; ++i) {
        const double middle = (good + bad) / 2;
        const Refusal there = look(middle);
        if (there.error != refusal.error) {
            good = middle;
            continue;
        }
        bad = middle;
        if (!refusal.at.limit_known || refusal.at.place != there.at.place) refusal.at = there.at;
    }
    return bad;
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

MoveShape refused(const Refusal& refusal) {
    MoveShape shape;
    shape.error = refusal.error;
    shape.at = refusal.at;
    return shape;
}
MoveShape refused(ErrorId error) { return refused(Refusal{error, {}}); }

/// u of the tool's point that a path of poses is long: turns count in its own length, too.
double way_of_point(const PathElement& element) noexcept {
    const double share = element.at(0).first.head<3>().norm();
    return share > 1e-9 ? share * element.length() : 0;
}

void put_point(PathHindrance& at, const std::array<double, 3>& point) noexcept {
    at.in_space = true;
    at.point = point;
}

PathSection whole(const MoveShape& shape) {
    PathSection section;
    section.element = shape.element;
    section.chart = shape.chart;
    section.length = shape.element.length();
    return section;
}

/// Where on it a line of the members is refused.
void find_on_line(Refusal& refusal, const MemberVector& to, const CarriedTool& carried, const MoveEnd& from, const MoveSpace& space) {
    MemberVector q = from.members;
    refusal.at.on_path = true;
    refusal.at.part = first_refused(0, 1, refusal, [&](double part) {
        for (std::size_t i = 0; i < space.members; ++i) q[i] = from.members[i] + part * (to[i] - from.members[i]);
        return within(q, space);
    });
    if (space.arm == nullptr) return;
    const ForwardResult there = space.arm->forward(joints_of(q), carried.tool);
    if (there.miss.ok()) put_point(refusal.at, there.pose.position);
}

/// The members on a straight line of their own.
MoveShape joint_line(const MemberVector& to, const CarriedTool& carried, const MoveEnd& from, const MoveSpace& space) {
    if (Refusal refusal = within(to, space); refusal.error != ErrorId::none) {
        find_on_line(refusal, to, carried, from, space);
        return refused(refusal);
    }
    MoveShape shape;
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
    if (const auto wall = leaves_rooms(whole(shape), run, space)) {
        shape.error = ErrorId::outside_workspace;
        shape.at = *wall;
    }
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
    MemberVector near = from.members, q{};
    const auto look = [&](double s) {
        const WayPoint w = way_point(all, run, s, space.arm, space.members, near);
        q = w.q;
        Refusal refusal = refusal_of(w.miss);
        if (refusal.error == ErrorId::none && space.arm->singularity(joints_of(q)).measure < least_singularity)
            refusal.error = ErrorId::singular_path;
        if (refusal.error == ErrorId::none) refusal = within(q, space);
        if (refusal.error == ErrorId::none && s == 0 && !same_place(q, from.members, space.members)) refusal.error = ErrorId::out_of_reach;
        return refusal;
    };
    for (int i = 0; i <= steps; ++i) {
        double s = all.length * i / steps;
        if (Refusal refusal = look(s); refusal.error != ErrorId::none) {
            if (i > 0) s = first_refused(all.length * (i - 1) / steps, s, refusal, look);
            shape.error = refusal.error;
            shape.at = refusal.at;
            shape.at.on_path = true;
            shape.at.part = s / all.length;
            shape.at.length = way_of_point(shape.element);
            shape.at.position = shape.at.limit;
            const auto p = shape.element.at(s).at;
            put_point(shape.at, {p[0], p[1], p[2]});
            return;
        }
        shape.members.push_back(near = q);
    }
    shape.end = {near, from.configuration};
    if (const auto wall = leaves_rooms(all, run, space)) {
        shape.error = ErrorId::outside_workspace;
        shape.at = *wall;
        shape.at.length = way_of_point(shape.element);
    }
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
    if (!here.miss.ok()) return refused(refusal_of(here.miss));
    const Pose start = here.pose, goal = goal_of(move, start, *space.arm);
    // A path keeps the way the arm stands (G-042): one that is told to end otherwise is none.
    const auto& wanted = move.command.wanted;
    if (!direct && !answers(from.configuration.branch, wanted.branch)) return refused(ErrorId::out_of_reach);
    Configuration asked = direct ? wanted : from.configuration;
    const AxisSolution there = space.arm->inverse(goal, tool, asked, joints_of(from.members));
    Refusal target = refusal_of(there.miss);
    put_point(target.at, goal.position);
    if (direct && !there.ok()) return refused(target);
    if (direct) return joint_line(members_of(there.axes), move.place.carried, from, space);

    MoveShape shape;
    shape.through_arm = true;
    shape.chart = chart_at(start, *space.arm);
    const Eigen::Vector3d turn = rotation_between(orientation_of(start), orientation_of(goal));
    if (turn.norm() > std::numbers::pi - 1e-9)
        return refused(there.ok() ? Refusal{ErrorId::half_turn, {}} : target);  // G-043: which way round is nobody's choice
    PathVector a = PathVector::Zero(), b = PathVector::Zero();
    a.head<3>() = position_of(start);
    b.head<3>() = position_of(goal);
    b.segment<3>(3) = shape.chart.lever * turn;
    if (is_circular(kind)) {
        auto arc = arc_of(move, start, a, b);
        if (!arc.ok()) return refused(there.ok() ? Refusal{ErrorId::invalid_arc, {}} : target);
        shape.element = arc.value();
    } else {
        // Nothing but the last digits of going through the arm and back.
        shape.empty = (b - a).norm() <= 1e-12 * std::max(1.0, a.norm());
        shape.end = from;
        if (shape.empty) return there.ok() ? shape : refused(target);
        shape.element = PathElement::line(a, b);
    }
    walk(shape, move.place.carried, from, space);
    if (there.ok() || shape.error == target.error) return shape;
    target.at.on_path = true;  // the end is refused, whatever else is on the way
    target.at.part = 1;
    target.at.length = way_of_point(shape.element);
    return refused(target);
}

ErrorId refuse_blend(const PathSection& blend, const RunSection& at, const MoveEnd& near, const MoveSpace& space) {
    if (leaves_rooms(blend, at, space)) return ErrorId::outside_workspace;
    if (!at.through_arm) return ErrorId::none;  // between two lines inside the limits it is inside
    constexpr int steps = 16;
    for (int i = 0; i <= steps; ++i) {
        const WayPoint w = way_point(blend, at, blend.begin + blend.length * i / steps, space.arm, space.members, near.members);
        if (const auto error = error_of(w.miss); error != ErrorId::none) return error;
        if (space.arm->singularity(joints_of(w.q)).measure < least_singularity) return ErrorId::singular_path;
        if (const auto refusal = within(w.q, space); refusal.error != ErrorId::none) return refusal.error;
    }
    return ErrorId::none;
}

}  // namespace taktwerk::axes
