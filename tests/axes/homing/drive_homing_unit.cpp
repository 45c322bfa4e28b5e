// The sequence of modes and levels for a drive that homes by itself (CiA 402, mode 6).

#include "axes/homing/drive_homing.hpp"

#include <gtest/gtest.h>

namespace taktwerk::axes {
namespace {

using namespace std::chrono_literals;
using Phase = DriveHoming::Phase;
using Result = DriveHoming::Result;

struct Sequence {
    DriveHoming homing;
    DriveFeedback drive;
    Instant now{};

    explicit Sequence(Duration delay = 0ms) {
        drive.fresh = drive.online = true;
        drive.mode = DriveMode::cyclic_position;
        homing.start(now, 5s, delay);
    }
    Result step(Duration later = 1ms, bool stands = true) {
        now += later;
        return homing.step(drive, stands, now);
    }
};

TEST(DriveHoming, StartsOnlyInTheConfirmedModeAndAfterItsDwell) {
    Sequence s(10ms);
    s.step();
    EXPECT_EQ(s.homing.mode(), DriveMode::homing);
    EXPECT_FALSE(s.homing.start_level());
    s.drive.mode = DriveMode::homing;
    for (int i = 0; i < 9; ++i) s.step();
    EXPECT_FALSE(s.homing.start_level());
    s.step();
    EXPECT_TRUE(s.homing.start_level());
}

// "Attained" left over from an earlier homing is not believed.
TEST(DriveHoming, WaitsForAFreshAttained) {
    Sequence s;
    s.drive.mode = DriveMode::homing;
    s.drive.homing_attained = true;
    s.step();
    ASSERT_TRUE(s.homing.start_level());
    s.step();
    EXPECT_TRUE(s.homing.start_level());
    s.drive.homing_attained = false;
    s.step();
    s.drive.homing_attained = true;
    EXPECT_EQ(s.step(), Result::none);
    EXPECT_EQ(s.homing.mode(), DriveMode::cyclic_position);
    EXPECT_EQ(s.step(), Result::none);  // not confirmed
    s.drive.mode = DriveMode::cyclic_position;
    s.step();
    EXPECT_EQ(s.step(), Result::attained);
    EXPECT_FALSE(s.homing.busy());
}

// Methods that are over at once (35, 37) never show it FALSE: after 50 ms it is believed.
TEST(DriveHoming, BelievesALastingAttained) {
    Sequence s;
    s.drive.mode = DriveMode::homing;
    s.drive.homing_attained = true;
    s.step();
    s.step(49ms);
    EXPECT_TRUE(s.homing.start_level());
    s.step(1ms);
    EXPECT_FALSE(s.homing.start_level());
}

TEST(DriveHoming, ErrorTakesTheStartBackAndWaitsForStandstill) {
    Sequence s;
    s.drive.mode = DriveMode::homing;
    s.step();
    s.drive.homing_error = true;
    s.step();
    EXPECT_FALSE(s.homing.start_level());
    EXPECT_EQ(s.homing.mode(), DriveMode::homing);
    s.step(1ms, false);
    EXPECT_EQ(s.homing.mode(), DriveMode::homing);  // still moving
    s.step(1ms, true);
    EXPECT_EQ(s.homing.mode(), DriveMode::cyclic_position);
    s.drive.mode = DriveMode::cyclic_position;
    s.step();
    EXPECT_EQ(s.step(), Result::failed);
}

TEST(DriveHoming, DriveThatNeverTakesTheModeTimesOut) {
    Sequence s;
    s.step(5s);
    EXPECT_EQ(s.homing.phase(), Phase::braking);
    s.step();
    s.step();
    EXPECT_EQ(s.step(), Result::timed_out);
}

// A drive that does not come back to cyclic position: failed, not busy for ever.
TEST(DriveHoming, DriveThatNeverComesBackFails) {
    Sequence s;
    s.drive.mode = DriveMode::homing;
    s.step();
    s.step();
    s.drive.homing_attained = true;
    s.step();
    s.step(2s);
    EXPECT_EQ(s.step(), Result::failed);
}

// A drive that is gone from the bus says nothing: not its failure (a run whose slaves were switched off accused each homing drive).
TEST(DriveHoming, ADriveThatIsGoneIsNotAccused) {
    Sequence s;
    s.drive.mode = DriveMode::homing;
    s.step();
    s.step();
    s.homing.abort(s.now);
    s.drive.online = s.drive.fresh = false;
    s.step(2s);
    EXPECT_EQ(s.homing.phase(), Phase::leaving);
    s.step(2s);
    EXPECT_EQ(s.step(), Result::aborted);
    EXPECT_FALSE(s.homing.busy());
}

}  // namespace
}  // namespace taktwerk::axes
