// Every trouble of the table, staged: it is said once, within two seconds, by its id, at its place, with its cause and its remedy, and nobody
// innocent is named. docs/troubles.md is what was said; TAKTWERK_REGENERATE=1 writes it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "tests/troubles/page.hpp"
#include "tests/troubles/trouble.hpp"

namespace taktwerk::troubles {

void PrintTo(const Said& said, std::ostream* out) { *out << said.id << " | " << said.place << " | " << said.cause << " | " << said.remedy; }
void PrintTo(const Trouble& trouble, std::ostream* out) { *out << trouble.name; }

namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using namespace std::chrono_literals;

/// Staged once for all tests of this process.
const std::vector<Said>& said_of(const Trouble& trouble) {
    static std::map<std::string_view, std::vector<Said>> known;
    const auto [at, fresh] = known.try_emplace(trouble.name);
    if (fresh) at->second = staged(trouble);
    return at->second;
}

class TroubleOf : public ::testing::TestWithParam<Trouble> {};

TEST_P(TroubleOf, IsNamedOnceWithItsCauseItsPlaceAndItsRemedy) {
    const Trouble& trouble = GetParam();
    if (!can_be_staged(trouble)) GTEST_SKIP() << "this system lets nobody make network namespaces or veth pairs";
    const auto& said = said_of(trouble);
    for (const auto& one : said) EXPECT_THAT(accused(trouble, one), IsEmpty()) << one.place << " | " << one.cause << " | " << one.remedy;
    ASSERT_THAT(said, SizeIs(1)) << "one trouble, one message";
    EXPECT_EQ(said[0].id, trouble.id);
    EXPECT_THAT(said[0].place, HasSubstr(trouble.place));
    EXPECT_THAT(said[0].cause, HasSubstr(trouble.cause));
    EXPECT_THAT(said[0].remedy, HasSubstr(trouble.remedy));
    EXPECT_FALSE(said[0].remedy.empty());
    EXPECT_LE(said[0].after, trouble.patience + 2s);
}

std::string test_name(const ::testing::TestParamInfo<Trouble>& info) {
    std::string name;
    bool capital = true;
    for (const char c : info.param.name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) capital = true;
        else name += static_cast<char>(std::exchange(capital, false) ? std::toupper(static_cast<unsigned char>(c)) : c);
    }
    return name;
}

INSTANTIATE_TEST_SUITE_P(All, TroubleOf, ::testing::ValuesIn(all_troubles()), test_name);

TEST(Troubles, AreManyAndEachHasANameAnIdAPlaceAndARemedy) {
    std::set<std::string_view> names;
    for (const auto& trouble : all_troubles()) {
        EXPECT_TRUE(names.insert(trouble.name).second) << trouble.name;
        EXPECT_FALSE(trouble.staged.empty() || trouble.id.empty() || trouble.place.empty() || trouble.cause.empty() ||
                     trouble.remedy.empty())
            << trouble.name;
        EXPECT_EQ(trouble.teller == Teller::alarm, trouble.strikes != nullptr) << trouble.name;
    }
    EXPECT_GE(names.size(), 95u);
}

// The test of the test: a slave whose name does not stand in the row, and a computer that was in time.
TEST(Accused, IsWhoeverTheRowDoesNotAllow) {
    const Trouble row{.name = "x", .staged = "x", .named = "b"};
    EXPECT_THAT(accused(row, {"", "slave 1 'b'", "its power", "check it", {}}), IsEmpty());
    EXPECT_THAT(accused(row, {"", "slave 1 'b'", "behind slave 0", "check 'c'", {}}), ::testing::ElementsAre("a", "c"));
    EXPECT_THAT(accused(row, {"", "", "this computer is late", "", {}}), ::testing::ElementsAre("this computer"));
    EXPECT_THAT(accused(row, {"", "", "or another master", "", {}}), SizeIs(::testing::Ge(1u)));
}

TEST(TroublesPage, IsWhatIsSaid) {
    for (const auto& trouble : all_troubles())
        if (!can_be_staged(trouble)) GTEST_SKIP() << "not all of it can be staged here: " << trouble.name;
    const std::string file = std::string{TAKTWERK_SOURCE_DIR} + "/docs/troubles.md";
    const std::string page = troubles_page(chapters(), said_of);
    if (std::getenv("TAKTWERK_REGENERATE") != nullptr) std::ofstream{file} << page;
    std::stringstream committed;
    committed << std::ifstream{file}.rdbuf();
    EXPECT_TRUE(committed.str() == page) << "TAKTWERK_REGENERATE=1 build/dev/tests/troubles_machine";
}

}  // namespace
}  // namespace taktwerk::troubles
