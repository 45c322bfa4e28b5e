// The other searches of PLCopen Part 5 on a rail: limit switch, block, reference pulse, distance-coded marks; and what bounds a step.

#include <gtest/gtest.h>

#include <vector>

#include "axes/homing/step_run.hpp"
#include "tests/axes/homing/rail.hpp"

namespace taktwerk::axes::test {
namespace {

using namespace std::chrono_literals;
using enum MC_SwitchMode;
using Kind = SearchMove::Kind;

// --- limit switch: on from -10000 down --------------------------------------------------------------------------------------

struct LimitCase {
    MC_SwitchMode mode;
    std::int64_t start, expected;
};
class LimitEdge : public ::testing::TestWithParam<LimitCase> {};
TEST_P(LimitEdge, IsTakenFromWhereverItStarts) {
    Rail rail{.position = GetParam().start};
    LimitSearch search(GetParam().mode, false);
    const auto end = rail.run(search);
    ASSERT_EQ(end.kind, Kind::found);
    EXPECT_EQ(end.place, GetParam().expected);
}
INSTANTIATE_TEST_SUITE_P(NegativeEnd, LimitEdge,
                         ::testing::Values(LimitCase{mcOn, 0, -9995}, LimitCase{mcOn, -10'200, -10'200}, LimitCase{mcOff, -10'200, -9995},
                                           LimitCase{mcOff, 0, 0}, LimitCase{mcRisingEdge, 0, -9995},
                                           LimitCase{mcRisingEdge, -10'200, -9995}, LimitCase{mcFallingEdge, 0, -9995},
                                           LimitCase{mcFallingEdge, -10'200, -9995}));

// The falling edge is on the way back, which is the slow one; the way there is not.
TEST(LimitSearch, FallingEdgeIsFineOnTheWayBackOnly) {
    Rail rail{.position = -9000};
    LimitSearch search(mcFallingEdge, false);
    auto move = search.step(rail.look());
    EXPECT_EQ(move.sense, -1);
    EXPECT_FALSE(move.fine);
    rail.position = -10'000;
    move = search.step(rail.look());
    EXPECT_EQ(move.sense, 1);
    EXPECT_TRUE(move.fine);
}

TEST(LimitSearch, PositiveEndIsTheOther) {
    Rail rail;
    LimitSearch search(mcOn, true);
    EXPECT_EQ(rail.run(search).place, 9995);
}

// A switch that never falls: the other end is reached.
TEST(LimitSearch, OtherEndReachedFails) {
    Rail rail{.position = -10'000, .negative_end = 20'000, .positive_end = 5'000};
    LimitSearch search(mcFallingEdge, false);
    EXPECT_EQ(rail.run(search).kind, Kind::failed);
}

// --- block ------------------------------------------------------------------------------------------------------------------

TEST(BlockSearch, NeedsTorqueAndStandstillForTheWholeTime) {
    BlockSearch search({.positive = true, .torque = 0.4, .velocity_limit = 1, .time = 10ms});
    SearchInput in{.position = 777, .velocity = 20, .torque = 0.1};
    EXPECT_EQ(search.step(in).sense, 1);
    in.torque = 0.5;  // accelerating: torque, but it moves
    for (int i = 0; i < 20; ++i, in.now += 1ms) EXPECT_EQ(search.step(in).kind, Kind::move);
    in.velocity = 0;
    for (int i = 0; i < 9; ++i, in.now += 1ms) EXPECT_EQ(search.step(in).kind, Kind::move);
    in.torque = -0.5;  // torque the other way is no block ahead: the time begins anew
    EXPECT_EQ(search.step(in).kind, Kind::move);
    in.torque = 0.5;
    in.now += 1ms;
    for (int i = 0; i < 10; ++i, in.now += 1ms) EXPECT_EQ(search.step(in).kind, Kind::move);
    const auto end = search.step(in);
    EXPECT_EQ(end.kind, Kind::found);
    EXPECT_EQ(end.place, 777);
}

// --- reference pulse --------------------------------------------------------------------------------------------------------

TEST(PulseSearch, TakesTheLatchOfTheDriveExactly) {
    PulseSearch search(false);
    SearchInput in{.position = -123};
    EXPECT_EQ(search.step(in).sense, -1);
    in.latched = true;
    in.latch = -119;
    EXPECT_EQ(search.step(in).place, -119);
}

TEST(PulseSearch, WithoutALatchThePlaceIsHalfWay) {
    Rail rail{.switch_from = 500, .switch_to = 520};
    PulseSearch search(true);
    const auto end = rail.run(search);
    ASSERT_EQ(end.kind, Kind::found);
    EXPECT_EQ(end.place, 495);
}

TEST(PulseSearch, LimitSwitchEndsIt) {
    Rail rail;
    PulseSearch search(true);
    EXPECT_EQ(rail.run(search).kind, Kind::failed);
}

// --- distance-coded marks ---------------------------------------------------------------------------------------------------

// A scale with 1000 signal periods between fixed marks and 4 counts per period: gaps of 501, 499, 502, 498, ... periods, as data sheets
// of such scales give them. Laid out mark by mark here, independent of the formula.
std::vector<std::int64_t> scale_of_marks() {
    std::vector<std::int64_t> marks{0};
    for (std::int64_t k = 0; k < 400; ++k) {
        marks.push_back(marks.back() + (501 + k) * 4);
        marks.push_back(marks.back() + (499 - k) * 4);
    }
    return marks;
}

TEST(CodedMarks, EveryTwoNeighboursTellWhereTheyAre) {
    const CodedMarks scale{.spacing = 4000, .step = 4};
    ASSERT_TRUE(scale.valid());
    const auto marks = scale_of_marks();
    constexpr std::int64_t power_on = 987'654;  // what the drive counts at the scale's zero
    for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
        EXPECT_EQ(scale.locate(marks[i] + power_on, marks[i + 1] + power_on), marks[i + 1]) << i;
        EXPECT_EQ(scale.locate(marks[i + 1] + power_on, marks[i] + power_on), marks[i]) << i;
        EXPECT_EQ(scale.locate(marks[i] + power_on, marks[i + 1] + power_on + 1), marks[i + 1]) << "a count of jitter";
    }
}

TEST(CodedMarks, GapsThatCannotBeAreRefused) {
    const CodedMarks scale{.spacing = 4000, .step = 4};
    EXPECT_FALSE(scale.locate(0, 2000));  // half the spacing: no gap is
    EXPECT_FALSE(scale.locate(0, 2002));  // between two gaps
    EXPECT_FALSE(scale.locate(0, 4004));  // a mark was missed
    EXPECT_FALSE(scale.locate(0, 4000));
    EXPECT_FALSE((CodedMarks{.spacing = 4000, .step = 3}.valid()));
    EXPECT_FALSE(CodedMarks{}.valid());
}

TEST(CodedSearch, RunsOverTwoMarks) {
    CodedSearch search({.spacing = 4000, .step = 4}, true);
    SearchInput in;
    EXPECT_EQ(search.step(in).kind, Kind::move);
    in.latched = true;
    in.latch = 100'000;
    EXPECT_EQ(search.step(in).kind, Kind::move);
    in.latch = 100'000 + 502 * 4;  // from fixed mark 1 to its neighbour: 1000 + 502 periods from zero
    const auto end = search.step(in);
    ASSERT_EQ(end.kind, Kind::found);
    EXPECT_EQ(end.place, 102'008);
    EXPECT_EQ(end.absolute, 1502 * 4);
}

// --- what bounds a step -----------------------------------------------------------------------------------------------------

struct Bounded {
    StepRun run;
    SearchInput in;
    explicit Bounded(StepSettings settings) {
        settings.velocity = 20;
        run.start(settings, Instant{}, 0);
    }
    void step(Duration later = 1ms) {
        in.now += later;
        run.step(in, true, run.demand() != StepRun::Demand::velocity);
    }
};

TEST(StepRun, TimeWayAndTorqueAreLimitedAndItStandsAfterwards) {
    Bounded time({.search = PulseSearch(true), .time_limit = 2s});
    time.step();
    EXPECT_EQ(time.run.velocity(), 20);
    time.step(2s);
    EXPECT_EQ(time.run.demand(), StepRun::Demand::stop);
    EXPECT_TRUE(time.run.busy());
    time.step();
    EXPECT_EQ(time.run.result(), StepRun::End::time_limit);

    Bounded way({.search = PulseSearch(false), .distance_limit = 500});
    way.in.position = -499;
    way.step();
    EXPECT_EQ(way.run.velocity(), -20);
    way.in.position = -500;
    way.step();
    way.step();
    EXPECT_EQ(way.run.result(), StepRun::End::distance_limit);

    Bounded torque({.search = PulseSearch(true), .torque_limit = 0.3});
    torque.in.torque = -0.29;
    torque.step();
    EXPECT_EQ(torque.run.velocity(), 20);
    torque.in.torque = -0.3;
    torque.step();
    torque.step();
    EXPECT_EQ(torque.run.result(), StepRun::End::torque_limit);
}

TEST(StepRun, AfterABlockItGoesBackToWhereTheAxisIs) {
    Bounded block({.search = BlockSearch({.positive = true, .torque = 0.4, .velocity_limit = 1, .time = 0ms})});
    block.step();
    EXPECT_TRUE(block.run.presses());
    block.in.torque = 0.4;
    block.in.position = 4321;
    block.step();
    EXPECT_EQ(block.run.demand(), StepRun::Demand::stop);
    block.step();
    EXPECT_EQ(block.run.demand(), StepRun::Demand::place);
    EXPECT_EQ(block.run.place(), 4321);
    block.step();
    EXPECT_EQ(block.run.result(), StepRun::End::found);
    EXPECT_FALSE(block.run.presses());
}

TEST(StepRun, WithoutFreshFeedbackOnlyTimeGoesOn) {
    StepRun run;
    run.start({.search = SwitchSearch(mcOn, MC_HomeDirection::mcPositiveDirection), .velocity = 5, .time_limit = 1s}, Instant{}, 0);
    SearchInput in{.signal = true};
    run.step(in, false, true);
    EXPECT_TRUE(run.busy());
    in.now += 1s;
    run.step(in, false, true);
    run.step(in, false, true);
    EXPECT_EQ(run.result(), StepRun::End::time_limit);
}

}  // namespace
}  // namespace taktwerk::axes::test
