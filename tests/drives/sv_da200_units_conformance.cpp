// SV-DA200 guide 2.1 note 3: what P4.25 makes of units, inputs and status word, at once (note 1).

#include "tests/drives/sv_da200.hpp"

namespace taktwerk::test::sv_da200_units {
namespace {

TEST_F(SvDa200, VelocitiesAreCountsASecondOrRpmAsP425Says) {  // 2.1 note 3; 10000 counts a turn: note 4
    enable_in(csv);
    pdo(0x60FF, 20000);  // 2 turns/s
    run(500);
    EXPECT_NEAR(speed(), 20000, 200);
    EXPECT_NEAR(static_cast<double>(read(0x606C)), 20000, 200);

    pdo(0x60FF, 120);
    for (const int ramp : {0x6083, 0x6084}) pdo(static_cast<std::uint16_t>(ramp), 0);  // ms
    ASSERT_EQ(sdo(0x2419, 0, 0), 0u);                                                  // at once: note 1
    run(500);
    EXPECT_NEAR(speed(), 20000, 200) << "120 rpm are 2 turns/s";
    EXPECT_NEAR(static_cast<double>(read(0x606C)), 120, 2);
}

// --- 6041h. "2: 6041h is changed to suit the state machine of Omron's NJ; 3: 6041h is changed", and no more than that. What is played is
// in `assumed` of the drive file: the cyclic modes show bit 12 as CiA 402-2 has it, and the "Standard" of 3 has none of the vendor's bits. ---

constexpr unsigned follows = 1u << 12, vendors = 1u << 8 | 1u << 14;

TEST_F(SvDa200, TheStatusWordOf312StandsWithP425At0And1) {
    for (const int unit : {0, 1}) {
        ASSERT_EQ(sdo(0x2419, 0, unit), 0u);
        enable_in(csp);
        EXPECT_EQ(status() & follows, 0u) << unit << ": 3.1.2 has bit 12 for PP, PV and homing only";
        EXPECT_EQ(status() & vendors, vendors) << unit << ": clock in step, zero speed";
        control(6);
    }
}

TEST_F(SvDa200, WithP425At2And3TheCyclicModesTellThatTheDriveFollows) {
    for (const int unit : {2, 3}) {
        ASSERT_EQ(sdo(0x2419, 0, unit), 0u);
        pdo(0x60E0, 1000);  // "has the torque limits by default": 2.1 note 9, they count
        pdo(0x60E1, 1000);
        pdo(0x6072, 1000);
        for (const auto mode : {csp, csv, cst}) {
            enable_in(mode);
            EXPECT_NE(status() & follows, 0u) << unit << ", " << mode;
            EXPECT_EQ(status() & 0x6Fu, 0x27u) << "the states are those of 3.1.2";
            control(7);
            EXPECT_EQ(status() & follows, 0u) << unit << ", " << mode << ": it follows nothing";
            control(6);
        }
        enable_in(pp);
        EXPECT_EQ(status() & follows, 0u) << "in PP it is the acknowledgement";
        control(6);
    }
}

TEST_F(SvDa200, WithP425At3TheVendorsBitsAreGoneAtOnce) {
    EXPECT_EQ(status() & vendors, vendors);
    ASSERT_EQ(sdo(0x2419, 0, 2), 0u);
    run(1);
    EXPECT_EQ(status() & vendors, vendors);
    ASSERT_EQ(sdo(0x2419, 0, 3), 0u);
    run(1);
    EXPECT_EQ(status() & vendors, 0u);
    EXPECT_TRUE(status_bit(4)) << "main power: a bit of CiA 402";
    EXPECT_TRUE(status_bit(9));
}

}  // namespace
}  // namespace taktwerk::test::sv_da200_units
