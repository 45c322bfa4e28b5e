#include "tests/architecture/one_name.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace taktwerk::architecture {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(OneName, EveryClassOfTheTreeStandsOnceInItsNamespace) {
    std::vector<SourceFile> all;
    for (const auto& level : floor_levels())
        for (const auto& floor : level)
            for (auto& file : read_sources(TAKTWERK_SOURCE_DIR, floor)) all.push_back(std::move(file));
    ASSERT_GT(all.size(), 1000u);
    EXPECT_THAT(check_names_stand_once(all), IsEmpty());
}

TEST(OneName, TwoOfOneNamespaceAreSeenWithBothPlaces) {
    EXPECT_THAT(
        check_names_stand_once({{"apps/a.hpp", "namespace t::apps {\n\nstruct Change {\n};\n}  // namespace t::apps\n"},
                                {"apps/b.hpp", "namespace t::apps {\nclass Change final : public Base {\n};\n}  // namespace t::apps\n"}}),
        ElementsAre(HasSubstr("t::apps::Change stands in apps/a.hpp:3 and in apps/b.hpp:2")));
}

TEST(OneName, OtherNamespacesUnnamedOnesDeclarationsAndSpecialisationsAreNone) {
    EXPECT_THAT(check_names_stand_once(
                    {{"a.hpp", "namespace t {\nstruct One {\n};\nstruct Two;\ntemplate <>\nstruct Three<int> {\n};\n}  // namespace t\n"},
                     {"b.hpp", "namespace t {\nnamespace {\nstruct One {\n};\n}  // namespace\nstruct Two {\n};\n}  // namespace t\n"},
                     {"c.hpp", "namespace u {\nstruct One {\n};\nstruct Three {\n};\n}  // namespace u\n"},
                     {"d.cpp", "namespace t {\nstruct Outer::One {\n};\n}  // namespace t\n"}}),
                IsEmpty());
}

}  // namespace
}  // namespace taktwerk::architecture
