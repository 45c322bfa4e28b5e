#include "axes/group/path_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/group/member_limits.hpp"
#include "axes/group/path_run_inside.hpp"
#include "axes/group/tool_motion.hpp"

namespace taktwerk::axes {
namespace {

/// A part of a limit that counts as using it.
constexpr double in_use = 0.98;

MemberLimits limits_of(const Axis& axis) noexcept {
    const auto& limits = axis.config().limits;
    MemberLimits m;
    // A path turns: what holds in one direction only is kept in both.
    m.velocity = std::min({limits.velocity_towards(1), limits.velocity_towards(-1), axis.velocity_of_mode()});
    m.acceleration = std::min(
        {limits.acceleration_towards(1), limits.acceleration_towards(-1), limits.deceleration_towards(1), limits.deceleration_towards(-1)});
    // Without a limit: an acceleration builds up within a few milliseconds.
    constexpr double shortest_ramp = 0.002;
    m.jerk = std::isfinite(limits.jerk) ? limits.jerk : m.acceleration / shortest_ramp;
    const bool hold = axis.view().homed;
    m.low = hold ? limits.position_min : -std::numeric_limits<double>::infinity();
    m.high = hold ? limits.position_max : std::numeric_limits<double>::infinity();
    return m;
}

void cap(MemberLimits& m, const JoggingDynamics& caps, std::size_t place) noexcept {
    const auto lower = [](double& limit, double most) {
        if (most > 0) limit = std::min(limit, most);
    };
    m.speeding = m.braking = m.acceleration;
    lower(m.velocity, caps.velocity[place]);
    lower(m.speeding, caps.acceleration[place]);
    lower(m.braking, caps.deceleration[place]);
    m.acceleration = std::max(m.speeding, m.braking);
    lower(m.jerk, caps.jerk[place]);
}

}  // namespace

PathRun::PathRun(std::span<Axis> axes, const AxisGroupConfig& config, Duration cycle, const PathShelf* paths)
    : inside_(std::make_unique<Inside>(axes, config, cycle, paths)) {}
PathRun::PathRun(PathRun&&) noexcept = default;
PathRun::~PathRun() = default;

void PathRun::service() { inside_->planner.step(); }

// --- orders ---------------------------------------------------------------------------------------------------------------------

void PathRun::tell() noexcept {
    auto& in = *inside_;
    if (in.told) return;
    in.wish.kind = GroupOrder::Kind::wish;
    in.told = in.link.orders.try_push(in.wish);
}

bool PathRun::restart(const GroupMembers& members, const Override& factors, const JoggingDynamics* caps, const JointVector* from) noexcept {
    auto& in = *inside_;
    GroupOrder order;
    order.kind = GroupOrder::Kind::restart;
    order.life = in.life + 1;
    order.factors = factors;
    std::size_t count = 0;
    for (std::size_t i = 0; i < most_members; ++i) {
        states_[i] = {};
        if (!members.has(i) || count == max_path_axes) continue;
        order.from[count] = from != nullptr ? (*from)[i] : members.axis(i).view().set_position;
        order.limits[count] = limits_of(members.axis(i));
        if (caps != nullptr) cap(order.limits[count], *caps, i);
        states_[i] = {order.from[count], 0, 0};
        end_[i] = order.from[count];
        in.places[count++] = static_cast<std::uint8_t>(i);
    }
    order.members = static_cast<std::uint8_t>(count);
    order.tool_velocity = in.tool_velocity.to_hold;
    if (!in.link.orders.try_push(order)) return false;
    clear();
    ++in.life;
    in.begun = 0;
    in.link.at_run.store(GroupLink::both(in.life, 0), std::memory_order_release);
    in.members = count;
    in.limits = order.limits;
    in.tool_velocity.planned = order.tool_velocity;
    in.q = order.from;
    in.wish = order;
    in.told = true;
    exists_ = true;
    return true;
}

void PathRun::keep_tool_below(double velocity) noexcept { inside_->tool_velocity.to_hold = velocity; }

bool PathRun::fits(const GroupMembers& members) const noexcept {
    const auto& in = *inside_;
    if (in.tool_velocity.to_hold < in.tool_velocity.planned) return false;
    for (std::size_t k = 0; k < in.members; ++k) {
        if (!members.has(in.places[k])) return false;
        const MemberLimits now = limits_of(members.axis(in.places[k])), &then = in.limits[k];
        const bool wide = now.velocity >= then.velocity && now.acceleration >= then.acceleration && now.jerk >= then.jerk;
        if (!wide || now.low > then.low || now.high < then.high) return false;
    }
    return true;
}

bool PathRun::send(CommandId id, const GroupCommand& command, const CommandPlace& place, const PathDynamics& dynamics, bool joins,
                   const JointVector* pressed, double way) noexcept {
    auto& in = *inside_;
    GroupOrder order;
    order.kind = GroupOrder::Kind::move;
    order.life = in.life;
    order.id = id;
    order.command = command;
    order.command.dynamics = dynamics;
    for (std::size_t k = 0; k < in.members; ++k) {
        order.target[k] = (pressed != nullptr ? *pressed : command.target)[in.places[k]];
        if (pressed != nullptr && command.frame == mcACS) order.command.target[k] = command.target[in.places[k]];
    }
    order.place = place;
    order.way = way;
    order.joins = joins;
    return in.link.orders.try_push(order);
}

std::optional<PathPlace> PathRun::verdict(CommandId id) const noexcept {
    for (const auto& v : inside_->verdicts.said)
        if (v.id == id && v.life == inside_->life && !v.standing)
            return PathPlace{.error = v.error, .line = v.line, .at = inside_->by_place(v.at)};
    return std::nullopt;
}

JogEnd PathRun::jog_end(CommandId id) const noexcept {
    const auto& in = *inside_;
    for (const auto& v : in.verdicts.said)
        if (v.id == id && v.life == in.life && v.jog_end != JogEnd::none) return v.jog_end;
    return JogEnd::none;
}

void PathRun::override_with(const Override& factors) noexcept {
    auto& in = *inside_;
    if (stops_ || factors == in.wish.factors) return;
    in.wish.factors = factors;
    in.told = false;
    tell();
}

void PathRun::stand(const PathDynamics& ramp, bool own, const Override& factors) noexcept {
    auto& in = *inside_;
    if (!exists_) return;
    stops_ = true;
    if (in.drive.on()) return in.drive.stand(ramp);
    in.wish.stands = true;
    in.wish.own_ramp = own;
    in.wish.factors = factors;
    in.wish.ramp = ramp;
    in.told = false;
    tell();
}

void PathRun::resume(const Override& factors) noexcept {
    auto& in = *inside_;
    stops_ = false;
    if (in.drive.on()) return in.drive.go();
    in.wish.stands = false;
    in.wish.factors = factors;
    in.wish.ramp = {};
    in.told = false;
    tell();
}

// --- the way --------------------------------------------------------------------------------------------------------------------

bool PathRun::begin(CommandId id) noexcept {
    auto& in = *inside_;
    if (!exists_) return false;
    if (in.player && in.track->last.load(std::memory_order_acquire) >= id) {
        arrived_ = false;
        return true;
    }
    if (in.take_next(id) == nullptr) return false;
    take_track();
    return true;
}

/// Onto the run that was taken.
void PathRun::take_track() noexcept {
    auto& in = *inside_;
    RunTrack& next = in.link.tracks[in.begun % 2];
    if (in.player) in.late += in.player->late();
    in.player.reset();
    in.drive.end();
    in.track = &next;
    if (next.drive.driven) begin_driven();
    else in.player.emplace(next.exchange, 0.0);
    ++in.begun;
    in.link.at_run.store(GroupLink::both(in.life, in.begun), std::memory_order_release);
    arrived_ = false;
}

bool PathRun::at_end_of_run() const noexcept {
    const auto& in = *inside_;
    if (in.drive.on()) return false;
    return !in.player || (in.player->standing() && s_.position >= in.track->closed.load(std::memory_order_acquire) * (1 - 1e-12));
}

const PathNote* PathRun::note() noexcept {
    auto& in = *inside_;
    for (PathNote next; !in.note && in.link.notes.try_pop(next);)
        if (next.life == in.life) {
            next.place.at = in.by_place(next.place.at);
            in.note = next;
        }
    if (!exists_ || !in.note) return nullptr;
    const auto& n = *in.note;
    if (n.kind != PathNote::Kind::tell) return n.run == in.begun && at_end_of_run() ? &n : nullptr;
    const bool passed = in.begun > n.run + 1 || (in.begun == n.run + 1 && in.player && (in.player->part() >= n.part || at_end_of_run()));
    return passed || (in.begun == n.run && at_end_of_run()) ? &n : nullptr;
}

void PathRun::drop_note() noexcept { inside_->note.reset(); }

void PathRun::go_over(CommandId id) noexcept {
    auto& in = *inside_;
    const bool first = in.note && in.note->run == in.begun;  // that is in front of it
    if (!exists_ || stops_ || first || !at_end_of_run()) return;
    if (in.take_next(id) != nullptr) take_track();
}

void PathRun::clear() noexcept {
    auto& in = *inside_;
    if (in.player) in.late += in.player->late();
    in.player.reset();
    in.drive.end();
    in.track = nullptr;
    in.verdicts.said = {};
    in.note.reset();
    s_ = {};
    command_ = 0;
    line_ = number_ = 0;
    length_ = remaining_ = 0;
    corner_ = CornerPassed::none;
    exists_ = arrived_ = stops_ = false;
    stuck_ = fault_ = ErrorId::none;
    limiter_ = PathLimiter::none;
    members_on_way_ = 0;
}

/// The next run may be known to be stuck long before this one is over.
ErrorId PathRun::stuck() const noexcept {
    if (!exists_ || stuck_ == ErrorId::none) return ErrorId::none;
    const std::uint32_t begun = inside_->begun;
    return stuck_run_ == begun || (stuck_run_ == begun + 1 && at_end_of_run()) ? stuck_ : ErrorId::none;
}

bool PathRun::over() const noexcept {
    if (!exists_) return true;
    const auto& in = *inside_;
    if (in.drive.on()) return in.drive.rests() || fault_ != ErrorId::none;
    return !in.player || (in.player->standing() && (stops_ || arrived_ || stuck() != ErrorId::none)) || fault_ != ErrorId::none;
}

void PathRun::advance(Duration period) noexcept {
    auto& in = *inside_;
    tell();
    for (GroupVerdict v; in.link.verdicts.try_pop(v);) {
        if (v.life != in.life) continue;
        if (v.standing) {
            stuck_ = v.error;
            stuck_run_ = v.run;
        }
        in.verdicts.said[in.verdicts.next++ % in.verdicts.said.size()] = v;
    }
    if (!exists_ || !in.goes() || fault_ != ErrorId::none) return;
    if (in.drive.on()) return go_driven(period);
    const PathMotion& now = in.player->step(to_seconds(period));
    s_ = {now.s, now.velocity, now.acceleration};
    in.period = to_seconds(period);
    in.before = in.acceleration;
    look();
}

/// Where that is for the members.
void PathRun::look() noexcept {
    auto& in = *inside_;
    const std::uint32_t part = in.part();
    const RunSection& run = in.track->section(part);
    const double s = in.place();
    in.track->part.store(part, std::memory_order_relaxed);
    in.track->s.store(s, std::memory_order_relaxed);
    in.track->velocity.store(s_.velocity, std::memory_order_relaxed);
    if (run.section.command == 0) return;  // it stands in front of the first stretch
    const bool before = run.section.blend && s < run.section.begin + run.section.length / 2;
    command_ = before ? run.before : run.section.command;
    if (!before) corner_ = run.corner_passed;
    carried_ = run.carried;
    line_ = run.line;
    number_ = run.number;
    arrived_ = in.player && in.player->standing() && !run.section.blend && s >= run.corner * (1 - 1e-12);
    length_ = before ? run.way_before : run.way;
    remaining_ = before              ? run.section.begin + run.section.length / 2 - s
                 : run.section.blend ? run.section.end() - s + run.rest
                                     : std::max(run.corner - s, 0.0);
    length_ = std::max(length_, remaining_);
    if (arrived_) {
        remaining_ = 0;
        in.q = run.to;
        in.velocity = in.acceleration = {};
    } else {
        in.at = way_point(run.section, run, s, in.arm.get(), in.members, in.q, 2);
        if (!in.at.miss.ok()) {
            fault_ = ErrorId::out_of_reach;
            return;
        }
        in.q = in.at.q;
        members_on_way_ = 0;
        for (std::size_t k = 0; k < in.members && !run.through_arm; ++k)
            if (in.at.first[k] != 0) members_on_way_ = static_cast<std::uint16_t>(members_on_way_ | 1u << in.places[k]);
        for (std::size_t k = 0; k < in.members; ++k) {
            in.velocity[k] = in.at.first[k] * s_.velocity;
            in.acceleration[k] = in.at.first[k] * s_.acceleration + in.at.second[k] * s_.velocity * s_.velocity;
        }
    }
    for (std::size_t k = 0; k < in.members; ++k) {
        states_[in.places[k]] = {in.q[k], in.velocity[k], in.acceleration[k]};
        if (!before) end_[in.places[k]] = run.to[k];
    }
    see_limits();
}

bool PathRun::see_tool(ToolMotion& motion) const noexcept {
    const auto& in = *inside_;
    if (!exists_ || !in.player) return false;
    const RunSection& run = in.track->section(in.player->part());
    if (run.section.command == 0 || !run.through_arm) return false;
    const PosePoint pose = pose_point(run.section.at(s_.position), run.section.chart);
    const double v = s_.velocity, a = s_.acceleration;
    motion.position = pose.position;
    motion.orientation = pose.orientation;
    motion.velocity = pose.linear[0] * v;
    motion.acceleration = pose.linear[0] * a + pose.linear[1] * (v * v);
    motion.turning = pose.angular[0] * v;
    motion.turning_faster = pose.angular[0] * a + pose.angular[1] * (v * v);
    motion.configuration = run.configuration;
    motion.tool = run.carried.tool;
    return true;
}

void PathRun::see_limits() noexcept {
    auto& in = *inside_;
    limiter_ = PathLimiter::none;
    if (in.player ? in.player->standing() : s_.velocity == 0) return;
    double most = 0;
    for (std::size_t k = 0; k < in.members; ++k) {
        const auto& limits = in.limits[k];
        const double jerk = (in.acceleration[k] - in.before[k]) / in.period;
        const double use = std::max(
            {std::abs(in.velocity[k]) / limits.velocity, std::abs(in.acceleration[k]) / limits.acceleration, std::abs(jerk) / limits.jerk});
        if (use <= most) continue;
        most = use;
        narrowest_ = in.places[k];
    }
    if (in.player && in.wish.factors.velocity < 1) limiter_ = PathLimiter::override_factor;  // none of what an axis drives (G-072)
    else limiter_ = most >= in_use ? PathLimiter::axis : PathLimiter::command;
}

std::uint64_t PathRun::serial() const noexcept { return exists_ ? GroupLink::both(inside_->life, inside_->begun) : 0; }

double PathRun::remaining_time() const noexcept {
    const auto& in = *inside_;
    if (!in.player || stops_ || arrived_) return 0;
    const double ends = in.player->stretch_end();
    return std::abs(ends - s_.position - remaining_) <= 1e-9 * std::max(1.0, ends) ? in.player->time_left() : 0;
}

UsableLimits path_limits_of(const Axis& axis) noexcept {
    const auto m = limits_of(axis);
    return {m.velocity, m.acceleration, m.jerk};
}

std::uint32_t PathRun::late() const noexcept {
    const auto& in = *inside_;
    return in.late + (in.player ? in.player->late() : 0);
}

}  // namespace taktwerk::axes
