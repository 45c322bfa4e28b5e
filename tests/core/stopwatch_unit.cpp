#include "core/stopwatch.hpp"

#include <gtest/gtest.h>

#include <type_traits>

namespace taktwerk {
namespace {

using namespace std::chrono_literals;

static_assert(std::is_trivially_copyable_v<StepStatistics<3>>);

void busy_for(Duration duration) {
    Stopwatch watch;
    for (Duration passed{0}; passed < duration;) passed += watch.lap();
}

TEST(Stopwatch, ALapIsTheTimeSinceTheLastOne) {
    Stopwatch watch;
    busy_for(200us);
    EXPECT_GE(watch.lap(), 200us);
    busy_for(100us);
    watch.restart();
    EXPECT_LT(watch.lap(), 50ms);  // what was before restart() is gone; generous for a loaded machine
}

TEST(StepStatistics, TimeIsBookedToTheStepItWasSpentIn) {
    StepStatistics<3> statistics{{"receive", "axes", "send"}};

    statistics.begin();
    statistics.done(0);
    busy_for(300us);
    statistics.done(1);
    busy_for(300us);
    statistics.skip();
    statistics.done(2);
    statistics.end();

    EXPECT_EQ(statistics.name(1), "axes");
    EXPECT_GE(statistics.times(1).max(), 300us);
    EXPECT_EQ(statistics.times(0).count(), 1u);
    Duration sum{0};
    for (std::size_t i = 0; i < 3; ++i) sum += statistics.in_this_cycle(i);
    EXPECT_EQ(statistics.total().max(), sum);  // the skipped 300 us are in no step
}

TEST(StepStatistics, OfTheSlowestCycleItIsKeptHowItWasSpent) {
    StepStatistics<2> statistics{{"a", "b"}};
    for (const auto spent : {Duration{0us}, Duration{2ms}, Duration{0us}}) {
        statistics.begin();
        statistics.done(0);
        busy_for(spent);
        statistics.done(1);
        statistics.end();
    }

    EXPECT_EQ(statistics.total().count(), 3u);
    EXPECT_EQ(statistics.in_worst_cycle(0) + statistics.in_worst_cycle(1), statistics.total().max());
    EXPECT_GE(statistics.in_worst_cycle(0) + statistics.in_worst_cycle(1), 2ms);

    statistics.reset();
    EXPECT_EQ(statistics.total().count(), 0u);
    EXPECT_EQ(statistics.name(1), "b");
}

}  // namespace
}  // namespace taktwerk
