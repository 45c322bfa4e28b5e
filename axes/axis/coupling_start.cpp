#include "axes/axis/coupling_start.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/aim.hpp"
#include "axes/axis/command_check.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/coupling_links.hpp"
#include "axes/axis/direction_limits.hpp"
#include "axes/axis/master_side.hpp"
#include "axes/axis/superimposed_motion.hpp"

namespace taktwerk::axes {

namespace {

Ratio ratio_of(const GearRatio& ratio) noexcept { return {ratio.numerator, ratio.denominator}; }

EndlessPlace moved(EndlessPlace place, double by) noexcept {
    place.local += by;
    return place;
}

}  // namespace

void CouplingStart::find_start(Link& link) noexcept {
    const auto* point = std::get_if<GearInPosDetails>(&link.command.details);
    const auto* cam = std::get_if<CamDetails>(&link.command.details);
    const MasterSide* master = links_.axis(link.masters.axes[0]);
    if (!master || !(point || (cam && cam->master_start_distance != 0))) return;
    const double distance = point ? point->master_start_distance : cam->master_start_distance;
    const auto& units = master->units();
    auto now = master->reading(link.masters.sources[0]).motion;
    if (links_.state.phase_master == link.masters.axes[0]) now.place.local += links_.state.phase.state().position;
    // Where the master was when the command came: in this cycle it has been planned already, and may have crossed the start. An update finds the
    // same repetition again.
    const auto counted_from = link.started ? link.master_start : earlier(now, to_seconds(body_.cycle)).place;
    const double here = way({units.anchor(), 0}, counted_from, units.feed());

    double place = 0, repeats = units.modulo();
    if (point) {
        place = units.to_local(point->master_sync_position);
    } else {
        const auto* table = body_.scene.tables->prepared(cam->table);
        if (!table) return;
        link.master_start = counted_from;
        const auto origin = cam_origin(*cam, *table, *master, counted_from);
        place = way({units.anchor(), 0}, origin, units.feed()) + cam->master_scaling * (sync_place(*cam, *table) - table->begin());
        if (table->periodic()) repeats = std::abs(cam->master_scaling) * table->length();
    }
    link.sense = 1;
    if (distance != 0) link.sense = distance < 0 ? -1 : 1;
    else if (units.modulo() > 0 ? now.velocity < 0 : place < here) link.sense = -1;
    link.sync = {units.anchor(), choose_sync_point(place, repeats, here, std::abs(distance), link.sense)};
    link.begin = moved(link.sync, -distance);
    link.waits = distance != 0;
    link.ahead = link.sense * way(counted_from, link.begin, units.feed());
    if (link.waits && !link.started && link.ahead < 0)
        conduct_.fail(AxisAlarm::coupling_start_passed, units.to_program(way({units.anchor(), 0}, link.begin, units.feed())),
                      units.to_program(here));
}

/// Where the lowest master position of the table lies for a master at `entry`.
EndlessPlace CouplingStart::cam_origin(const CamDetails& cam, const PreparedCam& table, const MasterSide& master,
                                       const EndlessPlace& entry) const noexcept {
    if (cam.start == mcRelative || !table.master_absolute()) return moved(entry, cam.master_offset);
    const auto& units = master.units();
    double origin = units.to_local(cam.master_offset + cam.master_scaling * table.begin());
    // A modulo master: the repetition in whose turn the cam is entered.
    if (units.modulo() > 0) {
        const double here = way({units.anchor(), 0}, entry, units.feed());
        origin += std::floor((here - origin) / units.modulo()) * units.modulo();
    }
    return {units.anchor(), origin};
}

bool CouplingStart::starts_now(Link& link) const noexcept {
    if (!link.waits) return true;
    const MasterSide* master = links_.axis(link.masters.axes[0]);
    const double ahead = link.sense * way(links_.seen(link, 0).place, link.begin, master->units().feed());
    const bool crossed = ahead <= 0 && (link.ahead > 0 || (!link.tracked && link.ahead == 0));
    link.ahead = ahead;
    link.tracked = true;
    return crossed;
}

FollowerLimits CouplingStart::follower_limits(const AxisCommand& command) const noexcept {
    const auto& axis = body_.config.limits;
    FollowerLimits limits{gentlest(full_limits(axis), axis), gentlest(dynamics_of(command, axis, body_.config.defaults), axis)};
    limits.axis.velocity = std::min(limits.axis.velocity, body_.velocity_cap());
    limits.forward = std::min(axis.velocity_towards(1), body_.velocity_cap());
    limits.backward = std::min(axis.velocity_towards(-1), body_.velocity_cap());
    return limits;
}

ErrorId CouplingStart::engage(Duration period) noexcept {
    auto& link = links_.state.next;
    // What was superimposed on the motion before becomes part of it; an update changes nothing there.
    if (!link.started && !link.waits && body_.queue.beside(SideSlot::superimposed) == 0) addition_.end(Outcome::aborted);
    if (!link.started) aim_.start_at_base();
    const auto first = earlier(links_.seen(link, 0), to_seconds(period));
    const auto second = link.masters.axes[1].valid() ? earlier(links_.seen(link, 1), to_seconds(period)) : EndlessMotion{};
    if (!link.started) {
        link.second_start = second.place;
        if (!link.chained) {
            if (!link.waits) link.master_start = first.place;
            link.slave_start = links_.slave_frame().place(motion_.setpoint.base().position);
        }
    }
    auto error = ErrorId::not_supported;
    switch (link.command.kind) {
        case CommandKind::gear_in: error = begin_gear(link); break;
        case CommandKind::combine: error = begin_sum(link); break;
        case CommandKind::gear_in_pos: error = begin_gear_in_pos(link, first); break;
        case CommandKind::cam_in: error = begin_cam(link, first); break;
        default: break;
    }
    if (error != ErrorId::none) return error;
    if (links_.state.phase_master != link.masters.axes[0]) links_.clear_phase();
    links_.drop(links_.state.running);
    if (link.waits) body_.alarms.clear(AxisAlarm::coupling_start_passed);
    links_.state.running = link;
    links_.state.running.started = true;
    links_.state.running.waits = false;
    links_.state.next = {};  // what it held goes on being held
    links_.state.cam_ends_seen = 0;
    const double former_jerk = aim_.jerk_of_motion();
    motion_.goal = {Goal::Kind::coupled, 0, full_limits(body_.config.limits), VelocityLimiter::command};
    motion_.goal.former_jerk = former_jerk;
    motion_.goal_pending = motion_.held = false;
    motion_.watch_limits = true;
    return ErrorId::none;
}

ErrorId CouplingStart::begin_gear(const Link& link) noexcept {
    GearLine line;
    const MasterSide& master = *links_.axis(link.masters.axes[0]);
    const auto ratio = ratio_of(std::get<GearDetails>(link.command.details).ratio);
    if (!line.set(ratio, master.units().feed(), body_.units.feed(), link.master_start, link.slave_start)) return ErrorId::invalid_ratio;
    links_.state.follower.begin(line, RunDown::velocity, follower_limits(link.command));
    return ErrorId::none;
}

ErrorId CouplingStart::begin_sum(const Link& link) noexcept {
    const auto& sum = std::get<CombineDetails>(link.command.details);
    const MasterSide& one = *links_.axis(link.masters.axes[0]);
    const MasterSide& two = *links_.axis(link.masters.axes[1]);
    auto second = ratio_of(sum.ratio2);
    if (sum.mode == mcSubAxes) second.numerator = -second.numerator;
    GearSum relation;
    if (!relation.set(ratio_of(sum.ratio1), second, one.units().feed(), two.units().feed(), body_.units.feed(), link.master_start,
                      link.second_start, link.slave_start))
        return ErrorId::invalid_ratio;
    links_.state.follower.begin(relation, RunDown::position, follower_limits(link.command));
    return ErrorId::none;
}

/// The polynomial from where the slave is to `end` at the sync point; sync_impossible where that lies behind the master, or the slave
/// would exceed velocity, acceleration, deceleration, or a jerk that was given, on the way were the master to keep its velocity (P1-284).
ErrorId CouplingStart::approach_to(const Link& link, const EndlessMotion& master, double master_feed, const CurvePoint& end,
                                   SyncApproach& approach) const noexcept {
    const double length = way(master.place, link.sync, master_feed);
    if (!(link.sense * length > 0)) return ErrorId::sync_impossible;
    const auto& slave = motion_.setpoint.base();
    const auto begin = as_curve({{}, slave.velocity, slave.acceleration}, slave.position, master.velocity, master.acceleration);
    approach.set(master.place, master_feed, length, begin, end);
    const auto limits = follower_limits(link.command);
    const double velocity = choose(link.command.velocity, 0, limits.axis.velocity);
    const double acceleration = std::min(limits.approach.acceleration, limits.approach.deceleration);
    const auto peaks = approach.peaks(master.velocity);
    // The state it begins with is not its doing.
    constexpr double rounding = 1 + 1e-6;
    const bool possible = peaks.velocity <= std::max(velocity, std::abs(slave.velocity)) * rounding &&
                          peaks.acceleration <= std::max(acceleration, std::abs(slave.acceleration)) * rounding &&
                          (!(link.command.jerk > 0) || peaks.jerk <= link.command.jerk * rounding);
    return possible ? ErrorId::none : ErrorId::sync_impossible;
}

ErrorId CouplingStart::begin_gear_in_pos(const Link& link, const EndlessMotion& first) noexcept {
    const auto& point = std::get<GearInPosDetails>(link.command.details);
    const double master_feed = links_.axis(link.masters.axes[0])->units().feed();
    const auto ratio = ratio_of(point.ratio);
    // Where the slave would come to at the mean of its velocity and the one it is to have.
    const double length = way(first.place, link.sync, master_feed);
    const auto& slave = motion_.setpoint.base();
    const double slope = as_curve({{}, slave.velocity, slave.acceleration}, 0, first.velocity, first.acceleration).slope;
    const double natural = slave.position + (slope + ratio.value()) / 2 * length;
    const double target =
        choose_image(body_.units.to_local(point.slave_sync_position), body_.units.modulo(), natural, ratio.value() * length, point.mode);

    SyncApproach approach;
    const auto error = approach_to(link, first, master_feed, {target, ratio.value(), 0}, approach);
    if (error != ErrorId::none) return error;
    GearLine line;
    if (!line.set(ratio, master_feed, body_.units.feed(), link.sync, links_.slave_frame().place(target))) return ErrorId::invalid_ratio;
    links_.state.follower.begin(line, approach, links_.slave_frame(), follower_limits(link.command));
    return ErrorId::none;
}

ErrorId CouplingStart::begin_cam(Link& link, const EndlessMotion& first) noexcept {
    const auto& cam = std::get<CamDetails>(link.command.details);
    const auto* table = body_.scene.tables->prepared(cam.table);
    if (!table) return ErrorId::invalid_table;
    const MasterSide& master = *links_.axis(link.masters.axes[0]);
    const bool relative = cam.start == mcRelative;
    const bool has_sync = cam.master_start_distance != 0;
    // Where the table's value is that of the slave: with a sync point a relative slave counts from the begin of the approach.
    const bool slave_relative = relative || !table->slave_absolute();
    const EndlessPlace entry = !has_sync ? link.master_start : slave_relative ? link.begin : link.sync;

    CamFit fit;
    fit.master_feed = master.units().feed();
    fit.slave_feed = body_.units.feed();
    fit.master_scaling = cam.master_scaling;
    fit.master_origin = has_sync ? moved(link.sync, -cam.master_scaling * (sync_place(cam, *table) - table->begin()))
                                 : cam_origin(cam, *table, master, entry);
    // The table's own value where the slave enters.
    CamCurve curve;
    if (!curve.set(*table, fit)) return ErrorId::invalid_ratio;
    const double value = way({}, curve.at({entry, 0, 0}).place, fit.slave_feed);
    if (!link.started) link.table_start = value;

    fit.slave_scaling = cam.slave_scaling;
    if (slave_relative) {
        fit.slave_origin = moved(link.slave_start, cam.slave_offset);
        fit.table_origin = link.table_start;
    } else {
        const double wanted = body_.units.to_local(cam.slave_offset) + cam.slave_scaling * value;
        const double nearest = choose_image(wanted, body_.units.modulo(), motion_.setpoint.base().position, 1, mcShortest);
        fit.slave_origin = {body_.units.anchor(), nearest - cam.slave_scaling * value};
    }
    if (!curve.set(*table, fit)) return ErrorId::invalid_ratio;
    if (!has_sync || link.started) {
        links_.state.follower.begin(curve, RunDown::position, follower_limits(link.command));
        return ErrorId::none;
    }
    // What the cam is at the sync point: with the master at velocity 1, slope and curvature are the slave's velocity and acceleration.
    auto at_sync = curve;
    (void)at_sync.at(first);
    const auto end = at_sync.at({link.sync, 1, 0});
    SyncApproach approach;
    const auto error =
        approach_to(link, first, fit.master_feed, {links_.slave_frame().local(end.place), end.velocity, end.acceleration}, approach);
    if (error != ErrorId::none) return error;
    links_.state.follower.begin(curve, approach, links_.slave_frame(), follower_limits(link.command));
    return ErrorId::none;
}

}  // namespace taktwerk::axes
