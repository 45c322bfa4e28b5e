// A histogram that one thread writes while others read it.

#include "core/shared_histogram.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace taktwerk {
namespace {

using namespace std::chrono_literals;

TEST(SharedHistogram, CountsAndKeepsTheLongestWithItsCycle) {
    SharedHistogram times;
    EXPECT_EQ(times.longest().cycle, 0u);
    times.record(5ns, 1);
    times.record(7ns, 2);
    times.record(6ns, 3);
    times.record(-1ns, 4);  // a clock that went back is no time
    EXPECT_EQ(times.bucket(5), 1u);
    EXPECT_EQ(times.bucket(7), 1u);
    EXPECT_EQ(times.bucket(0), 1u);
    EXPECT_EQ(times.longest().duration, 7ns);
    EXPECT_EQ(times.longest().cycle, 2u);
    times.reset();
    EXPECT_EQ(times.bucket(7), 0u);
    EXPECT_EQ(times.longest().cycle, 0u);
    times.record(3ns, 9);
    EXPECT_EQ(times.longest().duration, 3ns);
    EXPECT_EQ(times.longest().cycle, 9u);
}

// The longest duration and its cycle belong together, whenever they are read.
TEST(SharedHistogram, AReaderNeverSeesTwoHalves) {
    SharedHistogram times;
    std::thread writer{[&] {
        for (std::uint64_t cycle = 1; cycle <= 200'000; ++cycle) {
            times.record(Duration{static_cast<std::int64_t>(cycle)}, cycle);
            if (cycle % 1000 == 0) times.reset();
        }
        times.record(1h, 1);
    }};
    for (bool over = false; !over;) {
        const auto seen = times.longest();
        over = seen.duration == 1h;
        if (!over) {
            EXPECT_EQ(static_cast<std::uint64_t>(seen.duration.count()), seen.cycle);
        }
    }
    writer.join();
}

}  // namespace
}  // namespace taktwerk
