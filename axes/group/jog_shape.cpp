#include "axes/group/jog_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "axes/group/room_check.hpp"
#include "axes/pose_math.hpp"

namespace taktwerk::axes {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();
/// A way of less than this share of a place's size is none.
constexpr double no_way = 1e-7;
/// Nobody holds a key for longer; then it stands for a moment.
constexpr double longest_time = 3600;  // s
/// Where a path of poses is not followed any nearer.
constexpr double nearest_measure = 0.01;
/// No joint turns further between two places that are looked at, rad.
constexpr double most_turn = 0.02;
constexpr int most_looks = 8192;

double size_of(double value) noexcept { return std::max(1.0, std::abs(value)); }

/// What keeps a jog from going on.
struct Hindrance {
    JogEnd end = JogEnd::none;
    PathHindrance at{};
};

Hindrance limit_of(std::size_t place) noexcept {
    Hindrance by{JogEnd::member_limit, {}};
    by.at.place = static_cast<std::uint8_t>(place);
    return by;
}

MoveShape stands(const MoveEnd& from, Hindrance why = {}) {
    MoveShape shape;
    shape.empty = true;
    shape.end = from;
    shape.jog_end = why.end;
    shape.at = why.at;
    return shape;
}

/// One member alone, by a hair.
bool arm_lets(std::size_t k, double sense, const MemberVector& at, const MoveSpace& space) {
    if (space.arm == nullptr) return true;
    MemberVector next = at;
    next[k] += sense * 1e-9 * size_of(at[k]);
    return space.arm->limits_of(joints_of(next)).ok();
}

/// Up to when the arm has a pose, looked at densely.
template <class At>
double closes_until(double most, const MemberVector& rate, const At& at, const MoveSpace& space) {
    double fastest = 0;
    for (std::size_t k = 0; k < space.arm->joint_count(); ++k)
        if (space.arm->rotary()[k]) fastest = std::max(fastest, std::abs(rate[k]) * space.arm->map().settings(k).unit);
    double step = std::min(0.02, fastest > 0 ? most_turn / fastest : 0.02), time = 0;
    for (int i = 0; i < most_looks && time < most && step > 1e-10; ++i) {
        const double next = std::min(time + step, most);
        if (space.arm->forward(joints_of(at(next)), Pose{}).miss.ok()) time = next;
        else step /= 2;
    }
    return time;
}

/// Members on a straight line of their own, each at its jogging velocity. One that stands at its limit does not keep the others.
MoveShape jog_of_axes(const GroupOrder& move, const MoveEnd& from, const MoveSpace& space) {
    MemberVector rate{}, end{};
    double time = longest_time;
    std::size_t first = space.members;  // whose end is the end
    Hindrance why;
    for (std::size_t k = 0; k < space.members; ++k) {
        const double wanted = std::clamp(move.command.target[k], -1.0, 1.0), q = from.members[k];
        if (wanted == 0) continue;
        const double sense = wanted > 0 ? 1 : -1;
        const auto& limits = space.limits[k];
        const bool turning = space.arm != nullptr && k < max_joints && space.arm->rotary()[k];
        const double most = turning ? move.command.jog.angular : move.command.jog.linear;
        end[k] = sense > 0 ? limits.high : limits.low;
        const bool gone = most > 0 && sense * (move.target[k] + sense * most - end[k]) < 0;
        if (gone) end[k] = move.target[k] + sense * most;
        const double room = sense * (end[k] - q);
        const bool at_end = !(room > no_way * size_of(q));
        if (at_end || !arm_lets(k, sense, from.members, space)) {
            if (why.end == JogEnd::none || why.end == JogEnd::distance)
                why = gone && at_end ? Hindrance{JogEnd::distance, {}} : limit_of(k);
            continue;
        }
        rate[k] = wanted * limits.velocity;
        if (room / std::abs(rate[k]) > time) continue;
        time = room / std::abs(rate[k]);
        first = k;
    }
    const auto at = [&](double t) {
        MemberVector q = from.members;
        for (std::size_t k = 0; k < space.members; ++k) q[k] += rate[k] * t;
        return q;
    };
    if (space.arm != nullptr && !space.arm->limits_of(joints_of(at(time))).ok()) {
        // The arm's joints are straight lines of the members: inside up to one place.
        double inside = 0;
        for (int i = 0; i < 64; ++i) {
            const double middle = (inside + time) / 2;
            (space.arm->limits_of(joints_of(at(middle))).ok() ? inside : time) = middle;
        }
        time = inside;
        first = space.members;
    }
    if (space.arm != nullptr && space.arm->may_not_close() && space.arm->forward(joints_of(from.members), Pose{}).miss.ok()) {
        const double closes = closes_until(time, rate, at, space);
        if (closes < time) first = space.members;
        time = closes;
    }
    if (const double inside = inside_until(time, from.members, rate, move.place.carried.tool, space); inside < time) {
        first = space.members;
        time = inside;
        const auto wall = space.arm->forward(joints_of(at(inside)), move.place.carried.tool).pose.position;
        why = {JogEnd::workspace, room_at(*space.workspace, wall)};
    }
    MoveShape shape;
    shape.end.members = at(time);
    if (first < space.members) shape.end.members[first] = end[first];  // to the last bit
    PathVector a = PathVector::Zero(), b = PathVector::Zero();
    double size = 1;
    for (std::size_t k = 0; k < space.members; ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        a[i] = from.members[k];
        b[i] = shape.end.members[k];
        size = std::max(size, std::abs(a[i]));
    }
    const double length = (b - a).norm();
    if (!(length > no_way * size)) return stands(from, why.end == JogEnd::none ? Hindrance{JogEnd::reach, {}} : why);
    if (space.arm != nullptr) shape.end.configuration.branch = space.arm->configuration(joints_of(shape.end.members)).branch;
    shape.element = PathElement::line(a, b);
    shape.members = {from.members};
    PathFeed feed{endless, endless, endless, 0};
    for (std::size_t k = 0; k < space.members; ++k) {
        const double share = std::abs(shape.end.members[k] - from.members[k]) / length;
        if (share == 0) continue;
        const auto& limits = space.limits[k];
        feed.velocity = std::min(feed.velocity, limits.velocity / share);
        feed.acceleration = std::min(feed.acceleration, limits.speeding / share);
        feed.deceleration = std::min(feed.deceleration, limits.braking / share);
    }
    shape.feed = feed;
    return shape;
}

/// The tool's point on a straight line, its turns about one axis: one second of it.
struct PoseRate {
    Eigen::Vector3d linear, angular;  // u, rad, in the machine's directions
};

/// Turns go as fast as the slowest turning member may: jogging dynamics have one velocity of the tool, u/s.
double turning_velocity(const MoveSpace& space) noexcept {
    double least = endless;
    for (std::size_t k = 0; k < space.arm->joint_count(); ++k)
        if (space.arm->rotary()[k]) least = std::min(least, space.limits[k].velocity * space.arm->map().settings(k).unit);
    return std::isfinite(least) ? least : 0;
}

/// In the directions of the command's frame; of TCS as the tool stands.
PoseRate rate_of(const GroupOrder& move, const Pose& start, const MoveSpace& space) noexcept {
    const auto& d = move.command.target;
    Eigen::Vector3d linear(d[0], d[1], d[2]), angular(d[3], d[4], d[5]);
    linear /= std::max(1.0, linear.norm());
    angular /= std::max(1.0, angular.norm());
    const Eigen::Quaterniond frame = orientation_of(move.command.frame == mcTCS ? start : move.place.frame);
    const auto can = space.arm->commands();
    const double turning = can[3] || can[4] || can[5] ? turning_velocity(space) : 0;
    return {move.command.dynamics.velocity * (frame * linear), turning * (frame * angular)};
}

/// rad since it was pressed. Where the tool stands says it but for whole turns; these are what of the path is behind it, which counts a radian as a u.
double turned_since(const Pose& pressed, const Pose& here, const PoseRate& rate, double way) noexcept {
    constexpr double turn = 2 * std::numbers::pi;
    const Eigen::Quaterniond by = orientation_of(here) * orientation_of(pressed).conjugate();
    const double angular = rate.angular.norm(), shown = 2 * std::atan2(by.vec().dot(rate.angular) / angular, by.w());
    return shown + turn * std::round((way * angular / std::hypot(rate.linear.norm(), angular) - shown) / turn);
}

/// Looks along a line of poses until it cannot be gone any further.
class PoseWalk {
public:
    PoseWalk(const MoveEnd& from, const MoveSpace& space, const Pose& tool, const Pose& start, const PoseRate& rate)
        : from_(from), space_(space), tool_(tool), start_(start), rate_(rate), near_(from.members) {
        measure_ = space.arm->singularity(joints_of(near_)).measure;
    }

