// docs/security.md names the test that shows each line: a name that nobody has any more would be a claim without a proof.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::set<std::string> tests_of(const fs::path& folder) {
    static const std::regex test(R"(\nTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\))");
    std::set<std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".cpp") continue;
        const auto text = text_of(entry.path());
        for (std::sregex_iterator at(text.begin(), text.end(), test), end; at != end; ++at)
            all.insert((*at)[1].str() + "." + (*at)[2].str());
    }
    return all;
}

std::set<std::string> named_on(const std::string& page) {
    static const std::regex name(R"(`([A-Z]\w+\.[A-Z]\w+)`)");
    std::set<std::string> all;
    for (std::sregex_iterator at(page.begin(), page.end(), name), end; at != end; ++at) all.insert((*at)[1].str());
    return all;
}

const fs::path root = TAKTWERK_SOURCE_DIR;

TEST(SecurityPage, EveryTestThatItNamesIsThere) {
    const auto there = tests_of(root / "tests");
    const auto named = named_on(text_of(root / "docs/security.md"));
    EXPECT_GT(named.size(), 40u);
    for (const auto& name : named) EXPECT_TRUE(there.contains(name)) << name;
    EXPECT_FALSE(there.contains("SecurityPage.NobodyHasThis")) << "what it looks into knows no such test";
}

TEST(SecurityPage, EveryFuzzTargetStandsInIt) {
    const auto page = text_of(root / "docs/security.md");
    std::size_t targets = 0;
    for (const auto& entry : fs::directory_iterator(root / "tests/fuzz")) {
        const auto name = entry.path().stem().string();
        if (!name.ends_with("_fuzz")) continue;
        ++targets;
        EXPECT_NE(page.find("`" + name.substr(0, name.size() - 5) + "`"), std::string::npos) << name;
    }
    EXPECT_GT(targets, 30u);
}

}  // namespace
