// Triggers: each condition at the sample where it holds, windows, holdoff, and nothing that a thinned curve would have hidden.
#include "runtime/recording/trigger.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <vector>

#include "runtime/recording/signal_ring.hpp"

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using Kind = TriggerCondition::Kind;
using Mode = TriggerHunt::Mode;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// The places (from 1) of the samples at which it happens.
std::vector<int> places(TriggerCondition condition, const std::vector<double>& samples) {
    TriggerDetector detector{condition};
    std::vector<int> out;
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (detector.happens(samples[i])) out.push_back(static_cast<int>(i) + 1);
    return out;
}

TEST(TriggerDetector, EdgesAreCrossingsInTheirDirection) {
    const std::vector<double> samples{3, 1, 2, 1, 5, 5, 2, 1};
    EXPECT_THAT(places({Kind::rising, 2}, samples), ElementsAre(3, 5)) << "reaching the level counts";
    EXPECT_THAT(places({Kind::falling, 2}, samples), ElementsAre(2, 7));
    EXPECT_THAT(places({Kind::either, 2}, samples), ElementsAre(2, 3, 5, 7));
    EXPECT_TRUE(places({Kind::rising, 2}, {5, 5}).empty()) << "it was above when the trigger was armed: no edge";
}

TEST(TriggerDetector, LevelsAndWindowsHoldAtOnce) {
    const std::vector<double> samples{0, 2, 3, 4, 9};
    EXPECT_THAT(places({Kind::above, 3}, samples), ElementsAre(4, 5)) << "the level itself is not above it";
    EXPECT_THAT(places({Kind::below, 3}, samples), ElementsAre(1, 2));
    EXPECT_THAT(places({Kind::inside, 2, 4}, samples), ElementsAre(2, 3, 4)) << "both bounds are inside";
    EXPECT_THAT(places({Kind::outside, 2, 4}, samples), ElementsAre(1, 5));
}

TEST(TriggerDetector, ABitIsOneOfAWholeNumberThatComes) {
    EXPECT_THAT(places({Kind::bit, 0, 0, 3}, {0b1000, 0b0111, 0b1111, 0b1000, 0b0000, 0b1001}), ElementsAre(3, 6));
    EXPECT_THAT(places({Kind::bit, 0, 0, 0}, {0, 1, 1, 0, 1}), ElementsAre(2, 5));
    EXPECT_TRUE(places({Kind::bit, 0, 0, 52}, {0, -1, 1e300, no_number}).empty()) << "no whole numbers";
}

TEST(TriggerDetector, WhatIsNoNumberIsPassedOver) {
    EXPECT_THAT(places({Kind::rising, 2}, {1, no_number, 3}), ElementsAre(3));
    EXPECT_TRUE(places({Kind::rising, 2}, {no_number, 3}).empty());
    EXPECT_TRUE(places({Kind::above, no_number}, {1, 2}).empty());
    EXPECT_TRUE(places({Kind::outside, 1, 2}, {no_number}).empty());
    EXPECT_THAT(places({Kind::above, 2}, {std::numeric_limits<double>::infinity()}), ElementsAre(1));
}

class Hunt : public ::testing::Test {
protected:
    void write(double value) {
        auto row = ring.begin(++cycle);
        row.put(Duration{cycle * 1'000'000});
        row.put(value);
        ring.commit();
    }
    void write(std::initializer_list<double> values) {
        for (const double value : values) write(value);
    }
    void quiet(int rows) {
        for (int i = 0; i < rows; ++i) write(0);
    }
    TriggerHunt hunt(TriggerCondition condition, std::uint64_t pre, std::uint64_t post, Mode mode = Mode::single,
                     std::uint64_t holdoff = 0) {
        return {ring, {condition, SignalCell{1, 0, 64, SignalCell::Coding::real, 1}, pre, post, mode, holdoff}};
    }
    static std::vector<std::uint64_t> cycles(const TriggerHunt& hunt) {
        std::vector<std::uint64_t> out;
        for (const auto& event : hunt.events()) out.push_back(event.cycle);
        return out;
    }
    SignalRing ring{
        {{"time_s", "s", SignalKind::real, SignalGroup::machine, "", "", "", {0, 0, 64, SignalCell::Coding::integer, 1e9}}}, 2, 1000, 1ms};
    std::uint64_t cycle = 0;
};

TEST_F(Hunt, FindsAPulseOfOneSampleAndItsWindow) {
    quiet(300);
    auto one = hunt({Kind::rising, 5}, 100, 50);
    quiet(200);
    write(10);
    quiet(400);
    for (int i = 0; i < 20; ++i) one.step(64);

    ASSERT_EQ(one.events().size(), 1u);
    EXPECT_EQ(one.events()[0].cycle, 501u);
    EXPECT_EQ(one.events()[0].from, 401u);
    EXPECT_EQ(one.events()[0].to, 551u);
    EXPECT_FALSE(one.armed()) << "single";
    EXPECT_FALSE(one.events()[0].automatic);
}

