#include "core/clock.hpp"

#include <gtest/gtest.h>

namespace taktwerk {
namespace {

using namespace std::chrono_literals;

TEST(VirtualClock, TimePassesOnlyWhenSomeoneWaits) {
    VirtualClock clock{Instant{5ms}};
    EXPECT_EQ(clock.now(), Instant{5ms});

    clock.sleep_until(Instant{7ms});
    EXPECT_EQ(clock.now(), Instant{7ms});
}

TEST(VirtualClock, ADeadlineInThePastDoesNotTurnTimeBack) {
    VirtualClock clock{Instant{5ms}};
    clock.sleep_until(Instant{1ms});
    EXPECT_EQ(clock.now(), Instant{5ms});
}

TEST(SystemClock, NeverRunsBackAndWaitsAtLeastUntilTheDeadline) {
    SystemClock clock;
    const Instant before = clock.now();

    clock.sleep_until(before + 100us);

    EXPECT_GE(clock.now(), before + 100us);
}

TEST(SystemClock, ADeadlineBeforeBootReturnsAtOnce) {
    SystemClock clock;
    clock.sleep_until(Instant{-1ns});
    clock.sleep_until(Instant{});
    SUCCEED() << "a clock that waits here hangs the test";
}

}  // namespace
}  // namespace taktwerk
