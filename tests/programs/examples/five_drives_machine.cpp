// One of each drive and a belt, eleven axes: all home and move, each drive fails once and comes back, each by its program.

#include "tests/programs/examples/belt_eye.hpp"

namespace taktwerk::five_drives_example {
namespace {

using namespace std::chrono_literals;
using testing::BeltEye;
using testing::ExampleMachine;

// The machine file lets the SV33-E, the SV-DA200, the SE-808X and the XP200 fail, and cuts the serial line: 1 + 1 + 1 + 1 + 1 axes that go to ErrorStop,
// each once: the XP200's reset waits until it is disabled when its line is back. Of the TSVM-D6 one joint fails, then all six: the arm twice. The belt fails
// once, and the arm with it, which is on it.
TEST(FiveDrives, AllHomeAndMoveAndComeBackAfterTheirFaults) {
    ExampleMachine m{"five-drives"};
    ASSERT_TRUE(m.up());
    BeltEye eye{m};
    EXPECT_TRUE(m.until([&] { return m.variable("least_strokes") >= 1; }, 6s)) << m.alarms();
    EXPECT_EQ(m.variable("failures"), 0);
    EXPECT_TRUE(m.until([&] { return m.variable("placed") >= 1; }, 3s)) << m.alarms();
    EXPECT_EQ(m.variable("arm_failures"), 0);

    EXPECT_TRUE(m.until([&] { return m.variable("recoveries") >= 5; }, 30s)) << m.alarms();
    m.run(3s);
    EXPECT_EQ(m.variable("failures"), 5) << m.alarms();
    EXPECT_EQ(m.variable("recoveries"), m.variable("failures")) << m.alarms();
    EXPECT_EQ(m.variable("arm_failures"), 3) << m.alarms();
    EXPECT_EQ(m.variable("arm_recoveries"), 3) << m.alarms();
    EXPECT_EQ(m.variable("belt_failures"), 1);
    EXPECT_EQ(m.variable("belt_recoveries"), 1);
    const double strokes = m.variable("least_strokes"), placed = m.variable("placed");
    EXPECT_TRUE(m.until([&] { return m.variable("least_strokes") > strokes && m.variable("placed") >= placed + 2; }, 20s)) << m.alarms();
    for (const char* axis : {"sv33", "da200", "j1", "j2", "j3", "j4", "j5", "j6", "stepper", "xp200"})
        EXPECT_TRUE(m.axis(axis).homed) << axis;
    for (const char* axis : {"sv33", "da200", "j1", "j2", "j3", "j4", "j5", "j6", "stepper", "xp200", "belt"})
        EXPECT_NE(m.axis(axis).state, axes::AxisState::ErrorStop) << axis;
    EXPECT_TRUE(eye.clean()) << eye.report();
}

}  // namespace
}  // namespace taktwerk::five_drives_example
