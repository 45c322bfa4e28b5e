#include "axes/coupling/catch_up.hpp"

#include <algorithm>
#include <cmath>

#include "axes/coupling/relative_rounding.hpp"
#include "axes/planner/plan.hpp"
#include "core/math.hpp"

namespace taktwerk::axes {

namespace {

constexpr double least_catch_up_share = 0.2;  // of the acceleration that is left to catch up beside a master's own

double sign(double value) noexcept { return value > 0 ? 1.0 : value < 0 ? -1.0 : 0.0; }

/// The acceleration that the jerk takes away over a change of velocity.
double released_over(double velocity, double jerk) noexcept {
    return std::isfinite(jerk) ? math::sqrt(2 * jerk * std::max(0.0, velocity)) : jerk;
}

/// Of the slave's acceleration: upwards and downwards, and its jerk.
struct Bounds {
    double up = 0, down = 0, jerk = 0;
    double fastest = 0;  // u/s
};

/// PLCopen's acceleration and deceleration go by the sense of the velocity; where that turns round the smaller one holds for both.
Bounds bounds_of(double velocity, double goal, const FollowerLimits& limits) noexcept {
    const auto& [_, acceleration, deceleration, jerk] = limits.approach;
    if (velocity * goal < 0) {
        const double less = std::min(acceleration, deceleration);
        return {less, less, jerk, limits.axis.velocity};
    }
    const double sense = goal != 0 ? goal : velocity;
    return {sense >= 0 ? acceleration : deceleration, sense > 0 ? deceleration : acceleration, jerk, limits.axis.velocity};
}

/// A velocity that goes on as it does.
struct Line {
    double velocity = 0, acceleration = 0;
    [[nodiscard]] double velocity_before(double period) const noexcept { return velocity - acceleration * period; }
};

/// What is foreseen of the gear: as far as the slave can go with it, and with no acceleration that it could not lose before standstill or limit.
Line foreseen(const GearDemand& gear, double velocity, double sense, const Bounds& bounds, const FollowerLimits& limits) noexcept {
    if (velocity != gear.velocity) return {velocity, 0};
    const double room = sense * gear.acceleration >= 0 ? limits.room(sense) - std::abs(velocity) : std::abs(velocity);
    const double most = released_over(room, bounds.jerk), share = 1 - least_catch_up_share;
    return {velocity, std::clamp(std::clamp(gear.acceleration, -share * bounds.down, share * bounds.up), -most, most)};
}

struct Meeting {
    MotionState state;    // after a period, counted from the slave's place
    double duration = 0;  // s
    bool planned = false;
};

/// The fastest way from velocity and acceleration one period ago onto the line.
Meeting meet(double velocity, double acceleration, const Line& line, const Bounds& bounds, double period) noexcept {
    const MotionState lack{0, velocity - line.velocity_before(period), acceleration - line.acceleration};
    const double up = bounds.up - line.acceleration, down = bounds.down + line.acceleration;
    const double most = bounds.fastest + std::abs(lack.velocity);
    const auto plan =
        plan_to_velocity(lack, 0, SignedLimits{SignLimits{most, up, up, bounds.jerk}, SignLimits{most, down, down, bounds.jerk}});
    const auto beside = plan.profile.at(period);
    return {{beside.position + (line.velocity - line.acceleration * period / 2) * period, line.velocity + beside.velocity,
             line.acceleration + beside.acceleration},
            plan.profile.duration(),
            plan.error == PlanError::none};
}

/// The slave's acceleration, less what it would pass the line by, as far as the master gave up as much: `turn` in this cycle.
double given_up(double velocity, double acceleration, double turn, const Line& line, double jerk, double period) noexcept {
    if (!std::isfinite(jerk)) return acceleration;
    const double lack = velocity - line.velocity_before(period), width = released_over(std::abs(lack), jerk);
    const double highest = line.acceleration + (lack < 0 ? width : 0.0), lowest = line.acceleration - (lack > 0 ? width : 0.0);
    if (acceleration > highest && turn < 0) return std::max(highest, acceleration + turn);
    if (acceleration < lowest && turn > 0) return std::min(lowest, acceleration + turn);
    return acceleration;
}

}  // namespace

CatchUp::Step CatchUp::next(const MotionState& before, const GearDemand& gear, const FollowerLimits& limits, double period) noexcept {
    unrest_.look(gear);
    const double v = before.velocity, noise = 2 * unrest_.noise();
    const bool turns_seemingly = gear.velocity * gear.trend < 0 && std::abs(gear.velocity) > noise;
    const double goal = limits.inside(turns_seemingly ? 0.0 : gear.velocity);
    auto bounds = bounds_of(v, goal, limits);
    const double up = bounds.up * (1 + relative_rounding), down = bounds.down * (1 + relative_rounding);
    const double sense = goal != 0 ? sign(goal) : sign(v);
    const bool keeps_sense = v * sense >= 0;
    auto line = foreseen(gear, goal, sense, bounds, limits);
    Step out;
    out.held_back = goal != gear.velocity || line.acceleration != gear.acceleration;

    // What the slave brings along is lost before the velocity is 0, or the limit: with more jerk, or in this cycle.
    double a = before.acceleration;
    const bool brakes = v * a < 0;
    const double room = brakes ? std::abs(v) : limits.room(v != 0 ? v : a) - std::abs(v);
    // Where the limit has come down on it, it is behind that end already, and brakes from where it is.
    const bool beyond = room < 0;
    if (beyond) a = 0;
    const bool tight = keeps_sense && !beyond && std::isfinite(bounds.jerk) && a * a > 2 * room * bounds.jerk;
    const bool at_end = tight && 2 * room <= std::abs(a) * period;
    if (tight && !at_end) bounds.jerk = (1 + 1e-12) * a * a / (2 * room);
    a = given_up(v, a, unrest_.turn(), line, bounds.jerk, period);

    auto met = meet(v, a, line, bounds, period);
    // The master will have come to rest before.
    if (line.velocity * line.acceleration < 0 && std::abs(line.velocity) < std::abs(line.acceleration) * met.duration) {
        line.acceleration = -line.velocity / met.duration;
        met = meet(v, a, line, bounds, period);
    }
    if (at_end) {
        const double end = brakes ? 0.0 : v + std::copysign(room, a);
        met.state = {(v + end) / 2 * period, end, 0};
    } else if (keeps_sense && sense != 0) {
        const double rate = sense * met.state.acceleration, speed = sense * met.state.velocity, lost = rate * rate / (2 * bounds.jerk);
        if (rate < 0 && speed < lost) met = meet(v, a, {0, 0}, bounds, period);
        else if (rate > 0 && speed + lost > limits.room(sense)) met = meet(v, a, {sense * limits.room(sense), 0}, bounds, period);
        if (sense * met.state.velocity < 0) met.state.velocity = met.state.acceleration = 0;
    }
    if (!met.planned) return {{before.position + v * period, v, 0}, false, 0, true};  // only numbers beyond the planner's bounds
    out.state = {before.position + met.state.position, met.state.velocity, met.state.acceleration};

    // A gear that the slave could not go on with, it does not take over.
    const bool follows = goal == gear.velocity && gear.acceleration <= up && gear.acceleration >= -down;
    if (!follows || std::abs(unrest_.step()) > std::max(up, down) * period + noise) return out;
    if (!std::isfinite(bounds.jerk)) {
        out.caught = met.duration <= period * (1 + relative_rounding);
        out.place = out.state.position;
        return out;
    }
    // A cycle's jerk, what the master itself changes its acceleration by, and what it is unsteady by anyway.
    const double jerk = bounds.jerk * period * (1 + relative_rounding), change = unrest_.change();
    const double off = gear.velocity - v - (a + gear.acceleration) / 2 * period;
    out.caught = std::abs(gear.acceleration - a) <= jerk + change + noise / period + relative_rounding * limits.axis.acceleration &&
                 std::abs(off) <= (jerk / 4 + change) * period + noise + relative_rounding * limits.axis.velocity;
    out.place = before.position + ((v + gear.velocity) / 2 + (a - gear.acceleration) / 12 * period) * period;
    return out;
}

}  // namespace taktwerk::axes
