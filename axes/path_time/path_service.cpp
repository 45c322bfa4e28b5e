#include "axes/path_time/path_service.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "axes/path_time/along_limits.hpp"
#include "axes/path_time/braking.hpp"
#include "axes/path_time/plan_pieces.hpp"

namespace taktwerk::axes {
namespace {

/// Of the limits, that a halt is tried with: nearly all along a line, ever less where the path bends.
constexpr double halt_shares[] = {0.98, 0.955, 0.93, 0.905, 0.85, 0.74, 0.645, 0.56, 0.485, 0.42, 0.37, 0.32, 0.28, 0.24, 0.21};
constexpr int hard_shares = 4;  // of them
constexpr int patience = 4;     // borders from which a lowered velocity is not found, until it is looked for with less deceleration
constexpr double softer = 0.6, softest = 0.1;
constexpr int forbearance = 9;            // borders from which it is not, until it brakes as for a halt, to find a way from there
constexpr double furthest_border = 0.25;  // s behind the first one
/// Pieces are cut anew so long before the cycle comes to long ones: more than a plan takes, with its lead.
constexpr double cut_before = 1.0;     // s
constexpr double least_factor = 1e-6;  // what is slower stands
constexpr double slow_to_obey = 0.25;  // s above what is wanted, besides twice what braking to it takes

/// What a halt is planned with, that begins at a lowered override or above it. Who brakes for that override would come to its velocity first, and creep to the end of the
/// braking. Nor is it a bound for what an acceleration that is still there adds, ever so softly as it goes.
double halt_factor(double active, const RunTask& task, const AlongLimits& along) {
    const double a = std::max(task.acceleration, 0.0), adds = a * a / (2 * std::end(halt_shares)[-1] * along.jerk);
    return std::max(active, std::min((task.velocity + adds) / along.velocity, 1.0));
}

}  // namespace

/// The first border between pieces that the cycle does not reach before `lead`, and behind `tried`; the number of pieces where that is their
/// end. -1: not so far that a new wish would wait for it.
int PathService::border(const StretchProgress& at, int tried) const {
    const auto& pieces = active_.plan.pieces;
    if (active_.id == 0 || at.stretch != active_.id) return static_cast<int>(pieces.size());
    double time = 0;
    std::size_t i = static_cast<std::size_t>(at.piece) + 1;
    while (i < pieces.size() && time < lead_) time += pieces[i++].duration;
    if (i + 1 >= pieces.size()) return static_cast<int>(pieces.size());
    time = 0;
    for (; static_cast<int>(i) <= tried && i < pieces.size(); time += pieces[i++].duration)
        if (time > furthest_border) return -1;
    // The last piece is the end of braking: nothing else leads from there but to rest.
    return static_cast<int>(i + 1 >= pieces.size() ? pieces.size() : i);
}

/// How often the same wish has failed; a path that has grown is no other wish.
int PathService::failed_times(const Failed& now) const noexcept {
    const bool same = failed_.any && failed_.stand == now.stand && failed_.stretch == now.stretch && failed_.revision == now.revision &&
                      failed_.factor == now.factor;
    return same ? failed_.times : 0;
}

PathAnswer PathService::nothing_found(const Failed& now, bool at_rest) noexcept {
    const int times = failed_times(now) + 1;
    failed_ = now;
    failed_.any = true;
    failed_.times = times;
    return at_rest ? PathAnswer::stuck : PathAnswer::kept;
}

void PathService::send(int at_piece, const RunTask& task, bool stands, std::uint32_t revision) {
    TimeStretch* stretch = exchange_.free_stretch();
    stretch->id = ++ids_;
    stretch->follows = active_.id;
    stretch->at_piece = at_piece;
    stretch->count = static_cast<int>(plan_.pieces.size());
    std::copy(plan_.pieces.begin(), plan_.pieces.end(), stretch->pieces.begin());
    exchange_.offer();
    sent_.id = stretch->id;
    sent_.at_piece = at_piece;
    sent_.to = task.to;
    sent_.factor = task.velocity_factor;
    sent_.stands = stands;
    sent_.revision = revision;
    sent_.plan = plan_;
    pending_ = true;
}

/// To rest as soon as can be: at the least distance at which a plan is found.
bool PathService::plan_halt(const TimedCurve& curve, RunTask task, double furthest, const RunShape* former) {
    const AlongLimits l = along_limits(curve.at(task.from, CurveSide::after), limits_, 1);
    const auto aim = [&](double share) {
        task.halt_share = share;
        task.to = task.from + Braking(task.velocity, task.acceleration, share * l.deceleration, share * l.jerk).way();
        return task.to > task.from + 1e-12 * std::fabs(task.from) && task.to < furthest;  // or what runs comes to rest as soon
    };
    const auto plan = [&] {
        ++tries_;
        planner_.plan(curve, limits_, task, plan_, former);
        return found();
    };
    // As along a straight line with all of the limits, then with ever less of them. Where the least is still too much, so is all between.
    for (const double& share : halt_shares) {
        if (&share == halt_shares + hard_shares && aim(std::end(halt_shares)[-1]) && !plan()) return false;
        if (!aim(share)) return false;
        if (plan()) return true;
    }
    return false;
}

/// Who is told to go slower and finds no way down to that for long loses no more time: it brakes as for a halt. As soon as a way is found from there, it is taken; at
/// rest it always is.
bool PathService::brake_instead(const TimedCurve& curve, const RunTask& task, const RunShape* former) {
    RunTask halt = task;
    halt.softness = 1;
    halt.velocity_factor = halt_factor(active_.factor, task, along_limits(curve.at(task.from, CurveSide::after), limits_, 1));
    return plan_halt(curve, halt, active_.to, former);
}

/// What runs is what is wanted; before the cycle comes to its long pieces, the same motion in short ones takes its place.
PathAnswer PathService::shorten(const TimedCurve& curve, std::size_t begin, const RunTask& task) {
    if (begin == 0 || !has_long_pieces(active_.plan, begin, cut_before)) return PathAnswer::nothing_new;
    if (!cut_anew(curve, active_.plan, begin, plan_) || plan_.pieces.size() > TimeStretch::most_pieces) return PathAnswer::nothing_new;
    send(static_cast<int>(begin), task, false, active_.revision);
    return PathAnswer::offered;
}

/// An offer waits for its border, which may be a quarter of a second away. Who shall stand meanwhile, or harder, does not wait for that: a halt that is found from an earlier border
/// takes the place of an offer to go, and one that ends sooner that of a softer halt. So however often a wish changes, it comes to rest.
PathAnswer PathService::step(const TimedCurve& curve, double final_end, const PathWish& wish) {
    const bool stand = wish.motion == PathWish::Motion::stand || !(wish.velocity_factor >= least_factor);
    if (pending_ && exchange_.offering()) {
        if (!stand || active_.id == 0 || (sent_.stands && wish.revision == sent_.revision)) return PathAnswer::waiting;
        // What runs comes to rest, if nobody goes on from it.
        if (active_.stands && !sent_.stands && exchange_.take_back()) pending_ = false;
    } else if (pending_) {
        pending_ = false;
        if (exchange_.progress().stretch != sent_.id) {
            ++late_;
            lead_ = std::min(2 * lead_, most_lead);
            return PathAnswer::late;
        }
        exchange_.was_taken();
        std::swap(active_, sent_);
    }
    const StretchProgress at = exchange_.progress();
    Failed now{.stand = stand, .stretch = active_.id, .revision = wish.revision};
    now.to = stand ? 0 : final_end;
    now.factor = stand ? 0 : std::min(wish.velocity_factor, 1.0);
    const int failures = failed_times(now);
    const bool again = failures > 0 && failed_.to == now.to;
    const int begin = border(at, again ? failed_.border : -1);
    if (begin < 0) return PathAnswer::kept;
    if (pending_ && !sent_.stands && begin >= sent_.at_piece) return PathAnswer::waiting;
    now.border = begin;
    const bool at_rest = begin >= static_cast<int>(active_.plan.pieces.size());
    RunTask task;
    task.from = at_rest ? active_.to : active_.plan.pieces[static_cast<std::size_t>(begin)].begin;
    task.velocity_factor = stand ? active_.factor : std::min(wish.velocity_factor, 1.0);
    const RunShape* former = nullptr;
    if (!at_rest) {
        const TimePiece& piece = active_.plan.pieces[static_cast<std::size_t>(begin)];
        task.velocity = piece.velocity;
        task.acceleration = piece.slope;
        former = &active_.plan.shape;
        if (stand)
            task.velocity_factor = halt_factor(active_.factor, task, along_limits(curve.at(task.from, CurveSide::after), limits_, 1));
    }
    if (stand) {
        if (at_rest || (active_.stands && wish.revision == active_.revision)) return PathAnswer::nothing_new;
        const double furthest = pending_ && sent_.stands ? std::min(sent_.to, active_.to) : active_.to;
        if (!plan_halt(curve, task, furthest, former)) return nothing_found(now, false);
        if (pending_ && !exchange_.take_back()) return PathAnswer::waiting;
        task.to = plan_.shape.end;
        send(begin, task, true, wish.revision);
        return PathAnswer::offered;
    }
    task.to = std::min(curve.next_stop(task.from), final_end);
    const bool same = !active_.stands && task.velocity_factor == active_.factor && wish.revision == active_.revision &&
                      std::fabs(task.to - active_.to) <= 1e-12 * std::fabs(task.to);
    if (!at_rest && same) return shorten(curve, static_cast<std::size_t>(begin), task);
    if (!(task.to > task.from + 1e-12 * std::fabs(task.to))) return PathAnswer::nothing_new;
    if (again && failed_.border >= begin) return PathAnswer::stuck;  // at rest, and it was tried
    // Where the path bends, braking as along a line may be too far from what can be; from a softer one there is a way in.
    if (failures > patience) task.softness = std::max(std::pow(softer, failures - patience), softest);
    ++tries_;
    planner_.plan(curve, limits_, task, plan_, former);
    for (int i = 0; i < 8 && plan_.found && !found(); ++i) {
        task.to = task.from + (task.to - task.from) / 2;
        planner_.plan(curve, limits_, task, plan_, former);
    }
    // A plan that stays above what is wanted is better than none only where there is no other.
    const bool slow = plan_.above_for > 2 * plan_.braking_for + slow_to_obey, lowered = !at_rest && now.factor < active_.factor;
    if (found() && !(slow && lowered)) {
        send(begin, task, false, wish.revision);
        return PathAnswer::offered;
    }
    if (lowered && failures > forbearance && brake_instead(curve, task, former)) {
        task.to = plan_.shape.end;
        task.velocity_factor = active_.factor;
        send(begin, task, false, wish.revision);
        return PathAnswer::offered;
    }
    return nothing_found(now, at_rest);
}

}  // namespace taktwerk::axes
