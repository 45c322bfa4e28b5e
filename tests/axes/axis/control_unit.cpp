// Who may move the axis, how fast, and for how long: authority, machine modes, jog leases.

#include <array>

#include "axes/axis/direct_requests.hpp"
#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

TEST(Authority, OthersAreRefusedUntilTheyTakeControl) {
    Rig rig;
    rig.power_on();
    EXPECT_EQ(rig.view().owner, Owner::program);
    EXPECT_EQ(rig.refuse(absolute(1), Owner::operator_panel), ErrorId::owned_by_other);
    EXPECT_EQ(rig.axis.power(false, true, true, Owner::operator_panel), ErrorId::owned_by_other);
    EXPECT_EQ(rig.axis.set(SetPosition{0, false}, Owner::operator_panel), ErrorId::owned_by_other);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);

    rig.axis.take_control(Owner::commissioning);
    EXPECT_EQ(rig.view().owner, Owner::commissioning);
    EXPECT_EQ(rig.refuse(absolute(1), Owner::program), ErrorId::owned_by_other);
    rig.accept(absolute(1), Owner::commissioning);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.axis.release_control(Owner::commissioning);
    EXPECT_EQ(rig.view().owner, Owner::program);
}

// Taking over stops the axis first: until it stands nobody moves it.
TEST(Authority, TakingOverStopsTheAxisFirst) {
    Rig rig;
    rig.power_on();
    const auto id = rig.accept(at_velocity(80));
    rig.run(300);
    rig.axis.take_control(Owner::operator_panel);
    EXPECT_EQ(rig.status(id), CommandStatus::aborted);
    EXPECT_EQ(rig.view().state, AxisState::Stopping);
    EXPECT_EQ(rig.refuse(jog(5), Owner::operator_panel), ErrorId::state_forbids);
    EXPECT_EQ(rig.refuse(absolute(5, 10, mcBuffered), Owner::operator_panel), ErrorId::state_forbids);  // no command to wait behind
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_TRUE(rig.view().powered);
    rig.accept(jog(5), Owner::operator_panel);
    rig.expect_no_jump();
}

// A program that holds MC_Stop does not keep the operator out for ever.
TEST(Authority, TakingOverEndsAHeldStop) {
    Rig rig;
    rig.power_on();
    rig.accept(stop());
    rig.run(5);
    rig.axis.take_control(Owner::operator_panel);
    rig.run(3);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
}

// manual: operator, manual.fast; setup: manual.setup_velocity; both hold the speed down and the view says why.
TEST(Modes, CapTheSpeedAndChangeTheOwner) {
    auto config = plain_axis();
    config.manual = {.slow = 4, .fast = 20, .setup_velocity = 6};
    Rig rig(config);
    rig.power_on();
    rig.axis.set_mode(OperatingMode::manual);
    EXPECT_EQ(rig.view().owner, Owner::operator_panel);
    rig.accept(absolute(10, 100), Owner::operator_panel);
    rig.run(100);
    EXPECT_DOUBLE_EQ(rig.view().set_velocity, 20);
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::manual_speed);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));

    rig.axis.set_mode(OperatingMode::setup);
    rig.accept(jog(-50), Owner::operator_panel);
    rig.run(100);
    EXPECT_EQ(rig.view().set_velocity, -6);

    rig.axis.set_mode(OperatingMode::automatic);
    EXPECT_EQ(rig.view().owner, Owner::program);
    EXPECT_EQ(rig.view().state, AxisState::Stopping);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.accept(absolute(0));
    rig.run(100);
    EXPECT_LT(rig.view().set_velocity, -20);
}

// A jog lives by its lease: without renewal the axis stops along its ramp, warns, and wants a new command.
TEST(Jog, ExpiredLeaseStopsTheAxisAndNeedsANewCommand) {
    Rig rig;
    rig.power_on();
    const auto id = rig.accept(jog(40));
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);
    const auto begin = rig.now;
    rig.run(100);
    EXPECT_EQ(rig.axis.renew_jog(id, 40, Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.run_until([&] { return rig.raised(AxisAlarm::jog_lease_expired); }, 1000));
    EXPECT_EQ(rig.now - begin, 300ms);  // renewed at 100 ms, lease 200 ms
    EXPECT_EQ(rig.axis.renew_jog(id, 40, Owner::program), ErrorId::state_forbids);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));

    EXPECT_EQ(rig.status(id), CommandStatus::error);
    EXPECT_EQ(rig.error_of(id), static_cast<ErrorId>(AxisAlarm::jog_lease_expired));
    EXPECT_LE(rig.largest_acceleration, 1000 * (1 + 1e-12));
    EXPECT_EQ(rig.view().error, 0);  // a warning, no axis error
    rig.accept(jog(40));
    EXPECT_TRUE(rig.axis.active_alarms().empty());
    rig.expect_no_jump();
}

// Renewing with another velocity changes it, with 0 it ends in Standstill, done.
TEST(Jog, FollowsItsRenewedVelocityAndEndsAtZero) {
    Rig rig;
    rig.power_on();
    const auto id = rig.accept(jog(40));
    double wish = 40;
    rig.program = [&] { (void)rig.axis.renew_jog(id, wish, Owner::program); };
    rig.run(200);
    EXPECT_EQ(rig.view().set_velocity, 40);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
    wish = -10;
    rig.run(300);
    EXPECT_EQ(rig.view().set_velocity, -10);
    wish = 0;
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_EQ(rig.refuse(jog(0)), ErrorId::invalid_velocity);
    rig.expect_no_jump();
}

TEST(DirectRequests, GoToTheAxisTheyNameOrSayThatThereIsNone) {
    FakeDrive first(1ms), second(1ms);
    std::vector<Axis> axes;
    axes.reserve(2);
    axes.emplace_back(plain_axis(), first, 1ms, std::uint16_t{0});
    axes.emplace_back(plain_axis(), second, 1ms, std::uint16_t{1});
    DirectRequests requests(axes);

    EXPECT_EQ(requests.submit(AxisRef{2}, absolute(1), Owner::program).error, ErrorId::invalid_axis);
    EXPECT_EQ(requests.power(AxisRef{}, true, true, true, Owner::program), ErrorId::invalid_axis);
    EXPECT_EQ(requests.power(AxisRef{1}, true, true, true, Owner::program), ErrorId::none);
    Instant now{};
    for (int i = 0; i < 50; ++i) {
        now += 1ms;
        for (auto& axis : axes) {
            axis.update(now);
            axis.supervise(now);
            axis.plan(now, 1ms);
            axis.encode(now);
        }
    }
    EXPECT_EQ(axes[0].view().state, AxisState::Disabled);
    EXPECT_EQ(axes[1].view().state, AxisState::Standstill);
    EXPECT_NE(requests.submit(AxisRef{1}, absolute(1), Owner::program).id, 0u);
}

}  // namespace
}  // namespace taktwerk::axes::test
