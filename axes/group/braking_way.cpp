#include "axes/group/braking_way.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "axes/axis/command_check.hpp"
#include "axes/axis/direction_limits.hpp"
#include "axes/axis/stop_ramp.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "axes/planner/plan.hpp"

namespace taktwerk::axes {
namespace {

using Point = std::array<double, 3>;

/// By how much the tool may become faster, or its way more bent, while the arm's levers change.
constexpr double swing = 2;
constexpr double most_looks = 200;
constexpr int most_returns = 16;
constexpr double endless = std::numeric_limits<double>::infinity();

/// As the axis does it that is let go by its group (Conduct::halt_on_own_account).
Plan ramp_of(const MotionState& from, const Axis& axis, double period) noexcept {
    const auto& limits = axis.config().limits;
    return plan_stop(from, in_each_direction(never_reversing(from, full_limits(limits), period), limits));
}

/// The members' ramps, and what they bound of the tool's way by the levers where they begin.
struct Ramps {
    std::array<Profile, max_joints> of;
    std::size_t count = 0;
    double time = 0;  ///< s, until all of them rest
    double way = 0;   ///< u that the tool goes at most
    double bend = 0;  ///< u/s2 that it is accelerated with at most

    [[nodiscard]] Joints at(double t) const noexcept {
        Joints joints{};
        for (std::size_t i = 0; i < count; ++i) joints[i] = of[i].at(t).position;
        return joints;
    }
};

/// False: a member has no ramp.
bool plan_ramps(const std::array<MotionState, most_members>& from, const GroupMembers& members, double period, const BrakingSpace& space,
                Ramps& ramps) noexcept {
    Joints at{};
    std::array<double, max_joints> faster{}, turning{};
    ramps.count = space.arm->joint_count();
    for (std::size_t i = 0; i < ramps.count; ++i) {
        at[i] = from[i].position;
        ramps.of[i] = Profile{{from[i].position, 0, 0}};
        if (!members.has(i) || (from[i].velocity == 0 && from[i].acceleration == 0)) continue;
        const auto plan = ramp_of(from[i], members.axis(i), period);
        if (plan.error != PlanError::none) return false;
        ramps.of[i] = plan.profile;
        ramps.time = std::max(ramps.time, plan.profile.duration());
        const auto& limits = members.axis(i).config().limits;
        faster[i] = std::max({std::abs(from[i].acceleration), limits.acceleration_towards(1), limits.acceleration_towards(-1),
                              limits.deceleration_towards(1), limits.deceleration_towards(-1)});
        if (space.arm->rotary()[i]) turning[i] = plan.profile.max_speed() * space.arm->map().settings(i).unit;
    }
    const auto jacobian = space.arm->jacobian(at, space.tool);
    double turn = 0;  // rad/s of all of them: a lever that turns
    for (const double each : turning) turn += each;
    for (std::size_t i = 0; i < ramps.count; ++i) {
        const double lever = swing * jacobian.col(static_cast<Eigen::Index>(i)).head<3>().norm(), speed = ramps.of[i].max_speed();
        ramps.way += lever * std::abs(ramps.of[i].at(ramps.of[i].duration()).position - at[i]);
        ramps.bend += lever * (faster[i] + speed * turn);
    }
    return true;
}

/// The walls that the tool may come to: of six rooms mostly one or none.
class NearWalls {
public:
    static constexpr std::size_t most = 8;
    struct Look {
        Point point{};
        std::array<RoomPlace, most> at{};
        double room = endless;  ///< as Workspace::clearance(), of these walls
    };

    NearWalls(const Workspace& space, const Point& from, double way) noexcept {
        bool kept_in = false;
        for (const auto& room : space.rooms) {
            const double d = place_at(room, from).distance;
            kept_in = kept_in || (!room.kept_free && -d >= way);
        }
        for (const auto& room : space.rooms) {
            const double d = place_at(room, from).distance;
            if (room.kept_free ? d > way : kept_in || d > way) continue;
            if (count_ == most) whole_ = true;
            else rooms_[count_++] = &room;
        }
        bounded_ = !kept_in && std::any_of(space.rooms.begin(), space.rooms.end(), [](const auto& room) { return !room.kept_free; });
    }
    /// There are too many of them.
    [[nodiscard]] bool whole() const noexcept { return whole_; }
    [[nodiscard]] bool none() const noexcept { return count_ == 0 && !bounded_; }

