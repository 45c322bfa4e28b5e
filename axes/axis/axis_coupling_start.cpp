// How a coupling begins: where, and with which relation between the places of master and slave.
//
// A relation is made for the instant one period ago: that is where the slave is. The masters have been planned already, so they are
// taken back by one period.

#include <algorithm>
#include <cmath>

#include "axes/axis/axis_core.hpp"

namespace taktwerk::axes {

namespace {

Ratio ratio_of(const GearRatio& ratio) noexcept { return {ratio.numerator, ratio.denominator}; }

EndlessPlace moved(EndlessPlace place, double by) noexcept {
    place.local += by;
    return place;
}

}  // namespace

/// Sync point and start, as places of the master: what numbers mean is settled now, whatever MC_SetPosition does later.
void AxisCore::find_start(Link& link) noexcept {
    const auto* point = std::get_if<GearInPosDetails>(&link.command.details);
    const auto* cam = std::get_if<CamDetails>(&link.command.details);
    const AxisCore* master = axis_at(link.masters.axes[0]);
    if (!master || !(point || (cam && cam->master_start_distance != 0))) return;
    const double distance = point ? point->master_start_distance : cam->master_start_distance;
    const auto& units = master->units_;
    auto now = master->as_master(link.masters.sources[0]).motion;
    if (coupling_.phase_master == link.masters.axes[0]) now.place.local += coupling_.phase.state().position;
    // Where the master was when the command came: in this cycle it has been planned already, and may have crossed the start. An update finds the
    // same repetition again.
    const auto counted_from = link.started ? link.master_start : earlier(now, to_seconds(cycle_)).place;
    const double here = way({units.anchor(), 0}, counted_from, units.feed());

    double place = 0, repeats = units.modulo();
    if (point) {
        place = units.to_local(point->master_sync_position);
    } else {
        const auto* table = scene_.tables->prepared(cam->table);
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
        fail(AxisAlarm::coupling_start_passed, units.to_program(way({units.anchor(), 0}, link.begin, units.feed())),
             units.to_program(here));
}

/// Where the lowest master position of the table lies for a master at `entry`.
EndlessPlace AxisCore::cam_origin(const CamDetails& cam, const PreparedCam& table, const AxisCore& master,
                                  const EndlessPlace& entry) const noexcept {
    if (cam.start == mcRelative || !table.master_absolute()) return moved(entry, cam.master_offset);
    const auto& units = master.units_;
    double origin = units.to_local(cam.master_offset + cam.master_scaling * table.begin());
    // A modulo master: the repetition in whose turn the cam is entered.
    if (units.modulo() > 0) {
        const double here = way({units.anchor(), 0}, entry, units.feed());
        origin += std::floor((here - origin) / units.modulo()) * units.modulo();
    }
    return {units.anchor(), origin};
}

/// The master has crossed the start in its sense since the last cycle, or was on it at the beginning.
bool AxisCore::starts_now(Link& link) const noexcept {
    if (!link.waits) return true;
    const AxisCore* master = axis_at(link.masters.axes[0]);
    const double ahead = link.sense * way(seen(link, 0).place, link.begin, master->units_.feed());
    const bool crossed = ahead <= 0 && (link.ahead > 0 || (!link.tracked && link.ahead == 0));
    link.ahead = ahead;
    link.tracked = true;
    return crossed;
}

FollowerLimits AxisCore::follower_limits(const AxisCommand& command) const noexcept {
    FollowerLimits limits{full_limits(config_.limits), dynamics_of(command, config_.limits, config_.defaults)};
    limits.axis.velocity = limits.forward = limits.backward = std::min(limits.axis.velocity, velocity_cap());
    return limits;
}

ErrorId AxisCore::engage(Duration period) noexcept {
    auto& link = coupling_.next;
    // What was superimposed on the motion before becomes part of it; an update changes nothing there.
    if (!link.started && !link.waits && queue_.beside(SideSlot::superimposed) == 0) end_superimposed(Outcome::aborted);
    if (!link.started) start_at_base();
    const auto first = earlier(seen(link, 0), to_seconds(period));
    const auto second = link.masters.axes[1].valid() ? earlier(seen(link, 1), to_seconds(period)) : EndlessMotion{};
    if (!link.started) {
        link.second_start = second.place;
        if (!link.chained) {
            if (!link.waits) link.master_start = first.place;
            link.slave_start = slave_frame().place(setpoint_.base().position);
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
    if (coupling_.phase_master != link.masters.axes[0]) clear_phase();
    drop(coupling_.running);
    if (link.waits) alarms_.clear(AxisAlarm::coupling_start_passed);
    coupling_.running = link;
    coupling_.running.started = true;
    coupling_.running.waits = false;
    coupling_.next = {};  // what it held goes on being held
    coupling_.cam_ends_seen = 0;
    const double former_jerk = jerk_of_motion();
    goal_ = {Goal::Kind::coupled, 0, full_limits(config_.limits), VelocityLimiter::command};
    goal_.former_jerk = former_jerk;
    goal_pending_ = held_ = false;
    watch_limits_ = true;
    return ErrorId::none;
}

ErrorId AxisCore::begin_gear(const Link& link) noexcept {
    GearLine line;
    const AxisCore& master = *axis_at(link.masters.axes[0]);
    const auto ratio = ratio_of(std::get<GearDetails>(link.command.details).ratio);
    if (!line.set(ratio, master.units_.feed(), units_.feed(), link.master_start, link.slave_start)) return ErrorId::invalid_ratio;
    coupling_.follower.begin(line, RunDown::velocity, follower_limits(link.command));
    return ErrorId::none;
}

ErrorId AxisCore::begin_sum(const Link& link) noexcept {
    const auto& sum = std::get<CombineDetails>(link.command.details);
    const AxisCore& one = *axis_at(link.masters.axes[0]);
    const AxisCore& two = *axis_at(link.masters.axes[1]);
    auto second = ratio_of(sum.ratio2);
    if (sum.mode == mcSubAxes) second.numerator = -second.numerator;
    GearSum relation;
    if (!relation.set(ratio_of(sum.ratio1), second, one.units_.feed(), two.units_.feed(), units_.feed(), link.master_start,
                      link.second_start, link.slave_start))
        return ErrorId::invalid_ratio;
    coupling_.follower.begin(relation, RunDown::position, follower_limits(link.command));
    return ErrorId::none;
}

/// The polynomial from where the slave is to `end` at the sync point; sync_impossible where that lies behind the master, or the slave
/// would exceed velocity, acceleration, deceleration, or a jerk that was given, on the way were the master to keep its velocity (P1-284).
ErrorId AxisCore::approach_to(const Link& link, const EndlessMotion& master, double master_feed, const CurvePoint& end,
                              SyncApproach& approach) const noexcept {
    const double length = way(master.place, link.sync, master_feed);
    if (!(link.sense * length > 0)) return ErrorId::sync_impossible;
    const auto& slave = setpoint_.base();
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

ErrorId AxisCore::begin_gear_in_pos(const Link& link, const EndlessMotion& first) noexcept {
    const auto& point = std::get<GearInPosDetails>(link.command.details);
    const double master_feed = axis_at(link.masters.axes[0])->units_.feed();
    const auto ratio = ratio_of(point.ratio);
    // Where the slave would come to at the mean of its velocity and the one it is to have.
    const double length = way(first.place, link.sync, master_feed);
    const auto& slave = setpoint_.base();
    const double slope = as_curve({{}, slave.velocity, slave.acceleration}, 0, first.velocity, first.acceleration).slope;
    const double natural = slave.position + (slope + ratio.value()) / 2 * length;
    const double target =
        choose_image(units_.to_local(point.slave_sync_position), units_.modulo(), natural, ratio.value() * length, point.mode);

    SyncApproach approach;
    const auto error = approach_to(link, first, master_feed, {target, ratio.value(), 0}, approach);
    if (error != ErrorId::none) return error;
    GearLine line;
    if (!line.set(ratio, master_feed, units_.feed(), link.sync, slave_frame().place(target))) return ErrorId::invalid_ratio;
    coupling_.follower.begin(line, approach, slave_frame(), follower_limits(link.command));
    return ErrorId::none;
}

ErrorId AxisCore::begin_cam(Link& link, const EndlessMotion& first) noexcept {
    const auto& cam = std::get<CamDetails>(link.command.details);
    const auto* table = scene_.tables->prepared(cam.table);
    if (!table) return ErrorId::invalid_table;
    const AxisCore& master = *axis_at(link.masters.axes[0]);
    const bool relative = cam.start == mcRelative;
    const bool has_sync = cam.master_start_distance != 0;
    // Where the table's value is that of the slave: with a sync point a relative slave counts from the begin of the approach.
    const bool slave_relative = relative || !table->slave_absolute();
    const EndlessPlace entry = !has_sync ? link.master_start : slave_relative ? link.begin : link.sync;

    CamFit fit;
    fit.master_feed = master.units_.feed();
    fit.slave_feed = units_.feed();
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
        const double wanted = units_.to_local(cam.slave_offset) + cam.slave_scaling * value;
        const double nearest = choose_image(wanted, units_.modulo(), setpoint_.base().position, 1, mcShortest);
        fit.slave_origin = {units_.anchor(), nearest - cam.slave_scaling * value};
    }
    if (!curve.set(*table, fit)) return ErrorId::invalid_ratio;
    if (!has_sync || link.started) {
        coupling_.follower.begin(curve, RunDown::position, follower_limits(link.command));
        return ErrorId::none;
    }
    // What the cam is at the sync point: with the master at velocity 1, slope and curvature are the slave's velocity and acceleration.
    auto at_sync = curve;
    (void)at_sync.at(first);
    const auto end = at_sync.at({link.sync, 1, 0});
    SyncApproach approach;
    const auto error =
        approach_to(link, first, fit.master_feed, {slave_frame().local(end.place), end.velocity, end.acceleration}, approach);
    if (error != ErrorId::none) return error;
    coupling_.follower.begin(curve, approach, slave_frame(), follower_limits(link.command));
    return ErrorId::none;
}

}  // namespace taktwerk::axes
