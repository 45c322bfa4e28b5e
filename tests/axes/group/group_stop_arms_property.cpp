// An interruption at any moment of a program on every kind of arm, against a twin that goes on: how soon it begins to brake. At the edge of its axes' limits, where a path that an
// inverse bends runs most of the time, there is no other motion than the one that runs; from one of its next borders there is.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "tests/axes/group/given_program.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

/// Cycles of 1 ms from an interruption to the first that the twin does not have; those of who comes to rest with its twin do not count.
void interrupt_once(std::uint64_t seed, const JogArm& arm, const Arm& kinematics, std::vector<int>& begins) {
    ProgramDraws draws(seed, arm, kinematics);
    const auto moves = draws.program(std::min(draws.how_many(), 6));
    GivenProgram walk(arm, kinematics, moves), twin(arm, kinematics, moves);
    std::mt19937_64 random(seed);
    for (int i = std::uniform_int_distribution<int>(20, 1500)(random); i > 0; --i) {
        walk.step();
        twin.step();
    }
    if (walk.rig.view().state != GroupState::GroupMoving || walk.stands()) return;
    ASSERT_EQ(walk.rig.submit(simply(GroupCommandKind::interrupt)).error, ErrorId::none);
    int begin = 0, cycles = 0;
    for (; !walk.stands(); ++cycles) {
        ASSERT_LT(cycles, 5000) << "it does not come to rest";
        walk.step();
        twin.step();
        if (begin == 0 && walk.beside(twin)) begin = cycles + 1;
        ASSERT_FALSE(begin == 0 && twin.stands() && !walk.stands());
    }
    if (begin > 0) begins.push_back(begin);
}

TEST(GroupStopArms, BeginSoonAtAnyMomentOfAnyProgram) {
    constexpr int latest = 250, soon = 40;  // ms; docs/motion/path.md
    const auto arms = arms_of_programs();
    std::vector<Arm> kinematics;
    for (const auto& arm : arms) kinematics.push_back(arm_of(arm.description));
    std::vector<int> begins;
    const std::uint64_t first = first_program();
    for (std::uint64_t seed = first; seed < first + property_cases(10) && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << " on " << arms[seed % arms.size()].name);
        interrupt_once(seed, arms[seed % arms.size()], kinematics[seed % arms.size()], begins);
    }
    ASSERT_GT(begins.size(), 3u);
    std::sort(begins.begin(), begins.end());
    const auto part = [&](double share) { return begins[static_cast<std::size_t>(share * static_cast<double>(begins.size() - 1))]; };
    std::printf("%zu interruptions begin behind %d ms (p50), %d ms (p90), %d ms at most\n", begins.size(), part(.5), part(.9),
                begins.back());
    EXPECT_LE(begins.back(), latest);
    EXPECT_LE(part(.8), soon);
}

}  // namespace
}  // namespace taktwerk::axes::test
