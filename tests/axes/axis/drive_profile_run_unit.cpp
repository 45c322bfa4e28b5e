// What an axis believes of a profile that its drive makes.

#include "axes/axis/drive_profile_run.hpp"

#include <gtest/gtest.h>

namespace taktwerk::axes::test {
namespace {

using namespace std::chrono_literals;

struct WatchedRun {
    WatchedRun() {
        run.enter(DriveMode::profile_velocity);
        run.hand({}, {}, now);
        said.fresh = true;
    }
    void hears(Duration later, bool accepted, bool reached, bool stands = true) {
        now += later;
        if (accepted) said.profile_accepted = run.announced().sequence;
        said.target_reached = reached;
        run.watch(said, stands, now);
    }
    Instant now{};
    DriveProfileRun run;
    DriveFeedback said;
};

// The word of the set-point before stands for some cycles of dead time; one that never falls is believed after 50 ms.
TEST(DriveProfileRun, TargetReachedCountsOnceItFellOrAfterAWhile) {
    WatchedRun never_falls;
    never_falls.hears(10ms, true, true);
    EXPECT_FALSE(never_falls.run.in_target());
    never_falls.hears(49ms, true, true);
    EXPECT_FALSE(never_falls.run.in_target());
    never_falls.hears(1ms, true, true);
    EXPECT_TRUE(never_falls.run.in_target());

    WatchedRun falls;
    falls.hears(10ms, true, true);
    falls.hears(3ms, true, false);
    EXPECT_FALSE(falls.run.in_target());
    falls.hears(3ms, true, true);
    EXPECT_TRUE(falls.run.in_target());
    falls.hears(1ms, true, false);
    EXPECT_FALSE(falls.run.in_target()) << "and it follows the drive";
}

TEST(DriveProfileRun, NothingCountsBeforeTheDriveHasTakenIt) {
    WatchedRun r;
    r.hears(100ms, false, false);
    r.hears(100ms, false, true);
    EXPECT_FALSE(r.run.in_target());
    EXPECT_FALSE(r.run.arrived(true, r.now));
}

// Inside the axis' own window the drive's word and standstill are enough; outside it must have fallen and last half a second.
TEST(DriveProfileRun, AMoveIsOverStandingAtItsTargetByTheDrivesWord) {
    WatchedRun r;
    r.hears(1ms, true, true, false);
    EXPECT_FALSE(r.run.arrived(true, r.now)) << "it moves";
    r.hears(1ms, true, true);
    EXPECT_TRUE(r.run.arrived(true, r.now));
    r.hears(600ms, true, true);
    EXPECT_FALSE(r.run.arrived(false, r.now)) << "never seen to fall: it may be an old one";
    r.hears(1ms, true, false);
    r.hears(1ms, true, true);
    r.hears(499ms, true, true);
    EXPECT_FALSE(r.run.arrived(false, r.now));
    r.hears(1ms, true, true);
    EXPECT_TRUE(r.run.arrived(false, r.now));
}

TEST(DriveProfileRun, ASetPointIsRefusedAfterTwoSeconds) {
    WatchedRun r;
    r.hears(1999ms, false, false);
    EXPECT_FALSE(r.run.refused(r.now));
    r.hears(1ms, false, false);
    EXPECT_TRUE(r.run.refused(r.now));
    WatchedRun taken;
    taken.hears(100ms, true, false);
    taken.hears(3s, true, false);
    EXPECT_FALSE(taken.run.refused(taken.now));
}

// Never one number twice, also over a change of mode: the port remembers the last one that was taken.
TEST(DriveProfileRun, EachSetPointHasANumberOfItsOwn) {
    WatchedRun r;
    const auto first = r.run.announced().sequence;
    r.hears(1ms, true, true);
    r.run.end();
    EXPECT_EQ(r.run.announced().sequence, 0u);
    r.run.enter(DriveMode::profile_position);
    r.run.hand({}, {}, r.now);
    EXPECT_NE(r.run.announced().sequence, first);
    r.hears(100ms, false, true);
    EXPECT_FALSE(r.run.accepted());
}

}  // namespace
}  // namespace taktwerk::axes::test
