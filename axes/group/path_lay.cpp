// A stored path laid out as a whole, for an axis that drives it: the planner's part of MC_SyncGroupToAxis. Its length may go on, stop and go back at any
// place, so no place of it may want rest: no corner, no dwell, no M word.

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/group/group_planner.hpp"

namespace taktwerk::axes {
namespace {

constexpr int pieces_at_once = 200;  // pieces, in a step
constexpr double unbounded = std::numeric_limits<double>::infinity();
/// Of a member's acceleration and jerk: one half is for ramps along the path, the other for what its bends ask for.
constexpr double share_of_ramps = 0.5;
constexpr double seam_digits = 1e-9;
constexpr int looks_on_section = 8;

bool stands_for(const PathItem& item) noexcept {
    return item.kind == PathItem::Kind::dwell || item.kind == PathItem::Kind::ask || item.kind == PathItem::Kind::tell;
}

/// What is left along the path at a place: for ramps, and of velocity beside them.
MotionLimits room_at(const WayPoint& w, const MoveSpace& space) noexcept {
    MotionLimits room{unbounded, unbounded, unbounded, unbounded};
    for (std::size_t i = 0; i < space.members; ++i) {
        const auto& member = space.limits[i];
        const double first = std::abs(w.first[i]), second = std::abs(w.second[i]);
        if (first > 1e-12) {
            room.velocity = std::min(room.velocity, member.velocity / first);
            room.acceleration = std::min(room.acceleration, share_of_ramps * member.acceleration / first);
            room.jerk = std::min(room.jerk, share_of_ramps * member.jerk / first);
        }
        if (second > 1e-12) room.velocity = std::min(room.velocity, std::sqrt((1 - share_of_ramps) * member.acceleration / second));
    }
    room.deceleration = room.acceleration;
    return room;
}

/// In a bend a ramp costs jerk beside its own: 3 q'' v a. How fast it may be gone so that it can be braked there, with whatever acceleration a ramp to rest
/// has left at that velocity, from wherever it comes.
double fastest_in_bend(const WayPoint& w, const MotionLimits& ramp, const MoveSpace& space) noexcept {
    double least = unbounded;
    for (std::size_t i = 0; i < space.members; ++i) {
        const double second = std::abs(w.second[i]), third = std::abs(w.third[i]);
        const double most = space.limits[i].jerk - std::abs(w.first[i]) * ramp.jerk;  // what the ramp's own leaves: half of it at least
        if (second <= 1e-12 && third <= 1e-12) continue;
        const auto takes = [&](double v) {
            return third * v * v * v + 3 * second * v * std::min(ramp.deceleration, std::sqrt(2 * ramp.jerk * v));
        };
        constexpr int halvings = 40;
        double low = 0, high = third > 1e-12 ? std::cbrt(most / third) : most / (3 * second * ramp.deceleration) + most;
        for (int k = 0; k < halvings && takes(high) > most; ++k) {
            const double v = (low + high) / 2;
            (takes(v) > most ? high : low) = v;
        }
        least = std::min(least, takes(high) > most ? low : high);
    }
    return least;
}

MotionLimits lesser_room(const MotionLimits& a, const MotionLimits& b) noexcept {
    return {std::min(a.velocity, b.velocity), std::min(a.acceleration, b.acceleration), std::min(a.deceleration, b.deceleration),
            std::min(a.jerk, b.jerk)};
}

/// It goes on from its end to its beginning as if there were no seam.
bool closes(const Path& path, const MoveEnd& begin, const MoveEnd& end, std::size_t members) noexcept {
    const auto &first = path.sections().front().element, &last = path.sections().back().element;
    const PathVector a = first.at(0).at, b = last.at(last.length()).at;
    if ((a - b).norm() > seam_digits * std::max(1.0, a.norm())) return false;
    for (std::size_t i = 0; i < members; ++i)  // a joint that has turned round is somewhere else
        if (std::abs(begin.members[i] - end.members[i]) > 1e-6 * std::max(1.0, std::abs(begin.members[i]))) return false;
    return meet_smoothly(last, first);
}

}  // namespace

bool GroupPlanner::lay(const GroupOrder& move) {
    if (!walk_ || walk_->id != move.id) open_path(move);
    Walk& w = *walk_;
    for (int placed = 0; placed < pieces_at_once; ++placed) {
        if (!w.pending) w.item = w.source->next();
        w.pending = true;
        if (w.item.kind == PathItem::Kind::fault) return refuse_laid(move, w.item.place.error);
        if (w.item.kind == PathItem::Kind::end) return lay_done(move);
        if (stands_for(w.item)) return refuse_laid(move, ErrorId::path_stands);
        const MoveShape shape = segment_of(w.item, w.place, end_, space_);
        if (shape.error != ErrorId::none) return refuse_laid(move, shape.error, shape.at);
        if (!shape.empty) {
            if (!w.laid && claim(move) == nullptr) return false;  // not yet
            if (const auto error = lay_piece(move, shape); error != ErrorId::none) return refuse_laid(move, error);
        }
        w.pending = false;
    }
    return false;
}

ErrorId GroupPlanner::lay_piece(const GroupOrder& move, const MoveShape& shape) {
    Walk& w = *walk_;
    Run& run = *last();
    const GroupOrder piece = piece_of(move);
    const bool first = !w.laid;
    w.laid = true;
    if (!first && !piece.joins) return ErrorId::path_stands;
    if (!append(run, piece, shape, !first)) return ErrorId::path_stands;
    if (run.curve.seen.size() > run.track.most_sections) return ErrorId::path_too_long;
    end_ = shape.end;
    w.place.at = w.item.to;
    w.joint = w.item.joint;
    w.deviation = w.item.deviation;
    w.resting = false;
    return ErrorId::none;
}

/// As if it had not been: the next command begins where this one would have.
bool GroupPlanner::refuse_laid(const GroupOrder& move, ErrorId error, const PathHindrance& at) {
    const auto& place = walk_->item.place;
    const bool named = walk_->item.kind == PathItem::Kind::fault && place.line != 0;
    (void)link_.verdicts.try_push(
        {life_, move.id, error, false, 0, named ? place.line : walk_->item.line, JogEnd::none, named ? place.at : at});
    end_ = walk_->began;
    if (walk_->laid) runs_[--next_ % 2].reset();
    walk_.reset();
    return true;
}

bool GroupPlanner::lay_done(const GroupOrder& move) {
    if (!walk_->laid) return refuse_laid(move, ErrorId::path_stands);  // it has no length that an axis could drive
    Run& run = *last();
    const auto& path = run.curve.path;
    const auto mode = move.command.driver.mode;
    if (mode == mcPeriodic && !closes(path, walk_->began, end_, space_.members)) return refuse_laid(move, ErrorId::path_not_closed);
    run.open = false;
    run.final_end = path.length();
    look_ahead(run, mode);
    publish(run);
    auto& drive = run.track.drive;
    drive.driven = true;
    drive.driver = move.command.driver;
    drive.said = move.command.dynamics;
    walk_.reset();
    run.track.ready.store(GroupLink::both(life_, run.number), std::memory_order_release);
    return true;
}

/// How fast it may be gone everywhere, so that a ramp to rest can begin anywhere and stay on it.
void GroupPlanner::look_ahead(Run& run, MC_PATH_SYNC_MODE mode) const {
    auto& seen = run.curve.seen;
    const auto& sections = run.curve.path.sections();
    const std::size_t count = sections.size();
    const auto look = [&](std::size_t i, int k) {
        return run.curve.place(i, sections[i].begin + sections[i].length * k / looks_on_section);
    };
    MotionLimits room{unbounded, unbounded, unbounded, unbounded};
    for (std::size_t i = 0; i < count; ++i) {
        MotionLimits here{space_.tool_velocity, unbounded, unbounded, unbounded};  // its length is the way of the tool's point
        for (int k = 0; k <= looks_on_section; ++k) here = lesser_room(here, room_at(look(i, k), space_));
        seen[i].run.fastest = here.velocity;
        room = lesser_room(room, here);
    }
    for (std::size_t i = 0; i < count; ++i) {
        for (int k = 0; k <= looks_on_section; ++k)
            seen[i].run.fastest = std::min(seen[i].run.fastest, fastest_in_bend(look(i, k), room, space_));
        room.velocity = std::min(room.velocity, seen[i].run.fastest);
    }
    // At the ends of each section as fast as braking leads to what lies behind; a lap goes on at its other end.
    const bool laps = mode == mcPeriodic;
    const double lost = room.deceleration * room.deceleration / room.jerk;
    const auto in_front_of = [&](std::size_t from, bool on) {
        double fastest = unbounded, way = 0;
        for (std::size_t k = 1; k <= count; ++k) {
            if (!laps && (on ? from + k >= count : k > from)) break;
            const std::size_t i = (on ? from + k : from + count - k) % count;
            fastest = std::min(fastest, fastest_in_front_of(seen[i].run.fastest, way, room));
            way += sections[i].length;
            if (2 * room.deceleration * way >= fastest * (fastest + lost)) break;  // from there everything can be braked for
        }
        return fastest;
    };
    for (std::size_t i = 0; i < count; ++i) {
        seen[i].run.fastest_at_end = in_front_of(i, true);
        seen[i].run.fastest_at_begin = in_front_of(i, false);
    }
    run.track.drive = {.driven = false,
                       .driver = {},
                       .sections = static_cast<std::uint32_t>(count),
                       .length = run.curve.path.length(),
                       .room = room,
                       .said = {}};
}

}  // namespace taktwerk::axes
