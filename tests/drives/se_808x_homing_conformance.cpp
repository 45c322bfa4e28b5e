// Homing of the SE-808X, manual 3.2.7: methods 17 to 22 from every start, which way, how fast, where it ends, and what the bits say. The
// manual prints the way and the edge of 19 to 22 only, their figures are lost: the rest has the shape of CiA 402. Bits 4, 10, 12 and 13 are
// those of CiA 402 too, for nothing is said of them.
//
//      reverse limit        home switch         forward limit
//   ....-50000]             [0 .. 4000]             [50000....

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>

#include "tests/drives/drive_desk.hpp"

namespace taktwerk::axes::sim::se_808x_homing {
namespace {

using taktwerk::test::RunningDesk;

using namespace std::chrono_literals;

constexpr double fast = 20000, slow = 2000, acceleration = 200000;
constexpr double left = -20000, on_switch = 2000, right = 20000, at_reverse_limit = -50100, at_forward_limit = 50100;
/// Not stated: a limit switch in its way ends the run with bit 13.
constexpr double fails = std::numeric_limits<double>::infinity();
constexpr unsigned reached = 0x0400, attained = 0x1000, error = 0x2000;

PlantConfig rail(double start) {
    PlantConfig plant;
    plant.counts_per_revolution = 10000;
    plant.negative_limit = -50000;
    plant.positive_limit = 50000;
    plant.home_from = 0;
    plant.home_to = 4000;
    plant.start = start;
    return plant;
}

struct Case {
    int method;
    double start;
    char way;        ///< it sets out: '+' forward, '-' in reverse, '0' not at all
    double fastest;  ///< on the whole way
    double end;      ///< the edge at which it stops
};

void PrintTo(const Case& row, std::ostream* out) { *out << "method " << row.method << " from " << row.start; }

// 3.2.7: 17 and 18 with their speeds as printed. 19 to 22: first way and edge as printed; a search that has to come back is made with the
// speed of the search (6099h:01), an edge that is met at once with the low one (6099h:02): not stated.
const Case cases[] = {
    {17, left, '-', fast, -50000},
    {17, on_switch, '-', fast, -50000},
    {17, right, '-', fast, -50000},
    {17, at_forward_limit, '-', fast, -50000},
    {17, at_reverse_limit, '+', slow, -50000},
    {18, left, '+', fast, 50000},
    {18, on_switch, '+', fast, 50000},
    {18, right, '+', fast, 50000},
    {18, at_reverse_limit, '+', fast, 50000},
    {18, at_forward_limit, '-', slow, 50000},
    // "active: reverse, inactive: forward; 19 stops at the falling edge"
    {19, left, '+', fast, 0},
    {19, on_switch, '-', slow, 0},
    {19, right, '+', fast, fails},
    {19, at_reverse_limit, '+', fast, 0},
    {19, at_forward_limit, '0', slow, fails},
    // "20 stops at the rising edge"
    {20, left, '+', slow, 0},
    {20, on_switch, '-', fast, 0},
    {20, right, '+', slow, fails},
    {20, at_reverse_limit, '+', slow, 0},
    {20, at_forward_limit, '0', slow, fails},
    // "active: forward, inactive: reverse; 21 stops at the falling edge"
    {21, left, '-', fast, fails},
    {21, on_switch, '+', slow, 4000},
    {21, right, '-', fast, 4000},
    {21, at_reverse_limit, '0', slow, fails},
    {21, at_forward_limit, '-', fast, 4000},
    // "22 stops at the rising edge"
    {22, left, '-', slow, fails},
    {22, on_switch, '+', fast, 4000},
    {22, right, '-', slow, 4000},
    {22, at_reverse_limit, '0', slow, fails},
    {22, at_forward_limit, '-', slow, 4000},
};

class Se808xHoming : public ::testing::TestWithParam<Case> {};

/// In homing mode, enabled, with the speeds above and an offset of 700.
void prepare(RunningDesk& drive, int method) {
    ASSERT_EQ(drive.sdo(0x6098, 0, method), 0u);
    ASSERT_EQ(drive.sdo(0x6099, 1, static_cast<std::int64_t>(fast)), 0u);
    ASSERT_EQ(drive.sdo(0x6099, 2, static_cast<std::int64_t>(slow)), 0u);
    ASSERT_EQ(drive.sdo(0x609A, 0, static_cast<std::int64_t>(acceleration)), 0u);
    ASSERT_EQ(drive.sdo(0x607C, 0, 700), 0u);
    drive.pdo(0x6060, 6);
    drive.enable();
    ASSERT_EQ(drive.read(0x6061), 6);
}

TEST_P(Se808xHoming, GoesTheWayOfTheManual) {
    const auto& row = GetParam();
    RunningDesk drive{"se-808x", rail(row.start)};
    prepare(drive, row.method);
    EXPECT_EQ(drive.status() & (attained | error), 0u);
    drive.control(0x1F, 1);
    char way = '0';
    double fastest = 0, last = 0;
    for (int i = 0; i < 60000 && (drive.status() & (attained | error)) == 0; ++i) {
        EXPECT_EQ(drive.status() & reached, 0u) << "bit 10 while it runs";
        drive.cycle();
        const auto speed = static_cast<double>(drive.read(0x606C));
        if (way == '0' && std::abs(speed) > 500) way = speed > 0 ? '+' : '-';
        fastest = std::max(fastest, std::abs(speed));
        EXPECT_LE(std::abs(speed - last), acceleration * 1e-3 + 1) << "609Ah";
        last = speed;
    }
    drive.run(200);
    EXPECT_EQ(way, row.way);
    EXPECT_EQ(drive.status() & (reached | attained | error), row.end == fails ? reached | error : reached | attained);
    EXPECT_EQ(drive.read(0x603F), 0) << "no alarm belongs to it [5.1]";
    EXPECT_EQ(drive.read(0x606C), 0);
    if (row.end == fails) return;
    EXPECT_NEAR(fastest, row.fastest, 0.001 * row.fastest);
    // 607Ch is the coordinate of home (CiA 402; the manual has its name only): the edge reads 700. A rising edge is seen 1 ms later, 2 pulses at
    // the low speed [2.3].
    const double edge = drive.axis().plant().position() - static_cast<double>(drive.position() - 700);
    EXPECT_NEAR(edge, row.end, 4);
}

INSTANTIATE_TEST_SUITE_P(Section327, Se808xHoming, ::testing::ValuesIn(cases), [](const auto& tested) {
    const auto& row = tested.param;
    const char* from = row.start == left               ? "FromTheLeft"
                       : row.start == on_switch        ? "FromTheSwitch"
                       : row.start == right            ? "FromTheRight"
                       : row.start == at_reverse_limit ? "FromTheReverseLimit"
                                                       : "FromTheForwardLimit";
    return "Method" + std::to_string(row.method) + from;
});

// 4.3: 6098h = 20, 6099h = 10000 and 10000, 609Ah = 30000 from the factory.
TEST(Se808xHomingSettings, AreThoseOfTheFactoryUntilTheyAreWritten) {
    RunningDesk drive{"se-808x", rail(-20000)};
    drive.pdo(0x6060, 6);
    drive.enable();
    drive.control(0x1F, 100);
    EXPECT_NEAR(static_cast<double>(drive.read(0x606C)), 3000, 100);  // 30000 pulses/s2 for 0.1 s
    ASSERT_TRUE(drive.run_until([&] { return (drive.status() & attained) != 0; }, 10s));
    EXPECT_NEAR(drive.axis().plant().position() - static_cast<double>(drive.position()), 0, 15);  // 1 ms at 10000 pulses/s
}

// "Supports six methods", 17 to 22: any other does not move it.
TEST(Se808xHomingSettings, NoOtherMethodIsKnown) {
    for (const int method : {0, 1, 2, 7, 14, 16, 23, 33, 35, -1}) {
        RunningDesk drive{"se-808x", rail(2000)};
        prepare(drive, method);
        drive.control(0x1F, 300);
        EXPECT_NE(drive.status() & error, 0u) << method;
        EXPECT_EQ(drive.status() & attained, 0u) << method;
        EXPECT_EQ(drive.position(), 0) << method;
    }
}

// Not stated how it is broken off: bit 4 away, as CiA 402 has it. The position stays what it was.
TEST(Se808xHomingSettings, WithoutBitFourItStopsAndIsNotHomed) {
    RunningDesk drive{"se-808x", rail(-20000)};
    prepare(drive, 19);
    drive.control(0x1F, 300);
    ASSERT_GT(drive.read(0x606C), 0);
    drive.control(0x0F, 300);
    EXPECT_EQ(drive.read(0x606C), 0);
    EXPECT_EQ(drive.status() & (attained | error), 0u);
    EXPECT_NEAR(drive.axis().plant().position() - static_cast<double>(drive.position()), -20000, 2);
}

// 2.3: a signal counts if it lasts longer than 1 ms. A switch of 30 pulses is passed in 0.75 ms at 40000 pulses/s, in 1.5 ms at 20000.
TEST(Se808xHomingSettings, AHomeSwitchThatIsPassedWithinAMillisecondIsNotSeen) {
    for (const auto& [speed, seen] : {std::pair{20000, true}, std::pair{40000, false}}) {
        auto plant = rail(-20000);
        plant.home_to = 30;
        RunningDesk drive{"se-808x", plant};
        prepare(drive, 19);
        ASSERT_EQ(drive.sdo(0x6099, 1, speed), 0u);
        drive.control(0x1F, 1);
        ASSERT_TRUE(drive.run_until([&] { return (drive.status() & (attained | error)) != 0; }, 20s));
        EXPECT_EQ((drive.status() & attained) != 0, seen) << speed;
    }
}

}  // namespace
}  // namespace taktwerk::axes::sim::se_808x_homing
