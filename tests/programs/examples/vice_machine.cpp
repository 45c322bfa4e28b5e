// The vice presses with the torque it was given and no more, is slower downwards than upwards, and opens again.

#include <algorithm>
#include <cmath>

#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::vice_example {
namespace {

using namespace std::chrono_literals;
using testing::ExampleMachine;

// The part is at 60 mm. Pressed with 0.4 of the rated torque, as the machine file's events close and open it, and with 0.25 the second time.
TEST(Vice, PressesWithTheTorqueAskedForAndOpensAgain) {
    ExampleMachine m{"vice"};
    ASSERT_TRUE(m.up());
    double hardest = 0, down = 0, up = 0;
    m.each_cycle = [&] {
        const auto& jaw = m.axis("jaw");
        if (jaw.set_position > 56) hardest = std::max(hardest, jaw.actual_torque);
        down = std::max(down, jaw.set_velocity);
        up = std::min(up, jaw.set_velocity);
    };
    for (const double torque : {0.4, 0.25}) {
        m.set_parameter("torque", torque);
        hardest = 0;
        if (torque < 0.4) m.world().set_input("close", true);
        ASSERT_TRUE(m.until([&] { return m.output("clamped"); }, 10s)) << m.alarms();
        m.run(500ms);
        EXPECT_TRUE(m.output("clamped")) << "held";
        EXPECT_NEAR(m.place("jaw"), 60, 0.01);
        EXPECT_NEAR(m.axis("jaw").actual_torque, torque, 0.002);
        EXPECT_LE(hardest, torque + 0.001);
        EXPECT_EQ(m.axis("jaw").torque_limit_positive, torque);
        EXPECT_EQ(m.axis("jaw").torque_limit_negative, 1.5) << "as configured";
        if (torque < 0.4) m.world().set_input("close", false);
        ASSERT_TRUE(m.until([&] { return std::abs(m.place("jaw") - 10) < 0.05; }, 10s)) << m.alarms();
        EXPECT_EQ(m.axis("jaw").torque_limit_positive, 1.5);
    }
    EXPECT_EQ(down, 120);
    EXPECT_EQ(up, -200);
    EXPECT_EQ(m.alarms(), "");
}

}  // namespace
}  // namespace taktwerk::vice_example
