// MC_StepAbsoluteSwitch's search on a rail: which of the switch's two edges each mode takes, from wherever it starts. PLCopen Part 5.
// The switch is on from 1000 to 1500; an edge is seen between two samples of 10 counts: the place is right within 5.

#include "axes/homing/switch_search.hpp"

#include <gtest/gtest.h>

#include "tests/axes/homing/rail.hpp"

namespace taktwerk::axes::test {
namespace {

using enum MC_SwitchMode;
using enum MC_HomeDirection;
using Kind = SearchMove::Kind;

constexpr std::int64_t lower = 995, upper = 1505;  // half way between the last sample off and the first one on

struct Case {
    MC_SwitchMode mode;
    MC_HomeDirection direction;
    std::int64_t start, expected;
};

class EdgeTaken : public ::testing::TestWithParam<Case> {};
TEST_P(EdgeTaken, IsTheOneTheModeNames) {
    const auto c = GetParam();
    Rail rail{.position = c.start, .switch_from = 1000, .switch_to = 1500};
    SwitchSearch search(c.mode, c.direction);
    const auto end = rail.run(search);
    ASSERT_EQ(end.kind, Kind::found);
    EXPECT_EQ(end.place, c.expected);
}
// Rising and falling edge are those in the direction of the search, also from behind the switch (over the limit switch) and from on it.
INSTANTIATE_TEST_SUITE_P(
    InTheDirectionOfTheSearch, EdgeTaken,
    ::testing::Values(Case{mcRisingEdge, mcPositiveDirection, 0, lower}, Case{mcRisingEdge, mcPositiveDirection, 1200, lower},
                      Case{mcRisingEdge, mcPositiveDirection, 5000, lower}, Case{mcRisingEdge, mcNegativeDirection, 5000, upper},
                      Case{mcRisingEdge, mcNegativeDirection, 1200, upper}, Case{mcRisingEdge, mcNegativeDirection, 0, upper},
                      Case{mcFallingEdge, mcPositiveDirection, 0, upper}, Case{mcFallingEdge, mcPositiveDirection, 1200, upper},
                      Case{mcFallingEdge, mcPositiveDirection, 5000, upper}, Case{mcFallingEdge, mcNegativeDirection, 5000, lower},
                      Case{mcFallingEdge, mcNegativeDirection, 1200, lower}, Case{mcFallingEdge, mcNegativeDirection, 0, lower}));
// mcEdgeSwitchPositive: rising in positive, falling in negative direction: always the negative end. mcEdgeSwitchNegative: the positive end.
INSTANTIATE_TEST_SUITE_P(AtOneEndOfTheSwitch, EdgeTaken,
                         ::testing::Values(Case{mcEdgeSwitchPositive, mcPositiveDirection, 0, lower},
                                           Case{mcEdgeSwitchPositive, mcNegativeDirection, 5000, lower},
                                           Case{mcEdgeSwitchPositive, mcPositiveDirection, 1200, lower},
                                           Case{mcEdgeSwitchPositive, mcPositiveDirection, 5000, lower},
                                           Case{mcEdgeSwitchPositive, mcNegativeDirection, 0, lower},
                                           Case{mcEdgeSwitchNegative, mcPositiveDirection, 0, upper},
                                           Case{mcEdgeSwitchNegative, mcNegativeDirection, 5000, upper},
                                           Case{mcEdgeSwitchNegative, mcNegativeDirection, 1200, upper},
                                           Case{mcEdgeSwitchNegative, mcPositiveDirection, 5000, upper}));
// mcSwitchPositive: off, it begins in positive direction; on, in negative. So it always stays near the switch's negative end.
INSTANTIATE_TEST_SUITE_P(
    DirectionByTheSwitch, EdgeTaken,
    ::testing::Values(Case{mcOff, mcSwitchPositive, 1200, lower}, Case{mcOff, mcSwitchNegative, 1200, upper},
                      Case{mcOn, mcSwitchPositive, 0, lower}, Case{mcOn, mcSwitchNegative, 5000, upper},
                      Case{mcRisingEdge, mcSwitchPositive, 0, lower}, Case{mcRisingEdge, mcSwitchPositive, 1200, lower},
                      Case{mcRisingEdge, mcSwitchNegative, 5000, upper}, Case{mcFallingEdge, mcSwitchPositive, 1200, upper},
                      Case{mcFallingEdge, mcSwitchNegative, 1200, lower}, Case{mcEdgeSwitchPositive, mcSwitchPositive, 1200, lower}));
// By level the way is plain, and a limit switch turns it once.
INSTANTIATE_TEST_SUITE_P(ByLevel, EdgeTaken,
                         ::testing::Values(Case{mcOn, mcPositiveDirection, 0, lower}, Case{mcOn, mcPositiveDirection, 5000, upper},
                                           Case{mcOff, mcPositiveDirection, 1200, upper}, Case{mcOff, mcNegativeDirection, 1200, lower}));

TEST(SwitchSearch, ByLevelItIsOverAtOnceWhereTheLevelIs) {
    Rail rail{.position = 1200, .switch_from = 1000, .switch_to = 1500};
    SwitchSearch search(mcOn, mcSwitchPositive);
    const auto end = search.step(rail.look());
    EXPECT_EQ(end.kind, Kind::found);
    EXPECT_EQ(end.place, 1200);
}

TEST(SwitchSearch, StartedOnTheSwitchItLeavesItFirst) {
    Rail rail{.position = 1200, .switch_from = 1000, .switch_to = 1500};
    SwitchSearch search(mcRisingEdge, mcPositiveDirection);
    EXPECT_EQ(search.step(rail.look()).sense, -1);
    rail.position = 900;
    EXPECT_EQ(search.step(rail.look()).sense, 1);
}

TEST(SwitchSearch, BothLimitSwitchesAndNoSwitchFail) {
    for (const auto mode : {mcOn, mcRisingEdge, mcFallingEdge, mcEdgeSwitchPositive}) {
        Rail rail;
        SwitchSearch search(mode, mcNegativeDirection);
        EXPECT_EQ(rail.run(search).kind, Kind::failed);
        EXPECT_GE(rail.position, rail.positive_end);  // it has looked everywhere
    }
}

// The limit switch turned the search; the axis still rolls on over an edge: that edge was passed the other way.
TEST(SwitchSearch, EdgesSeenWhileTurningDoNotCount) {
    Rail rail{.position = 0, .switch_from = 50, .switch_to = 100, .positive_end = 40};
    SwitchSearch search(mcEdgeSwitchNegative, mcPositiveDirection);
    (void)search.step(rail.look());
    rail.in.set_velocity = 1;
    rail.position = 40;
    EXPECT_EQ(search.step(rail.look()).sense, -1);
    rail.position = 60;
    EXPECT_EQ(search.step(rail.look()).kind, Kind::move);  // would be the rising edge in negative direction
    rail.in.set_velocity = -1;
    EXPECT_EQ(search.step(rail.look()).kind, Kind::move);
}

}  // namespace
}  // namespace taktwerk::axes::test
