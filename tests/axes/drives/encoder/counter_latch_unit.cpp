// The latch of a counter terminal, cycle by cycle: armed once, shown until the arming is taken back, armed anew only when that is seen.

#include <gtest/gtest.h>

#include "axes/drives/encoder/counter_latch.hpp"

namespace taktwerk::axes::encoder {
namespace {

constexpr ProbeCommand at_index{.armed = true, .index_pulse = true};
constexpr ProbeCommand at_rising{.armed = true};
constexpr ProbeCommand nothing{};

TEST(CounterLatch, ArmsTheWayThatIsWanted) {
    const auto way = [](const ProbeCommand& wanted) { return CounterLatch{}.arm(wanted, true); };
    EXPECT_EQ(way(nothing), LatchWay::none);
    EXPECT_EQ(way(at_index), LatchWay::index);
    EXPECT_EQ(way(at_rising), LatchWay::rising);
    EXPECT_EQ(way({.armed = true, .edge = ProbeEdge::falling}), LatchWay::falling);
}

TEST(CounterLatch, WaitsUntilAFormerLatchIsGone) {
    CounterLatch latch;
    EXPECT_EQ(latch.arm(at_index, false), LatchWay::none);
    EXPECT_EQ(latch.arm(at_index, false), LatchWay::none);
    EXPECT_EQ(latch.arm(at_index, true), LatchWay::index);
    EXPECT_EQ(latch.arm(at_index, false), LatchWay::index) << "armed is armed";
}

TEST(CounterLatch, OneArmingIsOneLatch) {
    CounterLatch latch;
    ProbeFeedback shown;
    (void)latch.arm(at_index, true);
    EXPECT_FALSE(latch.take(true, false, shown)) << "the terminal does not know of the arming: it is a former latch";
    EXPECT_FALSE(shown.armed);
    EXPECT_FALSE(latch.take(false, true, shown));
    EXPECT_TRUE(shown.armed);
    EXPECT_TRUE(latch.take(true, true, shown));
    EXPECT_TRUE(shown.latched);
    EXPECT_EQ(shown.count, 1);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(latch.arm(at_index, false), LatchWay::index) << "or its bit would fall before everybody has seen it";
        EXPECT_FALSE(latch.take(true, true, shown));
    }
    EXPECT_EQ(latch.arm(nothing, false), LatchWay::none);
    EXPECT_FALSE(latch.take(true, false, shown));
    EXPECT_FALSE(shown.latched);
    EXPECT_EQ(shown.count, 0);
}

TEST(CounterLatch, ContinuouslyItArmsItselfAnewAndCounts) {
    auto wanted = at_rising;
    wanted.continuous = true;
    CounterLatch latch;
    ProbeFeedback shown;
    (void)latch.arm(wanted, true);
    for (std::uint16_t n = 1; n <= 3; ++n) {
        EXPECT_TRUE(latch.take(true, true, shown));
        EXPECT_EQ(shown.count, n);
        EXPECT_EQ(latch.arm(wanted, false), LatchWay::none);
        EXPECT_FALSE(latch.take(false, false, shown));
        EXPECT_FALSE(shown.latched) << "or it would be taken for one of the new arming";
        EXPECT_EQ(latch.arm(wanted, true), LatchWay::rising);
    }
}

TEST(CounterLatch, AnotherWayIsAnotherArming) {
    CounterLatch latch;
    ProbeFeedback shown;
    (void)latch.arm(at_index, true);
    EXPECT_TRUE(latch.take(true, true, shown));
    EXPECT_EQ(latch.arm(at_rising, false), LatchWay::none);
    EXPECT_FALSE(latch.take(true, false, shown));
    EXPECT_FALSE(shown.latched);
    EXPECT_EQ(latch.arm(at_rising, true), LatchWay::rising);
}

TEST(CounterLatch, ATerminalThatWasAwayIsArmedAnew) {
    CounterLatch latch;
    (void)latch.arm(at_index, true);
    latch.forget();
    EXPECT_EQ(latch.arm(at_index, false), LatchWay::none);
    EXPECT_EQ(latch.arm(at_index, true), LatchWay::index);
}

}  // namespace
}  // namespace taktwerk::axes::encoder
