// The indexing table stops where its stations are.

#include <cmath>

#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::indexing_table_example {
namespace {

using namespace std::chrono_literals;
using testing::ExampleMachine;

// Eight stations: every stop is a whole multiple of 45 degrees, to the last bit, the table never turns back, and over several turns
// through a gear of 7:3 the motor is where its counts say.
TEST(IndexingTable, StopsExactlyAtItsStationsAndNeverTurnsBack) {
    ExampleMachine m{"indexing_table"};
    ASSERT_TRUE(m.up());
    double seen = 0, slowest = 0, worst = 0;
    m.each_cycle = [&] {
        const auto& table = m.axis("table");
        slowest = std::min(slowest, table.set_velocity);
        const double indexed = m.variable("indexed");
        if (indexed == seen) return;
        seen = indexed;
        const auto steps = static_cast<int>(indexed);
        EXPECT_EQ(table.set_position, 45.0 * (steps % 8)) << "after " << steps;
        EXPECT_EQ(table.turns, steps / 8) << "after " << steps;
        EXPECT_EQ(table.set_velocity, 0);
        worst = std::max(worst, std::abs(table.following_error));
    };

    EXPECT_TRUE(m.until([&] { return seen >= 25; }, 40s)) << seen << " steps; alarms " << m.alarms();

    EXPECT_GE(slowest, 0);
    EXPECT_LT(worst, 0.5) << "degrees behind when the set-point has arrived";
}

}  // namespace
}  // namespace taktwerk::indexing_table_example
