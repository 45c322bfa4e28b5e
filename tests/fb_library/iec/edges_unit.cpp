// R_TRIG, F_TRIG, SR, RS against their equations in IEC 61131-3 ed. 3, 6.6.3.5.2 and 6.6.3.5.3.
#include <gtest/gtest.h>

#include <string>

#include "fb_library/iec/bistables.hpp"
#include "fb_library/iec/edges.hpp"

namespace taktwerk::fb {
namespace {

template <class Trigger>
std::string run(Trigger& trigger, const std::string& clk) {
    std::string q;
    for (const char c : clk) {
        trigger.CLK = c == '#';
        trigger(CycleContext{});
        q += trigger.Q ? '#' : '.';
    }
    return q;
}

TEST(RTrig, GivesOnePulsePerRisingEdge) {
    R_TRIG trigger;
    EXPECT_EQ(run(trigger, "..###.#.##"), "..#...#.#.");
}

TEST(FTrig, GivesOnePulsePerFallingEdge) {
    F_TRIG trigger;
    EXPECT_EQ(run(trigger, "###..##.#."), "...#...#.#");
}

// By the equations, M being FALSE at first: both give a pulse in the first scan of a cold start.
TEST(Triggers, FirstScanOfAColdStartFollowsTheEquations) {
    R_TRIG rising;
    EXPECT_EQ(run(rising, "##"), "#.");
    F_TRIG falling;
    EXPECT_EQ(run(falling, ".."), "#.");
}

TEST(Triggers, FirstScanOfAWarmStartComparesWithTheRetainedLevel) {
    R_TRIG rising;
    run(rising, ".##");
    R_TRIG retained_rising = rising;
    EXPECT_EQ(run(retained_rising, "#"), ".");

    F_TRIG falling;
    run(falling, "#..");
    F_TRIG retained_falling = falling;
    EXPECT_EQ(run(retained_falling, "."), ".");
}

// Columns: set, reset, state before, state after; the whole truth table.
struct Row {
    bool set, reset, before, sr, rs;
};
constexpr Row rows[] = {
    {false, false, false, false, false}, {false, false, true, true, true}, {false, true, false, false, false},
    {false, true, true, false, false},   {true, false, false, true, true}, {true, false, true, true, true},
    {true, true, false, true, false},    {true, true, true, true, false},
};

TEST(Bistables, FollowTheirTruthTables) {
    for (const Row& row : rows) {
        SR sr{.S1 = row.set, .R = row.reset, .Q1 = row.before};
        sr(CycleContext{});
        EXPECT_EQ(sr.Q1, row.sr) << "SR " << row.set << row.reset << row.before;
        RS rs{.S = row.set, .R1 = row.reset, .Q1 = row.before};
        rs(CycleContext{});
        EXPECT_EQ(rs.Q1, row.rs) << "RS " << row.set << row.reset << row.before;
    }
}

}  // namespace
}  // namespace taktwerk::fb
