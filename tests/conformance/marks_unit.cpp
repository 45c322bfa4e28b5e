// What is read as a mark, and what the verdict is over it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/conformance/report.hpp"

namespace taktwerk::conformance {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// The marks below stand in literals: this file itself shows nothing.
std::vector<std::string> found(const std::string& text) {
    std::vector<std::string> out;
    for (const auto& mark : marks_of({"tests/t_unit.cpp", text})) out.push_back(std::to_string(mark.clause) + " " + mark.test);
    return out;
}

TEST(Marks, AboveATestAndInsideIt) {
    EXPECT_THAT(found("// A rule. P1-7, P1-8\n"
                      "// and P1-9\n"
                      "TEST(A, One) {\n"
                      "    if (x) { y(); }  // P1-10\n"
                      "}\n"
                      "TEST_F(B, Two) { // P1-11\n}\n"
                      "TYPED_TEST(C,\n   Three) {}  // P1-12\n"),
                ElementsAre("7 A.One", "8 A.One", "9 A.One", "10 A.One", "11 B.Two", "12 C.Three"));
}

TEST(Marks, ARangeIsAllOfIt) {
    EXPECT_THAT(found("// P1-115..P1-117\nTEST(A, B) {}"), ElementsAre("115 A.B", "116 A.B", "117 A.B"));
    EXPECT_THAT(found("// P1-115..116, P1-3\nTEST(A, B) {}"), ElementsAre("115 A.B", "116 A.B", "3 A.B"));
}

TEST(Marks, OnlyCommentsCountAndOnlyNextToATest) {
    EXPECT_THAT(found("TEST(A, B) { say(\"P1-4\"); }"), IsEmpty());
    EXPECT_THAT(found("// P1-4\n\nTEST(A, B) {}\n"), ElementsAre("4 "));
    EXPECT_THAT(found("// P1-4\nstruct S {};\nTEST(A, B) {}\n"), ElementsAre("4 "));
    EXPECT_THAT(found("TEST(A, B) {} int x;  // what is P1-nnn\n"), IsEmpty());
}

Evidence sound() {
    return {{{1, "2.1", "13", "one", false}, {2, "2.1", "13", "two", false}, {3, "2.1", "13", "three", true}},
            {{{2}, "not built"}},
            {{3, "as we like", "README.md", "like"}},
            {{1, "A.B", "tests/t_unit.cpp", 1}}};
}

TEST(Verdict, EveryClauseIsSpokenOf) {
    EXPECT_THAT(problems_of(sound()), IsEmpty());
    EXPECT_THAT(page_of(sound()), HasSubstr("| 3 | 1 | 1 | 1 |"));

    auto silent = sound();
    silent.marks.clear();
    EXPECT_THAT(problems_of(silent), ElementsAre(HasSubstr("P1-001 (one) is shown by no test")));
    auto undecided = sound();
    undecided.decisions.clear();
    EXPECT_THAT(problems_of(undecided), ElementsAre(HasSubstr("P1-003 (three) leaves a choice")));
}

TEST(Verdict, WhatIsNotTrueIsNamed) {
    auto stale = sound();
    stale.marks.push_back({2, "A.C", "tests/t_unit.cpp", 9});
    EXPECT_THAT(problems_of(stale), ElementsAre(HasSubstr("P1-002 is shown by A.C")));
    auto unknown = sound();
    unknown.marks.push_back({4, "A.C", "tests/t_unit.cpp", 9});
    EXPECT_THAT(problems_of(unknown), ElementsAre(HasSubstr("tests/t_unit.cpp:9: there is no clause P1-004")));
    auto nowhere = sound();
    nowhere.marks.push_back({1, "", "tests/t_unit.cpp", 9});
    EXPECT_THAT(problems_of(nowhere), ElementsAre(HasSubstr("neither in a TEST")));
    auto disabled = sound();
    disabled.marks.push_back({1, "A.DISABLED_C", "tests/t_unit.cpp", 9});
    EXPECT_THAT(problems_of(disabled), ElementsAre(HasSubstr("is disabled")));
    auto twice = sound();
    twice.not_done.push_back({{2, 5}, "again"});
    EXPECT_THAT(problems_of(twice), ElementsAre(HasSubstr("twice"), HasSubstr("no clause P1-005")));
    auto free = sound();
    free.decisions.push_back({1, "d", "f", "w"});
    EXPECT_THAT(problems_of(free), ElementsAre(HasSubstr("P1-001 is no choice")));
}

TEST(Verdict, WhatIsShownByNowIsStruckFromTheList) {
    auto later = sound();
    later.not_done = {{{2, 3, 4, 6}, "not built"}, {{7}, "never"}};
    later.marks = {{3, "A.C", "tests/t_unit.cpp", 9}, {7, "A.C", "tests/t_unit.cpp", 9}};
    const auto left = parse_not_done(not_done_text(later)).entries;
    ASSERT_EQ(left.size(), 1u);
    EXPECT_THAT(left.front().clauses, ElementsAre(2, 4, 6));
}

TEST(Lists, ALineThatCannotBeReadIsNamed) {
    EXPECT_THAT(parse_not_done("# text\n1, 3..5 | why\nx | why\n").problems, ElementsAre(HasSubstr("line 3")));
    EXPECT_THAT(parse_not_done("1, 3..5 | why\n").entries.front().clauses, ElementsAre(1, 3, 4, 5));
    EXPECT_EQ(parse_clauses("1 | 2.1 | 13 | t | chioce\n").problems.size(), 1u);
    EXPECT_EQ(parse_decisions("1 | 2.1 | 13\n").problems.size(), 1u);
}

}  // namespace
}  // namespace taktwerk::conformance