TEST_F(Hunt, LooksAtNoMoreThanItIsGivenAStep) {
    quiet(1);
    auto one = hunt({Kind::rising, 5}, 0, 0);
    quiet(700);
    one.step(256);
    EXPECT_EQ(one.looked_to(), 257u);
    one.step(10000);
    EXPECT_EQ(one.looked_to(), 702u);
}

TEST_F(Hunt, APreTriggerBeginsWhereTheMemoryDoes) {
    quiet(20);
    auto one = hunt({Kind::rising, 5}, 5000, 10);
    write(10);
    one.step(1000);
    ASSERT_EQ(one.events().size(), 1u);
    EXPECT_EQ(one.events()[0].from, 1u);

    quiet(3000);
    auto later = hunt({Kind::rising, 5}, 5000, 10);
    write(10);
    later.step(1000);
    ASSERT_EQ(later.events().size(), 1u);
    EXPECT_EQ(later.events()[0].from, ring.span().first);
}

TEST_F(Hunt, NormalGoesOnAndHoldoffPassesOver) {
    quiet(10);
    auto plain = hunt({Kind::rising, 5}, 0, 1, Mode::normal), held = hunt({Kind::rising, 5}, 0, 1, Mode::normal, 25);
    for (int i = 0; i < 6; ++i) {
        write(10);
        quiet(9);
    }
    plain.step(1000);
    held.step(1000);
    EXPECT_THAT(cycles(plain), ElementsAre(11, 21, 31, 41, 51, 61));
    EXPECT_THAT(cycles(held), ElementsAre(11, 41)) << "36 would be over: the next pulse counts, and then 66 is";
    EXPECT_TRUE(held.armed());
}

TEST_F(Hunt, AutomaticShowsSomethingWhereNothingHappens) {
    quiet(10);
    auto one = hunt({Kind::rising, 5}, 100, 100, Mode::automatic);
    quiet(150);
    write(10);
    quiet(600);
    one.step(10000);

    ASSERT_GE(one.events().size(), 2u);
    EXPECT_EQ(one.events()[0].cycle, 161u);
    EXPECT_FALSE(one.events()[0].automatic);
    EXPECT_EQ(one.events()[1].cycle, 161u + 100 + 200) << "a window of quiet behind the window of the event";
    EXPECT_TRUE(one.events()[1].automatic);
}

// "Where nothing happens": a window that was shown meanwhile hides nothing, in itself or by its hold-off.
TEST_F(Hunt, AnAutomaticWindowKeepsNoEventAway) {
    quiet(10);
    auto one = hunt({Kind::rising, 5}, 100, 100, Mode::automatic), held = hunt({Kind::rising, 5}, 100, 100, Mode::automatic, 5000);
    quiet(250);  // at 210 something is shown all the same, until 310
    write(10);
    quiet(99);
    one.step(10000);
    held.step(10000);

    for (const auto& hunted : {one, held}) {
        ASSERT_EQ(hunted.events().size(), 2u);
        EXPECT_EQ(hunted.events()[0].cycle, 210u);
        EXPECT_TRUE(hunted.events()[0].automatic);
        EXPECT_EQ(hunted.events()[1].cycle, 261u);
        EXPECT_FALSE(hunted.events()[1].automatic);
    }
}

TEST_F(Hunt, WhoIsOvertakenSaysHowMuchItDidNotSee) {
    quiet(10);
    auto one = hunt({Kind::rising, 5}, 0, 0);
    quiet(3000);
    one.step(10);
    EXPECT_EQ(one.skipped(), 2001u) << "10 was the newest; 2011 to 3010 are there";
    EXPECT_GE(one.looked_to(), 2011u);
}

TEST_F(Hunt, OnlyTheNewestEventsAreKept) {
    quiet(1);
    auto one = hunt({Kind::rising, 5}, 0, 0, Mode::normal);
    for (int i = 0; i < 40; ++i) write({10, 0});
    one.step(1000);
    EXPECT_EQ(one.events().size(), TriggerHunt::most_events);
    EXPECT_EQ(one.events().back().cycle, 80u);
}

TEST_F(Hunt, AnAlarmIsOfferedAndOneFromBeforeDoesNotCount) {
    quiet(50);
    auto one = hunt({Kind::alarm}, 10, 10);
    quiet(20);
    one.offer(30);
    EXPECT_TRUE(one.armed());
    one.offer(60);
    one.step(1000);
    EXPECT_THAT(cycles(one), ElementsAre(60));
    EXPECT_FALSE(one.armed());
}

// Alarms are told a little later than the rows are there: where nothing is known yet, nothing is shown instead.
TEST_F(Hunt, AutomaticWaitsForTheAlarmsOfACycle) {
    quiet(50);
    auto one = hunt({Kind::alarm}, 50, 50, Mode::automatic);
    quiet(200);
    one.step(1000, 149);
    EXPECT_EQ(one.looked_to(), 150u);
    one.offer(150);
    one.step(1000, 250);
    ASSERT_EQ(one.events().size(), 1u) << "150 + 50 + 100 is still to come";
    EXPECT_EQ(one.events()[0].cycle, 150u);
    EXPECT_FALSE(one.events()[0].automatic);
}

}  // namespace
}  // namespace taktwerk::runtime
