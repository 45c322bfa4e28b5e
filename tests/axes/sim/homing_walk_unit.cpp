// Every homing method from every start, against tests/axes/sim/homing_walk.hpp. The same over the drives' own profiles:
// tests/config/drive_homing_unit.cpp.

#include <gtest/gtest.h>

#include "tests/axes/sim/homing_walk.hpp"

namespace taktwerk::axes::sim {
namespace {

using walk::fails;

struct WalkCase {
    walk::Row row;
    double start;
    friend void PrintTo(const WalkCase& c, std::ostream* out) { *out << "method " << c.row.method << " from " << c.start; }
};

std::vector<WalkCase> all() {
    std::vector<WalkCase> cases;
    for (const auto& row : walk::oracle)
        for (const double start : walk::starts) cases.push_back({row, start});
    return cases;
}

class HomingWalk : public ::testing::TestWithParam<WalkCase> {};

TEST_P(HomingWalk, EndsAtItsEdgeOrPulseAndSetsOutTheRightWay) {
    const auto& c = GetParam();
    const auto wanted = walk::expected(c.row, c.start);
    const auto seen = walk::home(walk::rail(c.start), {}, c.row.method);

    EXPECT_EQ(seen.way, wanted.way);
    // 6099h:01 and 609Ah bound the whole run (SV33-E 3.4.3(9)); a servo overshoots its ramp a little.
    EXPECT_LE(seen.fastest, walk::fast * 1.1);
    EXPECT_LE(seen.steepest, walk::acceleration * 1.3);
    EXPECT_FALSE(seen.faulted);
    EXPECT_EQ(seen.attained, wanted.end != fails);
    EXPECT_EQ(seen.error, wanted.end == fails);
    EXPECT_TRUE(seen.target_reached) << "it stands at the end";
    // One look of the drive (125 us) is a count at the slow speed, the actual position is whole.
    if (wanted.end != fails) {
        EXPECT_NEAR(seen.end, wanted.end, 2.0);
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, HomingWalk, ::testing::ValuesIn(all()));

// Without limit switches the mechanics end the search: first pulse on the way back. SV33-E tables 3-91, 3-92. Stops at -60000 and 60000.
TEST(HomingAgainstTheBlock, EndsAtTheFirstPulseOnTheWayBack) {
    for (const double start : {walk::left, walk::on, walk::right}) {
        auto plant = walk::rail(start);
        plant.negative_limit = -1e9;
        plant.positive_limit = 1e9;
        SimulatedMotor motor;
        motor.following_error_limit = 30000;
        const auto reverse = walk::home(plant, {}, -1, motor);
        EXPECT_EQ(reverse.way, '-');
        ASSERT_TRUE(reverse.attained);
        EXPECT_NEAR(reverse.end, -57000, 2.0);
        const auto forward = walk::home(plant, {}, -2, motor);
        EXPECT_EQ(forward.way, '+');
        ASSERT_TRUE(forward.attained);
        EXPECT_NEAR(forward.end, 53000, 2.0);
    }
}

TEST(HomingHere, GivesThePresentPlaceTheOffset) {  // method 35
    const auto seen = walk::home(walk::rail(walk::left), {}, 35);
    EXPECT_EQ(seen.way, '0');
    ASSERT_TRUE(seen.attained);
    EXPECT_NEAR(seen.end, walk::left, 2.0);
}

// SV33-E tables before 3-83 and 3-89, A.D35: "reserved"; 0 is no method either.
TEST(HomingMethods, ThoseThatDoNotExistAreAHomingErrorWithoutAMove) {
    for (const int method : {0, 15, 16, 31, 32, 36, 37, -3, -100, 100}) {
        const auto seen = walk::home(walk::rail(walk::on), {}, method);
        EXPECT_TRUE(seen.error) << method;
        EXPECT_FALSE(seen.attained) << method;
        EXPECT_EQ(seen.way, '0') << method;
    }
}

// A drive that documents 17 to 22 does not know 7.
TEST(HomingMethods, ThoseThatADriveDoesNotDocumentAreRefused) {
    DriveProfile profile;
    profile.homing_methods = {17, 18};
    EXPECT_TRUE(walk::home(walk::rail(walk::on), profile, 7).error);
    EXPECT_TRUE(walk::home(walk::rail(walk::on), profile, 18).attained);
}

// SV-DA200 5.3: Er25-6 "homing out of bounds", 603Fh FF00h, when a limit switch is hit.
TEST(HomingVariants, ALimitOnTheWayMayBeAFault) {
    DriveProfile profile;
    profile.homing_methods = {3, 19};
    profile.quirks = {Quirk::homing_limit_is_fault};
    DriveAlarmText row;
    row.code = 0xFF00;
    row.kind = DriveAlarmKind::homing_limit;
    profile.alarms = {row};
    const auto seen = walk::home(walk::rail(walk::right), profile, 19);
    EXPECT_TRUE(seen.faulted);
    EXPECT_EQ(seen.code, 0xFF00);
}

// SV-DA200 3.4.6: the table prints "negative" for 19, the text "like 3". As 21 of CiA 402 then: back onto the switch, forward off it.
TEST(HomingVariants, Method19MayStartInReverse) {
    DriveProfile profile;
    profile.homing_methods = {19};
    profile.quirks = {Quirk::homing_19_starts_negative};
    const auto seen = walk::home(walk::rail(walk::right), profile, 19);
    EXPECT_EQ(seen.way, '-');
    ASSERT_TRUE(seen.attained);
    EXPECT_NEAR(seen.end, 25000, 2.0);
}

}  // namespace
}  // namespace taktwerk::axes::sim
