// Places that do not drift: against whole-number arithmetic, over as many turns as a machine makes in years.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "axes/coupling/gear_line.hpp"
#include "axes/coupling/gear_sum.hpp"

namespace taktwerk::axes {
namespace {

__extension__ using Wide = __int128;

// 360 * 355 / 113 per step in steps of 10: 127800 / 1130 = 12780 / 113.
TEST(StepRatio, CountsLikeWholeNumbersWhateverTheSteps) {
    StepRatio steps;
    ASSERT_TRUE(steps.set(360, 355, 113, 10));
    std::mt19937_64 random(1);
    Wide total = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto more = static_cast<std::int64_t>(random() % 2'000'000'000'000) - 900'000'000'000;
        steps.advance(more);
        total += more;
        Wide whole = total * 12780 / 113, rest = total * 12780 % 113;
        if (rest < 0) rest += 113, --whole;
        ASSERT_EQ(steps.whole(), static_cast<std::int64_t>(whole)) << i;
        ASSERT_NEAR(steps.rest(), 10.0 * static_cast<double>(rest) / 113, 1e-14) << i;
    }
    EXPECT_GT(total, 1'000'000'000'000);
}

// 0.1 and 0.3 are not what they look like: 3602879701896397 / 2^55 and 5404319552844595 / 2^54. The place after 10^12 steps is
// that of those numbers, not of 1/3.
TEST(StepRatio, TakesDecimalFractionsForWhatTheyAre) {
    StepRatio steps;
    ASSERT_TRUE(steps.set(0.1, 1, 1, 0.3));
    constexpr std::int64_t count = 1'000'000'000'000;
    steps.advance(count);
    const Wide grow = static_cast<Wide>(3602879701896397) * count, step = static_cast<Wide>(5404319552844595) * 2;
    EXPECT_EQ(steps.whole(), static_cast<std::int64_t>(grow / step));
    EXPECT_NEAR(steps.rest(), 0.3 * static_cast<double>(grow % step) / static_cast<double>(step), 1e-15);
    steps.advance(-count);
    EXPECT_EQ(steps.whole(), 0);
    EXPECT_EQ(steps.rest(), 0);
}

TEST(StepRatio, RefusesWhatCannotBeExact) {
    StepRatio steps;
    EXPECT_FALSE(steps.set(1e-30, 1, 1, 1.0 / 3));
    EXPECT_FALSE(steps.set(10, 1, 0, 10));
    EXPECT_FALSE(steps.set(0, 1, 1, 10));
    EXPECT_FALSE(steps.set(10, 1, 1, std::nan("")));
    EXPECT_TRUE(steps.set(62.831853071795862, 32767, 65535, 0.1));
    EXPECT_TRUE(steps.set(10, -2147483648LL, 2147483647, 1.0 / 3));
    steps.advance(3);
    EXPECT_EQ(steps.whole(), -91);  // -90.00000004... thirds
}

// Small steps, large steps, with the master's number kept in feeds or in its local part: one place of the master has one place of the slave.
TEST(GearLine, ThePlaceDependsOnTheMasterAloneAndNotOnTheWay) {
    GearLine small, large;
    const EndlessPlace master{5, 1.25}, slave{-7, 0.5};
    ASSERT_TRUE(small.set({-7, 3}, 360, 10, master, slave));
    ASSERT_TRUE(large.set({-7, 3}, 360, 10, master, slave));
    EndlessMotion at{master, 0, 0};
    for (int i = 0; i < 100'000; ++i) {
        at.place.feeds += 3;
        (void)small.at(at);
    }
    const auto one = small.at(at).place, other = large.at(at).place;
    EXPECT_EQ(one, other);
    // 300000 turns of 360 at -7/3: -252,000,000 = -25,200,000 feeds of 10, exactly.
    EXPECT_EQ(one, (EndlessPlace{-7 - 25'200'000, 0.5}));
    at.place = {at.place.feeds - 2, at.place.local + 720};
    EXPECT_NEAR(way(other, small.at(at).place, 10), 0, 1e-12);
}

// 10^9 cycles at 1 ms, 50 turns a second, as steps of many turns: 5 * 10^7 turns ... and a thousand times that, as long as int64 lasts.
TEST(GearLine, ABillionCyclesLeaveNoTrace) {
    GearLine line;
    ASSERT_TRUE(line.set({355, 113}, 360, 0.1, {}, {}));
    std::mt19937_64 random(7);
    std::int64_t turns = 0;
    for (int i = 0; i < 1000; ++i) {
        turns += static_cast<std::int64_t>(random() % 100'000'000);
        const double local = static_cast<double>(random() % 360'000) / 1000;
        const auto slave = line.at({{turns, local}, 0, 0}).place;
        // 0.1 is 3602879701896397 / 2^55: 360 * 355 / 113 of a turn in such steps.
        const Wide grow = static_cast<Wide>(turns) * 360 * 355 * (static_cast<Wide>(1) << 55);
        const Wide step = static_cast<Wide>(113) * 3602879701896397;
        const double rest = 0.1 * static_cast<double>(grow % step) / static_cast<double>(step) + local * 355 / 113;
        ASSERT_EQ(slave.feeds, static_cast<std::int64_t>(grow / step)) << i;
        ASSERT_NEAR(slave.local, rest, 1e-12) << i;
    }
    EXPECT_GT(turns, 40'000'000'000);
}

TEST(GearLine, VelocityAndAccelerationGoWithTheRatio) {
    GearLine line;
    ASSERT_TRUE(line.set({-1, 2}, 10, 10, {}, {}));
    const auto slave = line.at({{0, 3}, 40, -100});
    EXPECT_EQ(slave.place.local + 10 * static_cast<double>(slave.place.feeds), -1.5);
    EXPECT_EQ(slave.velocity, -20);
    EXPECT_EQ(slave.acceleration, 50);
}

TEST(GearSum, AddsWhatEachMasterHasMoved) {
    GearSum sum;
    ASSERT_TRUE(sum.set({1, 2}, {-3, 1}, 360, 10, 10, {1, 0}, {0, 5}, {0, 100}));
    const auto slave = sum.at({{1, 40}, 2, 4}, {{1, 0}, 1, 1});  // 40 / 2 - 3 * 5
    EXPECT_NEAR(way({0, 100}, slave.place, 10), 5, 1e-12);
    EXPECT_EQ(slave.velocity, -2);
    EXPECT_EQ(slave.acceleration, -1);
}

}  // namespace
}  // namespace taktwerk::axes
