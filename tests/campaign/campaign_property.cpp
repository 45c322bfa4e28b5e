// The fault campaign. One seed a cell by default, TAKTWERK_SOAK_FACTOR seeds in a long run (./dev soak). TAKTWERK_REGENERATE=1
// writes docs/fault-campaign.md. TAKTWERK_CAMPAIGN=KIND[:PHASE[:SEED]] runs a part.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/campaign/report.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::campaign {
namespace {

const std::string page = std::string{TAKTWERK_SOURCE_DIR} + "/docs/fault-campaign.md";

struct Part {
    std::string kind, phase, seed;
};

Part part_asked_for() {
    Part part;
    if (const char* asked = std::getenv("TAKTWERK_CAMPAIGN")) {
        std::istringstream words{asked};
        std::getline(words, part.kind, ':');
        std::getline(words, part.phase, ':');
        std::getline(words, part.seed, ':');
    }
    return part;
}

class Campaign : public ::testing::TestWithParam<std::size_t> {
protected:
    static inline Counts counts;
    static inline std::size_t seeds = 0;

    static void TearDownTestSuite() {
        if (std::getenv("TAKTWERK_REGENERATE") == nullptr) return;
        std::ofstream{page} << documented_part() << counted_part(counts, seeds);
    }
};

TEST_P(Campaign, EndsAsDocumentedInEveryPhase) {
    const auto kind = static_cast<FaultKind>(GetParam());
    const Part part = part_asked_for();
    if (!part.kind.empty() && part.kind != name(kind) && part.kind != "all") GTEST_SKIP();
    seeds = property_cases(1);
    for (std::size_t p = 0; p < phase_names.size(); ++p) {
        const auto phase = static_cast<Phase>(p);
        if (!part.phase.empty() && part.phase != name(phase)) continue;
        const std::uint32_t first = part.seed.empty() ? 1 : static_cast<std::uint32_t>(std::stoul(part.seed));
        const std::size_t count = part.seed.empty() ? seeds : 1;
        for (std::uint32_t seed = first; seed < first + count; ++seed) {
            const RunResult run = run_fault(kind, phase, seed);
            ++counts[{kind, phase}][static_cast<std::size_t>(run.end)];
            for (const auto& problem : run.problems)
                ADD_FAILURE() << name(kind) << " in " << name(phase) << ", seed " << seed << ": " << problem
                              << "\n  again: TAKTWERK_CAMPAIGN=" << name(kind) << ":" << name(phase) << ":" << seed
                              << " build/dev/tests/campaign_property\n  " << run.story;
            if (!part.seed.empty()) fmt::print("{}\n  ended: {}\n", run.story, end_names[static_cast<std::size_t>(run.end)]);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Faults, Campaign, ::testing::Range(std::size_t{0}, fault_names.size()),
                         [](const auto& kind) { return std::string{fault_names[kind.param]}; });

TEST(CampaignPage, ShowsTheEndsAsTheyAreDocumented) {
    if (std::getenv("TAKTWERK_REGENERATE") != nullptr) GTEST_SKIP();
    std::ifstream file{page};
    std::stringstream shown;
    shown << file.rdbuf();
    const std::string text = shown.str();
    EXPECT_EQ(text.substr(0, text.find(counted_heading)), documented_part())
        << "TAKTWERK_REGENERATE=1 TAKTWERK_SOAK_FACTOR=20 build/dev/tests/campaign_property";
}

}  // namespace
}  // namespace taktwerk::campaign