    /// Up to which time, at most `most`: s.
    double reach(double most) {
        double step = std::min(first_step, most);
        for (int i = 0; i < most_looks && time_ < most; ++i) {
            const double next = std::min(time_ + step, most);
            MemberVector q;
            if (look(next, q)) {
                const double turn = turn_between(near_, q);
                take(next, q);
                if (turn < most_turn / 4) step = std::min(1.5 * step, longest_step);
            } else if (step > least_step) {
                step /= 2;
            } else {
                break;
            }
        }
        return time_;
    }
    [[nodiscard]] double turned() const noexcept { return turned_; }
    /// Where it did not reach `most`.
    [[nodiscard]] const Hindrance& why() const noexcept { return why_; }

private:
    static constexpr double first_step = 1e-3, longest_step = 0.02, least_step = 1e-11;  // s

    bool look(double t, MemberVector& q) {
        const Pose pose = pose_of(position_of(start_) + t * rate_.linear, turn_by(t * rate_.angular) * orientation_of(start_));
        const AxisSolution stand = space_.arm->inverse(pose, tool_, from_.configuration, joints_of(near_));
        if (stand.miss.fault == KinematicFault::joint_limit)
            return hindered(limit_of(static_cast<std::size_t>(std::max(stand.miss.joint, 0))));
        if (stand.miss.fault == KinematicFault::orientation) return hindered({JogEnd::orientation, {}});
        if (!stand.ok()) return hindered({JogEnd::reach, {}});
        q = members_of(stand.axes);
        if (turn_between(near_, q) > most_turn) return hindered({JogEnd::singularity, {}});  // of any step: the joints would have to jump
        for (std::size_t k = 0; k < space_.members; ++k) {
            // A hair inside, so that the arm's last digits do not lead out.
            const auto& l = space_.limits[k];
            const double high = std::max(l.high - 1e-9 * size_of(l.high), from_.members[k]);
            const double low = std::min(l.low + 1e-9 * size_of(l.low), from_.members[k]);
            if (q[k] > high || q[k] < low) return hindered(limit_of(k));
        }
        const double measure = space_.arm->singularity(stand.axes).measure;
        return (measure >= nearest_measure && measure >= std::min(jog_margin, measure_) * (1 - 1e-9)) ||
               hindered({JogEnd::singularity, {}});
    }
    bool hindered(const Hindrance& by) noexcept {
        why_ = by;
        return false;
    }
    void take(double t, const MemberVector& q) {
        turned_ += turn_between(near_, q);
        near_ = q;
        time_ = t;
        measure_ = std::max(measure_, space_.arm->singularity(joints_of(q)).measure);
    }
    static Eigen::Quaterniond turn_by(const Eigen::Vector3d& v) noexcept {
        const double angle = v.norm();
        return angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, v / angle)) : Eigen::Quaterniond::Identity();
    }
    [[nodiscard]] double turn_between(const MemberVector& a, const MemberVector& b) const noexcept {
        double most = 0;
        for (std::size_t k = 0; k < space_.arm->joint_count(); ++k)
            if (space_.arm->rotary()[k]) most = std::max(most, std::abs(b[k] - a[k]) * space_.arm->map().settings(k).unit);
        return most;
    }

    const MoveEnd& from_;
    const MoveSpace& space_;
    const Pose& tool_;
    const Pose& start_;
    const PoseRate& rate_;
    MemberVector near_;
    double measure_ = 0;  // the largest so far
    double time_ = 0, turned_ = 0;
    Hindrance why_;
};

