// SV33-E 3.4.4(2): "software limits are there in every mode. In a position mode whose target lies beyond, the motor goes to the end of the
// range; in other modes it stops in the chosen way when the actual position leaves it." 3.1.8 table 3-16: the ways, P04.15. 5.5: A.220.

#include "tests/drives/sv33_e.hpp"

namespace taktwerk::test::sv33_e_limit {
namespace {

constexpr std::int64_t turn = 131'072, pp = 1, pv = 3, pt = 4, csv = 9, cst = 10;
constexpr unsigned internal_limit = 1u << 11, warning = 1u << 7, acknowledged = 1u << 12, reached = 1u << 10;

class Sv33ELimits : public Sv33E {
protected:
    using Sv33E::Sv33E;

    /// P05.43 = 1, 607Dh from -2 to 2 turns; ramps of 100 turns/s2, a motor that may turn as fast as it likes.
    void begin(std::int64_t mode, std::int64_t switched = 1) {
        ASSERT_EQ(desk.sdo(0x2005, 0x2C, switched), 0u);
        ASSERT_EQ(desk.sdo(0x607D, 1, -2 * turn), 0u);
        ASSERT_EQ(desk.sdo(0x607D, 2, 2 * turn), 0u);
        for (const int ramp : {0x6083, 0x6084}) ASSERT_EQ(desk.sdo(static_cast<std::uint16_t>(ramp), 0, 100 * turn), 0u);
        ASSERT_EQ(desk.sdo(0x6081, 0, 5 * turn), 0u);
        map_and_start(mode);
        enable();
    }
    [[nodiscard]] double turns() { return static_cast<double>(desk.position()) / turn; }
    [[nodiscard]] bool stands() { return std::abs(desk.speed()) < 0.02 * turn; }
};

// --- position modes: the target is moved to the end of the range ------------------------------------------------------------------

TEST_F(Sv33ELimits, InPpATargetBeyondIsMovedToTheEnd) {
    begin(pp);
    desk.pdo(0x607A, 5 * turn);
    desk.control(31);
    EXPECT_NE(desk.status() & acknowledged, 0u);
    EXPECT_NE(desk.status() & internal_limit, 0u);
    desk.control(15);
    ASSERT_TRUE(desk.run_until([&] { return (desk.status() & reached) != 0; }, 2s));
    EXPECT_NEAR(turns(), 2, 0.01);
    EXPECT_EQ(desk.read(0x603F), 0) << "no fault, no warning";
    desk.pdo(0x607A, -9 * turn);  // relative: from the end it went to, to the other end
    desk.control(95);
    desk.control(15);
    ASSERT_TRUE(desk.run_until([&] { return (desk.status() & reached) != 0; }, 3s));
    EXPECT_NEAR(turns(), -2, 0.01);
    desk.pdo(0x607A, turn);
    desk.control(31);
    EXPECT_EQ(desk.status() & internal_limit, 0u);
}

// --- other modes: where the actual position leaves it, the drive stops ------------------------------------------------------------

class Sv33ELimitsInVelocityModes : public Sv33ELimits, public ::testing::WithParamInterface<std::int64_t> {};

// P04.15 = 1, the factory's: at zero speed, then position lock. From 5 turns/s the motor needs 3 x 1.27 N m on 2e-4 kg m2, 19050 rad/s2: 2 ms
// and less than a hundredth of a turn, and a cycle until it is seen.
TEST_P(Sv33ELimitsInVelocityModes, ItStopsBehindTheLimitAndHolds) {
    begin(GetParam());
    desk.pdo(0x60FF, 5 * turn);
    desk.run(1500);
    EXPECT_TRUE(stands());
    EXPECT_NEAR(turns(), 2.015, 0.015);
    EXPECT_EQ(desk.power_state(), 0x27u);
    EXPECT_NE(desk.status() & internal_limit, 0u);
    EXPECT_EQ(desk.read(0x603F), 0) << "A.220 is the switch's (5.5)";
    const double held = turns();
    desk.run(500);
    EXPECT_NEAR(turns(), held, 0.001);

    // The way back is free, and ends at the other limit.
    desk.pdo(0x60FF, -5 * turn);
    desk.run(200);
    EXPECT_LT(turns(), 1.9);
    EXPECT_EQ(desk.status() & internal_limit, 0u);
    desk.run(1500);
    EXPECT_NEAR(turns(), -2.015, 0.015);
}

TEST_P(Sv33ELimitsInVelocityModes, TheyAreOffFromTheFactory) {
    begin(GetParam(), 0);
    desk.pdo(0x60FF, 5 * turn);
    desk.run(1000);
    EXPECT_GT(turns(), 3);
}

// P05.43 = 2: "after homing". Method 35 makes this place 0.
TEST_P(Sv33ELimitsInVelocityModes, WithTwoTheyCountAfterHoming) {
    begin(6, 2);
    const auto run_up = [&] {
        desk.pdo(0x6060, GetParam());
        desk.run(5);
        desk.pdo(0x60FF, 5 * turn);
        desk.run(1000);
        desk.pdo(0x60FF, 0);
        desk.run(300);
    };
    run_up();
    EXPECT_GT(turns(), 3);
    ASSERT_EQ(desk.sdo(0x6098, 0, 35), 0u);
    desk.pdo(0x6060, 6);
    desk.run(5);
    desk.control(31, 50);
    ASSERT_NEAR(turns(), 0, 0.01);
    desk.control(15);
    run_up();
    EXPECT_NEAR(turns(), 2.015, 0.015);
}

INSTANTIATE_TEST_SUITE_P(PvAndCsv, Sv33ELimitsInVelocityModes, ::testing::Values(pv, csv));

class Sv33ELimitsInTorqueModes : public Sv33ELimits, public ::testing::WithParamInterface<std::int64_t> {};

TEST_P(Sv33ELimitsInTorqueModes, ItStopsBehindTheLimitAndHoldsAgainstTheTorque) {
    begin(GetParam());
    desk.pdo(0x607F, 5 * turn);  // as fast as that
    desk.pdo(0x6071, 300);
    desk.run(2000);
    EXPECT_TRUE(stands());
    EXPECT_NEAR(turns(), 2.015, 0.015);
    EXPECT_EQ(desk.power_state(), 0x27u);
    desk.pdo(0x6071, -300);
    desk.run(300);
    EXPECT_LT(turns(), 1.5);
}

INSTANTIATE_TEST_SUITE_P(PtAndCst, Sv33ELimitsInTorqueModes, ::testing::Values(pt, cst));

// Table 3-16: P04.15 = 0 stops freely and leaves the motor free, 2 stops at zero speed and leaves it free. A load that pulls outwards, 0.3 N m
// against 0.05 N m of friction, tells them from 1, which holds.
class Sv33EPulledOutwards : public Sv33ELimits {
protected:
    static axes::sim::PlantConfig load() {
        auto plant = sv33_e_motor();
        plant.load_torque = -0.3;
        return plant;
    }
    Sv33EPulledOutwards() : Sv33ELimits(load()) {}
    void run_into_the_limit(std::int64_t way) {
        ASSERT_EQ(desk.sdo(0x2004, 0x10, way), 0u);
        begin(csv);
        desk.pdo(0x60FF, 5 * turn);
        ASSERT_TRUE(desk.run_until([&] { return turns() > 2; }, 2s));
    }
};

TEST_F(Sv33EPulledOutwards, WithP0415At1ItIsStoppedAndHeld) {
    run_into_the_limit(1);
    ASSERT_TRUE(desk.run_until([&] { return stands(); }, 20ms));
    EXPECT_LT(turns(), 2.03);
    desk.run(1s);
    EXPECT_LT(turns(), 2.04);
}
TEST_F(Sv33EPulledOutwards, WithP0415At2ItIsStoppedAndLetGo) {
    run_into_the_limit(2);
    ASSERT_TRUE(desk.run_until([&] { return desk.speed() < 0.5 * turn; }, 20ms));
    EXPECT_LT(turns(), 2.03);
    desk.run(1s);
    EXPECT_GT(turns(), 10) << "1250 rad/s2 for a second, less what friction takes";
    EXPECT_EQ(desk.read(0x6077), 0);
}
TEST_F(Sv33EPulledOutwards, WithP0415At0ItIsLetGoAtOnce) {
    run_into_the_limit(0);
    desk.run(2);
    for (int i = 0; i < 100; ++i) {
        desk.run(1);
        EXPECT_EQ(desk.read(0x6077), 0);
        EXPECT_GT(desk.speed(), 5.0 * turn);
    }
}

// --- limit switches, 5.5: A.220 and A.221 in all modes --------------------------------------------------------------------------------

class Sv33ESwitches : public Sv33ELimits {
protected:
    static axes::sim::PlantConfig table() {
        auto plant = sv33_e_motor();
        plant.negative_limit = -1.0 * turn;
        plant.positive_limit = 1.0 * turn;
        return plant;
    }
    Sv33ESwitches() : Sv33ELimits(table()) {}
};

// "When both are there, the switch decides": here it comes first, and the warning tells.
TEST_F(Sv33ESwitches, InVelocityModeASwitchStopsAndWarns) {
    begin(csv);
    desk.pdo(0x60FF, 5 * turn);
    desk.run(1000);
    EXPECT_TRUE(stands());
    EXPECT_NEAR(turns(), 1.015, 0.015);
    EXPECT_EQ(desk.power_state(), 0x27u);
    EXPECT_NE(desk.status() & warning, 0u);
    EXPECT_EQ(desk.read(0x603F), 0x5443);
    EXPECT_EQ(desk.read(0x2021, 0x09), 0x220);
    // "Run in the other direction."
    desk.pdo(0x60FF, -5 * turn);
    desk.run(150);
    EXPECT_LT(turns(), 0.9);
    EXPECT_EQ(desk.read(0x603F), 0);
    desk.run(1000);
    EXPECT_NEAR(turns(), -1.015, 0.015);
    EXPECT_EQ(desk.read(0x603F), 0x5444);
}

TEST_F(Sv33ESwitches, InPpASwitchEndsTheMotionUntilAPointLeadsBack) {
    begin(pp, 0);
    desk.pdo(0x607A, 3 * turn);
    desk.control(31);
    desk.control(15, 1000);
    EXPECT_TRUE(stands());
    EXPECT_NEAR(turns(), 1.015, 0.015);
    EXPECT_EQ(desk.read(0x603F), 0x5443);
    desk.pdo(0x607A, 4 * turn);  // further out: not taken up
    desk.control(31);
    desk.control(15, 500);
    EXPECT_NEAR(turns(), 1.015, 0.02);
    desk.pdo(0x607A, 0);
    desk.control(31);
    desk.control(15, 1000);
    EXPECT_NEAR(turns(), 0, 0.01);
    EXPECT_EQ(desk.read(0x603F), 0);
}

}  // namespace
}  // namespace taktwerk::test::sv33_e_limit
