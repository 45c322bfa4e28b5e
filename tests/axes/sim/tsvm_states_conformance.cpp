// The state table of the TSVM-D6 manual V1.1, 5.3.1 and 5.3.2, row by row: which control word brings which status word.

#include <gtest/gtest.h>

#include "tests/axes/sim/axis_bench.hpp"

namespace taktwerk::axes::sim {
namespace {

/// As its drive file has it; literals from the manual.
DriveProfile tsvm() {
    DriveProfile p;
    p.quirks = {Quirk::alarm_sets_warning_bit,     // 5.3.2, bit 7
                Quirk::remote_bit_from_preop,      // 5.3.2, bit 9
                Quirk::quick_stop_bit_rests_high,  // 5.3.1, 0270h
                Quirk::cyclic_bit_10_reserved};    // 5.3.2, bit 10 has no meaning in csp
    p.stops.fault = DriveStop::coast;
    p.self_test = 20ms;
    p.deaf_after_enable = 100ms;                                         // 5.3.1
    p.torque_overload = 1.6;                                             // PA30
    p.torque_overload_time = 3s;                                         // PA31
    p.alarms = {{.code = 4, .kind = DriveAlarmKind::following_error},    // 7.2
                {.code = 29, .kind = DriveAlarmKind::torque_overload},   // 7.2
                {.code = 44, .kind = DriveAlarmKind::left_operational},  // 7.2
                {.code = 73, .whole_drive = true, .kind = DriveAlarmKind::undervoltage},
                {.code = 91, .whole_drive = true, .kind = DriveAlarmKind::communication}};
    return p;
}

PlantConfig bed() {
    auto plant = table();
    plant.negative_limit = -1e9;
    plant.positive_limit = 1e9;
    return plant;
}

/// Past its self-test, in Switch On Disabled.
struct Drive : Bench {
    explicit Drive(const DriveProfile& profile = tsvm()) : Bench(bed(), profile) { run(25); }
    /// The status word right after one control word.
    std::uint16_t answer(std::uint16_t control) {
        command(control, 1);
        return out.status;
    }
    void to_enabled() {
        answer(0x0006);
        answer(0x0007);
        ASSERT_EQ(answer(0x000F), 0x1237);
    }
    /// What the drive shows before any time has passed.
    std::uint16_t at_once() {
        axis.exchange(in, 1ms, out);
        return out.status;
    }
    void run_at_speed() {
        to_enabled();
        run(110);
        for (int i = 0; i < 200; ++i) {
            in.target_position += 50;
            cycle();
        }
    }
};

TEST(TsvmStateTable, Transitions0And1PassByThemselves) {
    Bench b{bed(), tsvm()};
    EXPECT_EQ(b.out.status, 0x0000);
    b.run(25);
    EXPECT_EQ(b.out.status, 0x0270);
}

TEST(TsvmStateTable, Transitions2To7UpAndDown) {
    Drive d;
    EXPECT_EQ(d.answer(0x0006), 0x0231);  // 2
    EXPECT_EQ(d.answer(0x0007), 0x0233);  // 3
    EXPECT_EQ(d.answer(0x000F), 0x1237);  // 4
    EXPECT_EQ(d.answer(0x0007), 0x0233);  // 5
    EXPECT_EQ(d.answer(0x0006), 0x0231);  // 6
    EXPECT_EQ(d.answer(0x0000), 0x0270);  // 7
}

TEST(TsvmStateTable, Transitions8To10LeaveInOneStep) {
    Drive d;
    d.to_enabled();
    EXPECT_EQ(d.answer(0x0006), 0x0231);  // 8
    d.to_enabled();
    EXPECT_EQ(d.answer(0x0000), 0x0270);  // 9
    d.answer(0x0006);
    d.answer(0x0007);
    EXPECT_EQ(d.answer(0x0000), 0x0270);  // 10
}

TEST(TsvmStateTable, Transitions11And12QuickStopEndsByItself) {
    Drive d;
    d.run_at_speed();
    EXPECT_EQ(d.answer(0x0002), 0x0217);  // 11
    d.run(2000);
    EXPECT_EQ(d.out.status, 0x0270);  // 12, 605Ah = 0 to 3
    EXPECT_NEAR(d.axis.plant().velocity(), 0, 1);
}

// 13: the table of 5.3.2 says 02BFh and then 02B8h; 5.3.1 prints 02B6h, which fits none of its rows.
TEST(TsvmStateTable, Transition13ShowsTheFaultByTheTableOrAsPrinted) {
    Drive d;
    d.to_enabled();
    d.axis.raise(AlarmCode{12});
    EXPECT_EQ(d.at_once(), 0x02BF);
    d.cycle();
    EXPECT_EQ(d.out.status, 0x02B8);
    EXPECT_EQ(d.out.error_code, 12);

    auto printed = tsvm();
    printed.quirks.push_back(Quirk::fault_reaction_02b6);
    Drive e{printed};
    e.to_enabled();
    e.axis.raise(AlarmCode{12});
    EXPECT_EQ(e.at_once(), 0x02B6);
}

TEST(TsvmStateTable, Transition15IsARisingEdgeAndBit7HeldIgnoresEverything) {
    Drive d;
    d.axis.raise(AlarmCode{12});
    EXPECT_EQ(d.answer(0x0000), 0x02B8);
    EXPECT_EQ(d.answer(0x0080), 0x0270);  // 15
    EXPECT_EQ(d.answer(0x0086), 0x0270) << "bit 7 is still held";
    d.axis.raise(AlarmCode{12});
    EXPECT_EQ(d.answer(0x0080), 0x02B8) << "no edge";
    EXPECT_EQ(d.answer(0x0000), 0x02B8);
    EXPECT_EQ(d.answer(0x0080), 0x0270);
}

// 5.3.1: "main power off: not in the state of servo ready, it cannot go to Switched on"; 5.3.2: bit 4 is its relay.
TEST(TsvmStateTable, WithoutMainPowerThereIsNoTransition3) {
    Drive d;
    d.axis.main_power(false);
    EXPECT_EQ(d.answer(0x0006), 0x0221);
    EXPECT_EQ(d.answer(0x0007), 0x0221);
    d.axis.main_power(true);
    EXPECT_EQ(d.answer(0x0007), 0x0233);
}

// 5.3.2: "bit 9: becomes 1 when the ESM state is PREOP or above".
TEST(TsvmStatusWord, Bit9StandsFromPreopOn) {
    Drive d;
    d.axis.operational(false);
    d.axis.reachable(true);
    EXPECT_EQ(d.at_once() & 0x0200u, 0x0200u);
    d.axis.reachable(false);
    EXPECT_EQ(d.at_once() & 0x0200u, 0u);
}

// 7.2, end of 7.2.1: starred alarms cannot be reset by software.
TEST(TsvmAlarm, AStarredOneNeedsAPowerCycle) {
    Drive d;
    d.axis.raise(AlarmCode{2, false});
    d.answer(0x0000);
    EXPECT_EQ(d.answer(0x0080), 0x02B8);
    d.axis.power_on(d.now);
    d.command(0x0000, 25);
    EXPECT_EQ(d.out.status, 0x0270);
}

// 7.1: "when both occur, the drive can only upload the common one".
TEST(TsvmAlarm, ACommonOneHidesTheAxisOwn) {
    Drive d;
    d.axis.raise(AlarmCode{12});
    d.axis.raise_common({72, true, 0, false, true});
    d.answer(0x0000);
    EXPECT_EQ(d.out.error_code, 72);
    EXPECT_EQ(d.answer(0x0080), 0x02B8);
    EXPECT_EQ(d.out.error_code, 12);
    d.answer(0x0000);
    EXPECT_EQ(d.answer(0x0080), 0x0270);
    EXPECT_EQ(d.out.error_code, 0);
}

// 7.2, alarm 44: while enabled the bus goes to a state that is not OP.
TEST(TsvmAlarm, LeavingOpWhileEnabledIs44) {
    Drive d;
    d.to_enabled();
    d.axis.left_operational();
    d.cycle();
    EXPECT_EQ(d.out.error_code, 44);

    Drive off;
    off.axis.left_operational();
    off.cycle();
    EXPECT_EQ(off.out.error_code, 0);
}

// 7.2, alarm 29 with PA30 = 160 % and PA31 = 3000 ms: a jam takes all the torque there is.
TEST(TsvmAlarm, MoreTorqueThanPa30ForPa31Is29) {
    Drive d;
    d.to_enabled();
    d.run(110);
    d.axis.jam(true);
    for (int i = 0; i < 400; ++i) {
        d.in.target_position += 50;
        d.cycle();
    }
    d.run(2500);
    EXPECT_EQ(d.out.error_code, 0);
    d.run(500);
    EXPECT_EQ(d.out.error_code, 29);
}

// 5.3.1: motion commands at least 100 ms after Operation enabled.
TEST(TsvmEnabling, SetPointsOfTheFirst100MsAreLost) {
    Drive d;
    d.to_enabled();
    d.in.target_position += 400;
    d.run(95);
    EXPECT_EQ(d.out.position, 0);
    EXPECT_GT(d.axis.early_commands(), 0u);
    Drive patient;
    patient.to_enabled();
    patient.run(110);
    for (int i = 0; i < 40; ++i) {
        patient.in.target_position += 10;
        patient.cycle();
    }
    patient.run(200);
    EXPECT_NEAR(static_cast<double>(patient.out.position), 400, 3);
    EXPECT_EQ(patient.axis.early_commands(), 0u);
}

}  // namespace
}  // namespace taktwerk::axes::sim
