// SV-DA200 guide 3.4: homing by the drive (CT-9). Every method from every start: tests/axes/sim/homing_walk_unit.cpp.

#include "tests/drives/sv_da200.hpp"

namespace taktwerk::test::sv_da200_homing {
namespace {

TEST_F(SvDa200, HomesToTheSwitchWhileBit4IsHeld) {
    home_by(19);
    enable_in(homing);
    pdo(0x6040, 0x1F);
    for (int i = 0; i < 20'000 && !status_bit(12) && !status_bit(13); ++i) run(1);
    EXPECT_TRUE(status_bit(12));
    EXPECT_FALSE(status_bit(13));
    run(100);
    EXPECT_TRUE(status_bit(10)) << "3.1.2: homing complete";
    // The zero is the edge of the switch, at 0 of the table.
    EXPECT_NEAR(axis().plant().position() - static_cast<double>(position()), 0, 20);
}

TEST_F(SvDa200, DroppingBit4AbortsTheHoming) {  // 3.4.2: 1 -> 0 aborts
    home_by(19);
    enable_in(homing);
    pdo(0x6040, 0x1F);
    run(200);
    ASSERT_GT(speed(), 10000);
    pdo(0x6040, 0x0F);
    run(300);
    EXPECT_NEAR(speed(), 0, 100);
    EXPECT_FALSE(status_bit(12));
    EXPECT_TRUE(enabled());
}

TEST_F(SvDa200, Method35TakesThePlaceWhereItStands) {  // 3.4.6
    ASSERT_EQ(sdo(0x6098, 0, 35), 0u);
    enable_in(homing);
    pdo(0x6040, 0x1F);
    run(20);
    EXPECT_TRUE(status_bit(12));
    EXPECT_NEAR(static_cast<double>(position()), 0, 1);
}

TEST_F(SvDa200, ZeroInTheControlWordEndsTheHomingAndThePower) {  // CT-9: 00h disables the drive
    home_by(19);
    enable_in(homing);
    pdo(0x6040, 0x1F);
    run(200);
    ASSERT_GT(speed(), 10000);
    control(0x00);
    EXPECT_EQ(power_state(), 0x40u);
    run(300);
    EXPECT_NEAR(speed(), 0, 100);
    EXPECT_FALSE(status_bit(12));
}

TEST_F(SvDa200, MeetingALimitSwitchIsBit13AndEr25_6) {  // 3.4.4 step 5; 5.3: "switch off and on"
    home_by(19);                                        // sets out in positive direction, where from 10000 on there is no home switch
    enable_in(csp);
    follow_to(10000);
    control(6);
    enable_in(homing);
    pdo(0x6040, 0x1F);
    ASSERT_TRUE(run_until([&] { return faulted(); }, 20s));
    EXPECT_TRUE(status_bit(13));
    EXPECT_EQ(read(0x603F), 0xFF00);
    EXPECT_EQ(read(0x4000), 0x1906);
    control(0x00);
    control(0x80);
    EXPECT_TRUE(faulted()) << "no reset clears it";
    restart();
    EXPECT_FALSE(faulted());
}

TEST_F(SvDa200, TheZeroLiesTheHomeOffsetBesideTheReference) {  // 3.4.2 step 3: P5.14; its sign is not stated, here 6064h reads it
    home_by(35);
    ASSERT_EQ(sdo(0x607C, 0, 1234), 0u);
    enable_in(homing);
    control(0x1F, 20);
    EXPECT_TRUE(status_bit(12));
    EXPECT_NEAR(static_cast<double>(position()), 1234, 1);
}

}  // namespace
}  // namespace taktwerk::test::sv_da200_homing
