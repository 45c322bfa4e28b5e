// Homing by the drive: every method of SV33-E manual 3.4.3(9) and SE-808X manual 3.2.7 from every start.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/axes/sim/axis_bench.hpp"

namespace taktwerk::axes::sim {
namespace {

constexpr double fast = 40000, slow = 4000, acceleration = 400000;
constexpr std::int64_t home_offset = 700;

enum class Ends { negative_edge, positive_edge, home_low, home_high, error };

constexpr double where(Ends ends) {
    switch (ends) {
        case Ends::negative_edge: return -50000;
        case Ends::positive_edge: return 50000;
        case Ends::home_low: return 0;
        case Ends::home_high: return 5000;
        case Ends::error: break;
    }
    return 0;
}

struct HomingCase {
    int method;
    double start;        // machine coordinate
    bool first_forward;  // which way it sets out
    Ends ends;
    friend void PrintTo(const HomingCase& c, std::ostream* out) { *out << "method " << c.method << " from " << c.start; }
};

// By hand from the tables: for each method left of the home switch, on it, right of it, at the negative and at the positive limit.
// "error": methods 19..22 that meet a limit before the home switch. Neither manual says what happens then; the simulated drive
// stops and reports a homing error, so that a machine that relies on more is found out.
class Homing : public ::testing::TestWithParam<HomingCase> {
protected:
    static PlantConfig at(double start) {
        auto plant = table();
        plant.start = start;
        return plant;
    }
    /// A servo hunts by a few counts around its place; it goes nowhere.
    static void expect_rest(Bench& b) {
        const double place = b.axis.plant().position();
        b.run(500);
        EXPECT_NEAR(b.axis.plant().position(), place, 5.0) << "it stands at the end";
    }
    void begin(Bench& b) {
        b.in.homing = {GetParam().method, fast, slow, acceleration};
        b.in.home_offset = home_offset;
        b.enable();
        b.in.mode = 6;
        b.run(3);
        ASSERT_EQ(b.out.mode, 6);
        b.in.control = 0x1F;
    }
};

TEST_P(Homing, EndsWhereTheTableSaysAndSetsOutTheRightWay) {
    const auto& c = GetParam();
    Bench b{at(c.start)};
    begin(b);
    const double before = b.axis.plant().position();
    double most = 0, steepest = 0, last = 0;
    bool set_out = false;
    for (int i = 0; i < 20000 && !(b.out.status & 0x3000u); ++i) {
        b.cycle();
        const double moved = b.axis.plant().position() - before;
        if (!set_out && std::abs(moved) > 20) {
            set_out = true;
            EXPECT_EQ(moved > 0, c.first_forward);
        }
        const double speed = b.axis.plant().velocity();
        most = std::max(most, std::abs(speed));
        steepest = std::max(steepest, std::abs(speed - last) / 1e-3);
        last = speed;
    }
    b.run(300);

    // 6099h:01 and 609Ah bound the whole run (SV33-E 3.4.3(9)); a servo overshoots its ramp a little.
    EXPECT_LE(most, fast * 1.1);
    EXPECT_LE(steepest, acceleration * 1.3);
    expect_rest(b);
    if (c.ends == Ends::error) {
        EXPECT_TRUE(b.out.status & (1u << 13));
        EXPECT_FALSE(b.out.status & (1u << 12));
        return;
    }
    ASSERT_TRUE(b.out.status & (1u << 12)) << "attained";
    EXPECT_TRUE(b.out.status & (1u << 10));
    EXPECT_FALSE(b.out.status & (1u << 13));
    // The edge has the coordinate of 607Ch (60E6h = 0): the actual position tells where it was taken. One inner step is half a count
    // at 4000 counts/s, five at 40000.
    const double edge = b.axis.plant().position() - static_cast<double>(b.out.position) + static_cast<double>(home_offset);
    EXPECT_NEAR(edge, where(c.ends), 8.0);
}

TEST_P(Homing, StopsWhenTheStartBitIsTakenBack) {
    Bench b{at(GetParam().start)};
    begin(b);
    b.run(40);
    b.command(0x000F, 300);
    expect_rest(b);
    EXPECT_FALSE(b.out.status & (1u << 12)) << "an aborted homing has found nothing";
}

INSTANTIATE_TEST_SUITE_P(Methods17To22, Homing,
                         ::testing::Values(
                             // 17: back to the negative limit switch, forward until it is left.
                             HomingCase{17, -20000, false, Ends::negative_edge}, HomingCase{17, 2500, false, Ends::negative_edge},
                             HomingCase{17, 20000, false, Ends::negative_edge}, HomingCase{17, -50500, true, Ends::negative_edge},
                             HomingCase{17, 50500, false, Ends::negative_edge},
                             // 18: its mirror.
                             HomingCase{18, -20000, true, Ends::positive_edge}, HomingCase{18, 2500, true, Ends::positive_edge},
                             HomingCase{18, 20000, true, Ends::positive_edge}, HomingCase{18, -50500, true, Ends::positive_edge},
                             HomingCase{18, 50500, false, Ends::positive_edge},
                             // 19: forward onto the home switch, back until it is left: its lower edge.
                             HomingCase{19, -20000, true, Ends::home_low}, HomingCase{19, 2500, false, Ends::home_low},
                             HomingCase{19, 20000, true, Ends::error}, HomingCase{19, -50500, true, Ends::home_low},
                             HomingCase{19, 50500, true, Ends::error},
                             // 20: forward until the home switch comes on: its lower edge.
                             HomingCase{20, -20000, true, Ends::home_low}, HomingCase{20, 2500, false, Ends::home_low},
                             HomingCase{20, 20000, true, Ends::error}, HomingCase{20, -50500, true, Ends::home_low},
                             HomingCase{20, 50500, true, Ends::error},
                             // 21: back onto the home switch, forward until it is left: its upper edge.
                             HomingCase{21, -20000, false, Ends::error}, HomingCase{21, 2500, true, Ends::home_high},
                             HomingCase{21, 20000, false, Ends::home_high}, HomingCase{21, -50500, false, Ends::error},
                             HomingCase{21, 50500, false, Ends::home_high},
                             // 22: back until the home switch comes on: its upper edge.
                             HomingCase{22, -20000, false, Ends::error}, HomingCase{22, 2500, true, Ends::home_high},
                             HomingCase{22, 20000, false, Ends::home_high}, HomingCase{22, -50500, false, Ends::error},
                             HomingCase{22, 50500, false, Ends::home_high}));

// SV33-E A.D35: "non-existent"; 35 and those with the index pulse are not simulated yet.
TEST(HomingRun, AnUnknownMethodIsAHomingError) {
    Bench b;
    b.in.homing = {15, fast, slow, acceleration};
    b.enable();
    b.in.mode = 6;
    b.run(3);
    b.command(0x1F);
    EXPECT_TRUE(b.out.status & (1u << 13));
    EXPECT_FALSE(b.out.status & (1u << 12));
}

// A machine whose limit switch is broken: the axis runs into its stop and the drive's own following error ends it.
TEST(HomingRun, AHardStopInsteadOfTheSwitchTripsTheFollowingError) {
    auto plant = table();
    plant.start = -40000;
    plant.negative_limit = -60000;
    plant.negative_stop = -50000;
    Personality p;
    p.following_error_limit = 5000;
    Bench b{plant, p};
    b.in.homing = {17, fast, slow, acceleration};
    b.enable();
    b.in.mode = 6;
    b.run(3);
    b.command(0x1F, 2000);
    EXPECT_EQ(b.out.error_code, 0x8611);
    EXPECT_FALSE(b.out.status & (1u << 12));
}

// SV33-E 3.4.3: while homing runs no other mode may be entered.
TEST(HomingRun, NoOtherModeIsEnteredWhileItRuns) {
    Bench b;
    b.in.homing = {18, fast, slow, acceleration};
    b.enable();
    b.in.mode = 6;
    b.run(3);
    b.command(0x1F, 100);
    b.in.mode = 8;
    b.run(10);
    EXPECT_EQ(b.out.mode, 6);
}

}  // namespace
}  // namespace taktwerk::axes::sim
