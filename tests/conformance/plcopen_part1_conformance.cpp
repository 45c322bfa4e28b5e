// docs/conformance/plcopen-part1.md says today's truth about the 314 clauses. TAKTWERK_REGENERATE=1 writes it, and strikes
// from not_done.txt what is shown by now.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "tests/conformance/report.hpp"

namespace taktwerk::conformance {
namespace {

const std::string root = TAKTWERK_SOURCE_DIR;
const std::string page = root + "/docs/conformance/plcopen-part1.md";

std::string text_of(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

template <class Entry>
std::vector<Entry> entries(Listed<Entry> (*parse)(std::string_view), const std::string& name) {
    const auto listed = parse(text_of(root + "/tests/conformance/" + name));
    for (const auto& problem : listed.problems) ADD_FAILURE() << name << ": " << problem;
    EXPECT_FALSE(listed.entries.empty()) << name;
    return listed.entries;
}

/// The folders whose tests are built: taktwerk_tests(FOLDER in the lists of the floors.
std::set<std::string> built_folders() {
    static const std::regex call(R"re(taktwerk_tests\(([\w/]+))re");
    std::set<std::string> folders;
    for (const char* floor :
         {"core", "ecat", "modbus", "axes", "fb_library", "programs", "runtime", "hmi_bridge", "config", "apps", "tests"}) {
        const std::string text = text_of(root + "/" + floor + "/CMakeLists.txt");
        for (std::sregex_iterator at(text.begin(), text.end(), call), end; at != end; ++at) folders.insert("tests/" + (*at)[1].str());
    }
    return folders;
}

bool is_test_source(const std::string& path) {
    static const std::regex name(R"re(.*_(unit|property|machine|conformance)\.cpp)re");
    return std::regex_match(path, name);
}

Evidence read_evidence() {
    Evidence all{entries(parse_clauses, "part1_clauses.txt"),
                 entries(parse_not_done, "not_done.txt"),
                 entries(parse_decisions, "decisions.txt"),
                 {}};
    for (const auto& file : architecture::read_sources(root, "tests")) {
        if (architecture::lies_in(file.path, "tests/conformance")) continue;  // speaks of marks, holds none
        if (file.text.find("P1-") == std::string::npos) continue;             // quick
        const auto marks = marks_of(file);
        all.marks.insert(all.marks.end(), marks.begin(), marks.end());
    }
    return all;
}

const Evidence& evidence() {
    static const Evidence all = read_evidence();
    return all;
}

/// First of all, so that the tests below judge the lists as they are then.
class Regeneration : public ::testing::Environment {
    void SetUp() override {
        if (std::getenv("TAKTWERK_REGENERATE") == nullptr) return;
        const auto left = not_done_text(read_evidence());
        std::ofstream{root + "/tests/conformance/not_done.txt"} << left;
        std::ofstream{page} << page_of(evidence());
    }
};
const auto* const regeneration = ::testing::AddGlobalTestEnvironment(new Regeneration);

TEST(PlcopenPart1, TheListIsWhole) {
    const auto clauses = entries(parse_clauses, "part1_clauses.txt");
    ASSERT_EQ(clauses.size(), 314u);
    for (std::size_t i = 0; i < clauses.size(); ++i) EXPECT_EQ(clauses[i].number, static_cast<int>(i) + 1);
}

TEST(PlcopenPart1, EveryClauseIsShownOrSaidToBeMissing) {
    for (const auto& problem : problems_of(evidence())) ADD_FAILURE() << problem;
}

TEST(PlcopenPart1, WhatShowsAClauseIsBuiltAndRun) {
    const auto folders = built_folders();
    for (const auto& mark : evidence().marks) {
        EXPECT_TRUE(is_test_source(mark.path)) << mark.path << ":" << mark.line << ": only *_KIND.cpp become test binaries";
        EXPECT_TRUE(folders.count(architecture::folder_of(mark.path)) == 1)
            << mark.path << ":" << mark.line << ": no taktwerk_tests() builds this folder";
    }
}

/// Whose axes are played by hand: what such a test expects of an axis, it says itself.
bool plays_the_axis(const std::string& text) {
    return text.find("fb_library/fake_axes.hpp") != std::string::npos || text.find("motion/one_block.hpp") != std::string::npos ||
           text.find("fb_library/block_rules.hpp") != std::string::npos;
}

TEST(PlcopenPart1, NoClauseOnMotionRestsOnPlayedAxesAlone) {
    // Of names, types and pins, which no axis has a say in; 50: no block of ours has an error that stays until Enable falls.
    const std::set<int> without_an_axis{1, 2, 3, 4, 9, 13, 50, 98};
    std::set<int> shown, on_an_axis;
    for (const auto& mark : evidence().marks) {
        shown.insert(mark.clause);
        if (!plays_the_axis(text_of(root + "/" + mark.path))) on_an_axis.insert(mark.clause);
    }
    ASSERT_GT(on_an_axis.size(), 200u);
    for (const int clause : shown)
        EXPECT_TRUE(on_an_axis.count(clause) == 1 || without_an_axis.count(clause) == 1)
            << "P1-" << clause << ": every test that names it plays the axis by hand";
}

TEST(PlcopenPart1, DecisionsStandWhereTheyAreSaidToStand) {
    for (const auto& decision : evidence().decisions)
        EXPECT_NE(text_of(root + "/" + decision.file).find(decision.words), std::string::npos)
            << "P1-" << decision.clause << ": '" << decision.words << "' is not in " << decision.file;
}

TEST(PlcopenPart1, ThePageSaysTodaysTruth) {
    EXPECT_TRUE(text_of(page) == page_of(evidence())) << "TAKTWERK_REGENERATE=1 build/dev/tests/conformance_conformance";
}

}  // namespace
}  // namespace taktwerk::conformance
