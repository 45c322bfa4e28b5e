// Every homing method of every drive, as its own file describes it, from every start: where the axis ends and which way it sets out, against
// the table in tests/axes/sim/homing_walk.hpp. The sets of methods are typed from the manuals.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/axes/sim/homing_walk.hpp"
#include "tests/config/loaded_drive.hpp"

namespace taktwerk::config {
namespace {

namespace walk = axes::sim::walk;

const std::map<std::string, std::set<int>>& documented() {
    static const std::map<std::string, std::set<int>> sets{
        // 3.4.3(9), tables 3-77 to 3-92; 15, 16, 31 and 32 are reserved, whatever 60E3h lists
        {"sv33-e",
         {-2, -1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 33, 34, 35}},
        {"sv-da200", {1, 2, 3, 4, 17, 18, 19, 20, 35}},  // 3.4.6
        {"tsvm-d6", {}},                                 // 5.4.1: homing "No"
        {"se-808x", {17, 18, 19, 20, 21, 22}},           // 3.2.7
        {"xp200", {}},                                   // no bus homing
    };
    return sets;
}

std::vector<std::string> drives_that_home() {
    std::vector<std::string> names;
    for (const auto& [name, methods] : documented())
        if (!methods.empty()) names.push_back(name);
    return names;
}

class DriveHoming : public ::testing::TestWithParam<std::string> {};

TEST_P(DriveHoming, KnowsTheMethodsOfItsManual) {
    const auto loaded = drive(GetParam());
    const auto& listed = loaded.profile->homing_methods;
    EXPECT_EQ((std::set<int>{listed.begin(), listed.end()}), documented().at(GetParam()));
}

TEST_P(DriveHoming, EndsWhereEachMethodSaysFromEveryStart) {
    const auto loaded = drive(GetParam());
    const auto& profile = *loaded.profile;
    // The one variant that changes the way: the table of SV-DA200 3.4.6 lets 19 set out in reverse, as 21 of CiA 402.
    const bool reverse_19 = loaded.profile->has(axes::Quirk::homing_19_starts_negative);
    const bool limit_is_fault = loaded.profile->has(axes::Quirk::homing_limit_is_fault);
    for (const int method : documented().at(GetParam())) {
        if (method == 35) continue;  // without a move
        const auto* row = walk::row(method == 19 && reverse_19 ? 21 : method);
        ASSERT_NE(row, nullptr) << method;
        for (const double start : walk::starts) {
            SCOPED_TRACE(testing::Message() << "method " << method << " from " << start);
            const auto wanted = walk::expected(*row, start);
            const auto seen = walk::home(walk::rail(start), profile, method);
            EXPECT_EQ(seen.way, wanted.way);
            EXPECT_EQ(seen.attained, wanted.end != walk::fails);
            EXPECT_EQ(seen.faulted, wanted.end == walk::fails && limit_is_fault);
            if (wanted.end == walk::fails) {
                EXPECT_TRUE(seen.error || seen.faulted);
            } else {
                EXPECT_NEAR(seen.end, wanted.end, 2.0);
            }
        }
    }
}

TEST_P(DriveHoming, RefusesWhatItsManualDoesNotList) {
    const auto loaded = drive(GetParam());
    const auto& profile = *loaded.profile;
    for (int method = -3; method <= 40; ++method) {
        if (documented().at(GetParam()).contains(method)) continue;
        const auto seen = walk::home(walk::rail(walk::on), profile, method);
        EXPECT_TRUE(seen.error || seen.faulted) << method;
        EXPECT_EQ(seen.way, '0') << method;
    }
}

INSTANTIATE_TEST_SUITE_P(Drives, DriveHoming, ::testing::ValuesIn(drives_that_home()));

// A drive without homing of its own says so, whatever 6060h is asked for.
TEST(DrivesWithoutHoming, ListNoMethod) {
    for (const char* name : {"tsvm-d6", "xp200"}) {
        const auto loaded = drive(name);
        EXPECT_FALSE(loaded.profile->alarms.empty()) << name << " was not read";
        EXPECT_TRUE(loaded.profile->homing_methods.empty()) << name;
    }
}

}  // namespace
}  // namespace taktwerk::config
