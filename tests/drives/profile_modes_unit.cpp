// The profile modes and ways of stopping as the drives' own files describe them.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/drives/drive_desk.hpp"

namespace taktwerk::test {
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
    while (drive.position() < 12000) {
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

// SV-DA200 3.2.7: eight set-points wait behind the running one; CT-5 and CT-7: 10Fh stops and holds with 605Dh = -1, bit 10 at standstill, and
// clearing it does not go on.
TEST(SvDa200ProfilePosition, HaltHoldsAndForgets) {
    RunningDesk drive{"sv-da200"};
    drive.pdo(0x6060, 1);
    drive.pdo(0x6081, 20000);
    drive.pdo(0x6083, 100000);
    drive.enable();
    ASSERT_EQ(drive.sdo(0x605D, 0, -1), 0u);
    drive.pdo(0x607A, 50000);
    drive.control(0x1F);
    ASSERT_NE(drive.status() & acknowledged, 0u);
    drive.control(0x0F, 400);
    drive.control(0x10F, 200);
    EXPECT_NE(drive.status() & reached, 0u);
    EXPECT_EQ(drive.status() & 0x6Fu, 0x27u);
    const auto at = drive.position();
    drive.control(0x0F, 500);
    EXPECT_NEAR(static_cast<double>(drive.position()), static_cast<double>(at), 20);
    for (int i = 1; i <= 9; ++i) {
        drive.pdo(0x607A, at + 1000 * i);
        drive.control(0x1F);
        drive.control(0x0F);
        EXPECT_EQ((drive.status() & acknowledged) != 0, i == 9) << i;
    }
}

// CT-6: 0Bh stops at once and clamps; the drive stays in Quick Stop Active.
TEST(SvDa200Stops, QuickStopClamps) {
    RunningDesk drive{"sv-da200"};
    drive.pdo(0x6060, 3);
    drive.pdo(0x6083, 100000);
    drive.pdo(0x6084, 100000);
    drive.enable();
    drive.pdo(0x60FF, 20000);
    drive.run(400);
    const auto from = drive.position();
    drive.control(0x0B, 300);
    EXPECT_EQ(drive.status() & 0x6Fu, 0x07u);
    EXPECT_LT(drive.position() - from, 500);  // 6084h would take 2000
}

}  // namespace
}  // namespace taktwerk::test
