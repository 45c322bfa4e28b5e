// Gears entered at any moment of any master: steady, ramping, jerk-limited, stopped hard, turning round; by set-points and by encoders. Until InGear the
// slave keeps what gear_oracle.hpp says.
//
// A failure names its seed; TAKTWERK_WALK_SEED=<seed> runs that walk alone and tells every cycle of it.

#include <cstdio>

#include "tests/axes/axis/gear_walk.hpp"
#include "tests/walk_seeds.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr unsigned gear_walks = 80;
constexpr int gear_cycles = 1500;  // cycles, and then as many as it takes to come into gear

TEST(GearWalks, CatchUpInsideWhatTheMasterDid) {
    GearCounts counts;
    const auto walked = taktwerk::test::walk_seeds(
        gear_walks, gear_cycles, [&](unsigned seed) { return GearWalk(seed, counts); }, [](const GearWalk&) {});
    std::printf("seeds %u to %u: %ld cycles, %ld of them catching up, %ld in gear; %ld hard stops, %ld of them while the slave caught up\n",
                walked.first, walked.first + static_cast<unsigned>(walked.walks) - 1, counts.cycles, counts.catching_up, counts.in_gear,
                counts.hard_stops, counts.hard_stops_on_the_way);
    if (walked.one_alone || HasFailure()) return;
    EXPECT_GT(counts.cycles, 100'000);
    EXPECT_GT(counts.catching_up, counts.cycles / 10);
    EXPECT_GT(counts.in_gear, counts.cycles / 10);
    EXPECT_GT(counts.measured, counts.cycles / 5);
    for (const long each : {counts.hard_stops, counts.hard_stops_on_the_way, counts.taken_away, counts.timed, counts.outside})
        EXPECT_GT(each, walked.walks / 4);
    EXPECT_GT(counts.reversals, walked.walks / 20);
}

}  // namespace
}  // namespace taktwerk::axes::test
