// The simulated SV-DA200 against the worked examples of its guide, object by object in virtual time: what the guide's section says
// stands beside each. The drive is that of config/drives/sv-da200.yaml; a cycle is 1 ms.

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "axes/sim/cia402_device.hpp"
#include "config/drive_loader.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::config {
namespace {

using namespace std::chrono_literals;
using ecat::sim::EsmState;

constexpr std::int64_t csp = 8, csv = 9, cst = 10, homing = 6;
constexpr std::uint16_t er24_c = 0x180C, er24_a = 0x180A, er22_0 = 0x1600, er21_0 = 0x1500, er21_1 = 0x1501;  // 5.1: main code, sub-code

const LoadedDrive& da200() {
    static const LoadedDrive loaded = std::get<LoadedDrive>(load_drive(std::string(TAKTWERK_SOURCE_DIR) + "/config/drives/sv-da200.yaml"));
    return loaded;
}

/// 10000 counts a turn; limit switches at -50000 and +50000, home switch from 0 to 5000; the motor stands at -20000.
axes::sim::PlantConfig table() {
    axes::sim::PlantConfig plant;
    plant.start = -20000;
    plant.negative_limit = -50000;
    plant.positive_limit = 50000;
    plant.home_to = 5000;
    plant.home_from = 0;
    return plant;
}

class SvDa200 : public ::testing::Test {
protected:
    explicit SvDa200(const axes::sim::PlantConfig& plant = table())
        : dictionary(*da200().device),
          device(*da200().profile, {{plant, axes::sim::personality_of(*da200().profile, plant.counts_per_revolution)}}) {
        start();
    }
    /// Control supply on and the bus up to OP, with SYNC0 each millisecond.
    void start() {
        device.power_on(dictionary, now);
        const ecat::sim::SyncSettings sync{.sync0_active = true, .sync0_cycle = 1ms, .output_bytes = 23, .input_bytes = 29};
        device.entered(EsmState::preop, now);
        ASSERT_EQ(device.refuse(EsmState::preop, EsmState::safeop, sync), 0);
        device.entered(EsmState::safeop, now);
        ASSERT_EQ(device.refuse(EsmState::safeop, EsmState::op, sync), 0);
        device.entered(EsmState::op, now);
        run(2);
    }
    void restart() {
        device.power_off(now);
        set(0x6040, 0);
        start();
    }

    /// Process data; parameters as an SDO does, so that the drive keeps them.
    void set(std::uint16_t index, std::int64_t value, std::uint8_t sub = 0) {
        dictionary.find(index, sub)->set(value);
        if (index < 0x6000) device.written(index, sub, now);
    }
    std::int64_t get(std::uint16_t index, std::uint8_t sub = 0) { return dictionary.value(index, sub); }
    /// As an SDO does.
    void write(std::uint16_t index, std::int64_t value, std::uint8_t sub = 0) {
        set(index, value, sub);
        device.written(index, sub, now);
    }
    std::uint16_t status() { return static_cast<std::uint16_t>(get(0x6041)); }
    bool status_bit(unsigned n) { return (status() >> n & 1) != 0; }
    /// 3.1.2: x01x0111 is Operation enabled, x0xx1000 Fault.
    bool enabled() { return (status() & 0x6F) == 0x27; }
    bool faulted() { return (status() & 0x4F) == 0x08; }

    /// `fresh`: frames arrive; else SYNC0 alone.
    void run(int cycles, bool fresh = true) {
        for (int i = 0; i < cycles; ++i) {
            now += 1ms;
            device.advance(now);
            if (each) each();
            device.exchange_due({.outputs = fresh, .sync0 = true});
            device.exchange(now);
        }
    }
    /// 3.3.4: mode, then 6 - 7 - 15 with the target at the actual position.
    void enable(std::int64_t mode) {
        set(0x6060, mode);
        set(0x607A, get(0x2025) == 0 ? 0 : get(0x6064));
        for (const int word : {6, 7, 15}) {
            set(0x6040, word);
            run(2);
        }
    }
    axes::sim::Cia402Axis& motor() { return device.axis(0); }
    double speed() { return motor().plant().velocity(); }

