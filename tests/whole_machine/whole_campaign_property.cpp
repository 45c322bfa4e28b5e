// The campaign over whole machines. 100 seeds in a test run, 5,000 with TAKTWERK_SOAK_FACTOR=50 (`./dev nightly`: 5,000 whatever its factor). A failure names its seed:
// TAKTWERK_WHOLE=SEED[:MACHINE[:TROUBLE]] runs that one alone and tells all that was done. TAKTWERK_WHOLE_FIRST=SEED begins there.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/property_cases.hpp"
#include "tests/whole_machine/documented.hpp"
#include "tests/whole_machine/loading.hpp"
#include "tests/whole_machine/whole_run.hpp"

namespace taktwerk::whole {
namespace {

const std::string page = std::string{TAKTWERK_SOURCE_DIR} + "/docs/whole-machine-campaign.md";

std::string title(const WholeRun& run) {
    std::string out = fmt::format("seed {}: {} while {}:", run.seed, run.machine, moment_names[static_cast<std::size_t>(run.moment)]);
    for (const auto trouble : run.troubles) out += fmt::format(" {}", name(trouble));
    return out;
}

TEST(WholeCampaign, EachRunEndsAsDocumented) {
    if (const char* asked = std::getenv("TAKTWERK_WHOLE")) {
        std::istringstream words{asked};
        std::string seed, machine, trouble;
        std::getline(words, seed, ':');
        std::getline(words, machine, ':');
        std::getline(words, trouble, ':');
        const auto run = run_whole(static_cast<std::uint32_t>(std::stoul(seed)), {.machine = machine, .trouble = trouble});
        fmt::print("{}\n{}", title(run), run.story);
        for (const auto& problem : run.problems) ADD_FAILURE() << problem;
        EXPECT_EQ(judged(run), "");
        return;
    }
    const char* first = std::getenv("TAKTWERK_WHOLE_FIRST");
    const auto begin = first ? static_cast<std::uint32_t>(std::stoul(first)) : 1u;
    const auto runs = static_cast<std::uint32_t>(property_cases(100));
    long commands = 0;
    AllCounted all;
    for (auto seed = begin; seed < begin + runs; ++seed) {
        const auto run = run_whole(seed);
        commands += run.commands;
        count(all, run);
        auto problems = run.problems;
        if (const auto other = judged(run); !other.empty()) problems.push_back(other);
        if (problems.empty()) continue;
        std::string said;
        for (const auto& problem : problems) said += "\n  " + problem;
        ADD_FAILURE() << title(run) << said << "\n again: TAKTWERK_WHOLE=" << seed << " build/dev/tests/whole_machine_property";
    }
    fmt::print("{} runs, {} commands\n", runs, commands);
    if (std::getenv("TAKTWERK_REGENERATE") != nullptr) std::ofstream{page} << documented_page() << counted_page(all, runs, commands);
}

// What is drawn seldom comes all the same: each trouble alone, upon a machine that works and has something of everything.
TEST(WholeCampaign, EachTroubleAloneEndsAsDocumented) {
    if (std::getenv("TAKTWERK_WHOLE") != nullptr || std::getenv("TAKTWERK_WHOLE_FIRST") != nullptr)
        GTEST_SKIP() << "other runs were asked for";
    for (const auto trouble : trouble_names) {
        const auto run = run_whole(7, {.machine = "five-drives", .trouble = trouble, .moment = Moment::running});
        ASSERT_EQ(run.troubles.size(), 1u) << trouble;
        for (const auto& problem : run.problems) ADD_FAILURE() << title(run) << ": " << problem << "\n" << run.story;
        EXPECT_EQ(run.end, WholeEnd::came_back) << title(run);
        EXPECT_EQ(judged(run), "") << title(run) << "\n" << run.story;
    }
}

TEST(WholeCampaign, ThePageSaysWhatIsDocumented) {
    if (std::getenv("TAKTWERK_REGENERATE") != nullptr) GTEST_SKIP();
    std::ifstream file{page};
    std::stringstream shown;
    shown << file.rdbuf();
    const auto text = shown.str();
    EXPECT_EQ(text.substr(0, text.find(runs_heading)), documented_page())
        << "TAKTWERK_REGENERATE=1 TAKTWERK_SOAK_FACTOR=50 build/dev/tests/whole_machine_property --gtest_filter='WholeCampaign*'";
}

}  // namespace
}  // namespace taktwerk::whole
