// SV33-E 5.4, 5.5: alarms that the drive finds by looking: at the distance between two SYNC0 (E.D32), at its mains (E.217, A.222) and at who
// enables it (E.418). Every alarm by its texts and its reset rule: every_alarm_unit.cpp.

#include "tests/drives/sv33_e.hpp"

namespace taktwerk::test::sv33_e_alarm {
namespace {

constexpr std::uint8_t p0a31 = 0x20, p0a32 = 0x21;                              // of 200Ah
constexpr std::uint8_t p2300 = 0x01, p2306 = 0x07, p2308 = 0x09, p2050 = 0x33;  // of 2023h, 2020h
constexpr std::int64_t csp = 8;

class Sv33EAlarms : public Sv33E {
protected:
    /// SYNC0 alternately early and late: intervals of 1 ms + `by` and 1 ms - `by`.
    void jitter(Duration by, int cycles) {
        for (int i = 0; i < cycles; ++i) desk.cycle(1ms + (i % 2 == 0 ? by : -by));
    }
    [[nodiscard]] std::int64_t alarm() { return desk.read(0x2021, 0x09); }
};

// --- E.D32: "the error of the sync period is beyond the threshold" [5.4]; P0A.32: 3000 ns, P0A.31: 9 may be lost [7.2] ---------------

TEST_F(Sv33EAlarms, TheTenthSync0InARowOutOfPlaceIsEd32) {
    map_and_start(csp);
    enable();
    jitter(3000ns, 100);
    EXPECT_EQ(desk.power_state(), 0x27u) << "not beyond the threshold";
    jitter(3001ns, 9);
    EXPECT_EQ(desk.power_state(), 0x27u) << "nine are allowed";
    jitter(0ns, 1);
    jitter(3001ns, 9);
    EXPECT_EQ(desk.power_state(), 0x27u) << "in a row, they are counted";
    jitter(3001ns, 1);
    desk.run(20ms);
    EXPECT_EQ(desk.power_state(), 0x08u);
    EXPECT_EQ(desk.read(0x603F), 0x0D32);
    EXPECT_EQ(alarm(), 0x0D32);
    // Resettable, once SYNC0 is regular.
    desk.control(0);
    desk.control(0x80);
    EXPECT_EQ(desk.power_state(), 0x40u);
}

// 5.4, the remedy: "raise P0A.32".
TEST_F(Sv33EAlarms, AGreaterP0a32Bears) {
    ASSERT_EQ(desk.sdo(0x200A, p0a32, 4000), 0u);
    map_and_start(csp);
    enable();
    jitter(3900ns, 100);
    EXPECT_EQ(desk.power_state(), 0x27u);
}

TEST_F(Sv33EAlarms, Sync0ThatDoesNotComeIsLostToo) {
    ASSERT_EQ(desk.sdo(0x200A, p0a31, 4), 0u);
    map_and_start(csp);
    enable();
    desk.arrives.sync0 = false;  // frames come all the same
    desk.run(4);
    desk.arrives.sync0 = true;
    desk.run(2);
    EXPECT_EQ(desk.power_state(), 0x27u) << "four are allowed";
    desk.arrives.sync0 = false;
    desk.run(7);
    desk.arrives.sync0 = true;
    desk.run(20);
    EXPECT_EQ(desk.read(0x603F), 0x0D32);
}

TEST_F(Sv33EAlarms, ADriveThatIsSwitchedOffMissesNoSync0) {
    map_and_start(csp);
    desk.power_cycle();
    desk.run(2);
    EXPECT_EQ(desk.read(0x603F), 0);
    ASSERT_EQ(desk.sdo(0x2021, 0x1F, 1), 0u);  // P21.30: the latest alarm
    desk.run(2);
    EXPECT_EQ(desk.read(0x2021, 0x20), 0);
}

// --- E.217, A.222: a phase of the mains is missing; P08.00: 0 fault, 1 fault and warning, 2 nothing [5.4, 5.5, 7.2] --------------------

TEST_F(Sv33EAlarms, AMissingPhaseIsE217) {
    map_and_start(csp);
    enable();
    desk.device.mains_complete(false);
    desk.run(100ms);
    EXPECT_EQ(desk.power_state(), 0x08u);
    EXPECT_EQ(desk.read(0x603F), 0x3130);
    EXPECT_EQ(alarm(), 0x0217);
    desk.control(0);
    desk.control(0x80);
    EXPECT_EQ(desk.power_state(), 0x08u) << "the phase is still missing (5.6)";
    desk.control(0);
    desk.device.mains_complete(true);
    desk.control(0x80);
    EXPECT_EQ(desk.power_state(), 0x40u);
}

TEST_F(Sv33EAlarms, P0800SwitchesTheDetectionOff) {
    ASSERT_EQ(desk.sdo(0x2008, 0x01, 2), 0u);
    desk.device.mains_complete(false);
    map_and_start(csp);
    enable();
    EXPECT_EQ(desk.read(0x603F), 0);
}

// "Fault and warning": when it is which is not stated; here it warns until the motor gets power. Both share 603Fh, P21.08 tells them apart.
TEST_F(Sv33EAlarms, WithP0800At1ItWarnsFirst) {
    ASSERT_EQ(desk.sdo(0x2008, 0x01, 1), 0u);
    map_and_start(csp);
    desk.device.mains_complete(false);
    desk.run(10ms);
    EXPECT_EQ(desk.power_state(), 0x40u);
    EXPECT_NE(desk.status() & 0x80, 0u);
    EXPECT_EQ(desk.read(0x603F), 0x3130);
    EXPECT_EQ(alarm(), 0x0222);
    desk.control(6);
    desk.control(7);
    align();
    desk.control(15);
    desk.run(300ms);
    EXPECT_EQ(desk.power_state(), 0x08u);
    EXPECT_EQ(alarm(), 0x0217);
}

// --- E.418: "enabled internally, and the enable of the bus comes" [5.4]; DI function 1 is servo enable [8.1], here of a VDI [P23.xx] ---

TEST_F(Sv33EAlarms, TheBusEnablesADriveThatAnInputEnablesIsE418) {
    ASSERT_EQ(desk.sdo(0x2023, p2308, 1), 0u);  // VDI2: servo enable
    ASSERT_EQ(desk.sdo(0x2023, p2300, 1), 0u);  // VDIs count
    ASSERT_EQ(desk.sdo(0x2020, p2050, 2), 0u);  // VDI2 is on
    map_and_start(csp);
    desk.control(6);
    desk.control(7);
    EXPECT_EQ(desk.read(0x603F), 0) << "the bus does not enable yet";
    align();
    desk.control(15);
    EXPECT_EQ(desk.power_state(), 0x08u);
    EXPECT_EQ(desk.read(0x603F), 0x5441);
    EXPECT_EQ(alarm(), 0x0418);
    // "Take the enable of the controller away": then it can be reset.
    desk.control(0x80);
    EXPECT_EQ(desk.power_state(), 0x40u);
    desk.control(0);
    ASSERT_EQ(desk.sdo(0x2020, p2050, 0), 0u);
    enable();
}

TEST_F(Sv33EAlarms, AnInputWithAnotherFunctionOrSwitchedOffEnablesNothing) {
    ASSERT_EQ(desk.sdo(0x2023, p2306, 4), 0u);  // VDI1: clear position deviation
    ASSERT_EQ(desk.sdo(0x2023, p2308, 1), 0u);
    ASSERT_EQ(desk.sdo(0x2020, p2050, 0xFFFD), 0u);  // all but VDI2
    ASSERT_EQ(desk.sdo(0x2023, p2300, 1), 0u);
    map_and_start(csp);
    enable();
    desk.control(6);
    desk.run(500ms);
    ASSERT_EQ(desk.sdo(0x2023, p2300, 0), 0u);
    ASSERT_EQ(desk.sdo(0x2020, p2050, 0xFFFF), 0u);
    enable();
    EXPECT_EQ(desk.read(0x603F), 0);
}

TEST_F(Sv33EAlarms, TheInputComesWhileTheBusHasEnabled) {
    ASSERT_EQ(desk.sdo(0x2023, p2306, 1), 0u);
    ASSERT_EQ(desk.sdo(0x2023, p2300, 1), 0u);
    map_and_start(csp);
    enable();
    ASSERT_EQ(desk.sdo(0x2020, p2050, 1), 0u);
    desk.run(50ms);
    EXPECT_EQ(alarm(), 0x0418);
}

}  // namespace
}  // namespace taktwerk::test::sv33_e_alarm
