// A stop of the machine's hand, or a harder one of a program, behind a soft halt, interruption or stop, or an override of 0, at any moment of a program on every kind of arm,
// against a twin that gets the last one alone. Where the soft one has not begun yet both are at the same place, and come to rest alike.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "tests/axes/group/given_program.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

struct SoftThenHard {
    int looked = 0, worst = 0;
};

enum class Softly : unsigned char { halt, interrupt, stop, override_of_0 };

void begin_softly(GivenProgram& walk, Softly how, const PathDynamics& soft) {
    if (how == Softly::override_of_0) {
        EXPECT_EQ(walk.rig.set(Override{.velocity = 0}), ErrorId::none);
        return;
    }
    const auto kind = how == Softly::halt        ? GroupCommandKind::halt
                      : how == Softly::interrupt ? GroupCommandKind::interrupt
                                                 : GroupCommandKind::stop;
    walk.stopped = how != Softly::interrupt;
    EXPECT_EQ(walk.rig.submit(simply(kind, soft)).error, ErrorId::none);
}

void stop_behind_soft(std::uint64_t seed, const JogArm& arm, const Arm& kinematics, SoftThenHard& totals) {
    ProgramDraws draws(seed, arm, kinematics);
    const auto moves = draws.program(std::min(draws.how_many(), 6));
    GivenProgram walk(arm, kinematics, moves), twin(arm, kinematics, moves);
    std::mt19937_64 random(seed);
    const auto between = [&](double from, double to) {
        return std::exp(std::uniform_real_distribution<double>(std::log(from), std::log(to))(random));
    };
    const auto both = [&](int cycles) {
        for (int i = 0; i < cycles && !walk.stands(); ++i) {
            walk.step();
            twin.step();
        }
    };
    for (int i = std::uniform_int_distribution<int>(20, 1200)(random); i > 0; --i) {
        walk.step();
        twin.step();
    }
    if (walk.rig.view().state != GroupState::GroupMoving || walk.stands()) return;
    PathDynamics soft;
    soft.deceleration = between(5, 100);
    soft.jerk = between(100, 3000);
    const auto how = static_cast<Softly>(random() % 4);
    begin_softly(walk, how, soft);
    both(std::uniform_int_distribution<int>(1, 300)(random));
    if (walk.stands() || walk.rig.point() != twin.rig.point()) return;
    walk.stopped = twin.stopped = true;
    for (auto* one : {&walk, &twin}) {
        if (how == Softly::stop) one->rig.step([&] { one->rig.groups[0].halt(); });  // no other block stops it now
        else EXPECT_EQ(one->rig.submit(simply(GroupCommandKind::stop)).error, ErrorId::none);
    }
    const int with = walk.to_rest(), alone = twin.to_rest();
    ++totals.looked;
    totals.worst = std::max(totals.worst, with - alone);
    EXPECT_LE(with, alone + 50) << "ms to rest, behind " << static_cast<int>(how) << " with " << soft.deceleration << " u/s2";
}

TEST(GroupStopBehindSoft, DoesNotWaitForWhatHasNotBegun) {
    const auto arms = arms_of_programs();
    std::vector<Arm> kinematics;
    for (const auto& arm : arms) kinematics.push_back(arm_of(arm.description));
    SoftThenHard totals;
    const auto look = [&](std::uint64_t seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << " on " << arms[seed % arms.size()].name);
        stop_behind_soft(seed, arms[seed % arms.size()], kinematics[seed % arms.size()], totals);
    };
    // These waited for 80 to 150 ms.
    for (const std::uint64_t seed : {4, 44, 290, 9043}) look(seed);
    EXPECT_EQ(totals.looked, 4);
    const std::uint64_t first = first_program();
    for (std::uint64_t seed = first; seed < first + property_cases(3) && !HasFailure(); ++seed) look(seed);
    std::printf("%d stops behind soft ones that had not begun: to rest %d ms later than alone, at most\n", totals.looked, totals.worst);
}

}  // namespace
}  // namespace taktwerk::axes::test
