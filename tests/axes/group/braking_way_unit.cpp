// Whether a stop off the path stays out of every wall: against each of its set-points, looked at one by one. Arms of each kind, drawn states and rooms.

#include "axes/group/braking_way.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "axes/axis/command_check.hpp"
#include "axes/axis/direction_limits.hpp"
#include "axes/axis/stop_ramp.hpp"
#include "tests/axes/group/jog_arms.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr double period = 1e-3;

struct Stops {
    Stops(const JogArm& of, std::uint32_t seed)
        : arm(arm_of(of.description)), rig(axes_of(of)), members(rig.axes), start(of.start), random(seed) {
        for (std::size_t i = 0; i < rig.axes.size(); ++i)
            EXPECT_EQ(members.add({static_cast<std::uint16_t>(i)}, static_cast<std::uint8_t>(i + 1)), ErrorId::none);
    }
    double draw(double least, double most) { return std::uniform_real_distribution<double>(least, most)(random); }
    std::array<MotionState, most_members> state() {
        std::array<MotionState, most_members> from{};
        for (std::size_t i = 0; i < rig.axes.size(); ++i) {
            const auto& limits = rig.axes[i].config().limits;
            from[i] = {start[i] + draw(-8, 8), draw(-1, 1) * limits.velocity, draw(-0.5, 0.5) * limits.acceleration};
            if (draw(0, 1) < 0.2) from[i].velocity = from[i].acceleration = 0;
        }
        return from;
    }
    std::vector<std::array<double, 3>> way(const std::array<MotionState, most_members>& from) const {
        std::vector<Profile> ramps;
        double time = 0;
        for (std::size_t i = 0; i < rig.axes.size(); ++i) {
            const auto& limits = rig.axes[i].config().limits;
            const bool stands = from[i].velocity == 0 && from[i].acceleration == 0;
            ramps.push_back(
                stands ? Profile{{from[i].position, 0, 0}}
                       : plan_stop(from[i], in_each_direction(never_reversing(from[i], full_limits(limits), period), limits)).profile);
            time = std::max(time, stands ? 0 : ramps.back().duration());
        }
        std::vector<std::array<double, 3>> points;
        for (int cycle = 0; cycle <= std::ceil(time / period); ++cycle) {
            Joints at{};
            for (std::size_t i = 0; i < ramps.size(); ++i) at[i] = ramps[i].at(cycle * period).position;
            points.push_back(arm->forward(at, {}).pose.position);
        }
        return points;
    }
    /// Rooms about a place of the way, so that many stops come near one.
    Workspace rooms(const std::vector<std::array<double, 3>>& way) {
        Workspace space;
        for (int n = 0; n < 6; ++n) {
            const auto& near = way[static_cast<std::size_t>(draw(0, 1) * static_cast<double>(way.size() - 1))];
            WorkspaceRoom room{.shape = draw(0, 1) < 0.5 ? WorkspaceRoom::Shape::box : WorkspaceRoom::Shape::cylinder, .kept_free = n != 5};
            const double size = room.kept_free ? std::exp(draw(-2, 4)) : 200, off = std::exp(draw(-4, 3));
            room.half = {size, size * draw(0.2, 2), size * draw(0.2, 2)};
            if (room.shape == WorkspaceRoom::Shape::cylinder) room.half[1] = room.half[0];
            const double a = draw(0, 6.3), turn = draw(0, 3.2), up = draw(-1, 1);
            const double reach = room.kept_free ? room.half[0] + off : room.half[0] - off;
            room.middle.position = {near[0] + reach * std::cos(a), near[1] + reach * std::sin(a), near[2] + up * off};
            room.middle.orientation = {std::cos(turn), 0, 0, std::sin(turn)};
            space.rooms.push_back(room);
        }
        if (draw(0, 1) < 0.5) space.rooms.pop_back();  // no room that it is kept in
        return space;
    }
    Arm arm;
    GroupRig rig;
    GroupMembers members;
    JointVector start;
    std::mt19937 random;
};

TEST(BrakingWay, IsInsideIfEachOfItsSetPointsIs) {
    int inside = 0, outside = 0, grazes = 0;
    for (const auto& of : every_kind_of_arm()) {
        Stops stops(of, 17);
        for (int n = 0; n < 1500; ++n) {
            const auto from = stops.state();
            const auto way = stops.way(from);
            if (way.size() > 200) continue;  // beyond that not each of them is promised
            const auto space = stops.rooms(way);
            const double least = std::min(0.0, space.clearance(way.front()));
            double room = 1e9;
            for (const auto& point : way) room = std::min(room, space.clearance(point) + wall_digits(point) - least);
            const bool stays = brakes_inside(from, stops.members, period, {stops.arm.get(), &space, {}, least});
            ASSERT_EQ(stays, room >= 0) << of.name << ' ' << n << ": " << room << " of " << way.size();
            ++(stays ? inside : outside);
            grazes += std::abs(room) < 0.1 ? 1 : 0;
        }
    }
    EXPECT_GT(inside, 1000);
    EXPECT_GT(outside, 1000);
    EXPECT_GT(grazes, 50) << "walls that are nearly touched are what it is about";
}

// The direction in which the distance grows, against differences; and that the tangent plane bounds it.
TEST(BrakingWay, ARoomsTangentPlaneIsNowhereFurtherThanTheRoom) {
    std::mt19937 random(5);
    const auto draw = [&](double most) { return std::uniform_real_distribution<double>(-most, most)(random); };
    for (int n = 0; n < 4000; ++n) {
        WorkspaceRoom room{.shape = n % 2 == 0 ? WorkspaceRoom::Shape::box : WorkspaceRoom::Shape::cylinder, .half = {10, 20, 30}};
        if (n % 2 != 0) room.half[1] = room.half[0];
        const double turn = draw(3);
        room.middle.orientation = {std::cos(turn), std::sin(turn) * 0.6, 0, std::sin(turn) * 0.8};
        const std::array<double, 3> at{draw(60), draw(60), draw(60)}, by{draw(30), draw(30), draw(30)};
        const auto here = place_at(room, at);
        double along = 0, size = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            along += here.outwards[i] * by[i];
            size += here.outwards[i] * here.outwards[i];
        }
        EXPECT_NEAR(size, 1, 1e-12);
        EXPECT_GE(place_at(room, {at[0] + by[0], at[1] + by[1], at[2] + by[2]}).distance, here.distance + along - 1e-9) << n;
        constexpr double step = 1e-6;
        const double further =
            place_at(room, {at[0] + step * here.outwards[0], at[1] + step * here.outwards[1], at[2] + step * here.outwards[2]}).distance;
        EXPECT_NEAR(further - here.distance, step, 1e-10) << n;
    }
}

}  // namespace
}  // namespace taktwerk::axes::test
