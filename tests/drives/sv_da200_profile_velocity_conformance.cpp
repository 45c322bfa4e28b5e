// SV-DA200 guide 3.5.5, CT-10 of its sheet: profile velocity; and its twin of 3.6.5, CSV, in which the drive ramps all the same (CT-11).

#include "tests/drives/sv_da200.hpp"

namespace taktwerk::test::sv_da200_profile_velocity {
namespace {

class SvDa200Pv : public SvDa200 {
protected:
    SvDa200Pv() : SvDa200(long_table()) {}
    void ramps(std::int64_t up, std::int64_t down) {
        pdo(0x6083, up);
        pdo(0x6084, down);
    }
    /// Milliseconds until the condition holds.
    template <typename Condition>
    int takes(Condition condition) {
        int cycles = 0;
        for (; cycles < 5000 && !condition(); ++cycles) run(1);
        return cycles;
    }
};

// 3.5.5 steps 1 to 4. 6083h leads away from standstill, 6084h back to it.
TEST_F(SvDa200Pv, TheDriveRampsBy6083hAnd6084h) {
    ramps(100'000, 50'000);
    enable_in(pv);
    EXPECT_TRUE(status_bit(12)) << "3.1.2: speed zero";
    pdo(0x60FF, 20'000);
    EXPECT_NEAR(takes([&] { return speed() >= 19'900; }), 200, 10) << "20000 / 100000 s";
    EXPECT_FALSE(status_bit(12));
    run(50);
    EXPECT_TRUE(status_bit(10)) << "3.1.2: the given speed is reached";
    EXPECT_NEAR(static_cast<double>(read(0x606C)), 20'000, 100);

    pdo(0x60FF, 5'000);
    run(3);
    EXPECT_FALSE(status_bit(10));
    EXPECT_NEAR(takes([&] { return speed() <= 5'100; }), 297, 10) << "14900 / 50000 s, less the 3 ms before";

    pdo(0x60FF, -20'000);
    EXPECT_NEAR(takes([&] { return speed() <= -19'900; }), 300, 10) << "5000 / 50000 to standstill, then 20000 / 100000 s";
    pdo(0x60FF, 0);
    EXPECT_NEAR(takes([&] { return status_bit(12); }), 400, 10) << "20000 / 50000 s";
}

// 3.5.5 step 2: "0Fh enables, 0h disables". What 0h does to a turning motor is not stated; here it runs out (P4.30 has no printed values).
TEST_F(SvDa200Pv, ZeroInTheControlWordDisables) {
    ramps(100'000, 100'000);
    enable_in(pv);
    pdo(0x60FF, 20'000);
    run(400);
    control(0x00, 2);
    EXPECT_EQ(power_state(), 0x40u);
    EXPECT_EQ(read(0x6077), 0);
    EXPECT_GT(speed(), 15'000);
    run(100);
    EXPECT_NEAR(speed(), 0, 100);
    EXPECT_EQ(read(0x60FF), 20'000);
    enable_in(pv);
    EXPECT_GT(takes([&] { return speed() >= 10'000; }), 80) << "from standstill by the ramp again";
}

// 2.1 note 3, P4.25 = 0: rpm, and ms from standstill to the rated speed, 3000 rpm in the model: 600 ms for 3000 rpm are 300 ms for 1500.
TEST_F(SvDa200Pv, WithManufacturerUnitsRampsAreTimes) {
    ASSERT_EQ(sdo(0x2419, 0, 0), 0u);
    ramps(600, 1200);
    enable_in(pv);
    pdo(0x60FF, 1500);
    EXPECT_NEAR(takes([&] { return read(0x606C) >= 1495; }), 300, 10);
    pdo(0x60FF, 0);
    EXPECT_NEAR(takes([&] { return read(0x606C) <= 15; }), 594, 15) << "longer is gentler";

    ramps(0, 0);
    pdo(0x60FF, 1500);
    EXPECT_LT(takes([&] { return read(0x606C) >= 1400; }), 30) << "no time: at once, as far as the motor can";
}

// 3.6.2 steps 2 and 3, 3.6.5 step 4: in CSV "6083h, 6084h modify the acceleration and deceleration time" as in PV.
TEST_F(SvDa200Pv, InCsvTheDriveRampsOnTopOfTheMaster) {
    ramps(100'000, 50'000);
    enable_in(csv);
    ASSERT_EQ(read(0x6061), csv);
    pdo(0x60FF, 20'000);
    run(100);
    EXPECT_NEAR(speed(), 10'000, 600) << "a step of the master's, halfway up the drive's ramp";
    run(150);
    EXPECT_NEAR(speed(), 20'000, 200);
    pdo(0x60FF, 0);
    run(200);
    EXPECT_NEAR(speed(), 10'000, 600) << "and halfway down its slower one";
    run(250);
    EXPECT_NEAR(speed(), 0, 100);
}

// 3.6.1: what the master interpolates more gently than the ramps passes unchanged.
TEST_F(SvDa200Pv, InCsvAGentlerProfileOfTheMasterPasses) {
    ramps(1'000'000, 1'000'000);
    enable_in(csv);
    for (int v = 0; v <= 20'000; v += 100) {  // 100000 pulses/s2
        pdo(0x60FF, v);
        run(1);
        if (v > 8'000) {  // friction is overcome
            EXPECT_NEAR(speed(), v, 300) << v;
        }
    }
}

}  // namespace
}  // namespace taktwerk::test::sv_da200_profile_velocity
