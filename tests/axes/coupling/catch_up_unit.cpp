// A slave that is not in gear yet, and a master that does not wait for it.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "axes/coupling/follower.hpp"

namespace taktwerk::axes::catching_up {
namespace {

using namespace std::chrono_literals;

constexpr double feed = 10, infinite = std::numeric_limits<double>::infinity(), period = 1e-3;

/// At 50 u/s, until it brakes to standstill.
struct Master {
    double place = 0, velocity = 50, acceleration = 0;
    void step(double deceleration) {
        const double next = std::max(0.0, velocity - deceleration * period);
        acceleration = next > 0 ? -deceleration : 0;
        place += (velocity + next) / 2 * period;
        velocity = next;
    }
};

struct Slave {
    explicit Slave(double jerk) : limits{.axis = {100, 1000, 1000, jerk}, .approach = {100, 1000, 1000, jerk}} {
        GearLine line;
        EXPECT_TRUE(line.set({1, 1}, feed, feed, {}, {}));
        follower.begin(line, RunDown::velocity, limits);
    }
    void step(const Master& master) {
        state = follower.step({{0, master.place}, master.velocity, master.acceleration}, {}, state, {0, feed}, 1ms);
    }
    FollowerLimits limits;
    Follower follower;
    MotionState state;
};

// From rest, and from above: wherever the slave is when the master stops, it stops too, and not beyond.
// P1-275
TEST(CatchUp, AMasterThatStopsHardTurnsNoSlaveRound) {
    for (const double jerk : {infinite, 30'000.0, 5000.0, 1000.0})
        for (const double deceleration : {100.0, 900.0, 2500.0, 30'000.0})
            for (const double from : {0.0, 90.0})
                for (const int stop : {1, 5, 20, 45, 80, 150}) {
                    SCOPED_TRACE(::testing::Message() << jerk << ' ' << deceleration << ' ' << from << ' ' << stop);
                    Slave slave(jerk);
                    slave.state.velocity = from;
                    Master master;
                    for (int i = 0; i < 4000 && !slave.follower.in_sync(); ++i) {
                        const auto before = slave.state;
                        master.step(i < stop ? 0 : deceleration);
                        slave.step(master);
                        if (slave.follower.in_sync()) break;
                        ASSERT_GE(slave.state.velocity, -1e-9) << i;
                        ASSERT_LE(slave.state.velocity, std::max(from, 50.0) + 1e-9) << i;
                        ASSERT_LE(std::abs(slave.state.acceleration), 1000 * (1 + 1e-9)) << i;
                        if (i != stop && master.velocity > 0) {  // in a corner of its motion the slave may give up what the master gave up
                            ASSERT_LE(std::abs(slave.state.acceleration - before.acceleration), jerk * period * (1 + 1e-6)) << i;
                        }
                    }
                    EXPECT_TRUE(slave.follower.in_sync());
                }
}

// 50 u/s that brake with 200 u/s2, and a slave that comes from rest with 1000: after 50 / 1200 s.
// P1-275
TEST(CatchUp, AMasterThatBrakesIsMetOnItsWay) {
    Slave slave(infinite);
    Master master;
    int i = 0;
    for (; i < 1000 && !slave.follower.in_sync(); ++i) {
        master.step(200);
        slave.step(master);
    }
    EXPECT_EQ(i, 42);
    EXPECT_NEAR(slave.state.velocity, 50 - 42 * 0.2, 1e-9);
}

// Its place is filtered, goes too far and comes back: the velocity says that it turned round, the trend that it did not.
TEST(CatchUp, AMasterThatOnlySeemsToTurnRoundTurnsNoSlaveRound) {
    for (const double jerk : {infinite, 20'000.0}) {
        Slave slave(jerk);
        slave.state.velocity = 20;
        EndlessMotion seen{{0, 0}, 0, 0, 0};
        for (int i = 0; i < 300; ++i) {
            seen.velocity = i < 100 ? -5 : 0;
            seen.trend = 1e-3;
            seen.place.local += seen.velocity * period;
            slave.state = slave.follower.step(seen, {}, slave.state, {0, feed}, 1ms);
            ASSERT_GE(slave.state.velocity, 0) << i;
            ASSERT_TRUE(i >= 100 || !slave.follower.in_sync()) << i;
        }
        EXPECT_TRUE(slave.follower.in_sync());
    }
}

// The velocity limit comes down on a slave that still speeds up, in the cycle in which its master gives up more acceleration than the slave has: the limit is
// behind it, and no end that it could reach by losing its acceleration. It brakes, at most with its deceleration.
TEST(CatchUp, ALimitThatComesDownOnTheSlaveIsNoStepOfItsVelocity) {
    for (const double sense : {1.0, -1.0}) {
        Slave slave(20'000);
        EndlessMotion master{};
        const auto step = [&](double velocity, double acceleration) {
            master.velocity = master.trend = sense * velocity;
            master.acceleration = sense * acceleration;
            master.place.local += master.velocity * period;
            const auto before = slave.state;
            slave.state = slave.follower.step(master, {}, slave.state, {0, feed}, 1ms);
            EXPECT_LE(std::abs(slave.state.velocity - before.velocity), 1000 * period * (1 + 1e-9)) << sense * before.velocity;
            EXPECT_FALSE(slave.follower.in_sync());
        };
        for (int i = 0; i < 40; ++i) step(60, 400);
        ASSERT_NEAR(sense * slave.state.velocity, 15, 2);  // on its way, and faster by the cycle
        slave.limits.axis.velocity = slave.limits.forward = slave.limits.backward = 5;
        slave.follower.set_limits(slave.limits);
        step(60, -900);
        for (int i = 0; i < 60; ++i) step(60, 0);
        EXPECT_NEAR(sense * slave.state.velocity, 5, 1e-9);
    }
}

}  // namespace
}  // namespace taktwerk::axes::catching_up
