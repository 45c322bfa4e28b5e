// Whatever programs and people ask of a whole machine and whatever happens to its bus and its drives: in every cycle a drive is told through the
// frames what its axis shows, and afterwards everything comes back.
//
// A failure names its seed; TAKTWERK_WALK_SEED=<seed> runs that walk alone and tells all that was asked in it.

#include "tests/machine_walk/machine_walk.hpp"
#include "tests/walk_seeds.hpp"

namespace taktwerk::runtime::testing {
namespace {

constexpr unsigned usual = 12;
constexpr int length = 3000;  // cycles of commands, and then as many as it takes to come back

// The walk must have gone everywhere.
void expect_all_seen(const WalkCounts& counts) {
    const auto at_least = [&](std::string_view what, long most) {
        const auto found = counts.find(what);
        EXPECT_GE(found == counts.end() ? 0 : found->second, most) << what;
    };
    for (const auto* state : {"in Disabled", "in Standstill", "in Homing", "in DiscreteMotion", "in ContinuousMotion",
                              "in SynchronizedMotion", "in Stopping", "in ErrorStop"})
        at_least(state, 100);
    for (const int mode : {1, 3, 4, 6, 8, 9, 10}) at_least(fmt::format("runs in mode {}", mode), 20);
    for (const auto* event : {"drive fault", "mains lost", "slave restarts", "cable pulled", "frames lost", "few frames lost",
                              "emergency stop", "jammed", "MC_Power off", "by hand"})
        at_least(event, 1);
    at_least("moves", 10'000);
    at_least("came back", usual);
}

TEST(MachineWalks, TellDrivesWhatTheirAxesShow) {
    WalkCounts counts;
    long cycles = 0, compared = 0, arrived = 0;
    const auto walked = taktwerk::test::walk_seeds(
        usual, length, [&](unsigned seed) { return MachineWalk(seed, counts); },
        [&](MachineWalk& walk) {
            cycles += walk.cycles();
            compared += walk.compared;
            arrived += walk.arrived;
        });
    std::printf("%ld cycles of axes; in %ld the motion was compared, in %ld what arrived\n", cycles, compared, arrived);
    if (walked.one_alone || HasFailure()) return;
    EXPECT_GT(cycles, 100'000);
    EXPECT_GT(compared, cycles / 3);
    EXPECT_GT(arrived, cycles / 2);
    expect_all_seen(counts);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
