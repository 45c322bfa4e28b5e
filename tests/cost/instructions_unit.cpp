// What an axis costs in each cycle, as a number that is the same on every machine: the instructions of one axis and cycle, counted by
// Valgrind's callgrind in motion_cost (compiled with -O2 whatever the preset). Ten percent above what was counted when the bound was set;
// docs/performance.md says where they go.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

namespace taktwerk {
namespace {

/// What `command` says, both ways; empty when it cannot be run.
std::string said_by(const std::string& command) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe{popen((command + " 2>&1").c_str(), "r"), pclose};
    std::string text;
    std::array<char, 256> part{};
    while (pipe && std::fgets(part.data(), static_cast<int>(part.size()), pipe.get())) text += part.data();
    return text;
}

double number_behind(const std::string& text, const std::string& words) {
    const auto at = text.find(words);
    return at == std::string::npos ? 0 : std::strtod(text.c_str() + at + words.size(), nullptr);
}

/// Of one axis and cycle.
double instructions(const std::string& motion) {
    const auto text = said_by("valgrind --tool=callgrind --callgrind-out-file=/dev/null --collect-atstart=no --toggle-collect=counted " +
                              std::string{TAKTWERK_BINARY_DIR} + "/tests/motion_cost " + motion);
    const double collected = number_behind(text, "Collected : "), axes_and_cycles = number_behind(text, "axes and cycles: ");
    EXPECT_GT(axes_and_cycles, 0) << text;
    std::printf("%s: %.0f instructions per axis and cycle\n", motion.c_str(), collected / axes_and_cycles);
    return collected / axes_and_cycles;
}

class InstructionsOfAnAxis : public testing::Test {
protected:
    void SetUp() override {
        if (said_by("valgrind --version").find("valgrind-") == std::string::npos)
            GTEST_SKIP() << "no valgrind: instructions are not counted (Debian package valgrind)";
        if (said_by("test -x " + std::string{TAKTWERK_BINARY_DIR} + "/tests/motion_cost && echo there").empty())
            GTEST_SKIP() << "motion_cost is built by g++ without sanitizers only: another compiler makes other instructions";
    }
};

constexpr double room = 1.1;

// With MC_Power, MC_MoveAbsolute and MC_ReadStatus on a virtual drive, and the loop of the benchmark around them.
TEST_F(InstructionsOfAnAxis, ToAndFro) { EXPECT_LE(instructions("to_and_fro"), room * 570); }
// Without blocks, but for the call of MC_Power.
TEST_F(InstructionsOfAnAxis, Standing) { EXPECT_LE(instructions("standing"), room * 372); }
TEST_F(InstructionsOfAnAxis, AtVelocity) { EXPECT_LE(instructions("at_velocity"), room * 391); }
TEST_F(InstructionsOfAnAxis, Geared) { EXPECT_LE(instructions("geared"), room * 1043); }
TEST_F(InstructionsOfAnAxis, OnACam) { EXPECT_LE(instructions("on_a_cam"), room * 2773); }

}  // namespace
}  // namespace taktwerk