/// Whether the members stand as the arm would put them there, and not in a singularity.
ErrorId refuse_start(const MoveEnd& from, const MoveSpace& space, const Pose& tool, const Pose& here, PathHindrance& at) {
    if (space.arm->singularity(joints_of(from.members)).measure < nearest_measure) return ErrorId::singular_path;
    const AxisSolution stand = space.arm->inverse(here, tool, from.configuration, joints_of(from.members));
    if (stand.miss.fault == KinematicFault::joint_limit) {
        at = limit_of(static_cast<std::size_t>(std::max(stand.miss.joint, 0))).at;
        return ErrorId::beyond_software_limit;
    }
    if (!stand.ok()) return ErrorId::out_of_reach;
    const MemberVector q = members_of(stand.axes);
    for (std::size_t k = 0; k < space.members; ++k)
        if (std::abs(q[k] - from.members[k]) > 1e-9 * size_of(q[k])) return ErrorId::out_of_reach;  // a beam that is askew
    return ErrorId::none;
}

MoveShape jog_of_pose(const GroupOrder& move, const MoveEnd& from, const MoveSpace& space) {
    const Pose& tool = move.place.carried.tool;
    const ForwardResult here = space.arm->forward(joints_of(from.members), tool);
    const ForwardResult pressed = space.arm->forward(joints_of(move.target), tool);
    if (!here.miss.ok() || !pressed.miss.ok()) return stands(from);
    const PoseRate rate = rate_of(move, here.pose, space);
    const double linear = rate.linear.norm(), angular = rate.angular.norm();
    double most = longest_time;
    const auto& reach = move.command.jog;
    if (reach.linear > 0 && linear > 0) {
        const double gone = (position_of(here.pose) - position_of(pressed.pose)).norm();
        most = std::min(most, (reach.linear - gone) / linear);
    }
    if (reach.angular > 0 && angular > 0)
        most = std::min(most, (reach.angular - turned_since(pressed.pose, here.pose, rate, move.way)) / angular);
    if (!(most > 0)) return stands(from, {JogEnd::distance, {}});
    if (linear == 0 && angular == 0) return stands(from);
    MoveShape refused;
    refused.error = refuse_start(from, space, tool, here.pose, refused.at);
    if (refused.error != ErrorId::none) return refused;
    PoseWalk walk(from, space, tool, here.pose, rate);
    double time = walk.reach(most);
    Hindrance why = time < most ? walk.why() : Hindrance{JogEnd::distance, {}};
    if (space.workspace != nullptr) {
        const auto at = [&](double t) {
            const Eigen::Vector3d p = position_of(here.pose) + t * rate.linear;
            return std::array<double, 3>{p.x(), p.y(), p.z()};
        };
        const double inside = jog_inside_until(*space.workspace, time, at, [&](double) { return linear; });
        if (inside < time) why = {JogEnd::workspace, room_at(*space.workspace, at(inside))};
        time = inside;
    }
    const double size = position_of(here.pose).norm();
    if (!(linear * time > no_way * size_of(size)) && !(angular * time > no_way)) return stands(from, why);

    MoveShape shape;
    shape.through_arm = true;
    const auto can = space.arm->commands();
    shape.chart = {here.pose.orientation, can[3] || can[4] || can[5] ? 1.0 : 0.0};
    PathVector a = PathVector::Zero(), b = PathVector::Zero();
    a.head<3>() = position_of(here.pose);
    b.head<3>() = position_of(here.pose) + time * rate.linear;
    b.segment<3>(3) = time * (orientation_of(here.pose).conjugate() * rate.angular);
    shape.element = PathElement::line(a, b);
    // Known places along it, dense enough for the turns between them.
    const int places = std::clamp(static_cast<int>(walk.turned() / (5 * most_turn)), 64, 2048);
    PathSection whole;
    whole.element = shape.element;
    whole.chart = shape.chart;
    whole.length = shape.element.length();
    RunSection run;
    run.through_arm = true;
    run.carried = move.place.carried;
    run.configuration = from.configuration;
    MemberVector near = from.members;
    for (int i = 0; i <= places; ++i) {
        const WayPoint w = way_point(whole, run, whole.length * i / places, space.arm, space.members, near);
        if (!w.miss.ok()) return stands(from);
        shape.members.push_back(near = w.q);
    }
    shape.end = {near, from.configuration};
    const auto& d = move.command.dynamics;
    const double scale = linear > 0 ? linear / d.velocity : angular / d.velocity;  // as long to its speed, whatever it is
    shape.feed = PathFeed{linear > 0 ? linear : angular, scale * d.acceleration, scale * d.deceleration, scale * d.jerk};
    return shape;
}

}  // namespace

MoveShape jog_shape(const GroupOrder& move, const MoveEnd& from, const MoveSpace& space) {
    for (std::size_t k = 0; k < space.members; ++k)
        if (from.members[k] > space.limits[k].high || from.members[k] < space.limits[k].low) {
            MoveShape shape;
            shape.error = ErrorId::beyond_software_limit;
            shape.at = limit_of(k).at;
            return shape;
        }
    MoveShape shape = move.command.frame == mcACS ? jog_of_axes(move, from, space)
                      : space.arm != nullptr      ? jog_of_pose(move, from, space)
                                                  : stands(from);
    // Of a distance that is none at all nothing has been gone, and nobody would have noticed.
    if (shape.empty && shape.jog_end == JogEnd::distance && move.way == 0 && move.target == from.members) {
        shape.empty = false;
        shape.error = ErrorId::invalid_position;
    }
    return shape;
}

}  // namespace taktwerk::axes
