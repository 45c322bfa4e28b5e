#include "ecat/dc/propagation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;

// master ==> [0:A:1] -- 100 ns -- [0:B:1] -- 250 ns -- [0:C]
// Each slave forwards in 0 ns here; the frame comes back to B.1 2*250 ns after it entered B.0, to A.1 2*(100+250) after A.0.
// A latches at its own 1000, B at its own 777000, C at its own 5.
std::vector<LatchedTimes> line_of_three() {
    return {
        {.port0 = 1000, .port1 = 1700, .port1_open = true, .unit = 1000},
        {.port0 = 777000, .port1 = 777500, .port1_open = true, .unit = 777000},
        {.port0 = 5, .port1 = 0, .port1_open = false, .unit = 5},
    };
}

TEST(LineDelays, AreHalfTheDifferenceOfTheRoundTrips) { EXPECT_THAT(line_delays(line_of_three()), ElementsAre(0, 100, 350)); }

// The same line; A's 32-bit clock wraps between the two latches: FFFFFE00h, and 700 ns later 000000BCh.
TEST(LineDelays, SurviveTheWrapOfTheLocalClock) {
    auto slaves = line_of_three();
    slaves[0].port0 = 0xFFFF'FE00u;
    slaves[0].port1 = 0x0000'00BCu;
    EXPECT_THAT(line_delays(slaves), ElementsAre(0, 100, 350));
}

TEST(LineDelays, NeverGoBackwardsByQuantisation) {
    // Zero cable, and B's quartz counted 10 ns more than A's over the same time.
    const std::vector<LatchedTimes> slaves{
        {.port0 = 0, .port1 = 500, .port1_open = true, .unit = 0},
        {.port0 = 0, .port1 = 510, .port1_open = true, .unit = 0},
        {.port0 = 0, .port1 = 0, .port1_open = false, .unit = 0},
    };
    EXPECT_THAT(line_delays(slaves), ElementsAre(0, 0, 255));
}

TEST(LineDelays, OfOneSlaveAndOfNone) {
    EXPECT_THAT(line_delays(std::vector<LatchedTimes>{{.port0 = 3, .port1 = 0, .port1_open = false, .unit = 3}}), ElementsAre(0));
    EXPECT_TRUE(line_delays({}).empty());
}

// The reference shall have had 10^9 when it latched at its local 1000. B saw the frame 100 ns later, at its 777000.
TEST(SystemOffsets, MakeEverySlaveShowTheReferenceTime) {
    const auto slaves = line_of_three();
    const auto delays = line_delays(slaves);
    const auto offsets = system_offsets(slaves, delays, 1'000'000'000);
    EXPECT_EQ(slaves[0].unit + offsets[0], 1'000'000'000u);
    EXPECT_EQ(slaves[1].unit + offsets[1], 1'000'000'100u);
    EXPECT_EQ(slaves[2].unit + offsets[2], 1'000'000'350u);
}

TEST(SystemOffsets, AreNegativeModulo2To64WhenTheSlaveRanLonger) {
    const std::vector<LatchedTimes> slaves{{.port0 = 0, .port1 = 0, .port1_open = false, .unit = 5'000}};
    const std::vector<std::uint32_t> delays{0};
    EXPECT_EQ(system_offsets(slaves, delays, 4'000)[0], static_cast<std::uint64_t>(-1'000));
}

// ceil((1.2345 s + 0.1 s)/1 ms) = 1335 ms, and half a cycle.
TEST(Sync0Start, LiesOnTheGridAfterTheMargin) {
    EXPECT_EQ(sync0_start(1'234'500'000, 100ms, 1ms, 0ns, 500us), 1'334'500'000u);
    EXPECT_EQ(sync0_start(1'234'500'001, 100ms, 1ms, 0ns, 500us), 1'335'500'000u);
    EXPECT_EQ(sync0_start(0, 100ms, 4ms, 0ns, 2ms), 102'000'000u);
}

// The master sends 300 us after each multiple of 1 ms; SYNC0 follows 500 us behind the sending.
TEST(Sync0Start, KeepsThePhaseOfTheMastersCycle) { EXPECT_EQ(sync0_start(10'000'000, 100ms, 1ms, 300us, 500us), 110'800'000u); }

TEST(Sync0Instants, NextAndLastAroundATime) {
    EXPECT_EQ(next_sync0(1'600, 500, 1'000), 2'500);
    EXPECT_EQ(next_sync0(1'500, 500, 1'000), 1'500);
    EXPECT_EQ(last_sync0(1'600, 500, 1'000), 1'500);
    EXPECT_EQ(last_sync0(1'499, 500, 1'000), 500);
    EXPECT_EQ(next_sync0(-10, 500, 1'000), 500) << "before the first SYNC0";
}

}  // namespace
}  // namespace taktwerk::ecat
