// CTU, CTD, CTUD: IEC 61131-3 ed. 3, 6.6.3.5.4 (table 45). Priority R, then LD, then counting.
#include "fb_library/iec/counters.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace taktwerk::fb {
namespace {

/// One rising and one falling edge of a count input.
template <class Block>
void pulse(Block& block, bool Block::*input, int times = 1) {
    for (int i = 0; i < times; ++i) {
        block.*input = true;
        block(CycleContext{});
        block.*input = false;
        block(CycleContext{});
    }
}

TEST(Ctu, CountsRisingEdgesOnly) {
    CTU c{.PV = 2};
    c.CU = true;
    c(CycleContext{});
    EXPECT_EQ(c.CV, 1) << "first call with CU TRUE is an edge";
    c(CycleContext{});
    EXPECT_EQ(c.CV, 1);
    c.CU = false;
    c(CycleContext{});
    EXPECT_EQ(c.CV, 1);
    EXPECT_FALSE(c.Q);
    pulse(c, &CTU::CU);
    EXPECT_EQ(c.CV, 2);
    EXPECT_TRUE(c.Q);
}

TEST(Ctu, CountsBeyondThePresetSoThatAnOvershootShows) {
    CTU c{.PV = 2};
    pulse(c, &CTU::CU, 5);
    EXPECT_EQ(c.CV, 5);
    EXPECT_TRUE(c.Q);
}

TEST(Ctd, CountsRisingEdgesOnly) {
    CTD c{.PV = 3};
    c.LD = true;
    c(CycleContext{});
    c.LD = false;
    c.CD = true;
    c(CycleContext{});
    EXPECT_EQ(c.CV, 2) << "on the rising edge";
    c.CD = false;
    c(CycleContext{});
    EXPECT_EQ(c.CV, 2) << "not on the falling one";
}

TEST(Ctd, GoesBelowZero) {
    CTD c{.PV = 0};
    pulse(c, &CTD::CD, 3);
    EXPECT_EQ(c.CV, -3);
    EXPECT_TRUE(c.Q);
}

TEST(Counters, StopAtTheLimitsOfTheirType) {
    CTU up{.PV = 1, .CV = 32766};
    pulse(up, &CTU::CU, 3);
    EXPECT_EQ(up.CV, 32767);

    CTD down{.CV = -32767};
    pulse(down, &CTD::CD, 3);
    EXPECT_EQ(down.CV, -32768);

    CTUD both{.CV = 32767};
    pulse(both, &CTUD::CU);
    EXPECT_EQ(both.CV, 32767);
    both.CV = -32768;
    pulse(both, &CTUD::CD);
    EXPECT_EQ(both.CV, -32768);

    CTU_LINT wide{.CV = std::numeric_limits<std::int64_t>::max()};
    pulse(wide, &CTU_LINT::CU);
    EXPECT_EQ(wide.CV, std::numeric_limits<std::int64_t>::max());

    CTD_UDINT without_sign{.CV = 1};
    pulse(without_sign, &CTD_UDINT::CD, 2);
    EXPECT_EQ(without_sign.CV, 0u);
    EXPECT_TRUE(without_sign.Q);
}

TEST(Counters, AnEdgeDuringResetOrLoadIsLostNotLate) {
    CTU up{.CU = true, .R = true, .PV = 5};
    up(CycleContext{});
    up.R = false;
    up(CycleContext{});
    EXPECT_EQ(up.CV, 0);

    CTD down{.CD = true, .LD = true, .PV = 5};
    down(CycleContext{});
    down.LD = false;
    down(CycleContext{});
    EXPECT_EQ(down.CV, 5);

    CTUD both{.CU = true, .R = true, .PV = 5};
    both(CycleContext{});
    both.R = false;
    both(CycleContext{});
    EXPECT_EQ(both.CV, 0);
}

// All coincidences in one call, from CV = 4, PV = 7.
struct Coincidence {
    bool cu, cd, r, ld;
    int cv;
};
constexpr Coincidence coincidences[] = {
    {false, false, false, false, 4}, {true, false, false, false, 5}, {false, true, false, false, 3}, {true, true, false, false, 4},
    {false, false, true, false, 0},  {true, false, true, false, 0},  {false, true, true, false, 0},  {true, true, true, false, 0},
    {false, false, false, true, 7},  {true, false, false, true, 7},  {false, true, false, true, 7},  {true, true, false, true, 7},
    {false, false, true, true, 0},   {true, false, true, true, 0},   {false, true, true, true, 0},   {true, true, true, true, 0},
};

TEST(Ctud, ResetBeforeLoadBeforeCountingAndBothEdgesCountNothing) {
    for (const auto& row : coincidences) {
        CTUD c{.CU = row.cu, .CD = row.cd, .R = row.r, .LD = row.ld, .PV = 7, .CV = 4};
        c(CycleContext{});
        EXPECT_EQ(c.CV, row.cv) << row.cu << row.cd << row.r << row.ld;
        EXPECT_EQ(c.QU, row.cv >= 7);
        EXPECT_EQ(c.QD, row.cv <= 0);
    }
}

TEST(Ctu, ResetBeforeCounting) {
    for (const bool cu : {false, true}) {
        CTU c{.CU = cu, .R = true, .PV = 7, .CV = 4};
        c(CycleContext{});
        EXPECT_EQ(c.CV, 0);
    }
}

TEST(Ctd, LoadBeforeCounting) {
    for (const bool cd : {false, true}) {
        CTD c{.CD = cd, .LD = true, .PV = 7, .CV = 4};
        c(CycleContext{});
        EXPECT_EQ(c.CV, 7);
    }
}

// Up then down would give CV = max - 1 here: the trap of applying the edges one after the other at a limit.
TEST(Ctud, BothEdgesAtTheLimitCountNothing) {
    CTUD c{.CU = true, .CD = true, .CV = 32767};
    c(CycleContext{});
    EXPECT_EQ(c.CV, 32767);
}

TEST(Counters, PresetIsLive) {
    CTU c{.PV = 10, .CV = 3};
    c(CycleContext{});
    EXPECT_FALSE(c.Q);
    c.PV = 3;
    c(CycleContext{});
    EXPECT_TRUE(c.Q);
}

}  // namespace
}  // namespace taktwerk::fb
