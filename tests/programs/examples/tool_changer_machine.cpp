// The tool changer takes and lays down both tools in turn, and its coupling never opens while the screwdriver has power.

#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::tool_changer_example {
namespace {

using namespace std::chrono_literals;
using testing::ExampleMachine;

TEST(ToolChanger, WorksWithBothToolsInTurnAndLetsGoNothingThatIsPowered) {
    ExampleMachine m{"tool-changer"};
    ASSERT_TRUE(m.up());
    double turned = 0;
    bool powered_while_open = false, gripped = false;
    m.each_cycle = [&] {
        const auto& screw = m.axis("screw");
        turned = std::max(turned, screw.set_velocity);
        gripped = gripped || m.output("grip");
        powered_while_open = powered_while_open || (m.output("release") && screw.drive_state == axes::PowerState::enabled);
    };
    ASSERT_TRUE(m.until([&] { return m.variable("changes") >= 4; }, 60s)) << m.alarms();

    EXPECT_EQ(m.alarms(), "");
    EXPECT_TRUE(gripped);
    EXPECT_GT(turned, 9) << "of 10 rev/s";
    EXPECT_FALSE(powered_while_open);
}

}  // namespace
}  // namespace taktwerk::tool_changer_example
