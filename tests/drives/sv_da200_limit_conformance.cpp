// SV-DA200 guide 2.1 notes 8 to 10, 5.3: limits of torque (CT-17), switches and following error.

#include "tests/drives/sv_da200.hpp"

namespace taktwerk::test::sv_da200_limit {
namespace {

constexpr std::int64_t er22_0 = 0x1600, er21_0 = 0x1500, er21_1 = 0x1501;  // 5.1: main code, sub-code

TEST_F(SvDa200, TorqueLimitsOfZeroAreIgnoredUntilP443OrOmronUnitsSayOtherwise) {
    pdo(0x60E0, 0);
    pdo(0x60E1, 0);
    const auto moves = [&] {
        enable_in(csv);
        pdo(0x60FF, 20000);
        run(300);
        const bool moved = speed() > 10000;
        pdo(0x60FF, 0);
        pdo(0x6040, 6);
        run(3000);
        return moved;
    };
    EXPECT_TRUE(moves()) << "P4.43 bit 0 is 1 from the factory";
    ASSERT_EQ(sdo(0x242B, 0, 0x0002), 0u);
    EXPECT_FALSE(moves());
    ASSERT_EQ(sdo(0x242B, 0, 0x0003), 0u);
    ASSERT_EQ(sdo(0x2419, 0, 2), 0u);
    EXPECT_FALSE(moves()) << "CIA402 OMRON never masks";
    for (const int limit : {0x6072, 0x60E0, 0x60E1}) pdo(static_cast<std::uint16_t>(limit), 1000);
    EXPECT_TRUE(moves());
}

TEST_F(SvDa200, ATorqueLimitHoldsInItsDirectionOnly) {  // 2.1 note 9: 0.1 % of rated, in all modes
    pdo(0x60E0, 10);                                    // 1 %: less than friction
    enable_in(csv);
    pdo(0x60FF, 20000);
    run(300);
    EXPECT_LT(speed(), 1000);
    pdo(0x60FF, -20000);
    run(300);
    EXPECT_LT(speed(), -10000);
}

TEST_F(SvDa200, ALimitSwitchInAPositionModeIsAFault) {  // Er21
    enable_in(csp);
    auto target = read(0x607A);
    for (int i = 0; i < 5000 && !faulted(); ++i) {
        pdo(0x607A, target += 40);
        run(1);
    }
    EXPECT_TRUE(faulted());
    EXPECT_EQ(read(0x603F), 0x8500);
    EXPECT_EQ(read(0x4000), er21_0);

    // Away from the switch it may go again.
    control(0x80);
    control(0);
    enable_in(csp);
    target = read(0x607A);
    for (int i = 0; i < 500; ++i) {
        pdo(0x607A, target -= 40);
        run(1);
    }
    EXPECT_TRUE(enabled());
    for (int i = 0; i < 5000 && !faulted(); ++i) {
        pdo(0x607A, target -= 40);
        run(1);
    }
    EXPECT_EQ(read(0x4000), er21_1);
}

TEST_F(SvDa200, ALimitSwitchInAVelocityModeIsNone) {  // Er21: "position mode or full closed loop"
    enable_in(csv);
    pdo(0x60FF, 60000);
    for (int i = 0; i < 3000 && axis().plant().position() < 52000; ++i) run(1);
    run(10);
    EXPECT_TRUE(axis().plant().positive_limit());
    EXPECT_FALSE(faulted());
}

TEST_F(SvDa200, P433IsTheFollowingErrorThatTripsIt) {  // Er22-0
    ASSERT_EQ(sdo(0x2421, 0, 1000), 0u);
    enable_in(csp);
    axis().jam(true);
    auto target = read(0x607A);
    for (int i = 0; i < 100 && !faulted(); ++i) {
        pdo(0x607A, target += 20);
        run(1);
    }
    EXPECT_TRUE(faulted());
    EXPECT_EQ(read(0x603F), 0x8611);
    EXPECT_EQ(read(0x4000), er22_0);
}

}  // namespace
}  // namespace taktwerk::test::sv_da200_limit
