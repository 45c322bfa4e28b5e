// SV-DA200 guide 3.3, 3.6, 3.7: the cyclic modes (CT-8, CT-11, CT-12).

#include "tests/drives/sv_da200.hpp"

namespace taktwerk::test::sv_da200_cyclic {
namespace {

TEST_F(SvDa200, CspFollowsAbsoluteTargets) {
    enable_in(csp);
    const auto from = position();
    for (int i = 1; i <= 100; ++i) {
        pdo(0x607A, from + 20 * i);
        run(1);
    }
    run(100);
    EXPECT_NEAR(static_cast<double>(position() - from), 2000, 5);
}

TEST_F(SvDa200, WithP037At0TheSameTargetIsAnIncrementEachCycle) {  // 3.3.2 step 3
    ASSERT_EQ(sdo(0x2025, 0, 0), 0u);
    enable_in(csp);
    const auto from = position();
    pdo(0x607A, 20);  // never changed: 20 counts a cycle
    run(100);
    pdo(0x607A, 0);
    run(100);
    EXPECT_NEAR(static_cast<double>(position() - from), 2000, 5);
}

TEST_F(SvDa200, TorqueModeKeepsToTheSpeedOf607F) {  // 2.1 note 10
    pdo(0x607F, 30000);
    enable_in(cst);
    pdo(0x6071, 300);
    run(2000);
    // How close to the limit a loaded motor comes is not stated: never above it, and not held far below.
    EXPECT_LE(speed(), 30000 * 1.01) << "30 % torque would take it far beyond";
    EXPECT_GE(speed(), 30000 * 0.9);
    pdo(0x607F, 15000);
    run(2000);
    EXPECT_LE(speed(), 15000 * 1.01) << "the limit of the moment, not the one at the start";
    EXPECT_GE(speed(), 15000 * 0.9);
}

TEST_F(SvDa200, AZeroIn607FIsIgnoredOrHoldsTheMotorAsP443Says) {  // 2.1 note 8 bit 1, note 10
    pdo(0x607F, 0);
    enable_in(cst);
    pdo(0x6071, 300);
    run(1000);
    EXPECT_GT(speed(), 50000) << "masked: nothing limits the speed";

    ASSERT_EQ(sdo(0x242B, 0, 0x0001), 0u);
    run(2000);
    EXPECT_NEAR(speed(), 0, 500) << "not masked: a limit of zero";
}

TEST_F(SvDa200, TheTorqueOffsetCountsInAllModesButThoseOfTorque) {  // 4.10
    enable_in(cst);
    pdo(0x60B2, 300);
    run(500);
    EXPECT_NEAR(speed(), 0, 100);
}

TEST_F(SvDa200, TheTorqueLimitsHoldInTorqueModeToo) {  // CT-12: 3.7.2 steps 5 to 7, 2.1 note 9
    pdo(0x607F, 1'000'000);
    enable_in(cst);
    pdo(0x6071, 500);
    run(20);
    EXPECT_EQ(read(0x6077), 500);
    pdo(0x60E0, 300);
    run(2);
    EXPECT_EQ(read(0x6077), 300);
    pdo(0x6072, 200);
    run(2);
    EXPECT_EQ(read(0x6077), 200) << "the least of both";
    pdo(0x6071, -500);
    run(2);
    EXPECT_EQ(read(0x6077), -200);
    control(0x00);
    EXPECT_EQ(read(0x6077), 0) << "3.7.5 step 2: 0h disables";
}

TEST_F(SvDa200, TorqueModeHasNoSlopeObject) {  // 3.7.5 step 4 names 6087h, which no table of the guide has (3.7.4, 4.3)
    EXPECT_EQ(sdo(0x6087, 0, 1), 0x06020000u);
}

// 3.7.2 step 3: 0.1 % of the rated torque, 1.27 N m. 25 % less 0.05 N m of friction on 2e-4 kg m2 for 20 ms: 26.75 rad/s, 42600 pulses/s, less
// what 0.001 N m s of viscous friction takes, some 5 %.
TEST_F(SvDa200, ATorqueIsTenthsOfAPercentOfTheRatedOne) {
    pdo(0x607F, 1'000'000);
    enable_in(cst);
    pdo(0x6071, 250);
    run(21);
    EXPECT_NEAR(speed(), 40'500, 1'500);
}

}  // namespace
}  // namespace taktwerk::test::sv_da200_cyclic