    [[nodiscard]] Look look(const Point& point) const noexcept {
        Look seen;
        seen.point = point;
        double inside = bounded_ ? -endless : endless, outside = endless;
        for (std::size_t i = 0; i < count_; ++i) {
            seen.at[i] = place_at(*rooms_[i], point);
            if (rooms_[i]->kept_free) outside = std::min(outside, seen.at[i].distance);
            else inside = std::max(inside, -seen.at[i].distance);
        }
        seen.room = std::min(inside, outside);
        return seen;
    }
    /// Of the straight way between both: rooms are convex, so the distance from one is at least that from its tangent plane, and whoever is in one room at
    /// both ends is in it.
    [[nodiscard]] double between(const Look& a, const Look& b) const noexcept {
        double inside = bounded_ ? -endless : endless, outside = endless;
        for (std::size_t i = 0; i < count_; ++i) {
            const auto &one = a.at[i], &other = b.at[i];
            double from_one = 0, from_other = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                from_one += one.outwards[k] * (b.point[k] - a.point[k]);
                from_other += other.outwards[k] * (a.point[k] - b.point[k]);
            }
            if (rooms_[i]->kept_free)
                outside = std::min(outside, std::max(one.distance + std::min(0.0, from_one), other.distance + std::min(0.0, from_other)));
            else inside = std::max(inside, std::min(-one.distance, -other.distance));
        }
        return std::min(inside, outside);
    }

private:
    std::array<const WorkspaceRoom*, most> rooms_{};
    std::size_t count_ = 0;
    bool bounded_ = false, whole_ = false;
};

}  // namespace

bool brakes_inside(const std::array<MotionState, most_members>& from, const GroupMembers& members, double period,
                   const BrakingSpace& space) noexcept {
    Ramps ramps;
    if (!plan_ramps(from, members, period, space, ramps)) return false;
    const auto tool_at = [&](double cycle) { return space.arm->forward(ramps.at(cycle * period), space.tool).pose.position; };
    const Point here = tool_at(0);
    const NearWalls walls(*space.workspace, here, ramps.way - space.least);
    if (walls.none()) return true;
    const auto left = [&](double room, const Point& point) { return room + wall_digits(point) - space.least; };
    const double cycles = std::ceil(ramps.time / period), stride = std::max(1.0, std::ceil(cycles / most_looks));
    if (walls.whole()) {
        for (double cycle = 0; cycle <= cycles; cycle = cycle < cycles ? std::min(cycles, cycle + stride) : cycles + 1) {
            const Point point = tool_at(cycle);
            if (!(left(space.workspace->clearance(point), point) >= 0)) return false;
        }
        return true;
    }
    // From look to look; between two of them the way is no further from the straight one than `bend` lets it, for which half of the room is left. Where that is
    // not enough: every set-point.
    auto seen = walls.look(here);
    int returns = 0;
    for (double cycle = 0;;) {
        const double room = left(seen.room, seen.point);
        if (!(room >= 0)) return false;
        if (cycle >= cycles) return true;
        const double straight = ramps.bend > 0 ? std::floor(std::sqrt(4 * room / ramps.bend) / period) : cycles;
        double step = returns < most_returns ? std::max(stride, straight) : stride;
        for (;;) {
            step = std::min(step, cycles - cycle);
            const auto next = walls.look(tool_at(cycle + step));
            const double off = ramps.bend * (step * period) * (step * period) / 8;
            const bool shown = step <= stride || left(std::min(walls.between(seen, next), next.room), next.point) >= off;
            if (shown) {
                seen = next;
                cycle += step;
                break;
            }
            ++returns;
            step = std::max(stride, std::floor(step / 4));
        }
    }
}

}  // namespace taktwerk::axes
