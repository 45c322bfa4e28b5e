#include "axes/path/path.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk::axes {
namespace {

constexpr double same_point = 1e-9;  // of the moves' size

Eigen::Quaterniond orientation(const PathChart& chart, const PathVector& at) {
    PathPoint p;
    p.at = at;
    return pose_point(p, chart).orientation;
}

/// Whether a move of `second` begins where one of `first` ends.
bool joins(const PathElement& first, const PathChart& chart, const PathMove& second) {
    const PathVector a = first.at(first.length()).at, b = second.element.at(0).at;
    const double size = std::max({1e-300, first.length(), second.element.length(), a.norm()});
    if (chart.lever <= 0) return second.chart.lever <= 0 && (a - b).norm() <= same_point * size;
    if ((a.head<3>() - b.head<3>()).norm() > same_point * size || second.chart.lever != chart.lever) return false;
    return rotation_between(orientation(chart, a), orientation(second.chart, b)).norm() <= same_point;
}

PathChart corner_chart(const PathMove& move) {
    PathChart chart = move.chart;
    if (chart.lever <= 0) return chart;
    const Eigen::Quaterniond q = orientation(move.chart, move.element.at(0).at);
    chart.reference = {q.w(), q.x(), q.y(), q.z()};
    return chart;
}

/// The rotation vector of an element counts from its chart's reference; at a corner both sides count from the corner. Every programmed
/// element turns about one axis, so this is a shift.
PathVector to_corner(const PathChart& chart, const PathVector& corner) {
    PathVector shift = PathVector::Zero();
    if (chart.lever > 0) shift.segment<3>(3) = -corner.segment<3>(3);
    return shift;
}

PathFeed slower(const PathFeed& a, const PathFeed& b) {
    return {std::min(a.velocity, b.velocity), std::min(a.acceleration, b.acceleration), std::min(a.deceleration, b.deceleration),
            std::min(a.jerk, b.jerk)};
}

}  // namespace

std::size_t Path::index_at(double s) const noexcept {
    const auto behind = std::upper_bound(begins_.begin(), begins_.end(), s);
    return behind == begins_.begin() ? 0 : static_cast<std::size_t>(behind - begins_.begin()) - 1;
}

void Path::append_over(const PathSection& curve, double before, const PathMove& move, double behind) {
    PathSection& last = sections_.back();
    last.length -= before;
    PathSection corner = curve;
    corner.feed = slower(last.feed, move.feed);
    corner.begin = last.end();
    corner.length = curve.element.length();
    corner.command = move.command;
    corner.blend = true;
    PathSection next;
    next.element = move.element;
    next.chart = move.chart;
    next.feed = move.feed;
    next.command = move.command;
    next.from = behind;
    next.begin = corner.end();
    next.length = move.element.length() - behind;
    push(corner);
    push(next);
}

Result<PathJoint> Path::append(const PathMove& move, const BlendRequest& transition, double frozen) {
    if (!(move.element.length() > 0) || !std::isfinite(move.element.length()))
        return Error{"path.empty_move", "", "a move of no length has no direction and cannot be part of a path", "leave it out"};
    PathSection next;
    next.element = move.element;
    next.chart = move.chart;
    next.feed = move.feed;
    next.command = move.command;
    next.length = move.element.length();
    if (sections_.empty()) {
        push(next);
        return PathJoint::first;
    }
    PathSection& last = sections_.back();
    if (!joins(last.element, last.chart, move))
        return Error{"path.gap", "", "a move begins elsewhere than where the one before it ends", "begin it at that end"};

    PathJoint joint = PathJoint::stop;
    const PathVector end = last.element.at(last.element.length()).at, begin = move.element.at(0).at;
    const PathElement first = last.element.shifted(to_corner(last.chart, end)), second = move.element.shifted(to_corner(move.chart, begin));
    // Half of each is left to the blend at its other end; what is frozen stays.
    const double room = std::min({last.element.length() * transition.share, last.length, last.end() - frozen});
    const auto curve = blend(first, second, transition, room, move.element.length() * transition.share);
    if (curve) {
        const bool whole = transition.rule == BlendRule::corner_distance ? curve->before >= transition.parameter * (1 - 1e-9)
                                                                         : curve->deviation >= transition.parameter * (1 - 1e-6);
        joint = whole ? PathJoint::blend : PathJoint::cut;
        last.length -= curve->before;
        PathSection corner;
        corner.element = curve->curve;
        corner.chart = corner_chart(move);
        corner.feed = slower(last.feed, move.feed);
        corner.begin = last.end();
        corner.length = curve->curve.length();
        corner.command = move.command;
        corner.blend = true;
        const bool nothing_left = last.length <= 1e-12 * last.element.length();
        if (nothing_left) {
            corner.begin = last.begin;
            corner.stop_before = last.stop_before;
            sections_.pop_back();
            begins_.pop_back();
        }
        push(corner);
        next.from = curve->behind;
        next.length -= curve->behind;
    } else if (meet_smoothly(first, second)) {
        joint = PathJoint::smooth;
    } else {
        next.stop_before = true;
    }
    next.begin = sections_.back().end();
    push(next);
    return joint;
}

}  // namespace taktwerk::axes
