// SV-DA200 guide 2.1, CT-0 of its sheet: what is set before the bus, and what the drive shows of itself. 3.1.2: its status word.

#include "tests/drives/sv_da200.hpp"

namespace taktwerk::test::sv_da200_commissioning {
namespace {

TEST_F(SvDa200, ObeysTheBusOnlyWithP003At8AndThatFromARestartOn) {  // 2.1 item 1, note 1
    ASSERT_EQ(sdo(0x2003, 0, 0), 0u);
    enable_in(csp);
    EXPECT_TRUE(enabled()) << "P0.03 counts from the restart on";
    restart();
    enable_in(csp);
    EXPECT_FALSE(enabled());
    EXPECT_EQ(read(0x6061), 0);

    ASSERT_EQ(sdo(0x2003, 0, 8), 0u);
    restart();
    enable_in(csp);
    EXPECT_TRUE(enabled());
}

TEST_F(SvDa200, MonitorShowsTheStateOfTheBus) {  // 2.1 note 13
    EXPECT_EQ(read(0x301C), 18);
    enter(EsmState::safeop);
    EXPECT_EQ(read(0x301C), 14);
    enter(EsmState::preop);
    EXPECT_EQ(read(0x301C), 12);
    enter(EsmState::init);
    EXPECT_EQ(read(0x301C), 11);
}

TEST_F(SvDa200, StatusBits4And8And14TellPowerClockAndStandstill) {  // 3.1.2
    EXPECT_TRUE(status_bit(4));
    EXPECT_TRUE(status_bit(8));
    EXPECT_TRUE(status_bit(9)) << "OP";
    EXPECT_TRUE(status_bit(14));

    device.behaviour(0).clock_locks(false);
    run(1);
    EXPECT_FALSE(status_bit(8));
    device.behaviour(0).clock_locks(true);
    axis().main_power(false);
    run(1);
    EXPECT_FALSE(status_bit(4));
    axis().main_power(true);

    enable_in(csv);
    pdo(0x60FF, 50000);
    run(100);
    EXPECT_FALSE(status_bit(14));
    EXPECT_TRUE(status_bit(4) && status_bit(8));
}

// 2.1 item 3 and note 1: P4.08 = 0 is Free-Run, from a restart on; then no clock follows SYNC0 [3.1.2 bit 8], and none is missed [5.2 Er24-a].
TEST_F(SvDa200, RunsFreeWithP408At0AndThatFromARestartOn) {
    ASSERT_EQ(sdo(0x2408, 0, 0), 0u);
    run(2);
    EXPECT_TRUE(status_bit(8));
    restart();
    EXPECT_FALSE(status_bit(8));
    enable_in(csp);
    arrives.sync0 = false;
    run(100);
    EXPECT_TRUE(enabled());
}

}  // namespace
}  // namespace taktwerk::test::sv_da200_commissioning
