// The sequence alone: which velocity it asks for at which switch. The ramps between are the axis' and are tested there.

#include "axes/homing/switch_homing.hpp"

#include <gtest/gtest.h>

namespace taktwerk::axes {
namespace {

using namespace std::chrono_literals;

struct Search {
    SwitchHoming homing;
    SwitchHomingInput in{.fresh = true, .standing = true};

    Search() { homing.start({.search_velocity = 20, .latch_velocity = 2, .negative = true, .timeout = 10s}, Instant{}); }
    double step(Duration later = 1ms) {
        in.now += later;
        in.standing = homing.velocity() == 0;  // an axis without ramps
        homing.step(in);
        return homing.velocity();
    }
};

TEST(SwitchHoming, SearchesStopsBacksOffAndTakesTheEdge) {
    Search s;
    EXPECT_EQ(s.step(), -20);
    s.in.home_switch = true;
    EXPECT_EQ(s.step(), 0);  // first stand
    EXPECT_EQ(s.step(), 2);  // then back off, slowly
    EXPECT_EQ(s.step(), 2);
    s.in.home_switch = false;
    s.in.position = 4711;
    EXPECT_EQ(s.step(), 0);
    s.in.position = 9999;  // it stops a little later; the edge counts
    s.step();

    EXPECT_EQ(s.homing.phase(), SwitchHoming::Phase::finished);
    EXPECT_EQ(s.homing.reference(), 4711);
    EXPECT_FALSE(s.homing.busy());
}

TEST(SwitchHoming, StartedOnTheSwitchItLeavesFirst) {
    Search s;
    s.in.home_switch = true;
    EXPECT_EQ(s.step(), 20);
    s.in.home_switch = false;
    EXPECT_EQ(s.step(), 0);
    EXPECT_EQ(s.step(), -20);
}

TEST(SwitchHoming, OverrunSwitchMustComeOnAgainBeforeItsEdgeCounts) {
    Search s;
    s.step();
    s.in.home_switch = true;
    s.step();
    s.in.home_switch = false;  // passed while stopping
    EXPECT_EQ(s.step(), 2);
    EXPECT_EQ(s.step(), 2);
    s.in.home_switch = true;
    EXPECT_EQ(s.step(), 2);
    s.in.home_switch = false;
    s.in.position = -5;
    EXPECT_EQ(s.step(), 0);
    EXPECT_EQ(s.homing.reference(), -5);
}

TEST(SwitchHoming, LimitReversesOnceThenFails) {
    Search s;
    s.step();
    s.in.negative_limit = true;
    EXPECT_EQ(s.step(), 0);
    EXPECT_EQ(s.step(), 20);  // over the whole switch
    s.in.negative_limit = false;
    s.in.home_switch = true;
    EXPECT_EQ(s.step(), 20);
    s.in.home_switch = false;
    EXPECT_EQ(s.step(), 0);
    EXPECT_EQ(s.step(), -20);
    s.in.negative_limit = true;
    EXPECT_EQ(s.step(), 0);
    s.step();
    EXPECT_EQ(s.homing.phase(), SwitchHoming::Phase::failed);
    EXPECT_EQ(s.homing.failed_in(), SwitchHoming::Phase::search);
}

TEST(SwitchHoming, OldInputsDecideNothing) {
    Search s;
    s.step();
    s.in.fresh = false;
    s.in.home_switch = true;
    EXPECT_EQ(s.step(), -20);
}

TEST(SwitchHoming, TimeIsLimitedAndItStillStands) {
    Search s;
    s.step();
    EXPECT_EQ(s.step(10s), 0);
    s.step();
    EXPECT_EQ(s.homing.phase(), SwitchHoming::Phase::timed_out);
}

}  // namespace
}  // namespace taktwerk::axes
