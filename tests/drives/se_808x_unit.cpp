// What the SE-808X keeps, shows and sees, as its manual says: 2.3, 2.8, 4.2, 4.4, 5.1, 5.2, 6.

#include <gtest/gtest.h>

#include "tests/drives/drive_desk.hpp"

namespace taktwerk::test::se_808x_unit {
namespace {

constexpr std::int64_t save = 0x65766173, load = 0x64616F6C;                   // 4.2
constexpr std::uint32_t cannot_store = 0x08000020, device_state = 0x08000022;  // CiA 301 table 22

axes::sim::PlantConfig table() {
    axes::sim::PlantConfig plant;
    plant.counts_per_revolution = 10000;
    plant.negative_limit = -50000;
    plant.positive_limit = 50000;
    plant.home_from = 1000;
    plant.home_to = 2000;
    return plant;
}

class Se808x : public ::testing::Test {
protected:
    DriveDesk desk{"se-808x", table()};

    void enable(std::int64_t mode = 8) {
        desk.go_operational();
        desk.pdo(0x6060, mode);
        desk.run(2ms);
        desk.pdo(0x607A, desk.read(0x6064));
        desk.control({6, 7, 15});
        ASSERT_EQ(desk.power_state(), 0x27u);
    }
    /// Values that count from the next power-on.
    void store_and_restart(std::initializer_list<std::pair<std::uint8_t, std::int64_t>> parameters) {
        for (const auto& [sub, value] : parameters) ASSERT_EQ(desk.sdo(0x2000, sub, value), 0u);
        ASSERT_EQ(desk.sdo(0x1010, 1, save), 0u);
        desk.power_cycle();
    }
    void reset() { desk.control({0, 0x80, 0}); }
};

// 4.2, 4.3: Ro, Wo; ranges of 4.2 for mappings and assignments (0 to 4).
TEST_F(Se808x, ItsObjectsHaveTheAccessOfTheManual) {
    constexpr std::uint32_t write_only = 0x06010001, read_only = 0x06010002, too_high = 0x06090031;
    for (const std::uint16_t object : std::initializer_list<std::uint16_t>{0x6040, 0x6060, 0x6098})
        EXPECT_EQ(desk.upload_abort(object), write_only) << std::hex << object;
    for (const std::uint8_t sub : std::initializer_list<std::uint8_t>{1, 2, 4, 5, 6, 8, 9, 0xA, 0xB, 0xC, 0x20}) {
        EXPECT_EQ(desk.sdo(0x1C32, sub, 0), read_only) << int{sub};
        EXPECT_EQ(desk.sdo(0x1C33, sub, 0), read_only) << int{sub};
    }
    EXPECT_EQ(desk.sdo(0x6064, 0, 0), read_only);
    EXPECT_EQ(desk.sdo(0x1600, 0, 5), too_high);
    EXPECT_EQ(desk.sdo(0x1C12, 0, 5), too_high);
    EXPECT_EQ(desk.sdo(0x2000, 1, 71), too_high) << "4.4: 7 A at the most";
}

// 1.2: "shortest period 500 us". 0036h: invalid SYNC0 cycle (ETG.1000.6).
TEST_F(Se808x, ShorterCyclesThan500usAreRefused) {
    const auto verdict = [&](Duration cycle) {
        return desk.device.refuse(EsmState::preop, EsmState::safeop, {.sync0_active = true, .sync0_cycle = cycle});
    };
    EXPECT_EQ(verdict(250us), 0x0036);
    EXPECT_EQ(verdict(500us), 0);
}

// 6: write, save (1010h:01), then switch off and on.
TEST_F(Se808x, ParametersAreLostUnlessTheyAreSaved) {
    ASSERT_EQ(desk.sdo(0x2000, 1, 40), 0u);
    EXPECT_EQ(desk.read(0x2000, 1), 40);
    desk.power_cycle();
    EXPECT_EQ(desk.read(0x2000, 1), 10);
    store_and_restart({{1, 40}});
    EXPECT_EQ(desk.read(0x2000, 1), 40);
}

// 6, second to fifth step: the steps per revolution count after saving and switching off and on, and read back at once.
TEST_F(Se808x, StepsPerRevolutionCountAfterSavingAndSwitchingOffAndOn) {
    ASSERT_EQ(desk.sdo(0x2000, 2, 50000), 0u);
    EXPECT_EQ(desk.read(0x2000, 2), 50000);
    EXPECT_EQ(desk.axis().counts_per_revolution(), 10000) << "what it works with";
    desk.power_cycle();
    EXPECT_EQ(desk.read(0x2000, 2), 10000) << "never saved";
    EXPECT_EQ(desk.axis().counts_per_revolution(), 10000);
    store_and_restart({{2, 50000}});
    EXPECT_EQ(desk.axis().counts_per_revolution(), 50000);
    // The mechanics have not moved: the home switch, at 1000 of 10000, is at 5000 of 50000.
    EXPECT_DOUBLE_EQ(desk.axis().plant().config().home_from, 5000);
}

// 4.2: "write 0x65766173, and the drive saves all parameters": those of 6000h too. What is no parameter is not saved.
TEST_F(Se808x, SavingKeepsAllParametersAndNoCommand) {
    ASSERT_EQ(desk.sdo(0x6083, 0, 77777), 0u);
    ASSERT_EQ(desk.sdo(0x607A, 0, 1234), 0u);
    store_and_restart({{2, 20000}});
    EXPECT_EQ(desk.read(0x6083), 77777);
    EXPECT_EQ(desk.read(0x2000, 2), 20000);
    EXPECT_EQ(desk.read(0x607A), 0);
}

// 4.2. The manual does not say how a wrong signature is refused; CiA 301 7.5.2.13 does.
TEST_F(Se808x, NothingButTheSignatureSavesOrRestores) {
    ASSERT_EQ(desk.sdo(0x2000, 1, 40), 0u);
    for (const std::int64_t wrong : {load, std::int64_t{0}, std::int64_t{1}, save + 1}) EXPECT_EQ(desk.sdo(0x1010, 1, wrong), cannot_store);
    for (const std::int64_t wrong : {save, std::int64_t{0}, std::int64_t{1}, load - 1}) EXPECT_EQ(desk.sdo(0x1011, 1, wrong), cannot_store);
    EXPECT_EQ(desk.read(0x2000, 1), 40);
    desk.power_cycle();
    EXPECT_EQ(desk.read(0x2000, 1), 10);
    EXPECT_EQ(desk.sdo(0x1010, 1, save), 0u);
    EXPECT_EQ(desk.read(0x1010, 1), 0) << "section 6 prints 0";
}

// 4.2: 1011h restores the factory values. That they count from the next power-on is CiA 301 7.5.2.14.
TEST_F(Se808x, RestoredValuesCountFromTheNextPowerOn) {
    store_and_restart({{1, 40}, {2, 20000}});
    ASSERT_EQ(desk.sdo(0x1011, 1, load), 0u);
    EXPECT_EQ(desk.read(0x2000, 1), 40);
    desk.power_cycle();
    EXPECT_EQ(desk.read(0x2000, 1), 10);
    EXPECT_EQ(desk.read(0x2000, 2), 10000);
}

// 3.2.1 names the states in which parameters are changed; none of them has power in the motor.
TEST_F(Se808x, ParametersAreRefusedWhileTheMotorHasPower) {
    enable();
    EXPECT_EQ(desk.sdo(0x2000, 1, 40), device_state);
    EXPECT_EQ(desk.read(0x2000, 1), 10);
}

// 2.3: input 1 home, 2 reverse limit, 3 forward limit; 4.3: 60FDh bit 0 reverse (negative), bit 1 forward (positive) limit, bit 2 home. 4.4,
// 2000h:1A: bit x = 1 makes input x + 1 normally closed. The contacts here are open, away from every switch.
TEST_F(Se808x, PolarityTurnsTheInputThatItsBitNames) {
    EXPECT_EQ(desk.read(0x60FD), 0);
    const std::pair<int, int> rows[] = {{1, 4}, {2, 1}, {4, 2}, {7, 7}};  // polarity, 60FDh
    for (const auto& [polarity, inputs] : rows) {
        store_and_restart({{0x1A, polarity}});
        desk.run(5ms);
        EXPECT_EQ(desk.read(0x60FD), inputs) << polarity;
    }
}

// The same for homing: with a normally closed home switch and 2000h:1A = 1 the open contact is "on the switch".
TEST_F(Se808x, HomingSeesTheInputsAsTheirPolarityHasThem) {
    store_and_restart({{0x1A, 1}});
    ASSERT_EQ(desk.sdo(0x6098, 0, 21), 0u);  // active: forward, stops at the falling edge
    enable(6);
    desk.control(0x1F);
    desk.run(3s);
    EXPECT_NE(desk.status() & 0x1000, 0);
    // The contact closes at 1000; it has to stay closed for 1 ms [2.3], 10 pulses at 10000 pulses/s.
    EXPECT_NEAR(desk.axis().plant().position() - static_cast<double>(desk.read(0x6064)), 1000, 15);
}

// 4.4, 2001h:01: 6 enabled, 52 offline.
TEST_F(Se808x, ItsStateObjectTellsEnabledFromFree) {
    EXPECT_EQ(desk.read(0x2001, 1), 52);
    enable();
    EXPECT_EQ(desk.read(0x2001, 1), 6);
    desk.control(0);
    EXPECT_EQ(desk.read(0x2001, 1), 52);
}

// 4.4: 2001h:01 and :02; 5.1: all of them clear by a reset; 605Eh = 0: the motor is free.
TEST_F(Se808x, EachAlarmShowsInItsStateObjectAndIsReset) {
    struct Row {
        std::uint16_t code;
        int state;
    };
    const Row rows[] = {{0x5552, 7}, {0x7122, 8}, {0x3221, 9}, {0x3211, 10}, {0x5551, 11}, {0x8611, 12}, {0x7500, 14}};
    enable();
    for (const auto& row : rows) {
        desk.device.raise(0, row.code);
        desk.run(2ms);
        EXPECT_EQ(desk.read(0x603F), row.code);
        EXPECT_EQ(desk.read(0x2001, 1), row.state) << std::hex << row.code;
        EXPECT_EQ(desk.read(0x2001, 2), row.code);
        EXPECT_FALSE(desk.axis().powered());
        reset();
        EXPECT_EQ(desk.power_state(), 0x40u) << std::hex << row.code;
        EXPECT_EQ(desk.read(0x2001, 2), 0);
        desk.control({6, 7, 15});
    }
}

// 4.4: 2001h:0A to :0E are the history, :09 the place of the next record. That it is a ring and outlives power is ours.
TEST_F(Se808x, TheHistoryIsARingOfFive) {
    desk.go_operational();
    EXPECT_EQ(desk.read(0x2001, 9), 1);
    const std::uint16_t errors[] = {0x3221, 0x3211, 0x7122, 0x5551, 0x8311, 0x5553};
    for (const auto code : errors) {
        desk.device.raise(0, code);
        desk.run(2ms);
        reset();
    }
    const auto expect_records = [&] {
        EXPECT_EQ(desk.read(0x2001, 9), 2);
        EXPECT_EQ(desk.read(0x2001, 0xA), 0x5553) << "the sixth where the first was";
        for (std::uint8_t i = 1; i < 5; ++i) EXPECT_EQ(desk.read(0x2001, static_cast<std::uint8_t>(0xA + i)), errors[i]);
    };
    expect_records();
    desk.power_cycle();
    expect_records();
}

// 5.2: 7500h is a general, a SYNC or a watchdog error, told apart by 2001h:04. Its numbers are not printed: played as 1, 2, 3.
TEST_F(Se808x, TheWatchdogOfTheProcessDataIsACommunicationError) {
    enable();
    desk.device.outputs_lost(desk.now);
    desk.run(2ms);
    EXPECT_EQ(desk.read(0x603F), 0x7500);
    EXPECT_EQ(desk.read(0x2001, 4), 3);
}

// The same by a master that leaves OP with the motor enabled.
TEST_F(Se808x, LeavingOpWhileEnabledIsAGeneralCommunicationError) {
    enable();
    desk.enter(EsmState::preop);
    desk.run(2ms);
    EXPECT_EQ(desk.read(0x603F), 0x7500);
    EXPECT_EQ(desk.read(0x2001, 4), 1);
}

// 4.4, 2000h:19, "longest communication error", 3000; a time by its name, taken as ms.
TEST_F(Se808x, ASilentBusIsAnErrorAfter2000h19) {
    enable();
    desk.arrives = {.outputs = false, .sync0 = true};  // the cable is gone: its own clock goes on
    desk.run(2900ms);
    EXPECT_EQ(desk.read(0x603F), 0);
    desk.run(200ms);
    EXPECT_EQ(desk.read(0x603F), 0x7500);
    EXPECT_EQ(desk.read(0x2001, 1), 14);
}

TEST_F(Se808x, FramesWithoutSync0AreASyncErrorAndWithoutDataAGeneralOne) {
    enable();
    desk.arrives = {.outputs = true, .sync0 = false};
    desk.run(3100ms);
    EXPECT_EQ(desk.read(0x603F), 0x7500);
    EXPECT_EQ(desk.read(0x2001, 4), 2);
    desk.arrives = {.outputs = true, .sync0 = true};
    desk.run(10ms);
    reset();
    EXPECT_EQ(desk.read(0x2001, 4), 0);
    desk.control({6, 7, 15});
    desk.arrives = {.outputs = false, .sync0 = true};
    desk.run(3100ms);
    EXPECT_EQ(desk.read(0x603F), 0x7500);
    EXPECT_EQ(desk.read(0x2001, 4), 1);
}

// 4.4: 2000h:14 = 20 V and 2000h:15 = 90 V from the factory. That an alarm stays while its cause does is not stated.
TEST_F(Se808x, TheSupplyIsWatchedByItsLimits) {
    enable();
    desk.device.supply_voltage(19);
    desk.run(2ms);
    EXPECT_EQ(desk.read(0x603F), 0x3221);
    reset();
    EXPECT_EQ(desk.read(0x603F), 0x3221);
    desk.device.supply_voltage(48);
    reset();
    EXPECT_EQ(desk.power_state(), 0x40u);

    desk.enter(EsmState::preop);
    store_and_restart({{0x15, 60}});
    enable();
    desk.device.supply_voltage(61);
    desk.run(2ms);
    EXPECT_EQ(desk.read(0x603F), 0x3211);
}

}  // namespace
}  // namespace taktwerk::test::se_808x_unit
