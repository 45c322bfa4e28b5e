// Backlash and errors of the pitch: the motor's business, which programs do not see.

#include "axes/axis/compensation.hpp"

#include "tests/axes/axis/axis_rig.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::test {
namespace {

const std::vector<PitchPoint> screw{{0, 0}, {10, 0.2}, {20, -0.1}, {30, 0.1}};

TEST(PitchTable, IsLinearBetweenItsPointsAndConstantBeyond) {
    EXPECT_EQ(pitch_correction(screw, -5), 0);
    EXPECT_NEAR(pitch_correction(screw, 5), 0.1, 1e-15);
    EXPECT_NEAR(pitch_correction(screw, 15), 0.05, 1e-15);
    EXPECT_EQ(pitch_correction(screw, 20), -0.1);
    EXPECT_EQ(pitch_correction(screw, 99), 0.1);
    EXPECT_EQ(pitch_correction({}, 5), 0);
}

TEST(PitchTable, TheInverseTakesTheCorrectionAway) {
    for (double x = -10; x <= 40; x += 0.37) EXPECT_NEAR(pitch_inverse(screw, x + pitch_correction(screw, x)), x, 1e-12) << x;
    EXPECT_EQ(pitch_inverse({}, 7), 7);
}

AxisConfig with_backlash() {
    auto config = plain_axis();
    config.compensation.backlash = 0.05;  // 50 counts
    config.compensation.velocity = 2;     // 25 ms for all of it
    return config;
}

// Positive motion runs on the positive flank; a reversal takes the motor 0.05 u further, at 2 u/s on top of the motion.
TEST(Backlash, AReversalAddsItSlowlyAndProgramsDoNotSeeIt) {
    Rig rig(with_backlash());
    rig.power_on();
    rig.accept(absolute(10));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.drive.last.position, 10000);

    rig.accept(absolute(5));
    std::int64_t before = rig.drive.last.position;
    double set = rig.view().set_position;
    double most = 0;
    for (Patience patience; patience.lasts(rig.view().state != AxisState::Standstill);) {
        rig.step();
        const double extra = static_cast<double>(rig.drive.last.position - before) - (rig.view().set_position - set) * 1000;
        most = std::max(most, std::abs(extra));
        before = rig.drive.last.position;
        set = rig.view().set_position;
    }
    EXPECT_LE(most, 2 + 1);  // 2 u/s are 2 counts per cycle; rounding
    EXPECT_EQ(rig.view().set_position, 5);
    EXPECT_EQ(rig.drive.last.position, 4950);
    rig.run(20);
    EXPECT_NEAR(rig.view().actual_position, 5, 1e-9) << "read on the same flank";
    EXPECT_TRUE(rig.view().in_position);

    rig.accept(absolute(6));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.drive.last.position, 6000);
    EXPECT_LT(std::abs(rig.view().following_error), 0.002);
}

AxisConfig with_pitch() {
    auto config = plain_axis();
    config.homing.kind = HomingKind::set_here;
    config.compensation.velocity = 1;
    config.compensation.pitch = screw;
    return config;
}

TEST(PitchError, IsCorrectedOnceHomedAndReadBackInverse) {
    Rig rig(with_pitch());
    rig.power_on();
    rig.accept(absolute(10));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.drive.last.position, 10000) << "not homed: nobody knows which place of the screw this is";

    rig.accept(home(10));
    rig.run(2);
    EXPECT_NEAR(static_cast<double>(rig.drive.last.position), 10000, 3) << "no step";
    rig.run(300);  // 0.2 u at 1 u/s
    EXPECT_EQ(rig.drive.last.position, 10200);
    EXPECT_EQ(rig.view().set_position, 10);
    EXPECT_NEAR(rig.view().actual_position, 10, 1e-9);

    rig.accept(absolute(25));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.drive.last.position, 25000);
    rig.accept(absolute(20));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.drive.last.position, 19900);
    rig.run(5);
    EXPECT_NEAR(rig.view().actual_position, 20, 0.0011);
    rig.expect_no_jump();
}

// The screw stays where it is when a program gives its places other numbers.
TEST(PitchError, SetPositionDoesNotMoveTheTable) {
    Rig rig(with_pitch());
    rig.power_on();
    rig.accept(home(10));
    rig.run(300);
    ASSERT_EQ(rig.drive.last.position, 200);
    EXPECT_EQ(rig.axis.set(SetPosition{0, false}, Owner::program), ErrorId::none);
    rig.run(300);
    EXPECT_EQ(rig.drive.last.position, 200);
    EXPECT_NEAR(rig.view().set_position, 0, 1e-9);
}

TEST(CompensationConfig, ATableThatTurnsTheMotionRoundIsRefused) {
    auto config = with_pitch();
    EXPECT_TRUE(check(config).empty());
    config.compensation.pitch = {{0, 0}, {1, -1.0}};
    ASSERT_EQ(check(config).size(), 1u);
    EXPECT_NE(check(config)[0].what.find("turns the motion round"), std::string::npos);
    config.compensation.pitch = {{0, 0}, {0, 0.1}};
    EXPECT_EQ(check(config).size(), 1u);
    config.compensation = {.backlash = -1, .velocity = 0, .pitch = {}};
    EXPECT_EQ(check(config).size(), 2u);
}

}  // namespace
}  // namespace taktwerk::axes::test
