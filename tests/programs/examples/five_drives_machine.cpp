// One of each drive, ten axes: all home and move, each drive fails once and comes back.

#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::five_drives_example {
namespace {

using namespace std::chrono_literals;
using testing::ExampleMachine;

// The machine file lets the SV33-E, the SV-DA200, one joint of the TSVM-D6, all six of them, the SE-808X and the XP200 fail, and cuts the
// serial line: 1 + 1 + 1 + 6 + 1 + 1 + 1 axes that go to ErrorStop, each once: the XP200's reset waits until it is disabled when its line is back.
TEST(FiveDrives, AllHomeAndMoveAndComeBackAfterTheirFaults) {
    ExampleMachine m{"five-drives"};
    ASSERT_TRUE(m.up());
    EXPECT_TRUE(m.until([&] { return m.variable("least_strokes") >= 1; }, 6s)) << m.alarms();
    EXPECT_EQ(m.variable("failures"), 0);

    EXPECT_TRUE(m.until([&] { return m.variable("recoveries") >= 12; }, 30s)) << m.alarms();
    m.run(3s);
    EXPECT_EQ(m.variable("failures"), 12) << m.alarms();
    EXPECT_EQ(m.variable("recoveries"), m.variable("failures")) << m.alarms();
    const double strokes = m.variable("least_strokes");
    EXPECT_TRUE(m.until([&] { return m.variable("least_strokes") > strokes; }, 20s)) << m.alarms();
    for (const char* axis : {"sv33", "da200", "j1", "j2", "j3", "j4", "j5", "j6", "stepper", "xp200"}) {
        EXPECT_TRUE(m.axis(axis).homed) << axis;
        EXPECT_NE(m.axis(axis).state, axes::AxisState::ErrorStop) << axis;
    }
}

}  // namespace
}  // namespace taktwerk::five_drives_example
