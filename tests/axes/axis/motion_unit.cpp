// Motion of one axis: commands, their ends, what aborts and what waits. PLCopen Part 1 v2.0, sections 2.4 and 3.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

// P1-136, P1-137: ends at the target, to the last bit, with velocity zero; the state shows the motion.
TEST(AxisMotion, AbsoluteMoveEndsExactlyAtTheTarget) {
    Rig rig;
    rig.power_on();

    const auto id = rig.accept(absolute(33.3, 50));
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);  // P1-017: at once
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));

    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_EQ(rig.view().set_position, 33.3);
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_EQ(rig.drive.last.position, 33300);
    EXPECT_LE(rig.largest_velocity, 50.0 * (1 + 1e-12));
    rig.run(20);
    EXPECT_TRUE(rig.view().in_position);
    rig.expect_no_jump();
}

}  // namespace
}  // namespace taktwerk::axes::test
