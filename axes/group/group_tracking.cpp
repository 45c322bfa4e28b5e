#include "axes/group/group_tracking.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "axes/group/braking_way.hpp"
#include "axes/group/group_equipment.hpp"
#include "axes/group/leading_axis.hpp"
#include "axes/group/member_limits.hpp"
#include "axes/group/tool_motion.hpp"
#include "axes/group/way_point.hpp"
#include "axes/group/workspace.hpp"
#include "axes/pose_math.hpp"

namespace taktwerk::axes {
namespace {

/// Of the velocity that is there for the frame: a follower needs the rest to come up to it.
constexpr double usable_share = 0.99;
constexpr double digits = 1e-9, slack = 1e-6, jerk_slack = 1e-3;
constexpr double endless = 1e9;
/// Of a place, that its sums cost.
constexpr double last_digits = 1e-15;

struct Bounds {
    UsableLimits limits;
    double low = 0, high = 0;
};
Bounds bounds_of(const Axis& axis) noexcept {
    const auto& limits = axis.config().limits;
    const bool homed = axis.view().homed;
    const double inf = std::numeric_limits<double>::infinity();
    return {path_limits_of(axis), homed ? limits.position_min : -inf, homed ? limits.position_max : inf};
}

/// Where it comes to rest at the farthest, if it begins to brake now: first its acceleration is taken away, then it brakes with all it has.
double rest_of(const MotionState& at, const UsableLimits& limits) noexcept {
    const double sense = at.velocity < 0 ? -1 : 1;
    const double faster = std::max(0.0, sense * at.acceleration), t = faster / limits.jerk;
    const double speed = std::abs(at.velocity) + faster * t / 2;
    const double until = std::abs(at.velocity) * t + faster * t * t / 3;
    const double a = limits.acceleration, j = limits.jerk;
    const double braking = speed * j >= a * a ? speed * speed / (2 * a) + speed * a / (2 * j) : speed * std::sqrt(speed / j);
    return at.position + sense * (until + braking);
}

/// From one set-point to the next: place, velocity and acceleration are of one motion. Of what is measured the velocity is held to the acceleration.
bool joins(const MotionState& from, const MotionState& next, const UsableLimits& most, bool planned, double t, double far) noexcept {
    const double jerk = planned ? most.jerk : 2 * most.acceleration / t;
    const double way = next.position - from.position, faster = next.velocity - from.velocity;
    return std::abs(next.acceleration - from.acceleration) <= jerk * t * (1 + jerk_slack) + digits &&
           std::abs(faster) <= most.acceleration * t * (1 + digits) && std::abs(way) <= most.velocity * t * (1 + digits) + digits &&
           std::abs(way - t * (next.velocity + from.velocity) / 2) <= jerk * t * t * t / 2 + digits + far;
}

ToolMotion at_rest(const Kinematics& arm, const JointVector& members, const Pose& tool) noexcept {
    MemberVector q{};
    for (std::size_t i = 0; i < max_joints; ++i) q[i] = members[i];
    const auto stand = arm.forward(joints_of(q), tool);
    ToolMotion still;
    still.position = position_of(stand.pose);
    still.orientation = orientation_of(stand.pose);
    still.configuration.branch = arm.configuration(joints_of(q)).branch;
    still.tool = tool;
    return still;
}

}  // namespace

struct GroupTracking::Inside {
    std::shared_ptr<const Kinematics> arm;
    std::shared_ptr<const Workspace> workspace;
    double out = 0;  // by how much the tool's point is where it may not be; only less from then on
    Pose watched{};  // whose point that is, from the flange
    struct Product {
        std::uint32_t serial = 0;
        MasterTrack master;
    };
    std::array<Product, product_frames> products{};
    Conveyance frame{};
    ToolMotion still{};  // the last one
    MemberVector q{};    // as given
    std::optional<EndlessMotion> master;
    bool planned = false;               // it comes from set-points
    std::optional<MotionState> before;  // its way, a cycle ago
    double drag = 0;                    // u of the tool's point per u of the frame's way
};

GroupTracking::GroupTracking(std::span<Axis> axes, std::shared_ptr<const Kinematics> arm, std::shared_ptr<const Workspace> workspace)
    : axes_(axes), inside_(std::make_unique<Inside>()) {
    inside_->arm = std::move(arm);
    inside_->workspace = std::move(workspace);
}
GroupTracking::GroupTracking(GroupTracking&&) noexcept = default;
GroupTracking::~GroupTracking() = default;

namespace {

/// u of a table's axis in a turn.
double turn_of(const Axis& axis) noexcept { return axis.config().modulo; }

/// A tool that is turned about less than the table turns about would slip on it.
bool turns_with(const Kinematics& arm, const Conveyance& frame) noexcept {
    if (!frame.turns) return true;
    constexpr double parallel = 1e-6;  // rad
    const auto which = arm.commands();
    const Eigen::Vector3d about = orientation_of(arm.base()).conjugate() * frame.axis;
    for (std::size_t i = 0; i < 3; ++i)
        if (!which[3 + i] && std::abs(about[static_cast<Eigen::Index>(i)]) > parallel) return false;
    return true;
}

}  // namespace

ErrorId GroupTracking::take(FrameTrack& track, const GroupFrames& frames, const GroupMembers& members) noexcept {
    if (track.master.index >= axes_.size()) return ErrorId::invalid_axis;
    if (inside_->arm == nullptr) return ErrorId::no_kinematics;
    if (members.contains(track.master)) return ErrorId::invalid_axis;
    if (track.kind == FrameTrack::Kind::table && !(turn_of(axes_[track.master.index]) > 0)) return ErrorId::not_supported;
    if (!turns_with(*inside_->arm, conveyance_of(track, pose_of_numbers(frames.machine), turn_of(axes_[track.master.index]))))
        return ErrorId::not_supported;
    const auto reading = leading_reading(axes_[track.master.index]);
    if (!reading.usable) return ErrorId::frame_lost;
    track.reference = reading.motion.place;
    track.serial = ++serials_;
    return ErrorId::none;
}

void GroupTracking::watch(GroupFrames& frames, Instant now, Duration period) noexcept {
    auto& in = *inside_;
    const double seconds = to_seconds(period);
    for (std::size_t i = 0; i < product_frames; ++i) {
        const auto& track = frames.tracks[i];
        auto& seen = in.products[i];
        if (!track.moves()) continue;
        if (seen.serial != track.serial) seen = {track.serial, {}};
        const Axis& axis = axes_[track.master.index];
        const double feed = leading_reading(axis).feed;
        if (const auto motion = next_of_leading(seen.master, axis, now, seconds))
            frames.product[i] = numbers_of(object_at(track, way(track.reference, motion->place, feed), turn_of(axis)));
    }
    if (in.master) in.before = {way(track_.reference, in.master->place, feed_), in.master->velocity, in.master->acceleration};
    in.master.reset();
    if (!follows()) return;
    const Axis& axis = axes_[track_.master.index];
    in.planned = leading_reading(axis).planned;
    if (axis.view().state != AxisState::ErrorStop) in.master = next_of_leading(master_, axis, now, seconds);
}

ErrorId GroupTracking::prepare(const FrameTrack& track, const GroupMembers& members) noexcept {
    auto& in = *inside_;
    const Axis& axis = axes_[track.master.index];
    const auto reading = leading_reading(axis);
    if (!reading.usable || axis.view().state == AxisState::ErrorStop) return ErrorId::frame_lost;
    const auto frame = conveyance_of(track, pose_of_numbers(track.machine), turn_of(axis));
    if (!turns_with(*in.arm, frame)) return ErrorId::not_supported;  // the machine's frame has been turned since
    clear();
    track_ = track;
    feed_ = reading.feed;
    for (std::size_t i = 0; i < product_frames; ++i)  // its filter has settled already
        if (in.products[i].serial == track.serial) master_ = in.products[i].master;
    way_ = {way(track.reference, reading.motion.place, feed_), 0, 0};
    in.frame = frame;
    const auto at = members.set_positions();
    for (std::size_t i = 0; i < most_members; ++i) states_[i] = {at[i], 0, 0};
    plan_anew(members);
    in.out = -std::numeric_limits<double>::infinity();
    phase_ = Phase::prepared;
    see_room(members);
    return ErrorId::none;
}

/// What moves on the frame stands: nothing that is given changes by this.
void GroupTracking::plan_anew(const GroupMembers& members) noexcept {
    auto& in = *inside_;
    begun_at_ = way_.position;
    planned_ = seen_from(pose_of_numbers(track_.machine), object_at(track_, begun_at_, turn_of(axes_[track_.master.index])));
    const auto at = members.set_positions();
    for (std::size_t i = 0; i < max_joints; ++i) in.q[i] = at[i];
    in.still = at_rest(*in.arm, at, Pose{});
}

void GroupTracking::engage() noexcept {
    if (phase_ != Phase::prepared) return;
    phase_ = Phase::following;
    fresh_ = true;
}

void GroupTracking::release() noexcept {
    if (phase_ == Phase::prepared) phase_ = Phase::resting;
    if (phase_ != Phase::following) return;
    phase_ = Phase::leaving;
    leaving_ = plan_stop(way_, rest_);
    left_ = {};
}

void GroupTracking::clear() noexcept {
    phase_ = Phase::off;
    fault_ = ErrorId::none;
    fresh_ = false;
    difference_.clear();
    inside_->master.reset();
    inside_->before.reset();
    master_.forget();
}

JoggingDynamics GroupTracking::path_caps(const GroupMembers& members) const noexcept {
    JoggingDynamics caps;
    for (std::size_t i = 0; i < most_members; ++i) {
        if (!members.has(i)) continue;
        const auto limits = path_limits_of(members.axis(i));
        caps.velocity[i] = path_share * limits.velocity;
        caps.acceleration[i] = caps.deceleration[i] = path_share * limits.acceleration;
        caps.jerk[i] = path_share * limits.jerk;
    }
    return caps;
}

/// What the frame's way may do: its half of each member, as the arm stands.
void GroupTracking::see_room(const GroupMembers& members) noexcept {
    auto& in = *inside_;
    const MotionState gone{way_.position - begun_at_, 0, 0};
    const auto point = carried_by(in.frame, gone, in.still).position;
    const auto drag = drag_at(in.frame, point);
    in.drag = Eigen::Vector3d(drag.position[0][0], drag.position[0][1], drag.position[0][2]).norm();
    const auto d = in.arm->derivatives(joints_of(in.q), in.still.tool, drag);
    MotionLimits most{endless, endless, endless, endless};
    for (std::size_t i = 0; i < in.arm->joint_count(); ++i) {
        if (!members.has(i)) continue;
        const auto limits = path_limits_of(members.axis(i));
        const double share = 1 - path_share, first = std::abs(d.of[0][i]);
        const double bent = std::abs(d.of[1][i]) * way_.velocity * way_.velocity;
        if (first < 1e-12) continue;
        most.velocity = std::min(most.velocity, share * limits.velocity / first);
        most.acceleration = std::min(most.acceleration, std::max(share * limits.acceleration - bent, 0.1 * limits.acceleration) / first);
        most.jerk = std::min(most.jerk, share * limits.jerk / first);
    }
    most.deceleration = most.acceleration;
    rest_ = most;
}

/// What the frame's way lacks of its master runs down beside it, whatever the master does meanwhile; only where both together would become too fast it is
/// thought over.
MotionState GroupTracking::come_nearer(const MotionState& goal, Duration cycle) noexcept {
    auto& in = *inside_;
    const auto plan = [&](const MotionState& from, double beside) {
        const double least = 0.01 * rest_.velocity, a = rest_.acceleration / 2, j = rest_.jerk / 2;
        const SignLimits up{std::max(rest_.velocity - beside, least), a, a, j}, down{std::max(rest_.velocity + beside, least), a, a, j};
        const auto made = Difference::plan(from, {up, down});
        if (made.error == PlanError::none) difference_.run(made.profile);
    };
    if (fresh_) {
        const double t = to_seconds(cycle);
        const MotionState told{goal.position - t * (goal.velocity - t * goal.acceleration / 2), goal.velocity - t * goal.acceleration,
                               goal.acceleration};
        const auto was = in.before.value_or(told);
        plan({way_.position - was.position, way_.velocity - was.velocity, way_.acceleration - was.acceleration}, was.velocity);
        fresh_ = false;
    } else if (!difference_.finished()) {
        const auto& now = difference_.state();
        const double speed = goal.velocity + now.velocity, faster = goal.acceleration + now.acceleration;
        const double soon = std::abs(speed) + (speed * faster > 0 ? faster * faster / rest_.jerk : 0);
        if (soon > usable_share * rest_.velocity) plan(now, goal.velocity);
    }
    const MotionState next = difference_.advance(cycle);
    return difference_.finished() ? MotionState{} : next;
}

/// It is not where its velocity has brought it: its zero was changed, or its drive was switched on where it was not thought to be. Of what is measured
/// already the filter makes a velocity, which no member could take.
bool GroupTracking::jumps(const MotionState& next, double period) const noexcept {
    const double mean = period * (next.velocity + way_.velocity) / 2, far = last_digits * std::abs(next.position);
    const double most = inside_->planned ? rest_.jerk * period * period * period : rest_.acceleration / (1 - path_share) * period * period;
    const double faster = inside_->planned ? 0 : std::abs(next.velocity - way_.velocity);
    return std::abs(next.position - way_.position - mean) > most + digits + far || faster > rest_.acceleration / (1 - path_share) * period;
}

void GroupTracking::follow(double period, Duration cycle) noexcept {
    auto& in = *inside_;
    const auto let_go = [&](ErrorId why) {
        fault_ = why;
        release();
    };
    if (phase_ == Phase::following && !in.master) let_go(ErrorId::frame_lost);
    if (phase_ == Phase::following && std::abs(in.master->velocity) > usable_share * rest_.velocity) let_go(ErrorId::frame_too_fast);
    if (phase_ == Phase::following) {
        const auto& master = *in.master;
        const MotionState goal{way(track_.reference, master.place, feed_), master.velocity, master.acceleration};
        const MotionState beside = come_nearer(goal, cycle);
        const MotionState next{goal.position + beside.position, goal.velocity + beside.velocity, goal.acceleration + beside.acceleration};
        // What is measured trembles: of that the jerk is what it is.
        const double bend = std::abs(next.acceleration - way_.acceleration) / period;
        // A master that is planned behind the group and bends harder than it may: what was foreseen of it does not fit to what it does.
        const double torn = std::abs(next.velocity - way_.velocity - period * (next.acceleration + way_.acceleration) / 2);
        const bool harder = in.planned && (bend > rest_.jerk * (1 + slack) + digits || torn > rest_.jerk * period * period / 2 + digits ||
                                           std::abs(next.acceleration) > rest_.acceleration * (1 + slack));
        if (harder) let_go(ErrorId::frame_too_fast);
        else if (jumps(next, period)) let_go(ErrorId::frame_lost);
        else way_ = next;
    }
    if (phase_ == Phase::following) return;
    if (phase_ != Phase::leaving) return;
    left_ += cycle;
    const double t = to_seconds(left_);
    const auto& profile = leaving_.profile;
    way_ = profile.at(std::min(t, profile.duration()));
    if (leaving_.error != PlanError::none || t < profile.duration()) return;
    way_.velocity = way_.acceleration = 0;
    phase_ = Phase::resting;
}

/// Where it is, and all of the way on which it would come to rest if each member braked now.
bool GroupTracking::in_workspace(const std::array<MotionState, most_members>& next, const GroupMembers& members, double period) noexcept {
    auto& in = *inside_;
    if (in.workspace == nullptr) return true;
    const auto room = [&](const std::array<MotionState, most_members>& states) {
        Joints at{};
        for (std::size_t i = 0; i < in.arm->joint_count(); ++i) at[i] = states[i].position;
        const auto point = in.arm->forward(at, in.still.tool).pose.position;
        return in.workspace->clearance(point) + wall_digits(point);
    };
    if (std::isinf(in.out) || in.watched != in.still.tool) in.out = std::min(0.0, room(states_));  // where it stood
    in.watched = in.still.tool;
    const double now = room(next);
    const bool good = now >= std::min(0.0, in.out) &&
                      brakes_inside(next, members, period, {in.arm.get(), in.workspace.get(), in.still.tool, std::min(now, 0.0)});
    in.out = std::max(in.out, std::min(now, 0.0));
    return good;
}

ErrorId GroupTracking::step(const ToolMotion* still, const GroupMembers& members, Duration period) noexcept {
    if (phase_ == Phase::prepared) return ErrorId::none;  // it stands, however its members stand
    auto& in = *inside_;
    if (still != nullptr) in.still = *still;
    else in.still.velocity = in.still.acceleration = in.still.turning = in.still.turning_faster = Eigen::Vector3d::Zero();
    see_room(members);
    follow(to_seconds(period), period);
    const MotionState gone{way_.position - begun_at_, way_.velocity, way_.acceleration};
    const ToolMotion at = carried_by(in.frame, gone, in.still);
    const auto stand = in.arm->inverse(pose_of(at.position, at.orientation), at.tool, at.configuration, joints_of(in.q));
    if (!stand.ok() || in.arm->singularity(stand.axes).measure < least_singularity) return ErrorId::frame_limit;
    const auto numbers = [](const Eigen::Vector3d& v) { return std::array<double, 3>{v.x(), v.y(), v.z()}; };
    PathDerivatives motion;
    motion.position = {numbers(at.velocity), numbers(at.acceleration), {}};
    motion.turn = {numbers(at.turning), numbers(at.turning_faster), {}};
    const auto d = in.arm->derivatives(stand.axes, at.tool, motion);
    if (!d.miss.ok()) return ErrorId::frame_limit;
    std::array<MotionState, most_members> next = states_;
    for (std::size_t i = 0; i < in.arm->joint_count(); ++i) {
        if (!members.has(i)) continue;
        next[i] = {stand.axes[i], d.of[0][i], d.of[1][i]};
        const auto bounds = bounds_of(members.axis(i));
        const double rests = rest_of(next[i], bounds.limits);
        const bool inside =
            joins(states_[i], next[i], bounds.limits, in.planned, to_seconds(period), last_digits * std::abs(way_.position)) &&
            std::abs(next[i].velocity) <= bounds.limits.velocity * (1 + digits) &&
            std::abs(next[i].acceleration) <= bounds.limits.acceleration * (1 + digits) &&
            (next[i].velocity == 0 || (rests <= bounds.high && rests >= bounds.low));
        if (!inside) return ErrorId::frame_limit;
    }
    if (!in_workspace(next, members, to_seconds(period))) return ErrorId::frame_limit;
    states_ = next;
    for (std::size_t i = 0; i < max_joints; ++i) in.q[i] = stand.axes[i];
    return ErrorId::none;
}

void GroupTracking::publish(GroupView& view) const noexcept {
    const bool on = active();
    view.track = {on ? track_.master : AxisRef{}, in_sync(), engaged() ? -difference_.state().position * inside_->drag : 0,
                  on ? track_.serial : 0, on ? track_.kind : FrameTrack::Kind::none};
}

}  // namespace taktwerk::axes
