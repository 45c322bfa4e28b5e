#include "axes/group/mixed_corner.hpp"

#include <algorithm>
#include <cmath>

#include "axes/group/room_check.hpp"
#include "axes/pose_math.hpp"

namespace taktwerk::axes {
namespace {

constexpr double turn_back = 0.35;  // |t0 + t1| below which (160 degrees) the path turns back
constexpr double straight = 0.05;   // how much a bend shortens the curve's length: as between lines (blend.cpp)
constexpr double corner_digits = 1e-9;
constexpr int halvings = 50, tries = 40, looks_on_curve = 16;

enum class End { of_first, of_second };

double place_on_side(const CornerSide& side, End end, double from_corner) {
    return end == End::of_first ? side.section.end() - from_corner : side.section.begin + from_corner;
}
std::optional<PathPoint> corner_point(const CornerSide& side, End end, double from_corner, const MoveSpace& space) {
    const WayPoint w = way_point(side.section, side.run, place_on_side(side, end, from_corner), space.arm, space.members, side.near, 2);
    if (!w.miss.ok()) return std::nullopt;
    PathPoint p;
    for (std::size_t i = 0; i < space.members; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        p.at[k] = w.q[i];
        p.first[k] = w.first[i];
        p.second[k] = w.second[i];
    }
    return p;
}
MemberVector members_on_curve(const PathVector& at, const MoveSpace& space) {
    MemberVector q{};
    for (std::size_t i = 0; i < space.members; ++i) q[i] = at[static_cast<Eigen::Index>(i)];
    return q;
}

/// Of the tool's point, from the corner.
class Distance {
public:
    Distance(const Pose& tool, const MoveSpace& space, const MemberVector& corner)
        : tool_(tool), space_(space), corner_(position_of(space.arm->forward(joints_of(corner), tool).pose)) {}
    [[nodiscard]] double of(const PathVector& at) const {
        return (position_of(space_.arm->forward(joints_of(members_on_curve(at, space_)), tool_).pose) - corner_).norm();
    }
    /// How much of its length the path has until the point is so far away: its room at most.
    [[nodiscard]] double length_for(const CornerSide& side, End end, double distance) const {
        const auto off = [&](double length) {
            const auto p = corner_point(side, end, length, space_);
            return p ? of(p->at) : distance;
        };
        if (off(side.room) <= distance * (1 + corner_digits)) return side.room;
        double least = 0, most = side.room;
        for (int i = 0; i < halvings; ++i) (off((least + most) / 2) < distance ? least : most) = (least + most) / 2;
        return (least + most) / 2;
    }

private:
    const Pose& tool_;
    const MoveSpace& space_;
    Eigen::Vector3d corner_;
};

bool curve_inside(const PathElement& curve, const Pose& tool, const MoveSpace& space) {
    for (int i = 0; i <= looks_on_curve; ++i) {
        const MemberVector q = members_on_curve(curve.at(curve.length() * i / looks_on_curve).at, space);
        for (std::size_t k = 0; k < space.members; ++k)
            if (q[k] > space.limits[k].high || q[k] < space.limits[k].low) return false;
        if (!space.arm->limits_of(joints_of(q)).ok()) return false;
    }
    PathSection section;
    section.element = curve;
    section.length = curve.length();
    RunSection run;
    run.carried.tool = tool;
    return !leaves_rooms(section, run, space);
}

std::optional<PathElement> curve_of(const CornerSide& before, const CornerSide& behind, double first, double second, const Pose& tool,
                                    const MoveSpace& space) {
    const auto from = corner_point(before, End::of_first, first, space), to = corner_point(behind, End::of_second, second, space);
    if (!from || !to) return std::nullopt;
    const PathVector t0 = from->first.normalized(), t1 = to->first.normalized();
    if ((t0 + t1).norm() < turn_back) return std::nullopt;
    const double length = (1 - straight * (t1 - t0).squaredNorm()) * (first + second);
    if (!Quintic(*from, *to, length).smooth()) return std::nullopt;
    const auto curve = PathElement::course(*from, *to, length);
    return curve_inside(curve, tool, space) ? std::optional(curve) : std::nullopt;
}

}  // namespace

std::optional<MixedCorner> mixed_corner(const CornerSide& before, const CornerSide& behind, const MixedRequest& request, const Pose& tool,
                                        const MoveSpace& space) {
    if (space.arm == nullptr || !(before.room > 0) || !(behind.room > 0)) return std::nullopt;
    const Distance distance(tool, space, before.near);
    double first = before.room, second = behind.room;
    if (request.distance > 0) {
        first = distance.length_for(before, End::of_first, request.distance);
        second = distance.length_for(behind, End::of_second, request.distance);
    } else if (request.before > 0) {
        first = std::min(request.before, before.room);
        second = std::min(request.behind, behind.room);
    }
    MixedCorner corner;
    corner.cut = first >= before.room || second >= behind.room;
    for (int i = 0; i < tries; ++i) {
        const auto curve = curve_of(before, behind, first, second, tool, space);
        if (!curve) return std::nullopt;
        const double off = distance.of(curve->at(curve->length() / 2).at);
        if (!(request.deviation > 0) || off <= request.deviation * (1 + corner_digits)) {
            corner.curve = *curve;
            corner.before = first;
            corner.behind = second;
            return corner;
        }
        corner.cut = false;  // it is as large as it may be
        const double less = std::min(request.deviation / off, 1 - corner_digits);
        first *= less;
        second *= less;
    }
    return std::nullopt;
}

}  // namespace taktwerk::axes
