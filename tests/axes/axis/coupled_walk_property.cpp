// Whatever is asked of one to four axes that follow one another, in whatever order and with whatever faults: the set-point never leaves what its
// velocity, its acceleration and its limits say, the drive is told what the view shows, no command is forgotten, and everything comes to an end.
//
// A failure names its seed; TAKTWERK_WALK_SEED=<seed> runs that walk alone and tells all that was asked in it.

#include "tests/axes/axis/coupled_walk.hpp"
#include "tests/walk_seeds.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr unsigned usual = 100;
constexpr int length = 1500;  // cycles of commands, and then as many as it takes to come to an end

// The walk must have gone everywhere: each kind of command was accepted, and what only their meeting brings did happen.
void expect_all_seen(const WalkCounts& counts, long walks) {
    const auto at_least = [&](std::string_view what, double each) {
        const auto found = counts.find(what);
        const double seen = found == counts.end() ? 0 : static_cast<double>(found->second);
        EXPECT_GE(seen, each * static_cast<double>(walks)) << what << " in " << walks << " walks";
    };
    for (const auto& kind : walk_kinds) at_least(kind.name, 0.1);
    for (const auto* setting :
         {"SetPosition", "WriteParameter", "WriteOutput", "Override", "SetpointFeed", "SelectCam", "ContinuousUpdate"})
        at_least(setting, 0.5);
    for (const auto* event : {"drive fault", "power off", "feedback lost", "bus lost", "emergency stop", "power lost", "operating mode",
                              "control taken", "feedback gap", "direction not permitted", "reset", "jog renewed"})
        at_least(event, 0.1);
    for (int mode = 1; mode <= 5; ++mode) at_least(fmt::format("buffered in mode {}", mode), 0.2);
    for (const auto* where : {"in Disabled", "in Standstill", "in Homing", "in DiscreteMotion", "in ContinuousMotion",
                              "in SynchronizedMotion", "in Stopping", "in ErrorStop"})
        at_least(where, 20);
    at_least("waiting coupling", 0.5);
    at_least("coupling waits in motion", 20);
    at_least("superimposed while a coupling waits", 1);
    at_least("superimposed on a coupling", 1);
    for (const auto* what :
         {"in sync", "phasing", "on the way to a sync point", "commands wait", "overridden", "in torque", "in a profile of the drive"})
        at_least(what, 1);
    for (const auto* what : {"jog renewed under an addition", "addition replaced", "base updated under an addition"}) at_least(what, 0.3);
    at_least("came to rest", 1);
}

TEST(CoupledWalks, KeepEveryRule) {
    WalkCounts counts;
    long cycles = 0, compared = 0;
    const auto walked = taktwerk::test::walk_seeds(
        usual, length, [&](unsigned seed) { return CoupledWalk(seed, counts); },
        [&](CoupledWalk& walk) {
            cycles += walk.cycles() * static_cast<long>(walk.rig().axes.size());
            for (const auto& oracle : walk.rig().oracles) compared += oracle.compared();
        });
    std::printf("seeds %u to %u: %ld cycles of axes, in %ld of them the motion was compared\n", walked.first,
                walked.first + static_cast<unsigned>(walked.walks) - 1, cycles, compared);
    if (walked.one_alone || HasFailure()) return;
    EXPECT_GT(compared, cycles / 2);
    EXPECT_GT(cycles, 100'000);
    expect_all_seen(counts, walked.walks);
}

// Seeds beyond those of the usual run that found a fault. 978: a torque over a move just handed to the drive, which never came. 1360: a reset while
// the drive left its torque kept the velocity of the motor in a set-point that stood. 2427: so did another mode for the controller.
TEST(CoupledWalks, SeedsThatHaveFoundSomething) {
    WalkCounts counts;
    for (const unsigned seed : {978u, 1360u, 2427u}) {
        CoupledWalk walk(seed, counts);
        EXPECT_EQ(walk.run(length), "") << "seed " << seed;
    }
}

// Of walks with an operator. 827, 902: a stop with the jerk that a feed had declared, above the axis' own. 3496: an update of what had not begun made a
// cam endless before a command that waited. 3575: coordinates that changed by three counts (the oracle). 3691: a limit that came down on a slave which was
// speeding up, a step of 8 u/s. 4461: a jog that stopped was said to be overridden.
TEST(CoupledWalks, SeedsOfAnOperatorThatHaveFoundSomething) {
    WalkCounts counts;
    for (const unsigned seed : {827u, 902u, 3496u, 3575u, 3691u, 4461u}) {
        CoupledWalk walk(seed, counts, Directions::alike, Operators::at_the_override);
        EXPECT_EQ(walk.run(length), "") << "seed " << seed;
    }
}

// The same with axes that are slower in one direction, and have other ramps there: the oracle holds each velocity and each ramp against its own.
TEST(CoupledWalks, KeepTheLimitsOfEachDirection) {
    WalkCounts counts;
    long cycles = 0, compared = 0;
    const auto walked = taktwerk::test::walk_seeds(
        usual / 2, length, [&](unsigned seed) { return CoupledWalk(seed, counts, Directions::differ); },
        [&](CoupledWalk& walk) {
            cycles += walk.cycles() * static_cast<long>(walk.rig().axes.size());
            for (const auto& oracle : walk.rig().oracles) compared += oracle.compared();
        });
    if (walked.one_alone || HasFailure()) return;
    EXPECT_GT(compared, cycles / 2);
    EXPECT_GT(cycles, 50'000);
}

// The same while somebody turns the operator's override, of one axis or all, slowly or at once.
TEST(CoupledWalks, KeepEveryRuleUnderTheHandOfAnOperator) {
    WalkCounts counts;
    long cycles = 0, compared = 0;
    const auto walked = taktwerk::test::walk_seeds(
        usual / 2, length, [&](unsigned seed) { return CoupledWalk(seed, counts, Directions::alike, Operators::at_the_override); },
        [&](CoupledWalk& walk) {
            cycles += walk.cycles() * static_cast<long>(walk.rig().axes.size());
            for (const auto& oracle : walk.rig().oracles) compared += oracle.compared();
        });
    if (walked.one_alone || HasFailure()) return;
    EXPECT_GT(compared, cycles / 2);
    EXPECT_GT(cycles, 50'000);
    EXPECT_GT(counts["operator's override"], 20 * walked.walks);
    EXPECT_GT(counts["operator's override of a coupling"], walked.walks);
    EXPECT_GT(counts["overridden"], 100 * walked.walks);
}

}  // namespace
}  // namespace taktwerk::axes::test
