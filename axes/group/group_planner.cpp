#include "axes/group/group_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/path/transition.hpp"

namespace taktwerk::axes {
namespace {

PathFeed feed_of(const PathDynamics& d) noexcept {
    return {std::max(d.velocity, 0.0), std::max(d.acceleration, 0.0), std::max(d.deceleration, 0.0), std::max(d.jerk, 0.0)};
}

/// Pieces of nearly one length would leave straight parts of a millionth between their curves, around which time is planned in cells of that size.
constexpr double share_of_short_pieces = 0.45;

bool asks_for_a_curve(const GroupOrder& move) noexcept {
    return move.command.transition != mcTMNone && move.command.transition_parameter > 0;
}

/// Braking from v, limited in jerk.
double stopping_way(double v, double a, double j) noexcept {
    return v * j >= a * a ? v * v / (2 * a) + v * a / (2 * j) : v * std::sqrt(v / j);
}

}  // namespace

void GroupPlanner::restart(const GroupOrder& order) {
    life_ = order.life;
    wish_ = order;
    ++revision_;
    moves_.clear();
    first_.reset();
    walk_.reset();
    runs_ = {};
    for (auto& track : link_.tracks) track.ready.store(0, std::memory_order_release);
    next_ = 0;
    space_.members = order.members;
    space_.limits = order.limits;
    space_.tool_velocity = order.tool_velocity;
    end_ = {order.from, {}};
    if (space_.arm != nullptr) end_.configuration.branch = space_.arm->configuration(joints_of(order.from)).branch;
}

void GroupPlanner::take(const GroupOrder& order) {
    switch (order.kind) {
        case GroupOrder::Kind::restart: restart(order); break;
        case GroupOrder::Kind::move:
            if (order.life == life_) moves_.push_back(order);
            break;
        case GroupOrder::Kind::wish: {
            const bool other = order.factors.acceleration != wish_.factors.acceleration || order.factors.jerk != wish_.factors.jerk;
            const bool other_ramp = order.stands && (!wish_.stands || order.own_ramp != wish_.own_ramp || order.ramp != wish_.ramp);
            if (other || other_ramp) ++revision_;
            wish_ = order;
            break;
        }
    }
}

void GroupPlanner::step() {
    GroupOrder order;
    while (link_.orders.try_pop(order)) take(order);
    place_moves();
    for (const auto& run : {runs_[next_ % 2].get(), last()})
        if (run != nullptr && next_ > 0) feed(*run);
}

void GroupPlanner::place_moves() {
    while (!moves_.empty()) {
        const GroupOrder& move = moves_.front();
        if (move.command.kind == GroupCommandKind::path) {
            if (!walk(move)) return;
            moves_.pop_front();
            continue;
        }
        if (move.command.kind == GroupCommandKind::driven_path) {
            if (!lay(move)) return;
            moves_.pop_front();
            continue;
        }
        if (!first_) first_ = shape_of(move, end_, space_);
        if (first_->error != ErrorId::none || first_->empty)
            (void)link_.verdicts.try_push({life_, move.id, first_->error, false, 0, 0, first_->jog_end, first_->at});
        else if (!place(move, *first_)) return;  // later: no track is free yet
        else end_ = first_->end;
        moves_.pop_front();
        first_.reset();
    }
}

bool GroupPlanner::place(const GroupOrder& move, const MoveShape& shape) {
    Run* run = last();
    // Poses of another tool's point are another path: between them the arm stands.
    const auto fits = [&](const RunSection& before) {
        return before.through_arm == shape.through_arm && (!shape.through_arm || before.carried.tool == move.place.carried.tool);
    };
    if (run != nullptr && run->open && move.joins) {
        const RunSection& before = run->curve.seen.back().run;
        const bool mixed = before.through_arm != shape.through_arm;
        if (mixed || fits(before)) {
            if (!has_room(*run)) return false;
            if (mixed ? append_mixed(*run, move, shape) : append(*run, move, shape, true)) return true;
        }
    }
    if (run != nullptr) run->open = false;
    Run* made = claim(move);
    return made != nullptr && append(*made, move, shape, false);
}

bool GroupPlanner::has_room(const Run& run) const noexcept {
    const std::uint32_t behind = run.curve.forgotten + static_cast<std::uint32_t>(run.curve.seen.size());
    return behind + 2 - run.track.part.load(std::memory_order_relaxed) < run.track.most_sections;
}

GroupPlanner::Run* GroupPlanner::claim(const GroupOrder& move) {
    const std::uint64_t begun = link_.at_run.load(std::memory_order_acquire);
    const std::uint32_t runs_begun = begun >> 32 == life_ ? static_cast<std::uint32_t>(begun) : 0;
    if (next_ > 1 && runs_begun < next_) return nullptr;  // its track is still gone
    RunTrack& track = link_.tracks[next_ % 2];
    track.ready.store(0, std::memory_order_release);
    track.exchange.reset();
    track.drive = {};
    track.part.store(0, std::memory_order_relaxed);
    track.s.store(0, std::memory_order_relaxed);
    track.velocity.store(0, std::memory_order_relaxed);
    track.closed.store(std::numeric_limits<double>::infinity(), std::memory_order_relaxed);
    track.first.store(move.id, std::memory_order_relaxed);
    auto& made = runs_[next_ % 2];
    made = std::make_unique<Run>(space_, track, lead_);
    made->first = move.id;
    made->rolls = move.command.kind == GroupCommandKind::jog;
    made->pulled = goes_stored_path(move.command.kind);
    made->driven = move.command.kind == GroupCommandKind::driven_path;
    made->number = ++next_;
    return made.get();
}

BlendRequest GroupPlanner::blend_of(const Run& run, const GroupOrder& move, const MoveShape& shape) const {
    const double parameter = move.command.transition_parameter;
    const auto& curve = run.curve;
    const auto& before = curve.path.sections().back();
    const auto dynamics = [&] {
        PathFeed feed = curve.feed_at(curve.path.length());
        const auto said = feed_of(move.command.dynamics);
        if (said.velocity > 0) feed.velocity = std::min(feed.velocity, said.velocity);
        if (said.acceleration > 0) feed.acceleration = std::min(feed.acceleration, said.acceleration);
        return feed;
    };
    switch (move.command.transition) {
        case mcTMNone: break;
        case mcTMCornerDistance: return {BlendRule::corner_distance, parameter};
        case mcTMMaxCornerDeviation: return {BlendRule::corner_deviation, parameter};
        case mcTMStartVelocity: return start_velocity_transition(parameter, curve.feed_at(curve.path.length()), dynamics());
        case mcTMConstantVelocity:
            return constant_velocity_transition(parameter, curve.feed_at(curve.path.length()), dynamics(),
                                                before.element.at(before.element.length()).first, shape.element.at(0).first);
    }
    return {};
}

RunCurve::Seen GroupPlanner::corner_of(const Run& run, const GroupOrder& move, const MoveShape& shape, CornerPassed passed) const {
    RunCurve::Seen corner;
    corner.run.through_arm = shape.through_arm;
    corner.run.carried = move.place.carried;
    corner.run.configuration = end_.configuration;
    corner.run.before = run.curve.seen.back().run.section.command;
    corner.run.way_before = run.curve.seen.back().run.way;
    corner.run.way = shape.element.length();
    corner.run.rest = run.curve.path.sections().back().length;
    corner.run.to = shape.end.members;
    corner.run.line = move.line;
    corner.run.number = move.number;
    corner.run.section.command = move.id;
    corner.run.corner_passed = passed;
    corner.members = {end_.members};
    return corner;
}

RunCurve::Seen GroupPlanner::section_of(const Run& run, const GroupOrder& move, const MoveShape& shape, CornerPassed passed) const {
    const PathSection& section = run.curve.path.sections().back();
    RunCurve::Seen seen;
    seen.run.through_arm = shape.through_arm;
    seen.run.carried = move.place.carried;
    seen.run.configuration = end_.configuration;
    seen.run.section.command = move.id;
    seen.run.corner = section.begin + section.length;
    seen.run.way = shape.element.length();
    seen.run.to = shape.end.members;
    seen.run.corner_passed = passed;
    seen.run.line = move.line;
    seen.run.number = move.number;
    seen.members = shape.members;
    return seen;
}

/// Its curve lies in the axes, and the lesser of both velocities holds on it, each in its own unit.
bool GroupPlanner::append_mixed(Run& run, const GroupOrder& move, const MoveShape& shape) {
    auto& curve = run.curve;
    if (space_.arm == nullptr || !asks_for_a_curve(move)) return false;
    const PathSection last = curve.path.sections().back();
    const RunSection came = curve.seen.back().run;
    PathMove element;
    element.element = shape.element;
    element.chart = shape.chart;
    element.feed = feed_of(move.command.dynamics);
    element.command = move.id;
    const double half = BlendRequest{}.share;
    CornerSide before{last, came, end_.members, std::min({half * last.element.length(), last.length, last.end() - run.final_end})};
    CornerSide behind{{}, {}, end_.members, half * shape.element.length()};
    behind.section.element = shape.element;
    behind.section.chart = shape.chart;
    behind.section.length = shape.element.length();
    behind.run.through_arm = shape.through_arm;
    behind.run.carried = move.place.carried;
    behind.run.configuration = end_.configuration;
    const Pose& tool = shape.through_arm ? move.place.carried.tool : came.carried.tool;
    const auto corner = mixed_corner(before, behind, mixed_request_of(run, move, shape), tool, space_);
    if (!corner) return false;
    PathSection section;
    section.element = corner->curve;
    curve.path.append_over(section, corner->before, element, corner->behind);
    const auto passed = corner->cut ? CornerPassed::smaller : CornerPassed::as_asked;
    auto seen = corner_of(run, move, shape, passed);
    seen.run.through_arm = false;
    curve.seen.push_back(seen);
    curve.seen.push_back(section_of(run, move, shape, passed));
    run.track.last.store(move.id, std::memory_order_release);
    return true;
}

/// By a velocity: each side brakes in its own unit.
MixedRequest GroupPlanner::mixed_request_of(const Run& run, const GroupOrder& move, const MoveShape& shape) const {
    const double parameter = move.command.transition_parameter;
    if (move.command.transition == mcTMCornerDistance) return {.distance = parameter};
    if (move.command.transition == mcTMMaxCornerDeviation) return {.deviation = parameter};
    const PathFeed came = run.curve.feed_at(run.curve.path.length());
    RunCurve next(space_.arm, space_.members, space_.limits,
                  space_.tool_velocity);  // the later one by itself: what it leaves out its own axes say
    PathMove element;
    element.element = shape.element;
    element.chart = shape.chart;
    element.feed = feed_of(move.command.dynamics);
    (void)next.path.append(element, {}, 0);
    RunCurve::Seen seen;
    seen.run.through_arm = shape.through_arm;
    seen.run.carried = move.place.carried;
    seen.run.configuration = end_.configuration;
    seen.members = shape.members.empty() ? std::vector<MemberVector>{end_.members} : shape.members;
    next.seen.push_back(seen);
    const PathFeed goes = next.feed_at(0);
    return {.before = parameter * stopping_way(came.velocity, came.deceleration, came.jerk),
            .behind = parameter * stopping_way(goes.velocity, goes.acceleration, goes.jerk)};
}

bool GroupPlanner::append(Run& run, const GroupOrder& move, const MoveShape& shape, bool blended) {
    auto& curve = run.curve;
    PathMove element;
    element.element = shape.element;
    element.chart = shape.chart;
    element.feed = shape.feed ? *shape.feed : feed_of(move.command.dynamics);
    element.command = move.id;
    BlendRequest request = blended ? blend_of(run, move, shape) : BlendRequest{};
    if (run.pulled) request.share = share_of_short_pieces;
    const Path::Mark kept = curve.path.mark();
    const std::size_t known = curve.seen.size();
    const double one = known > 0 ? curve.path.sections().back().feed.velocity : 0, other = element.feed.velocity;
    const auto joint = curve.path.append(element, request, run.final_end);
    if (!joint.ok()) return false;
    if (joint.value() == PathJoint::stop) {  // a corner at rest ends a run: its point is stood at, exactly
        curve.path.back_to(kept);
        return false;
    }
    CornerPassed passed = CornerPassed::none;
    if (asks_for_a_curve(move)) {
        passed = blended ? CornerPassed::as_asked : move.joins ? CornerPassed::stood : CornerPassed::none;
        if (joint.value() == PathJoint::cut) passed = CornerPassed::smaller;
    }
    const auto& all = curve.path.sections();
    const bool with_corner = all.size() > 1 && all[all.size() - 2].blend && all[all.size() - 2].command == move.id;
    RunCurve::Seen corner;
    if (with_corner) {
        corner = corner_of(run, move, shape, passed);
        if (one > 0 && other > 0) {
            if (move.command.buffer_mode == mcBlendingPrevious) corner.velocity = one;
            if (move.command.buffer_mode == mcBlendingNext) corner.velocity = other;
            if (move.command.buffer_mode == mcBlendingHigh) corner.velocity = std::max(one, other);
        }
        if (refuse_blend(all[all.size() - 2], corner.run, end_, space_) != ErrorId::none) {
            curve.path.back_to(kept);  // the corner itself is sound: it is stood at
            return false;
        }
    }
    curve.seen.resize(all.size() - (with_corner ? 2 : 1));
    if (with_corner) curve.seen.push_back(corner);
    curve.seen.push_back(section_of(run, move, shape, passed));
    run.track.last.store(move.id, std::memory_order_release);
    return true;
}

/// A jog is released long before its end: there is no sense in planning all of it.
double GroupPlanner::rolling_end(const Run& run) const {
    const double full = run.curve.path.length(), s = std::max(run.track.s.load(std::memory_order_relaxed), run.curve.begin());
    const AlongLimits l = run.curve.along(s);
    const double stop = stopping_way(l.velocity, l.deceleration, l.jerk);
    constexpr double least = 1, most = 2.5;  // s of it as fast as it goes now or shall go, beside the way of a stop
    constexpr double slowest = 1e-3;         // of its full speed
    const double now = run.track.velocity.load(std::memory_order_relaxed);
    const double v = std::max(now, l.velocity * std::clamp(wish_.factors.velocity, slowest, 1.0));
    if (run.final_end >= std::min(full, s + stop + least * v)) return run.final_end;
    return std::min(full, s + stop + most * v);
}

/// Up to where nothing that may still come can bend the path. As long as there is time for it, room is left for a blend at the end.
double GroupPlanner::final_end(const Run& run) const {
    const double full = run.curve.path.length();
    if (run.rolls) return rolling_end(run);
    if (!run.open || run.final_end >= full) return full;
    const auto& section = run.curve.path.sections().back();
    const double half = full - std::min(section.element.length() / 2, section.length);
    // What comes behind a piece of a stored path is known, only later where the planner is slow: that must not bend it.
    if (run.pulled) return std::max(half, run.final_end);
    const double s = std::max(run.track.s.load(std::memory_order_relaxed), run.curve.begin());
    const AlongLimits l = run.curve.along(std::min(std::max(s, section.begin), full));
    const double soon = 6 * run.service->lead();
    const double v = std::min(run.track.velocity.load(std::memory_order_relaxed) + l.acceleration * soon, l.velocity);
    return half - s > stopping_way(v, l.deceleration, l.jerk) + v * soon ? std::max(half, run.final_end) : full;
}

void GroupPlanner::publish(Run& run) {
    const auto& all = run.curve.path.sections();
    const std::size_t known = run.published > run.curve.forgotten ? run.published - run.curve.forgotten : 0;
    for (std::size_t i = known; i < all.size() && all[i].begin < run.final_end; ++i) {
        const std::uint32_t part = run.curve.forgotten + static_cast<std::uint32_t>(i);
        RunSection& slot = run.track.sections[part % run.track.most_sections];
        slot = run.curve.seen[i].run;
        slot.section = all[i];
        run.published = part + 1;
    }
    if (!run.open) run.track.closed.store(run.curve.path.length(), std::memory_order_release);
}

/// Planned before the factors were lowered, and not begun yet: anew, from its beginning.
void GroupPlanner::take_back(Run& run) {
    std::uint64_t prepared = GroupLink::both(life_, run.number);
    if (!run.track.ready.compare_exchange_strong(prepared, 0, std::memory_order_acq_rel, std::memory_order_relaxed)) return;  // it is gone
    run.track.exchange.reset();
    run.plan_anew(lead_);
    run.offered = false;
}

void GroupPlanner::feed(Run& run) {
    if (run.driven) return;
    if (run.offered && asks_for_more(run.track.planned, wish_.factors)) take_back(run);
    run.curve.forget_before(run.track.part.load(std::memory_order_relaxed));
    run.curve.wish(wish_.stands, wish_.own_ramp, wish_.factors, wish_.ramp);
    run.final_end = final_end(run);
    publish(run);
    PathWish wish;
    wish.motion = wish_.stands ? PathWish::Motion::stand : PathWish::Motion::go;
    wish.velocity_factor = wish_.factors.velocity;
    wish.revision = revision_;
    const PathAnswer answer = run.service->step(run.curve, run.final_end, wish);
    if (answer == PathAnswer::offered && !run.offered) {
        run.offered = true;
        run.track.planned = wish_.factors;
        run.track.ready.store(GroupLink::both(life_, run.number), std::memory_order_release);
    }
    if (answer == PathAnswer::stuck) say_stuck(run);
}

/// Where not even the run's beginning was found nobody goes over to it: that is what became of its first command, in its turn. On the way, and of a
/// stored path, whose runs are all one command, it is the end of what runs.
void GroupPlanner::say_stuck(Run& run) {
    if (run.said_stuck) return;
    run.said_stuck = true;
    const bool begins = !run.offered && !run.pulled;
    const CommandId id = begins ? run.first : run.curve.path.section_at(run.service->end()).command;
    (void)link_.verdicts.try_push({life_, id, ErrorId::path_not_planned, !begins, run.number});
}

}  // namespace taktwerk::axes
