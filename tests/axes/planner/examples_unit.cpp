// The planner's tutorial: each program stands in docs/planner-tutorial.md as it is compiled, and prints what stands there behind it.

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace taktwerk::axes {
namespace {

const std::string tutorial_source = TAKTWERK_SOURCE_DIR;

std::string content_of(const std::string& path) {
    std::ifstream stream(path);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::set<std::string> tutorial_programs() {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(tutorial_source + "/axes/planner/examples"))
        if (entry.path().extension() == ".cpp") names.insert(entry.path().stem().string());
    return names;
}

std::string printed_by(const std::string& name) {
    std::string out;
    FILE* pipe = popen((std::string(TAKTWERK_BINARY_DIR) + "/axes/planner_examples/" + name).c_str(), "r");
    if (pipe == nullptr) return "cannot be started";
    char buffer[256];
    while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) out += buffer;
    EXPECT_EQ(pclose(pipe), 0) << name;
    return out;
}

class PlannerExample : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, PlannerExample, testing::ValuesIn(tutorial_programs()),
                         [](const auto& one) { return one.param.substr(one.param.find('_') + 1); });

TEST_P(PlannerExample, StandsInTheTutorialAndPrintsWhatStandsThere) {
    const auto page = content_of(tutorial_source + "/docs/planner-tutorial.md");
    const auto code = content_of(tutorial_source + "/axes/planner/examples/" + GetParam() + ".cpp");
    const auto at = page.find("[" + GetParam() + ".cpp](../axes/planner/examples/" + GetParam() + ".cpp)");
    ASSERT_NE(at, std::string::npos) << "the tutorial does not name it";
    const auto main = code.find("int main()");
    ASSERT_NE(main, std::string::npos);
    const auto expected = "\n\n```cpp\n" + code.substr(main) + "```\n\nprints\n\n```\n" + printed_by(GetParam()) + "```\n";
    const auto link_end = page.find(')', at) + 1;
    EXPECT_EQ(page.substr(link_end, expected.size()), expected);
}

TEST(PlannerExamples, AreSix) { EXPECT_EQ(tutorial_programs().size(), 6u); }

}  // namespace
}  // namespace taktwerk::axes
