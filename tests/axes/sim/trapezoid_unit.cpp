// The drive's own profile: hand calculations, and from many states the two properties that define it: continuous speed, and never more
// than the ramps.

#include "axes/sim/trapezoid.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace taktwerk::axes::sim {
namespace {

// 1000 counts, 100 counts/s, 200 up, 50 down: 0.5 s and 25 counts up, 2 s and 100 down, 875 at 100: 8.75 s.
TEST(Trapezoid, FromRestWithUnequalRamps) {
    Trapezoid profile;
    profile.go(0, 0, 1000, {100, 200, 50});
    EXPECT_NEAR(profile.duration(), 0.5 + 8.75 + 2.0, 1e-9);
    EXPECT_NEAR(profile.at(0.5).position, 25, 1e-9);
    EXPECT_NEAR(profile.at(0.5).velocity, 100, 1e-9);
    EXPECT_NEAR(profile.at(9.25).position, 900, 1e-9);
    EXPECT_NEAR(profile.at(10.25).velocity, 50, 1e-9);
    EXPECT_NEAR(profile.at(10.25).position, 975, 1e-9);
    EXPECT_EQ(profile.at(20).position, 1000);
    EXPECT_EQ(profile.at(20).velocity, 0);
}

// 100 counts backwards, speed not reached: peak^2 (1/400 + 1/100) = 100 gives 89.44 counts/s after 0.4472 s, 1.342 s in all (2 a d s / (a + d)).
TEST(Trapezoid, AShortWayIsATriangle) {
    Trapezoid profile;
    profile.go(50, 0, -50, {1000, 200, 50});
    const double peak = std::sqrt(2 * 200.0 * 50.0 * 100 / 250);
    EXPECT_NEAR(profile.duration(), peak / 200 + peak / 50, 1e-9);
    EXPECT_NEAR(profile.at(peak / 200).velocity, -peak, 1e-9);
    EXPECT_EQ(profile.at(99).position, -50);
}

// At 100 counts/s with 50 down it needs 100 counts to stand: a target 40 ahead is passed and come back to.
TEST(Trapezoid, TooFastItPassesTheTargetAndComesBack) {
    Trapezoid profile;
    profile.go(0, 100, 40, {100, 200, 50});
    EXPECT_NEAR(profile.at(2).position, 100, 1e-9);
    EXPECT_NEAR(profile.at(2).velocity, 0, 1e-9);
    EXPECT_EQ(profile.at(profile.duration()).position, 40);
}

TEST(Trapezoid, ArrivesWithTheSpeedItGoesOnWith) {
    Trapezoid profile;
    profile.go(0, 0, 1000, {100, 200, 50}, 100);
    EXPECT_NEAR(profile.duration(), 0.5 + 9.75, 1e-9);
    EXPECT_NEAR(profile.at(profile.duration()).velocity, 100, 1e-9);
    EXPECT_NEAR(profile.at(profile.duration() + 1).position, 1100, 1e-9);
}

// SE-808X note on 1601h, SV33-E 8.5.5: a speed or ramp of zero moves nothing.
TEST(Trapezoid, AZeroMovesNothing) {
    for (const TrapezoidLimits limits : {TrapezoidLimits{0, 1, 1}, {1, 0, 1}, {1, 1, 0}}) {
        Trapezoid profile;
        profile.go(7, 0, 1000, limits);
        EXPECT_EQ(profile.at(100).position, 7);
    }
}

TEST(Trapezoid, FromAnyStateTheSpeedIsContinuousAndTheRampsHold) {
    constexpr double dt = 1e-3;
    unsigned seed = 1;
    const auto random = [&](double least, double most) {
        seed = seed * 1664525u + 1013904223u;
        return least + (most - least) * (seed >> 8) / double{1u << 24};
    };
    for (int i = 0; i < 2000; ++i) {
        const TrapezoidLimits limits{random(1, 200), random(10, 500), random(10, 500)};
        const double from = random(-500, 500), speed = random(-300, 300), target = random(-500, 500);
        Trapezoid profile;
        profile.go(from, speed, target, limits, i % 3 == 0 ? random(0, 200) : 0);
        const double most = std::max(limits.acceleration, limits.deceleration) * dt * (1 + 1e-9) + 1e-9;
        Demand before = profile.at(0);
        ASSERT_NEAR(before.velocity, speed, 1e-9);
        for (double t = dt; t < profile.duration(); t += dt) {
            const Demand now = profile.at(t);
            ASSERT_LE(std::abs(now.velocity - before.velocity), most) << i << ' ' << t;
            ASSERT_NEAR(now.position - before.position, (now.velocity + before.velocity) / 2 * dt, 1e-3) << i << ' ' << t;
            before = now;
        }
        ASSERT_NEAR(before.position, target, std::abs(before.velocity) * dt + 1e-3) << i;
    }
}

}  // namespace
}  // namespace taktwerk::axes::sim
