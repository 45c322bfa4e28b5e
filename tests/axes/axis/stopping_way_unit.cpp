// What a drive that stops by itself may be behind its set-point, and that one which does not brake is noticed.

#include "axes/axis/stopping_way.hpp"

#include <gtest/gtest.h>

namespace taktwerk::axes::test {
namespace {

/// 100 u/s, told to stop with 200 u/s2, heard 0.1 s later, window 5: it may go 5 + 100 x 0.1 + 100^2 / 400 = 40 u.
StoppingWay::Sample sample(bool told, double place, double error) {
    return {.told_to_stop = told,
            .place = place,
            .velocity = 100,
            .error = error,
            .speed = 0,
            .deceleration = 200,
            .latency = 0.1,
            .window = 5};
}

TEST(StoppingWay, WithoutAStopNothingIsAllowed) {
    StoppingWay way;
    EXPECT_EQ(way.allowance(sample(false, 0, 30)), 0);
    EXPECT_EQ(way.allowance(sample(false, 10, -30)), 0);
}

TEST(StoppingWay, WhileItBrakesTheErrorIsWhateverItIs) {
    StoppingWay way;
    EXPECT_EQ(way.allowance(sample(true, 0, -17)), 17);
    EXPECT_EQ(way.allowance(sample(true, 39, -56)), 56);
}

TEST(StoppingWay, BeyondTheWayOfItsRampNothingIsAllowed) {
    StoppingWay way;
    EXPECT_EQ(way.allowance(sample(true, 0, 1)), 1);
    EXPECT_EQ(way.allowance(sample(true, 40.5, 12)), 0);
    EXPECT_EQ(way.allowance(sample(true, -40.5, 12)), 0) << "in either direction";
}

// Of a set-point at 200 u/s the motor may have as much when it hears of the stop: 5 + 20 + 100.
TEST(StoppingWay, AMotorOnItsWayToTheSpeedOfItsSetPointMayGetThere) {
    StoppingWay way;
    auto first = sample(true, 0, 1), later = sample(true, 124, 9);
    first.speed = 200;
    EXPECT_EQ(way.allowance(first), 1);
    EXPECT_EQ(way.allowance(later), 9);
    later.place = 126;
    EXPECT_EQ(way.allowance(later), 0);
}

TEST(StoppingWay, WhatItMakesUpAfterwardsIsForgivenNoMore) {
    StoppingWay way;
    (void)way.allowance(sample(true, 0, 30));
    EXPECT_EQ(way.allowance(sample(false, 0, 35)), 30);
    EXPECT_EQ(way.allowance(sample(false, 0, 12)), 12);
    EXPECT_EQ(way.allowance(sample(false, 0, 20)), 12);
    EXPECT_EQ(way.allowance(sample(false, 0, 0)), 0);
}

}  // namespace
}  // namespace taktwerk::axes::test