    ecat::sim::ObjectDictionary dictionary;
    axes::sim::Cia402Device device;
    Instant now{};
    std::function<void()> each;
};

// --- CT-0: commissioning [2.1] -----------------------------------------------------------------------------------------------------

TEST_F(SvDa200, ObeysTheBusOnlyWithP003At8AndThatFromARestartOn) {  // 2.1 item 1, note 1
    set(0x2003, 0);
    enable(csp);
    EXPECT_TRUE(enabled()) << "P0.03 counts from the restart on";
    restart();
    enable(csp);
    EXPECT_FALSE(enabled());
    EXPECT_EQ(get(0x6061), 0);

    set(0x2003, 8);
    restart();
    enable(csp);
    EXPECT_TRUE(enabled());
}

TEST_F(SvDa200, MonitorShowsTheStateOfTheBus) {  // 2.1 note 13
    EXPECT_EQ(get(0x301C), 18);
    device.entered(EsmState::safeop, now);
    EXPECT_EQ(get(0x301C), 14);
    device.entered(EsmState::preop, now);
    EXPECT_EQ(get(0x301C), 12);
    device.entered(EsmState::init, now);
    EXPECT_EQ(get(0x301C), 11);
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
    motor().main_power(false);
    run(1);
    EXPECT_FALSE(status_bit(4));
    motor().main_power(true);

    enable(csv);
    set(0x60FF, 50000);
    run(100);
    EXPECT_FALSE(status_bit(14));
    EXPECT_TRUE(status_bit(4) && status_bit(8));
}

// --- CT-8: CSP [3.3.2, 3.3.4] ----------------------------------------------------------------------------------------------------

TEST_F(SvDa200, CspFollowsAbsoluteTargets) {
    enable(csp);
    const auto from = get(0x6064);
    for (int i = 1; i <= 100; ++i) {
        set(0x607A, from + 20 * i);
        run(1);
    }
    run(100);
    EXPECT_NEAR(static_cast<double>(get(0x6064) - from), 2000, 5);
}

TEST_F(SvDa200, WithP037At0TheSameTargetIsAnIncrementEachCycle) {  // 3.3.2 step 3
    set(0x2025, 0);
    enable(csp);
    const auto from = get(0x6064);
    set(0x607A, 20);  // never changed: 20 counts a cycle
    run(100);
    set(0x607A, 0);
    run(100);
    EXPECT_NEAR(static_cast<double>(get(0x6064) - from), 2000, 5);
}

// --- CT-9: homing [3.4.4, 3.4.6] --------------------------------------------------------------------------------------------------

TEST_F(SvDa200, HomesToTheSwitchWhileBit4IsHeld) {
    set(0x6098, 19);
    set(0x6099, 20000, 1);
    set(0x6099, 2000, 2);
    set(0x609A, 200000);
    enable(homing);
    set(0x6040, 0x1F);
    for (int i = 0; i < 20'000 && !status_bit(12) && !status_bit(13); ++i) run(1);
    EXPECT_TRUE(status_bit(12));
    EXPECT_FALSE(status_bit(13));
    run(100);
    EXPECT_TRUE(status_bit(10)) << "3.1.2: homing complete";
    // The zero is the edge of the switch, at 0 of the table.
    EXPECT_NEAR(motor().plant().position() - static_cast<double>(get(0x6064)), 0, 20);
}

TEST_F(SvDa200, DroppingBit4AbortsTheHoming) {  // 3.4.2: 1 -> 0 aborts
    set(0x6098, 19);
    set(0x6099, 20000, 1);
    set(0x6099, 2000, 2);
    set(0x609A, 200000);
    enable(homing);
    set(0x6040, 0x1F);
    run(200);
    ASSERT_GT(speed(), 10000);
    set(0x6040, 0x0F);
    run(300);
    EXPECT_NEAR(speed(), 0, 100);
    EXPECT_FALSE(status_bit(12));
    EXPECT_TRUE(enabled());
}

TEST_F(SvDa200, Method35TakesThePlaceWhereItStands) {  // 3.4.6
    set(0x6098, 35);
    enable(homing);
    set(0x6040, 0x1F);
    run(20);
    EXPECT_TRUE(status_bit(12));
    EXPECT_NEAR(static_cast<double>(get(0x6064)), 0, 1);
}

// --- CT-11, CT-12: CSV, CST [3.6.5, 3.7.5] ----------------------------------------------------------------------------------------

TEST_F(SvDa200, VelocitiesAreCountsASecondOrRpmAsP425Says) {  // 2.1 note 3; 10000 counts a turn: note 4
    enable(csv);
    set(0x60FF, 20000);  // 2 turns/s
    run(500);
    EXPECT_NEAR(speed(), 20000, 200);
    EXPECT_NEAR(static_cast<double>(get(0x606C)), 20000, 200);

    set(0x60FF, 120);
    set(0x2419, 0);  // at once: note 1
    run(500);
    EXPECT_NEAR(speed(), 20000, 200) << "120 rpm are 2 turns/s";
    EXPECT_NEAR(static_cast<double>(get(0x606C)), 120, 2);
}

TEST_F(SvDa200, TorqueModeKeepsToTheSpeedOf607F) {  // 2.1 note 10
    set(0x607F, 30000);
    enable(cst);
    set(0x6071, 300);
    run(2000);
    EXPECT_GT(speed(), 20000);
    EXPECT_LT(speed(), 31000);
}

TEST_F(SvDa200, AZeroIn607FIsIgnoredOrHoldsTheMotorAsP443Says) {  // 2.1 note 8 bit 1, note 10
    set(0x607F, 0);
    enable(cst);
    set(0x6071, 300);
    run(1000);
    EXPECT_GT(speed(), 50000) << "masked: nothing limits the speed";

    set(0x242B, 0x0001);
    run(2000);
    EXPECT_NEAR(speed(), 0, 500) << "not masked: a limit of zero";
}

TEST_F(SvDa200, TheTorqueOffsetCountsInAllModesButThoseOfTorque) {  // 4.10
    enable(cst);
    set(0x60B2, 300);
    run(500);
    EXPECT_NEAR(speed(), 0, 100);
}

// --- CT-13: touch probe [3.8] -----------------------------------------------------------------------------------------------------

class SvDa200Probe : public SvDa200 {
protected:
    static axes::sim::PlantConfig plant() {
        auto p = table();
        p.probe[0] = {-15000, -14000, 0};
        p.probe[1] = {-12000, -11000, 0};
        return p;
    }
    SvDa200Probe() : SvDa200(plant()) {}
    void drive_to(double place) {  // of the plant
        const auto target = get(0x607A) + static_cast<std::int64_t>(place - motor().plant().position());
        const auto step = target > get(0x607A) ? 20 : -20;
        while (std::abs(target - get(0x607A)) > 20) {
            set(0x607A, get(0x607A) + step);
            run(1);
        }
        run(50);
    }
};

TEST_F(SvDa200Probe, LatchesTheRisingEdgeOfItsInput) {  // 3.8.3: 0011h
    enable(csp);
    set(0x60B8, 0x0011);
    run(2);
    EXPECT_EQ(get(0x60B9) & 1, 1);
    drive_to(-13000);
    EXPECT_EQ(get(0x60B9) & 7, 3);
    EXPECT_NEAR(static_cast<double>(get(0x60BA)), 5000, 1) << "5000 counts from -20000, where it counted 0";
}

TEST_F(SvDa200Probe, AnInputWithAFunctionIsNoProbe) {  // 3.8.1: P3.00 = 0, from a restart on
    set(0x2300, 1);
    enable(csp);
    set(0x60B8, 0x0011);
    run(2);
    EXPECT_EQ(get(0x60B9) & 1, 1) << "until the restart";
    set(0x60B8, 0);
    restart();
    enable(csp);
    set(0x60B8, 0x0011);
    run(2);
    drive_to(-13000);
    EXPECT_EQ(get(0x60B9) & 7, 0);
}

TEST_F(SvDa200Probe, TheIndexPulseIsLatchedUnlessP425Is3) {  // 3.8.3: 0015h; 2.1 note 3
    enable(csp);
    set(0x60B8, 0x0015);
    run(2);
    drive_to(-5000);
    EXPECT_EQ(get(0x60B9) & 3, 3);
    set(0x60B8, 0);
    set(0x2419, 3);
    run(2);
    set(0x60B8, 0x0015);
    run(2);
    drive_to(8000);
    EXPECT_EQ(get(0x60B9) & 3, 0);
}

TEST_F(SvDa200Probe, InContinuousModeBit6TogglesWithEachLatch) {  // 3.8.3
    enable(csp);
    set(0x60B8, 0x0013);
    run(2);
    drive_to(-14500);
    const auto first = get(0x60B9) >> 6 & 1;
    drive_to(-16000);
    drive_to(-14500);
    EXPECT_NE(get(0x60B9) >> 6 & 1, first);
}

TEST_F(SvDa200Probe, TheInputsStandInAnotherPlaceWithP425At2) {  // 4.6
    enable(csp);
    drive_to(-14500);
    EXPECT_EQ(get(0x60FD) >> 16 & 0xFF, 0x01) << "DI1 is bit 16";
    set(0x2419, 2);
    run(1);
    EXPECT_EQ(get(0x60FD) >> 17 & 0x7F, 0x01) << "DI1 is bit 17, bit 16 the index pulse";
}

TEST_F(SvDa200, LimitsAndHomeAreBits0To2) {  // 4.6
    EXPECT_EQ(get(0x60FD) & 7, 0);
    enable(csv);
    set(0x60FF, 50000);
    for (int i = 0; i < 2000 && motor().plant().position() < 2000; ++i) run(1);
    EXPECT_EQ(get(0x60FD) & 7, 4);
}

// --- CT-14: the tunnel [4.9] -----------------------------------------------------------------------------------------------------

TEST_F(SvDa200, TheTunnelReadsAndWritesParameters) {
    set(0x2005, 123);
    write(0x4300, 0x200500, 1);  // P0.05, as the guide has it
    EXPECT_EQ(get(0x4300, 2), 123);
    EXPECT_EQ(get(0x4300, 3), 0) << "0: the value is valid";
    write(0x4300, 77, 2);
    EXPECT_EQ(get(0x4300, 3), 4) << "4: written";
    EXPECT_EQ(get(0x2005), 77);
}

TEST_F(SvDa200, TheTunnelReachesNeitherWhatIsNotThereNorWhatIsReadOnly) {
    write(0x4300, 0x607D01, 1);
    EXPECT_NE(get(0x4300, 3), 0);
    write(0x4300, 0x300000, 1);  // R0.00
    EXPECT_EQ(get(0x4300, 3), 0);
    write(0x4300, 5, 2);
    EXPECT_NE(get(0x4300, 3), 4);
}

// --- CT-15, CT-16: outputs [4.7, 4.8] --------------------------------------------------------------------------------------------

TEST_F(SvDa200, TheBusSetsTheOutputsOnlyWithP428FromARestartOn) {
    set(0x60FE, 1 << 16, 1);
    run(1);
    EXPECT_EQ(device.behaviour(0).digital_outputs(), 0u);
    set(0x241C, 1);
    run(1);
    EXPECT_EQ(device.behaviour(0).digital_outputs(), 0u) << "P4.28 counts from the restart on (2.1 note 1)";
    restart();
    set(0x60FE, 1 << 16, 1);  // a command: gone with the power
    run(1);
    EXPECT_EQ(device.behaviour(0).digital_outputs(), 1u) << "bit 16 is DO1";
}

TEST_F(SvDa200, AnAnalogueOutputIsTheValueDividedByItsGain) {
    set(0x231F, 10);
    set(0x4100, 1);
    run(1);
    EXPECT_EQ(get(0x3108), 100) << "1 with a gain of 10 is 0.1 V";
    set(0x231E, 3);
    run(1);
    EXPECT_EQ(get(0x3108), 0) << "P3.30 gives the output to the drive";
}

// --- CT-17: torque limits of zero [2.1 notes 8 and 9] --------------------------------------------------------------------------------

TEST_F(SvDa200, TorqueLimitsOfZeroAreIgnoredUntilP443OrOmronUnitsSayOtherwise) {
    set(0x60E0, 0);
    set(0x60E1, 0);
    const auto moves = [&] {
        enable(csv);
        set(0x60FF, 20000);
        run(300);
        const bool moved = speed() > 10000;
        set(0x60FF, 0);
        set(0x6040, 6);
        run(3000);
        return moved;
    };
    EXPECT_TRUE(moves()) << "P4.43 bit 0 is 1 from the factory";
    set(0x242B, 0x0002);
    EXPECT_FALSE(moves());
    set(0x242B, 0x0003);
    set(0x2419, 2);
    EXPECT_FALSE(moves()) << "CIA402 OMRON never masks";
    for (const int limit : {0x6072, 0x60E0, 0x60E1}) set(static_cast<std::uint16_t>(limit), 1000);
    EXPECT_TRUE(moves());
}

TEST_F(SvDa200, ATorqueLimitHoldsInItsDirectionOnly) {  // 2.1 note 9: 0.1 % of rated, in all modes
    set(0x60E0, 10);                                    // 1 %: less than friction
    enable(csv);
    set(0x60FF, 20000);
    run(300);
    EXPECT_LT(speed(), 1000);
    set(0x60FF, -20000);
    run(300);
    EXPECT_LT(speed(), -10000);
}

// --- CT-18: communication [2.1 note 7, 5.2] ----------------------------------------------------------------------------------------

TEST_F(SvDa200, LostProcessDataAreAFaultOnlyWhileEnabled) {
    set(0x2409, 20);
    restart();
    run(100, false);
    EXPECT_FALSE(faulted()) << "watched after enabling only";
    enable(csp);
    run(15, false);
    EXPECT_FALSE(faulted());
    run(50, false);
    EXPECT_TRUE(faulted());
    EXPECT_EQ(get(0x603F), 0x8100);
    EXPECT_EQ(get(0x4000), er24_c);
}

TEST_F(SvDa200, WithoutSync0TheClockIsMissed) {  // Er24-a
    enable(csp);
    for (int i = 0; i < 50; ++i) {  // frames come, SYNC0 does not
        now += 1ms;
        device.advance(now);
        device.exchange_due({.outputs = true, .sync0 = false});
        device.exchange(now);
    }
    EXPECT_TRUE(faulted());
    EXPECT_EQ(get(0x603F), 0x8100);
    EXPECT_EQ(get(0x4000), er24_a);
}

TEST_F(SvDa200, GoesOnByTheLastIncrementForAsManyCyclesAsP427Says) {  // 2.1 note 7
    const auto coasting = [&](std::int64_t cycles) {
        set(0x241B, cycles);
        run(2);
        auto target = get(0x607A);
        for (int i = 0; i < 50; ++i) {
            set(0x607A, target += 20);
            run(1);
        }
        run(8, false);                                   // P4.09 is 10 ms
        const auto reached = get(0x60F4) + get(0x6064);  // following error and actual: the demand
        set(0x607A, target);
        run(1);
        run(200);
        return reached - target;
    };
    enable(csp);
    EXPECT_NEAR(static_cast<double>(coasting(0)), 0, 1);
    EXPECT_NEAR(static_cast<double>(coasting(3)), 60, 1) << "three cycles of 20 counts";
    EXPECT_NEAR(static_cast<double>(coasting(5)), 100, 1);
}

// --- Faults [5.3] ------------------------------------------------------------------------------------------------------------------

TEST_F(SvDa200, ALimitSwitchInAPositionModeIsAFault) {  // Er21
    enable(csp);
    auto target = get(0x607A);
    for (int i = 0; i < 5000 && !faulted(); ++i) {
        set(0x607A, target += 40);
        run(1);
    }
    EXPECT_TRUE(faulted());
    EXPECT_EQ(get(0x603F), 0x8500);
    EXPECT_EQ(get(0x4000), er21_0);

    // Away from the switch it may go again.
    set(0x6040, 0x80);
    run(2);
    set(0x6040, 0);
    run(2);
    enable(csp);
    target = get(0x607A);
    for (int i = 0; i < 500; ++i) {
        set(0x607A, target -= 40);
        run(1);
    }
    EXPECT_TRUE(enabled());
    for (int i = 0; i < 5000 && !faulted(); ++i) {
        set(0x607A, target -= 40);
        run(1);
    }
    EXPECT_EQ(get(0x4000), er21_1);
}

TEST_F(SvDa200, ALimitSwitchInAVelocityModeIsNone) {  // Er21: "position mode or full closed loop"
    enable(csv);
    set(0x60FF, 60000);
    for (int i = 0; i < 3000 && motor().plant().position() < 52000; ++i) run(1);
    run(10);
    EXPECT_TRUE(motor().plant().positive_limit());
    EXPECT_FALSE(faulted());
}

TEST_F(SvDa200, P433IsTheFollowingErrorThatTripsIt) {  // Er22-0
    set(0x2421, 1000);
    enable(csp);
    motor().jam(true);
    auto target = get(0x607A);
    for (int i = 0; i < 100 && !faulted(); ++i) {
        set(0x607A, target += 20);
        run(1);
    }
    EXPECT_TRUE(faulted());
    EXPECT_EQ(get(0x603F), 0x8611);
    EXPECT_EQ(get(0x4000), er22_0);
}

}  // namespace
}  // namespace taktwerk::config
