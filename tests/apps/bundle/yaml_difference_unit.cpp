// What differs between two versions of a YAML file, in words.

#include "apps/bundle/yaml_difference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace taktwerk::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(YamlDifference, NamesKeysWithTheirOldAndNewValues) {
    EXPECT_THAT(yaml_difference("a: 1\nlimits: { velocity: 200 mm/s, jerk: 5 }\nold: x\n",
                                "a: 1\nlimits: { velocity: 250 mm/s, jerk: 5 }\nmore: { b: [1, 2] }\n"),
                ElementsAre("limits.velocity: 200 mm/s -> 250 mm/s", "more: new, {b: [1, 2]}", "old: gone (x)"));
}

TEST(YamlDifference, CommentsSpacesAndTheOrderOfKeysAreNone) {
    EXPECT_THAT(yaml_difference("a: 1\nb: 2 # two\n", "# later\nb:   2\na: 1\n"), IsEmpty());
}

TEST(YamlDifference, ElementsWithNamesAreComparedByThem) {
    EXPECT_THAT(yaml_difference("s: [{name: x, p: a}, {name: y, p: b}]", "s: [{name: z, p: c}, {name: x, p: d}]"),
                ElementsAre("s[z]: new, {name: z, p: c}", "s[x].p: a -> d", "s[y]: gone ({name: y, p: b})"));
    EXPECT_THAT(yaml_difference("s: [{name: x}, {name: y}]", "s: [{name: y}, {name: x}]"), ElementsAre("s: in another order"))
        << "the order of slaves is that of the cable";
}

TEST(YamlDifference, OthersByTheirPlace) {
    EXPECT_THAT(yaml_difference("l: [1, 2, 3]", "l: [1, 4]"), ElementsAre("l[1]: 2 -> 4", "l[2]: gone (3)"));
}

TEST(YamlDifference, ATextInQuotesIsAnother) { EXPECT_THAT(yaml_difference("a: 1", "a: '1'"), ElementsAre("a: 1 -> 1")); }

TEST(YamlDifference, WhatIsNoYamlDiffersAsAWhole) {
    EXPECT_THAT(yaml_difference("a: [", "a: 1"), ElementsAre("the text is another one"));
    EXPECT_THAT(yaml_difference("a: [", "a: ["), IsEmpty());
}

TEST(YamlDifference, LongValuesAreCut) {
    const auto lines = yaml_difference("a: b", "a: " + std::string(1000, 'x'));
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_LT(lines[0].size(), 100u);
}

}  // namespace
}  // namespace taktwerk::apps
