#include "ecat/dc/propagation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <initializer_list>

#include "ecat/wire/registers.hpp"

namespace taktwerk::ecat {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

// In all drawings a frame needs 340 ns through a processing unit and 300 ns past one; the wires are given. Every stamp is what
// the drawing adds up to, on clocks that started anywhere.

/// A tree from the open ports of its slaves.
Topology tree(std::initializer_list<std::initializer_list<unsigned>> open_ports) {
    std::vector<std::uint16_t> dl_status;
    for (const auto& ports : open_ports) {
        unsigned status = 0x5500;  // all loops closed
        for (const unsigned p : ports) status = (status & ~(1u << (8 + 2 * p))) | (1u << (9 + 2 * p)) | (1u << (4 + p));
        dl_status.push_back(static_cast<std::uint16_t>(status));
    }
    return build_topology(dl_status).value();
}

LatchedTimes clock(std::array<std::uint32_t, 4> ports) { return {.dc = true, .port = ports, .unit = ports[0]}; }
LatchedTimes no_clock() { return {}; }

// master == 0[A]1 -- 60 ns -- 0[B]1 -- 160 ns -- 0[C]
//
// At B after 340 + 60 = 400, at C after 400 + 340 + 160 = 900; turned around in C: back at B.1 at 900 + 340 + 160 = 1400, at A.1
// at 1400 + 300 + 60 = 1760. A's clock shows 1000 when the frame comes, B's 777000, C's 5.
std::vector<LatchedTimes> line_of_three() { return {clock({1000, 2760}), clock({777000, 778000}), clock({5})}; }

TEST(PropagationDelays, AlongALine) {
    const auto delays = propagation_delays(tree({{0, 1}, {0, 1}, {0}}), line_of_three());

    EXPECT_THAT(delays.ns, ElementsAre(0, 400, 900));
    EXPECT_THAT(delays.estimated, IsEmpty());
}

// The same; A's 32-bit clock wraps on the way: FFFFFE00h, and 1760 ns later 000004E0h.
TEST(PropagationDelays, SurviveTheWrapOfAClock) {
    auto slaves = line_of_three();
    slaves[0].port = {0xFFFF'FE00u, 0x0000'04E0u};
    EXPECT_THAT(propagation_delays(tree({{0, 1}, {0, 1}, {0}}), slaves).ns, ElementsAre(0, 400, 900));
}

// What closed ports have latched earlier means nothing.
TEST(PropagationDelays, IgnoreClosedPorts) {
    auto slaves = line_of_three();
    slaves[1].port = {777000, 778000, 123, 778900};
    EXPECT_THAT(propagation_delays(tree({{0, 1}, {0, 1}, {0}}), slaves).ns, ElementsAre(0, 400, 900));
}

// The cable from A is in B's port 1, its way on is port 3: the stamps tell, whatever the topology took for the entry.
TEST(PropagationDelays, DoNotMindTheSocketThatIsTheEntry) {
    auto slaves = line_of_three();
    slaves[1].port = {0, 777000, 0, 778000};
    slaves[2].port = {0, 0, 5, 0};
    EXPECT_THAT(propagation_delays(tree({{0, 1}, {1, 3}, {2}}), slaves).ns, ElementsAre(0, 400, 900));
}

//                  3 -- 60 ns -- 0[B]
// master == 0[A]
//                  1 -- 160 ns -- 0[C]
//
// At B after 400, back at A.3 at 400 + 340 + 60 = 800; past the unit to C: 800 + 300 + 160 = 1260, back at A.1 at 1760.
TEST(PropagationDelays, CountTheBranchesBefore) {
    const std::vector slaves{clock({50, 50 + 1760, 0, 50 + 800}), clock({7}), clock({9})};
    EXPECT_THAT(propagation_delays(tree({{0, 1, 3}, {0}, {0}}), slaves).ns, ElementsAre(0, 400, 1260));
}

// master == 0[A]1 -- 0[B]   3 -- 0[C]1 -- 0[D]      all wires 100 ns
//                           1 -- 0[E]
//
// B 440, C 880, D 1320; back at C.1 1760, at B.3 2160; E 2560; back at B.1 3000, at A.1 3400.
TEST(PropagationDelays, InNestedBranches) {
    const std::vector slaves{clock({0, 3400}), clock({440, 3000, 0, 2160}), clock({880, 1760}), clock({1320}), clock({2560})};
    EXPECT_THAT(propagation_delays(tree({{0, 1}, {0, 1, 3}, {0, 1}, {0}, {0}}), slaves).ns, ElementsAre(0, 440, 880, 1320, 2560));
}

// All four ports of B: C behind 3, D behind 1, E behind 2; wires of 100 ns.
// B 440; C 880, back 1320; D 1320 + 400 = 1720, back 2160; E 2560, back 3000; at A.1 3400.
TEST(PropagationDelays, OfAStar) {
    const std::vector slaves{clock({0, 3400}), clock({440, 2160, 3000, 1320}), clock({0}), clock({0}), clock({0})};
    EXPECT_THAT(propagation_delays(tree({{0, 1}, {0, 1, 2, 3}, {0}, {0}, {0}}), slaves).ns, ElementsAre(0, 440, 880, 1720, 2560));
}

// master == 0[A]1 -- 0[n]1 -- 0[C]       n has no clock; wires of 100 ns
//
// n 440, C 880, back at n 1320, at A.1 1720.
TEST(PropagationDelays, ASlaveWithoutClockIsCable) {
    const std::vector slaves{clock({0, 1720}), no_clock(), clock({3})};
    EXPECT_THAT(propagation_delays(tree({{0, 1}, {0, 1}, {0}}), slaves).ns, ElementsAre(0, 0, 880));
}

// master == 0[A]1 -- 0[n]   3 -- 0[C]      wires of 100 ns
//                           1 -- 0[D]
//
// n 440, C 880, back at n 1320, D 1720, back at n 2160, at A.1 2560.
TEST(PropagationDelays, BranchesThatPartAtASlaveWithoutClock) {
    const std::vector slaves{clock({0, 2560}), no_clock(), clock({3}), clock({8})};
    EXPECT_THAT(propagation_delays(tree({{0, 1}, {0, 1, 3}, {0}, {0}}), slaves).ns, ElementsAre(0, 0, 880, 1720));
}

// Terminals before the first clock and at the ends change nothing.
// master == 0[n]1 -- 0[A]1 -- 0[m]      wires of 100 ns; back at A.1 880 after A.0
TEST(PropagationDelays, TheReferenceIsTheFirstSlaveWithAClock) {
    const std::vector slaves{no_clock(), clock({0, 880}), no_clock()};
    const auto delays = propagation_delays(tree({{0, 1}, {0, 1}, {0}}), slaves);
    EXPECT_THAT(delays.ns, ElementsAre(0, 0, 0));
    EXPECT_THAT(delays.estimated, IsEmpty());
}

//                  3 -- 0[A]
// master == 0[n]                no clock sees both ways: out of A and into B are taken for 600 and 560 ns
//                  1 -- 0[B]
TEST(PropagationDelays, BeyondTheReferencesBranchAreEstimatedAndSaidToBe) {
    const std::vector slaves{no_clock(), clock({5}), clock({6})};
    const auto delays = propagation_delays(tree({{0, 1, 3}, {0}, {0}}), slaves);
    EXPECT_THAT(delays.ns, ElementsAre(0, 0, 1160));
    EXPECT_THAT(delays.estimated, ElementsAre(2));
}

// Zero cable, and B's quartz counted more than A's over the same time: a hop is never negative.
TEST(PropagationDelays, NeverGoBackwardsByQuantisation) {
    const std::vector slaves{clock({0, 500}), clock({0, 510}), clock({0})};
    const auto delays = propagation_delays(tree({{0, 1}, {0, 1}, {0}}), slaves);
    EXPECT_THAT(delays.ns, ElementsAre(0, 40, 295));
}

TEST(PropagationDelays, OfOneSlaveOfNoneAndOfNoClock) {
    EXPECT_THAT(propagation_delays(tree({{0}}), std::vector{clock({3})}).ns, ElementsAre(0));
    EXPECT_THAT(propagation_delays({}, {}).ns, IsEmpty());
    EXPECT_THAT(propagation_delays(tree({{0, 1}, {0}}), std::vector{no_clock(), no_clock()}).ns, ElementsAre(0, 0));
}

// The reference shall have had 10^9 when it latched at its local 1000. B saw the frame 400 ns later, at its 777000.
TEST(SystemOffset, MakesEverySlaveShowTheReferenceTime) {
    EXPECT_EQ(1000 + system_offset(1000, 0, 1'000'000'000), 1'000'000'000u);
    EXPECT_EQ(777'000 + system_offset(777'000, 400, 1'000'000'000), 1'000'000'400u);
}

TEST(SystemOffset, IsNegativeModulo2To64WhenTheSlaveRanLonger) {
    EXPECT_EQ(system_offset(5'000, 0, 4'000), static_cast<std::uint64_t>(-1'000));
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

// What the cycle keeps of a slave's SYNC0 answers like the arithmetic, whatever is asked in whichever order: the next cycle, the same
// instant again, a jump ahead over missed cycles, back, another start after a recovery.
TEST(Sync0, FollowedFromCycleToCycleIsTheSameGrid) {
    Sync0Pulse pulse;
    constexpr std::int64_t cycle = 1'000;
    for (const std::int64_t start : {500, 777})
        for (const std::int64_t t : {-10, 499, 500, 501, 1'499, 1'500, 1'501, 2'400, 2'600, 2'601, 9'000, 10'001, 3'000, 3'000, 1}) {
            EXPECT_EQ(pulse.next(t, start, cycle), next_sync0(t, start, cycle)) << t << " from " << start;
            EXPECT_EQ(pulse.last(t, start, cycle), last_sync0(t, start, cycle)) << t << " from " << start;
        }
}

}  // namespace
}  // namespace taktwerk::ecat
