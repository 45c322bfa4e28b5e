// A slave gets onto its relation and stays on it, inside its limits, whatever the master does.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "axes/coupling/follower.hpp"

namespace taktwerk::axes {
namespace {

using namespace std::chrono_literals;

constexpr double feed = 10, infinite = std::numeric_limits<double>::infinity();
constexpr Duration cycle = 1ms;

struct Slave {
    FollowerLimits limits{.axis = {100, 1000, 1000, infinite}, .approach = {100, 1000, 1000, infinite}};
    Follower follower;
    MotionState state;
    double largest_velocity = 0, largest_change = 0, largest_jump = 0;

    void step(const EndlessMotion& master, const EndlessMotion& second = {}) {
        const auto before = state;
        state = follower.step(master, second, before, {0, feed}, cycle);
        largest_velocity = std::max(largest_velocity, std::abs(state.velocity));
        largest_change = std::max(largest_change, std::abs(state.velocity - before.velocity));
        // A place is where the velocity leads to.
        largest_jump =
            std::max(largest_jump, std::abs(state.position - before.position - (state.velocity + before.velocity) / 2 * to_seconds(cycle)));
    }
    void expect_inside_its_limits() const {
        EXPECT_LE(largest_velocity, limits.axis.velocity * (1 + 1e-9));
        EXPECT_LE(largest_change, limits.axis.acceleration * to_seconds(cycle) * (1 + 1e-9));
        EXPECT_LE(largest_jump, limits.axis.acceleration * to_seconds(cycle) * to_seconds(cycle) * 0.51);
    }
};

EndlessMotion rolling(double velocity, int cycles) { return {{0, velocity * to_seconds(cycle) * cycles}, velocity, 0}; }

GearLine gear(Ratio ratio) {
    GearLine line;
    EXPECT_TRUE(line.set(ratio, feed, feed, {}, {}));
    return line;
}

// From rest to 40 u/s at 1000 u/s2: 40 ms, in which the master goes 1.6 and the slave 0.8. The rest is lost and stays lost.
// P1-275
TEST(Follower, AGearRampsToTheRatioAndKeepsTheDistanceLost) {
    Slave slave;
    slave.follower.begin(gear({1, 1}), RunDown::velocity, slave.limits);
    for (int i = 1; i <= 40; ++i) {
        EXPECT_FALSE(slave.follower.in_sync()) << i;
        slave.step(rolling(40, i));
        EXPECT_NEAR(slave.state.velocity, i, 1e-9);
    }
    EXPECT_TRUE(slave.follower.in_sync());
    for (int i = 41; i < 1000; ++i) {
        slave.step(rolling(40, i));
        EXPECT_NEAR(slave.state.position, 40e-3 * i - 0.8, 1e-9);
        EXPECT_TRUE(slave.follower.in_sync());
    }
    slave.expect_inside_its_limits();
}

// The master's place jumps while its velocity stays: the slave cannot be where the gear says, so it is not in gear until it is there again.
TEST(Follower, AGearWhoseMasterJumpsIsOutOfGearUntilItIsMadeUp) {
    Slave slave;
    slave.follower.begin(gear({1, 1}), RunDown::velocity, slave.limits);
    for (int i = 1; i <= 100; ++i) slave.step(rolling(40, i));
    ASSERT_TRUE(slave.follower.in_sync());
    const auto jumped = [](int i) { return EndlessMotion{{0, 40e-3 * i + 5}, 40, 0}; };
    slave.step(jumped(101));
    EXPECT_TRUE(slave.follower.held_back());
    EXPECT_FALSE(slave.follower.in_sync());
    // 5 u beside the master at 1000 u/s2, up to 60 u/s faster: 60 ms up, 23 ms, 60 ms down.
    int more = 0;
    while (!slave.follower.in_sync() && more < 1000) slave.step(jumped(102 + more++));
    EXPECT_NEAR(more, 143, 2);
    EXPECT_NEAR(slave.state.position, 40e-3 * (101 + more) - 0.8 + 5, 1e-9);
    slave.expect_inside_its_limits();
}

/// Speeds up from rest with `acceleration`, at once, to `velocity`.
EndlessMotion ramping(double acceleration, double velocity, int cycles) {
    const double t = cycles * to_seconds(cycle), ramp = velocity / acceleration;
    if (t < ramp) return {{0, acceleration * t * t / 2}, acceleration * t, acceleration};
    return {{0, velocity * (t - ramp / 2)}, velocity, 0};
}

// A slave takes away the acceleration that it has itself, not the one that its master has: with this jerk 900 u/s2 would cost 202 u/s.
// P1-275
TEST(Follower, AGearEnteredInTheMastersRampRunsUpToItAndNeverBack) {
    for (const double jerk : {1000.0, 2000.0, 5000.0, 20000.0})
        for (const int begin : {1, 20, 40, 80, 88}) {
            Slave slave;
            slave.limits.axis.jerk = slave.limits.approach.jerk = jerk;
            slave.follower.begin(gear({1, 1}), RunDown::velocity, slave.limits);
            double fastest_loss = 0;
            for (int i = begin; i < begin + 2000; ++i) {
                const double before = slave.state.velocity;
                slave.step(ramping(900, 80, i));
                fastest_loss = std::max(fastest_loss, before - slave.state.velocity);
                ASSERT_LE(slave.state.velocity, 80 + 1e-9) << jerk << ' ' << begin << ' ' << i;
            }
            EXPECT_LE(fastest_loss, 1e-9) << jerk << ' ' << begin;
            EXPECT_TRUE(slave.follower.in_sync());
            EXPECT_EQ(slave.state.velocity, 80);
            slave.expect_inside_its_limits();
        }
}

// In gear, and the master speeds up harder than the slave can: the slave falls behind, goes on upwards, and makes up what it lost.
TEST(Follower, AGearThatCannotFollowGoesOnUpwardsAndMakesUp) {
    Slave slave;
    slave.limits.axis = slave.limits.approach = {100, 300, 300, 2000};
    slave.follower.begin(gear({1, 1}), RunDown::velocity, slave.limits);
    slave.step({});
    ASSERT_TRUE(slave.follower.in_sync());
    double furthest_behind = 0;
    for (int i = 1; i < 3000; ++i) {
        const double before = slave.state.velocity;
        const auto master = ramping(1000, 50, i);
        slave.step(master);
        const double behind = master.place.local - slave.state.position;
        furthest_behind = std::max(furthest_behind, behind);
        ASSERT_GE(behind, -1e-9) << i;
        if (slave.state.velocity < before) {
            ASSERT_GE(before, 50) << "slows down below its master in cycle " << i;
        }
    }
    EXPECT_GT(furthest_behind, 50.0 * 50 / 2 / 300 - 50.0 * 50 / 2 / 1000);
    EXPECT_TRUE(slave.follower.in_sync());
    EXPECT_NEAR(slave.state.position, ramping(1000, 50, 2999).place.local, 1e-9);
    slave.expect_inside_its_limits();
}

// A sum whose master comes to rest while the slave is behind: with all of its deceleration the slave stops where the master stands.
TEST(Follower, ASumBehindItsMasterStopsWhereTheMasterDoes) {
    Slave slave;
    slave.limits.axis = slave.limits.approach = {100, 100, 100, infinite};
    GearSum sum;
    ASSERT_TRUE(sum.set({1, 1}, {1, 1}, feed, feed, feed, {}, {}, {}));
    slave.follower.begin(sum, RunDown::position, slave.limits);
    // 0 to 50 u/s and back at 1000 u/s2 in 400 ms: it then stands at 17.5. The slave is at 8 with 40 u/s, and needs 8 more to stop.
    const auto master = [](int i) {
        if (i <= 350) return ramping(1000, 50, i);
        const double t = std::min(i - 350, 50) * to_seconds(cycle);
        return EndlessMotion{{0, 16.25 + 50 * t - 500 * t * t}, 50 - 1000 * t, i < 400 ? -1000.0 : 0.0};
    };
    for (int i = 1; i < 3000; ++i) {
        slave.step(master(i), {});
        if (i == 400) {
            ASSERT_LT(slave.state.position + slave.state.velocity * slave.state.velocity / 200, 17.5);
        }
        ASSERT_LE(slave.state.position, 17.5 + 1e-9) << i;
    }
    EXPECT_TRUE(slave.follower.in_sync());
    EXPECT_NEAR(slave.state.position, 17.5, 1e-9);
    slave.expect_inside_its_limits();
}

// P1-275
TEST(Follower, AccelerationAndDecelerationAreThoseOfTheSlave) {
    Slave slave;
    slave.limits.approach.acceleration = 200;
    slave.limits.approach.deceleration = 500;
    slave.follower.begin(gear({1, 1}), RunDown::velocity, slave.limits);
    int i = 0;
    while (!slave.follower.in_sync() && i < 1000) slave.step(rolling(-50, ++i));
    EXPECT_EQ(i, 250);  // 50 / 200
    slave.follower.begin(gear({1, 5}), RunDown::velocity, slave.limits);
    int more = 0;
    do slave.step(rolling(-50, ++i)), ++more;
    while (!slave.follower.in_sync() && more < 1000);
    EXPECT_EQ(more, 80);  // 40 / 500
    EXPECT_NEAR(slave.state.velocity, -10, 1e-9);
    slave.expect_inside_its_limits();
}

// A sum catches up with what its masters have moved since it began.
// P1-300
TEST(Follower, ASumMakesUpTheWay) {
    Slave slave;
    slave.state.position = 3;
    GearSum sum;
    ASSERT_TRUE(sum.set({1, 1}, {-1, 2}, feed, feed, feed, {}, {}, {0, 3}));
    slave.follower.begin(sum, RunDown::position, slave.limits);
    int i = 0;
    while (!slave.follower.in_sync() && i < 1000) ++i, slave.step(rolling(30, i), rolling(20, i));
    ASSERT_TRUE(slave.follower.in_sync());
    EXPECT_NEAR(slave.state.position, 3 + 20e-3 * i, 1e-9);
    slave.expect_inside_its_limits();
}

// A straight cam changes its velocity at once; the slave does not.
TEST(Follower, CornersOfACamAreRounded) {
    PreparedCam cam(4);
    const std::vector<CamPoint> points{{.master = 0, .slave = 0, .segment = CamSegment::linear},
                                       {.master = 10, .slave = 10, .segment = CamSegment::linear},
                                       {.master = 20, .slave = 0, .segment = CamSegment::linear},
                                       {.master = 40, .slave = 0, .segment = CamSegment::linear}};
    ASSERT_EQ(cam.prepare(points, true, true, true), ErrorId::none);
    CamCurve curve;
    ASSERT_TRUE(curve.set(cam, {.master_feed = feed, .slave_feed = feed}));
    Slave slave;
    slave.follower.begin(curve, RunDown::position, slave.limits);
    int out = 0;
    for (int i = 1; i <= 8000; ++i) {
        slave.step(rolling(20, i));
        if (!slave.follower.in_sync()) ++out;
        else {
            ASSERT_NEAR(slave.state.position, cam.at(std::fmod(20e-3 * i, 40)).position, 1e-9) << i;
        }
    }
    EXPECT_GT(out, 4 * 4 * 10);
    EXPECT_LT(out, 8000 / 2);
    slave.expect_inside_its_limits();
}

// A master too fast: the slave keeps its own limit and says so. When the master slows down it locks again.
TEST(Follower, TheSlavesOwnLimitsHold) {
    Slave slave;
    slave.follower.begin(gear({3, 1}), RunDown::velocity, slave.limits);
    double master = 0;
    for (int i = 0; i < 2000; ++i) {
        const double velocity = i < 1000 ? 50 : 20;  // even a jump of the master's velocity
        master += velocity * to_seconds(cycle);
        slave.step({{0, master}, velocity, 0});
        if (i > 200 && i < 1000) {
            ASSERT_NEAR(slave.state.velocity, 100, 1e-6);
            ASSERT_FALSE(slave.follower.in_sync());
            ASSERT_TRUE(slave.follower.held_back());
        }
    }
    EXPECT_TRUE(slave.follower.in_sync());
    EXPECT_NEAR(slave.state.velocity, 60, 1e-9);
    slave.expect_inside_its_limits();
}

// A place that jumps (another table, another zero) moves the slave there, it does not throw it.
TEST(Follower, AJumpOfTheMasterIsMadeUpInsideTheLimits) {
    Slave slave;
    CamCurve curve;
    PreparedCam cam(2);
    ASSERT_EQ(cam.prepare(std::vector<CamPoint>{{.master = 0, .slave = 0, .segment = CamSegment::linear}, {.master = 10, .slave = 10}},
                          true, true, true),
              ErrorId::none);
    ASSERT_TRUE(curve.set(cam, {.master_feed = feed, .slave_feed = feed}));
    slave.follower.begin(curve, RunDown::position, slave.limits);
    for (int i = 1; i < 3000; ++i) slave.step({{0, 20e-3 * i + (i > 1000 ? 7.0 : 0.0)}, 20, 0});
    EXPECT_TRUE(slave.follower.in_sync());
    EXPECT_NEAR(slave.state.position, 20e-3 * 2999 + 7, 1e-9);
    slave.expect_inside_its_limits();
}

// Over the master's position from (0, at rest) to 10 with the ratio 1 at the master's 20: the sync point is met although the master slows
// down, stands and hurries on the way.
// P1-280
TEST(Follower, ASyncPointIsMetWhateverTheMastersVelocity) {
    Slave slave;
    GearLine line;
    ASSERT_TRUE(line.set({1, 1}, feed, feed, {2, 0}, {1, 0}));  // 10 when the master is at 20
    SyncApproach approach;
    approach.set({}, feed, 20, {0, 0, 0}, {10, 1, 0});
    slave.follower.begin(line, approach, {0, feed}, slave.limits);
    double master = 0, velocity = 30, at_sync = -1;
    for (int i = 0; i < 3000; ++i) {
        const double wish = i < 200 ? 30 : i < 600 ? 0 : i < 1200 ? 10 : 40;
        velocity += std::clamp(wish - velocity, -0.1, 0.1);
        const double before = master;
        master += velocity * to_seconds(cycle);
        slave.step({{0, master}, velocity, 0});
        ASSERT_EQ(slave.follower.in_sync(), master >= 20) << i;
        if (before < 20 && master >= 20) at_sync = slave.state.position - (master - 20);
        if (master >= 20) {
            ASSERT_NEAR(slave.state.position, 10 + (master - 20), 1e-9) << i;
        }
    }
    EXPECT_NEAR(at_sync, 10, 1e-9);
    slave.expect_inside_its_limits();
}

}  // namespace
}  // namespace taktwerk::axes
