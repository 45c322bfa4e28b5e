// MC_Stop: the lock, its release, what waits behind it. PLCopen Part 1 v2.0, 3.3.

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

// P1-125..P1-131, held: Done at zero while still Stopping; nothing else moves it; Standstill when Execute falls.
TEST(AxisStop, HeldStopLocksTheAxis) {
    Rig rig;
    rig.power_on();
    const auto running = rig.accept(at_velocity(50));
    rig.run(200);
    const auto stopping = rig.accept(stop());
    EXPECT_EQ(rig.view().state, AxisState::Stopping);
    EXPECT_EQ(rig.status(running), CommandStatus::aborted);
    EXPECT_EQ(rig.refuse(at_velocity(10)), ErrorId::state_forbids);
    EXPECT_EQ(rig.refuse(stop()), ErrorId::state_forbids);  // U-01

    ASSERT_TRUE(rig.run_until([&] { return rig.status(stopping) == CommandStatus::done; }));
    EXPECT_EQ(rig.view().set_velocity, 0);
    rig.run(20);
    EXPECT_EQ(rig.view().state, AxisState::Stopping);
    EXPECT_EQ(rig.refuse(absolute(1)), ErrorId::state_forbids);
    rig.axis.release_stop(stopping, Owner::program);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    rig.accept(absolute(1));
}

// short: Execute falls in the ramp; Done and Standstill come together.
TEST(AxisStop, ReleasedInTheRampEndsInStandstillWithDone) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(50));
    rig.run(200);
    const auto stopping = rig.accept(stop());
    rig.run(5);
    rig.axis.release_stop(stopping, Owner::program);
    EXPECT_EQ(rig.view().state, AxisState::Stopping);

    ASSERT_TRUE(rig.run_until([&] { return rig.status(stopping) == CommandStatus::done; }));
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_EQ(rig.view().set_velocity, 0);
}

// P1-029: from Standstill Stopping, Done, and back.
TEST(AxisStop, FromStandstillAndBack) {
    Rig rig;
    rig.power_on();
    const auto stopping = rig.accept(stop());
    rig.run(2);
    EXPECT_EQ(rig.status(stopping), CommandStatus::done);
    EXPECT_EQ(rig.view().state, AxisState::Stopping);
    rig.axis.release_stop(stopping, Owner::program);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
}

// P1-094: a buffered command behind MC_Stop starts only after Done and after Execute fell.
TEST(AxisStop, BufferedFollowerWaitsForExecuteToFall) {
    Rig rig;
    rig.power_on();
    rig.accept(at_velocity(50));
    rig.run(200);
    const auto stopping = rig.accept(stop());
    const auto next = rig.accept(absolute(0, 100, mcBuffered));
    rig.run(300);
    EXPECT_EQ(rig.status(next), CommandStatus::queued);

    rig.axis.release_stop(stopping, Owner::program);
    EXPECT_EQ(rig.status(next), CommandStatus::active);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_NEAR(rig.view().set_position, 0, 1e-12);
}

// P1-132 (figure 16): 50 u/s, stop with d = 20 takes 2.5 s.
TEST(AxisStop, UsesItsOwnDeceleration) {
    auto config = plain_axis();
    config.limits.jerk = std::numeric_limits<double>::infinity();
    Rig rig(config);
    rig.power_on();
    rig.accept(at_velocity(50));
    rig.run(100);
    const auto begin = rig.now;
    const auto id = rig.accept({.kind = CommandKind::stop, .deceleration = 20});
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }));
    EXPECT_NEAR(to_seconds(rig.now - begin), 2.5, 0.0011);
}

}  // namespace
}  // namespace taktwerk::axes::test
