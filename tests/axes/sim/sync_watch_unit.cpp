// How regularly SYNC0 comes. A cycle of 1 ms, a threshold of 3 us (SV33-E P0A.32).

#include "axes/sim/sync_watch.hpp"

#include <gtest/gtest.h>

namespace taktwerk::axes::sim {
namespace {

using namespace std::chrono_literals;

class SyncWatchTest : public ::testing::Test {
protected:
    SyncWatchTest() {
        watch.restart(1ms);
        signal_after(7ms);  // the first one has nothing to be compared with
    }
    void signal_after(Duration interval) { watch.signal(now += interval, threshold); }
    [[nodiscard]] std::int64_t lost() const { return watch.lost(now, threshold); }

    static constexpr Duration threshold = 3us;
    SyncWatch watch;
    Instant now{};
};

TEST_F(SyncWatchTest, InPlaceUpToTheThresholdEitherWay) {
    for (const Duration interval : {Duration{1ms}, Duration{1ms + 3us}, Duration{1ms - 3us}}) {
        signal_after(interval);
        EXPECT_EQ(lost(), 0);
    }
}

TEST_F(SyncWatchTest, OutOfPlaceIsCountedUntilOneIsInPlaceAgain) {
    signal_after(1ms + 3us + 1ns);
    EXPECT_EQ(lost(), 1);
    signal_after(1ms - 3us - 1ns);
    EXPECT_EQ(lost(), 2);
    signal_after(1ms);
    EXPECT_EQ(lost(), 0);
}

TEST_F(SyncWatchTest, OverdueSignalsAreCountedBeforeTheNextComes) {
    now += 1ms + 2us;
    EXPECT_EQ(lost(), 0);
    now += 2us;
    EXPECT_EQ(lost(), 1);
    now += 3ms;
    EXPECT_EQ(lost(), 4);
    watch.signal(now, threshold);
    EXPECT_EQ(lost(), 4) << "it came, but those before did not";
    signal_after(1ms);
    EXPECT_EQ(lost(), 0);
}

TEST_F(SyncWatchTest, WithoutACycleNothingIsDue) {
    watch.restart({});
    signal_after(1ms);
    now += 1s;
    EXPECT_EQ(lost(), 0);
}

}  // namespace
}  // namespace taktwerk::axes::sim
