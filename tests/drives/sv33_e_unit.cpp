// The simulated SV33-E where its manual is definite about parameters, mapping and alarms (V1.1, sections beside each).

#include "tests/drives/sv33_e.hpp"

namespace taktwerk::test::sv33_e_unit {
namespace {

using State = axes::sim::Cia402Axis::State;

constexpr std::uint32_t cannot_store = 0x08000020, device_state = 0x08000022, sub0_not_zero = 0x06010003, read_only = 0x06010002,
                        too_high = 0x06090031, no_object = 0x06020000, no_subindex = 0x06090011;

// --- Process data [6.2.9.1, 6.2.9.2] -----------------------------------------------------------------------------------------

TEST_F(Sv33E, MappingIsChangedFromCountZero) {
    EXPECT_EQ(desk.sdo(0x1600, 1, 0x60400010), sub0_not_zero);  // the count is 3 from the factory
    EXPECT_EQ(desk.sdo(0x1600, 0, 0), 0u);
    const std::int64_t entries[] = {0x60400010, 0x607A0020, 0x60FF0020, 0x60710010, 0x60600008, 0x60B80010};
    for (std::uint8_t n = 0; n < 6; ++n) EXPECT_EQ(desk.sdo(0x1600, static_cast<std::uint8_t>(n + 1), entries[n]), 0u) << int{n};
    EXPECT_EQ(desk.sdo(0x1600, 0, 6), 0u);
    EXPECT_EQ(desk.read(0x1600, 0), 6);
    EXPECT_EQ(desk.sdo(0x1600, 0, 11), too_high);  // 7.1: 0 to 10
}

TEST_F(Sv33E, OnePdoADirectionAndItsAssignmentFromCountZeroToo) {
    EXPECT_EQ(desk.read(0x1C12, 1), 0x1701);  // 7.1
    EXPECT_EQ(desk.read(0x1C13, 1), 0x1B01);
    EXPECT_EQ(desk.sdo(0x1C12, 1, 0x1600), sub0_not_zero);
    EXPECT_EQ(desk.sdo(0x1C12, 0, 0), 0u);
    EXPECT_EQ(desk.sdo(0x1C12, 1, 0x1600), 0u);
    EXPECT_EQ(desk.sdo(0x1C12, 0, 1), 0u);
    EXPECT_EQ(desk.sdo(0x1C12, 0, 2), too_high);  // 7.1: 0 to 1
}

TEST_F(Sv33E, FixedPdosAreReadOnlyAndAllAreOutsidePreop) {
    EXPECT_EQ(desk.sdo(0x1701, 0, 0), read_only);
    desk.enter(EsmState::safeop);
    EXPECT_EQ(desk.sdo(0x1600, 0, 0), device_state);
    EXPECT_EQ(desk.sdo(0x1C12, 0, 0), device_state);
}

// --- Parameters [7.2] --------------------------------------------------------------------------------------------------------

TEST_F(Sv33E, WhatTheDictionaryLacksIsRefused) {
    EXPECT_EQ(desk.sdo(0x605B, 0, 0), no_object);  // 7.3 has 605Ah and 605Dh only
    EXPECT_EQ(desk.sdo(0x1010, 1, 0x65766173), no_object);
    EXPECT_EQ(desk.sdo(0x2004, 0x20, 0), no_subindex);
    EXPECT_EQ(desk.sdo(0x2021, 0x09, 1), read_only);  // P21.08
}

TEST_F(Sv33E, WritesAreKeptOverPowerCyclesUnlessP0510SaysNo) {
    EXPECT_EQ(desk.sdo(0x6065, 0, 393'216), 0u);
    EXPECT_EQ(desk.sdo(0x2005, 0x0F, 200), 0u);  // P05.14
    EXPECT_EQ(desk.device.parameters().eeprom_writes(), 2u);
    desk.power_cycle();
    EXPECT_EQ(desk.read(0x6065), 393'216);
    EXPECT_EQ(desk.read(0x2005, 0x0F), 200);

    EXPECT_EQ(desk.sdo(0x2005, 0x0B, 0), 0u);  // P05.10 = 0
    EXPECT_EQ(desk.sdo(0x6065, 0, 500'000), 0u);
    EXPECT_EQ(desk.read(0x6065), 500'000);
    EXPECT_EQ(desk.device.parameters().eeprom_writes(), 2u);
    desk.power_cycle();
    EXPECT_EQ(desk.read(0x6065), 393'216);
}

TEST_F(Sv33E, FactoryValuesComeBackByP0501AndARestart) {
    EXPECT_EQ(desk.sdo(0x6085, 0, 12345), 0u);
    EXPECT_EQ(desk.sdo(0x2005, 0x02, 1), 0u);
    EXPECT_EQ(desk.read(0x6085), 12345);
    desk.power_cycle();
    EXPECT_EQ(desk.read(0x6085), 100);  // 7.3
}

TEST_F(Sv33E, SomeParametersAreRefusedWhileTheMotorIsPowered) {
    EXPECT_EQ(desk.sdo(0x2004, 0x0D, 1), 0u);  // P04.12, changed when stopped
    EXPECT_EQ(desk.sdo(0x2004, 0x0D, 2), 0u);
    map_and_start(8);
    enable();
    EXPECT_EQ(desk.sdo(0x2004, 0x0D, 1), device_state);
    EXPECT_EQ(desk.sdo(0x2006, 0x01, 300), 0u);  // P06.00, changed at any time
    desk.control(6);
    desk.run(500ms);  // stopped and the brake closed
    EXPECT_EQ(desk.sdo(0x2004, 0x0D, 1), 0u);
}

// 5.5, A.426: until the power cycle; P04.01 is effective "after power-on again".
TEST_F(Sv33E, AParameterThatNeedsARestartWarns) {
    desk.run(2ms);
    EXPECT_EQ(desk.status() & 0x80, 0);
    EXPECT_EQ(desk.sdo(0x2004, 0x02, 1), 0u);
    desk.run(2ms);
    EXPECT_NE(desk.status() & 0x80, 0);
    EXPECT_EQ(desk.read(0x603F), 0x6320);
    EXPECT_EQ(desk.read(0x2021, 0x09), 0x426);
    EXPECT_EQ(desk.power_state(), 0x40u);  // a warning stops nothing
    desk.power_cycle();
    desk.run(2ms);
    EXPECT_EQ(desk.read(0x603F), 0);
    EXPECT_EQ(desk.read(0x2004, 0x02), 1);
}

// 5.5, A.427: "very frequently and in great number"; it goes by itself.
TEST_F(Sv33E, ManyStoredWritesWarnAndNoneDoWithP0510Off) {
    for (int i = 0; i < 150; ++i) EXPECT_EQ(desk.sdo(0x6081, 0, i), 0u);
    desk.run(2ms);
    EXPECT_EQ(desk.read(0x603F), 0x7600);
    EXPECT_EQ(desk.read(0x2021, 0x09), 0x427);
    desk.run(11s);
    EXPECT_EQ(desk.read(0x603F), 0);

    EXPECT_EQ(desk.sdo(0x2005, 0x0B, 0), 0u);
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(desk.sdo(0x6081, 0, i), 0u);
    desk.run(2ms);
    EXPECT_EQ(desk.read(0x603F), 0);
}

// --- Alarms [5.1 to 5.6] -------------------------------------------------------------------------------------------------------

// 5.6: "first remove servo enable, then reset"; by bit 7, by P20.03.
TEST_F(Sv33E, AFaultIsResetWithTheEnableDropped) {
    map_and_start(8);
    enable();
    desk.axis().provoke("E.219");
    desk.run(100ms);
    desk.axis().release("E.219");
    ASSERT_EQ(desk.power_state(), 0x08u);
    desk.control(0x8F);
    EXPECT_EQ(desk.power_state(), 0x08u);
    desk.control(0x0F);
    desk.control(0x00);
    desk.control(0x80);
    EXPECT_EQ(desk.power_state(), 0x40u);
    desk.control(0);

    desk.axis().provoke("E.219");
    desk.run(2ms);
    desk.axis().release("E.219");
    EXPECT_EQ(desk.sdo(0x2020, 0x04, 1), 0u);  // P20.03
    desk.run(2ms);
    EXPECT_EQ(desk.power_state(), 0x40u);
}

// 5.4, E.216: the torque goes at once, whatever P04.11 says of stopping.
TEST_F(Sv33E, SafeTorqueOffLetsTheMotorRunOut) {
    map_and_start(9);
    enable();
    desk.pdo(0x60FF, 1'310'720);  // 10 turns a second
    desk.run(500ms);
    desk.axis().provoke("E.216");
    desk.run(2ms);
    EXPECT_EQ(desk.axis().state(), State::fault);
    EXPECT_EQ(desk.read(0x6077), 0);
    EXPECT_GT(desk.read(0x606C), 1'000'000);
}

// 5.4, E.218: P20.02 is the stop from the tool; it clears by itself when it is released.
TEST_F(Sv33E, TheEmergencyStopOfTheToolStopsAndClearsItself) {
    map_and_start(9);
    enable();
    desk.pdo(0x60FF, 1'310'720);
    desk.run(500ms);
    EXPECT_EQ(desk.sdo(0x2020, 0x03, 1), 0u);
    desk.run(500ms);
    EXPECT_EQ(desk.read(0x603F), 0x5442);
    EXPECT_EQ(desk.read(0x606C), 0);
    desk.pdo(0x6040, 0);
    EXPECT_EQ(desk.sdo(0x2020, 0x03, 0), 0u);
    desk.run(2ms);
    EXPECT_EQ(desk.power_state(), 0x40u);
}

// 5.4, E.917: P20.05 = 1 after the battery is connected.
TEST_F(Sv33E, TheBatteryAlarmGoesByP2005) {
    desk.axis().provoke("E.917");
    desk.go_operational();
    desk.control(0x80);
    EXPECT_EQ(desk.read(0x2021, 0x09), 0x917);
    desk.control(0);
    EXPECT_EQ(desk.sdo(0x2020, 0x06, 1), 0u);
    desk.run(2ms);
    desk.control(0x80);
    EXPECT_EQ(desk.power_state(), 0x40u);
}

// 5.4, E.D15 and E.D16.
TEST_F(Sv33E, CrossedSoftwareLimitsAndAHomeOffsetOutsideAreFaults) {
    EXPECT_EQ(desk.sdo(0x607D, 1, -1000), 0u);
    EXPECT_EQ(desk.sdo(0x607D, 2, -1000), 0u);
    desk.run(2ms);
    EXPECT_EQ(desk.read(0x603F), 0x0D15);
    EXPECT_EQ(desk.sdo(0x607D, 2, 1000), 0u);
    desk.go_operational();
    desk.control(0x80);
    EXPECT_EQ(desk.power_state(), 0x40u);
    EXPECT_EQ(desk.sdo(0x607C, 0, 1001), 0u);
    desk.run(2ms);
    EXPECT_EQ(desk.read(0x603F), 0x0D16);
}

// 5.4, E.423 and 7.3: the window is 6065h.
TEST_F(Sv33E, TheFollowingErrorIsComparedWith6065) {
    EXPECT_EQ(desk.sdo(0x6065, 0, 50), 0u);
    map_and_start(8);
    enable();
    desk.axis().jam(true);
    desk.pdo(0x607A, desk.read(0x6064) + 40);
    desk.run(50ms);
    EXPECT_EQ(desk.power_state(), 0x27u);
    desk.pdo(0x607A, desk.read(0x6064) + 60);
    desk.run(50ms);
    EXPECT_EQ(desk.read(0x603F), 0x8611);
    EXPECT_EQ(desk.read(0x2021, 0x09), 0x423);
}

// 5.4, E.B11 and 7.2, P08.18: 200 ms.
TEST_F(Sv33E, AStalledMotorIsSeenAfter200Milliseconds) {
    map_and_start(10);
    enable();
    desk.axis().jam(true);
    desk.pdo(0x6071, 5000);
    desk.run(190ms);
    EXPECT_EQ(desk.power_state(), 0x27u);
    desk.run(30ms);
    EXPECT_EQ(desk.read(0x603F), 0x7121);
}

// 5.4, E.D26: the master leaves OP while the axis is enabled.
TEST_F(Sv33E, LeavingOpWhileEnabledIsAFault) {
    map_and_start(8);
    enable();
    desk.enter(EsmState::safeop);
    desk.run(100ms);
    EXPECT_EQ(desk.read(0x603F), 0x0D26);
}

// 3.4.4(2): in position modes the motor goes to the limit, bit 11 tells; P05.43 = 0 from the factory switches it off.
TEST_F(Sv33E, ASoftwareLimitHoldsTheTargetBack) {
    EXPECT_EQ(desk.sdo(0x607D, 1, -1000), 0u);
    EXPECT_EQ(desk.sdo(0x607D, 2, 1000), 0u);
    map_and_start(8);
    enable();
    const auto go_to = [&](std::int64_t target) {
        for (auto at = desk.read(0x607A); at != target;) {
            at += target > at ? std::min<std::int64_t>(20, target - at) : -std::min<std::int64_t>(20, at - target);
            desk.pdo(0x607A, at);
            desk.run(1ms);
        }
        desk.run(200ms);
    };
    constexpr double stuck = 20;  // counts of 131072 a turn that friction leaves to a loop without position integral
    go_to(1500);
    EXPECT_NEAR(static_cast<double>(desk.read(0x6064)), 1500, stuck);
    EXPECT_EQ(desk.status() & 0x800, 0);
    go_to(0);
    desk.control(6);
    desk.run(500ms);
    EXPECT_EQ(desk.sdo(0x2005, 0x2C, 1), 0u);
    enable();
    go_to(1500);
    EXPECT_NEAR(static_cast<double>(desk.read(0x6064)), 1000, stuck);
    EXPECT_NE(desk.status() & 0x800, 0);
    EXPECT_EQ(desk.power_state(), 0x27u);  // no fault
    go_to(900);
    EXPECT_EQ(desk.status() & 0x800, 0);
}

// 5.1: the last ten, one that is among the last five only once; 7.2: P21.30 chooses, P21.31 and P21.33 show.
TEST_F(Sv33E, EarlierAlarmsCanBeLookedUp) {
    desk.go_operational();
    const auto happen = [&](const char* panel) {
        desk.axis().provoke(panel);
        desk.run(2ms);
        desk.axis().release(panel);
        desk.control(0x80);
        desk.control(0);
    };
    happen("E.416");
    desk.run(1s);
    happen("E.219");
    happen("E.219");
    desk.axis().provoke("E.415");
    desk.run(2ms);
    const auto record = [&](std::int64_t n) {
        EXPECT_EQ(desk.sdo(0x2021, 0x1F, n), 0u);
        desk.run(2ms);
        return desk.read(0x2021, 0x20);
    };
    EXPECT_EQ(record(0), 0x415);
    EXPECT_EQ(record(1), 0x219);
    EXPECT_GE(desk.read(0x2021, 0x22), 10);  // tenths of a second
    EXPECT_EQ(record(2), 0x416);
    EXPECT_EQ(record(3), 0);
}

}  // namespace
}  // namespace taktwerk::test::sv33_e_unit
