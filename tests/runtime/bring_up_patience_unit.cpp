#include "runtime/run/bring_up_patience.hpp"

#include <gtest/gtest.h>

namespace taktwerk::runtime {
namespace {

using namespace std::chrono_literals;

// The slowest bring-ups (docs/performance.md: terminals with long EEPROMs) leave at least as much again; so does a slow cycle, at which each
// answer takes its cycle too. Measured are the rows of 1 ms and 4 ms; that of 10 ms is 4 ms' scaled by the cycle, as those two are to each other.
TEST(BringUpPatience, IsTwiceWhatTheSlowestBusNeeds) {
    struct Slowest {
        std::size_t slaves;
        Duration cycle, time_to_op;
    };
    for (const auto& it : {Slowest{300, 1ms, 10100ms}, Slowest{300, 4ms, 40200ms}, Slowest{300, 10ms, 100500ms}})
        EXPECT_GE(30s + patience_with(it.slaves, it.cycle), 2 * it.time_to_op) << it.slaves;
    EXPECT_LE(30s + patience_with(4, 1ms), 31s);  // and nobody waits long for a small bus that does not come
}

}  // namespace
}  // namespace taktwerk::runtime
