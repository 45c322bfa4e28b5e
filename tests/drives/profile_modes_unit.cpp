// The profile modes and ways of stopping as the drives' own files describe them. SV-DA200: sv_da200_profile_position_conformance.cpp.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/drives/drive_desk.hpp"
#include "tests/patience.hpp"

namespace taktwerk::test::profile_modes {
namespace {

constexpr unsigned reached = 0x0400, acknowledged = 0x1000;

void profile(RunningDesk& drive, std::int64_t mode) {
    drive.pdo(0x6060, mode);
    drive.pdo(0x6081, 20000);
    drive.pdo(0x6083, 100000);
    drive.pdo(0x6084, 100000);
    drive.enable();
}

// SV33-E 3.4.3(5), 8.5.4: 6081h is 0 from the factory, so nothing moves although the set-point is acknowledged.
TEST(Sv33eProfilePosition, WithFactorySettingsNothingMoves) {
    RunningDesk drive{"sv33-e"};
    drive.pdo(0x6060, 1);
    drive.enable();
    drive.pdo(0x607A, 5000);
    drive.control(31, 300);
    EXPECT_NE(drive.status() & acknowledged, 0u);
    EXPECT_NEAR(static_cast<double>(drive.position()), 0, 1);
}

// SV33-E 8.5.4: 31 for an absolute target, 95 for a relative one.
TEST(Sv33eProfilePosition, AbsoluteBy31RelativeBy95) {
    RunningDesk drive{"sv33-e"};
    profile(drive, 1);
    drive.pdo(0x607A, 5000);
    drive.control(31);
    ASSERT_NE(drive.status() & acknowledged, 0u);
    drive.control(15);
    ASSERT_EQ(drive.status() & acknowledged, 0u);
    ASSERT_TRUE(drive.run_until([&] { return (drive.status() & reached) != 0; }, 2s));
    drive.pdo(0x607A, 3000);
    drive.control(95);
    drive.control(15);
    ASSERT_TRUE(drive.run_until([&] { return (drive.status() & reached) != 0; }, 2s));
    drive.run(200);
    EXPECT_NEAR(static_cast<double>(drive.position()), 8000, 5);
}

// SE-808X 3.2.4: bit 5 = 1 keeps the speed at the first target; 6081h, 6083h, 6084h are taken as they stand.
TEST(Se808xProfilePosition, BitFiveBlends) {
    RunningDesk drive{"se-808x"};
    profile(drive, 1);
    drive.pdo(0x607A, 8000);
    drive.control(0x1F);
    drive.control(0x0F);
    drive.pdo(0x607A, 16000);
    drive.control(0x3F);
    drive.control(0x0F);
    ASSERT_TRUE(drive.run_until([&] { return drive.position() >= 7000; }, 2s));
    std::int64_t slowest = 20000;
    for (Patience patience; patience.lasts(drive.position() < 12000);) {
        drive.cycle();
        slowest = std::min(slowest, drive.read(0x606C));
    }
    EXPECT_GT(slowest, 19500);
}

// SV33-E 3.1.8 table 3-18: halt with 605Dh = 1 ramps by 6084h in PV and keeps the position. v^2 / 2a = 2000 counts.
TEST(Sv33eStops, HaltInProfileVelocityRampsBy6084) {
    RunningDesk drive{"sv33-e"};
    profile(drive, 3);
    drive.pdo(0x60FF, 20000);
    drive.run(400);
    const auto from = drive.position();
    drive.control(0x10F, 600);
    EXPECT_NEAR(static_cast<double>(drive.position() - from), 2000, 100);
    EXPECT_EQ(drive.status() & 0x6Fu, 0x27u);
}

// SV33-E 3.1.8 table 3-17: 605Ah = 2 ramps by 6085h and lets go, 6 keeps the position; 605Ah takes 0 to 7 only (7.3).
TEST(Sv33eStops, QuickStopByItsOptionCode) {
    for (const int value : {2, 6}) {
        RunningDesk drive{"sv33-e"};
        profile(drive, 3);
        ASSERT_EQ(drive.sdo(0x605A, 0, value), 0u);
        EXPECT_NE(drive.sdo(0x605A, 0, 8), 0u);
        drive.pdo(0x6085, 200000);
        drive.pdo(0x60FF, 20000);
        drive.run(400);
        const auto from = drive.position();
        drive.control(0x02, 400);
        EXPECT_NEAR(static_cast<double>(drive.position() - from), 1000, 100) << value;
        EXPECT_EQ(drive.status() & 0x4Fu, value == 2 ? 0x40u : 0x07u);
    }
}

// CSV takes a set-point as it comes, whatever 6083h says (SV33-E: 100 counts/s2 from the factory, 7.3), unless the drive ramps by itself
// (SV-DA200 3.6.2: `csv_ramps`).
TEST(CyclicVelocity, OnlyADriveThatSaysSoRampsOnTopOfTheMaster) {
    struct Case {
        const char* drive;
        double after_100_ms;  // of a step to 20000 counts/s, with ramps of 100000 counts/s2
    };
    for (const auto& c : {Case{"sv33-e", 20000}, Case{"sv-da200", 10000}}) {
        RunningDesk drive{c.drive};
        ASSERT_EQ(drive.sdo(0x6083, 0, 100'000), 0u);
        ASSERT_EQ(drive.sdo(0x6084, 0, 100'000), 0u);
        drive.pdo(0x6060, 9);
        drive.enable();
        drive.pdo(0x60FF, 20000);
        drive.run(100);
        EXPECT_NEAR(drive.speed(), c.after_100_ms, 600) << c.drive;
        drive.run(200);
        EXPECT_NEAR(drive.speed(), 20000, 300) << c.drive;
        drive.pdo(0x60FF, 0);
        drive.run(100);
        EXPECT_NEAR(drive.speed(), 20000 - c.after_100_ms, 600) << c.drive;
    }
}

}  // namespace
}  // namespace taktwerk::test::profile_modes
