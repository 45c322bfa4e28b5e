// Some minutes of what `./dev soak day` does for 24 hours: each alarm explained, each position exact, memory flat.

#include <gtest/gtest.h>

#include "tests/property_cases.hpp"
#include "tests/whole_machine/long_day.hpp"

namespace taktwerk::whole {
namespace {

class Soak : public ::testing::TestWithParam<const char*> {};

TEST_P(Soak, EachAlarmHasItsReasonAndEachPositionIsExact) {
    LongDay day{GetParam(), 2026};
    const auto minutes = static_cast<int>(property_cases(3));
    day.live(std::chrono::minutes{minutes}, std::chrono::minutes{1}, [](const LongDay::Hour&) {});
    const auto end = day.so_far();
    day.end();
    for (const auto& problem : day.problems()) ADD_FAILURE() << problem << "\n" << day.story();
    EXPECT_GT(end.troubles, 3 * minutes / 2);
    EXPECT_GT(end.alarms, 0);
    EXPECT_GT(end.compared, 1000) << "no axis at rest was compared with its drive";
    EXPECT_GT(end.references, 0) << "no axis was compared with its mechanics";
}

INSTANTIATE_TEST_SUITE_P(Machines, Soak, ::testing::Values("demo", "five-drives"),
                         [](const auto& machine) { return std::string(machine.param) == "demo" ? "Demo" : "FiveDrives"; });

}  // namespace
}  // namespace taktwerk::whole
