// The list of mutants is whole: every mistake still stands where it would be put, once. A mutant that is left behind by a change of the code
// would be noticed by nobody until somebody runs them all.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace taktwerk::architecture {
namespace {

std::string text_of(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

std::size_t times(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

/// "name: what is wrong", for a list in the format of tests/mutants/mutants.txt.
std::vector<std::string> left_behind(std::istream&& list, const std::string& root) {
    std::vector<std::string> problems;
    std::string name, file;
    for (std::string line; std::getline(list, line);) {
        const auto value = line.substr(std::min(line.size(), line.find(' ') + 1));
        if (line.starts_with("mutant ")) name = value;
        if (line.starts_with("file ")) file = value;
        if (!line.starts_with("from ")) continue;
        const auto found = times(text_of(root + "/" + file), value);
        if (found != 1) problems.push_back(name + ": its text stands " + std::to_string(found) + " times in " + file);
    }
    return problems;
}

TEST(Mutants, StandWhereTheyWouldBePut) {
    const auto path = std::string{TAKTWERK_SOURCE_DIR} + "/tests/mutants/mutants.txt";
    ASSERT_GT(times(text_of(path), "\nmutant "), 100u) << path;
    std::string all;
    for (const auto& problem : left_behind(std::ifstream(path), TAKTWERK_SOURCE_DIR)) all += problem + "\n";
    EXPECT_EQ(all, "");
}

TEST(Mutants, OneThatIsLeftBehindIsSeen) {
    const auto problems =
        left_behind(std::istringstream("mutant a\nfile README.md\nfrom nowhere at all in here\nto x\ntests y\n"), TAKTWERK_SOURCE_DIR);
    EXPECT_EQ(problems, std::vector<std::string>{"a: its text stands 0 times in README.md"});
}

}  // namespace
}  // namespace taktwerk::architecture
