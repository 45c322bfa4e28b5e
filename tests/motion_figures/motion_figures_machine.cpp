// The pictures in docs/motion/figures/ are what the blocks do today: each is drawn again from a run and compared.
// TAKTWERK_REGENERATE=1 (`./dev figures`) writes them.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/motion_figures/scenes.hpp"

namespace taktwerk::figures {
namespace {

namespace fs = std::filesystem;
const fs::path pages = fs::path{TAKTWERK_SOURCE_DIR} / "docs/motion";

constexpr std::array all_scenes{moves,  endless_moves, stops,  buffer_modes,    superimposed, couplings, time_profiles,
                                torque, following,     homing, probes_and_cams, modulo,       by_hand,   groups};

std::string text_of(const fs::path& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

/// First of all, so that the tests below judge what is there then.
class Regeneration : public ::testing::Environment {
    void SetUp() override {
        if (std::getenv("TAKTWERK_REGENERATE") == nullptr) return;
        for (const auto scenes : all_scenes)
            for (const auto& figure : scenes()) std::ofstream{pages / "figures" / (figure.name + ".svg")} << svg(figure);
    }
};
const auto* const regeneration = ::testing::AddGlobalTestEnvironment(new Regeneration);

class Pictures : public ::testing::TestWithParam<std::vector<Figure> (*)()> {};

TEST_P(Pictures, ShowWhatTheBlocksDoToday) {
    for (const auto& figure : GetParam()()) {
        const auto file = pages / "figures" / (figure.name + ".svg");
        EXPECT_TRUE(text_of(file) == svg(figure)) << file << " is old: ./dev figures writes it; look at the difference";
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Pictures, ::testing::ValuesIn(all_scenes));

// Every picture stands on a page, and no page shows a picture that is not there.
TEST(MotionPages, ShowEachPictureOnce) {
    std::string text;
    for (const auto& entry : fs::directory_iterator(pages))
        if (entry.path().extension() == ".md") text += text_of(entry.path());
    std::set<std::string> files;
    for (const auto& entry : fs::directory_iterator(pages / "figures")) files.insert(entry.path().filename().string());
    for (const auto& file : files) EXPECT_NE(text.find("(figures/" + file + ")"), std::string::npos) << file << " is on no page";
    for (auto at = text.find("(figures/"); at != std::string::npos; at = text.find("(figures/", at + 1)) {
        const auto name = text.substr(at + 9, text.find(')', at) - at - 9);
        EXPECT_EQ(files.count(name), 1u) << name;
    }
}

// A tenth of a pixel at most is lost, and a straight line needs two points.
TEST(Simplified, KeepsWithinTheTolerance) {
    std::vector<double> y;
    for (int i = 0; i <= 400; ++i) y.push_back(i < 100 ? 0 : 50 * std::sin((i - 100) * 0.02));
    const auto kept = simplified(y, 1, 0.1);
    EXPECT_LT(kept.size(), 60u);
    EXPECT_EQ(kept.front(), 0u);
    EXPECT_EQ(kept.back(), 400u);
    for (std::size_t k = 1; k < kept.size(); ++k)
        for (std::size_t i = kept[k - 1]; i <= kept[k]; ++i) {
            const double part = static_cast<double>(i - kept[k - 1]) / static_cast<double>(kept[k] - kept[k - 1]);
            EXPECT_NEAR(y[i], y[kept[k - 1]] + part * (y[kept[k]] - y[kept[k - 1]]), 0.1 * std::hypot(1.0, 1.0) + 1e-9);
        }
    EXPECT_EQ(simplified(std::vector<double>(1000, 3.0), 1, 0.1).size(), 2u);
}

}  // namespace
}  // namespace taktwerk::figures
