// Limits of one direction: each plan keeps those of the direction in which the axis moves. The oracle of the rig holds every cycle against them.

#include "axes/axis/direction_limits.hpp"

#include "axes/axis/parameters.hpp"
#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

/// A weight helps downwards: 100 u/s and 1000 u/s2 up, 40 u/s, 400 u/s2 and 600 u/s2 down. Corners, so that each ramp reaches its limit.
AxisConfig hoist() {
    auto config = trapezoids(100, 1000);
    config.limits.negative = {.velocity = 40, .acceleration = 400, .deceleration = 600};
    return config;
}

/// The greatest velocity, and the greatest accelerations while it gets faster and slower, in one direction.
struct Peaks {
    double velocity = 0, faster = 0, slower = 0;
    void see(const AxisView& view, double sense) {
        if (view.set_velocity * sense <= 0) return;
        velocity = std::max(velocity, std::abs(view.set_velocity));
        double& most = view.set_acceleration * view.set_velocity > 0 ? faster : slower;
        most = std::max(most, std::abs(view.set_acceleration));
    }
};

TEST(DirectionLimits, AMoveKeepsThoseOfItsDirection) {
    Rig rig(hoist());
    rig.power_on();
    Peaks up, down;
    rig.program = [&] { up.see(rig.view(), 1), down.see(rig.view(), -1); };
    rig.accept(absolute(60));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(up.velocity, 100);
    EXPECT_EQ(up.faster, 1000);
    EXPECT_EQ(up.slower, 1000);
    rig.accept(absolute(0));
    rig.step();
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::axis_limit) << "why it is slower than commanded";
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 0);
    EXPECT_EQ(down.velocity, 40);
    EXPECT_EQ(down.faster, 400);
    EXPECT_EQ(down.slower, 600);
}

// Down 10 u: 40^2 / 800 + 40^2 / 1200 = 3.333 u of ramps and 6.667 u at 40 u/s: 0.1 + 0.0667 + 0.1667 s.
TEST(DirectionLimits, AndIsAsFastAsTheyAllow) {
    Rig rig(hoist());
    rig.power_on();
    const auto id = rig.accept(relative(-10));
    int cycles = 0;
    while (rig.status(id) != CommandStatus::done && cycles < 1000) {
        rig.step();
        ++cycles;
    }
    EXPECT_EQ(cycles, 334);
}

TEST(DirectionLimits, HoldForVelocitiesJogsAndMovesThatTurnRound) {
    Rig rig(hoist());
    rig.power_on();
    Peaks up, down;
    rig.program = [&] { up.see(rig.view(), 1), down.see(rig.view(), -1); };
    rig.accept(at_velocity(80));
    rig.run(200);
    const auto back = rig.accept(at_velocity(-80));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(back) == CommandStatus::in_target; }, 500));
    EXPECT_EQ(rig.view().set_velocity, -40) << "InVelocity at what the direction allows";
    EXPECT_EQ(rig.view().limiter, VelocityLimiter::axis_limit);
    rig.accept(absolute(rig.view().set_position + 30));  // out of the motion downwards
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.accept(at_velocity(-80));
    rig.run(300);
    rig.accept(stop());
    rig.run(300);
    EXPECT_EQ(up.velocity, 100);
    EXPECT_EQ(up.slower, 1000);
    EXPECT_EQ(down.velocity, 40);
    EXPECT_EQ(down.faster, 400);
    EXPECT_EQ(down.slower, 600);
}

// A stop for an error is as hard as it is configured, in both directions; where nothing is configured, as the direction is.
TEST(DirectionLimits, AStopForAnErrorIsAsHardAsConfigured) {
    for (const double hard : {0.0, 2000.0}) {
        auto config = hoist();
        config.limits.stop_deceleration = hard;
        Rig rig(config);
        rig.power_on();
        rig.accept(at_velocity(-40));
        rig.run(300);
        Peaks down;
        rig.program = [&] { down.see(rig.view(), -1); };
        rig.axis.demand_emergency_stop(EmergencyStop::stop);
        rig.run(200);
        EXPECT_EQ(rig.view().set_velocity, 0);
        EXPECT_EQ(down.slower, hard > 0 ? 2000 : 600);
    }
}

// The lower limit at -20 u is met from a motion at 40 u/s with 600 u/s2: the guard begins where these bring it to rest on the limit.
TEST(DirectionLimits, ASoftwareLimitIsMetWithTheRampOfTheDirection) {
    auto config = hoist();
    config.limits.position_min = -20;
    config.limits.position_max = 100;
    config.homing.kind = HomingKind::set_here;
    Rig rig(config);
    rig.power_on();
    const auto id = rig.accept(home(0));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }));
    Peaks down;
    rig.program = [&] { down.see(rig.view(), -1); };
    rig.accept(at_velocity(-40));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_velocity == 0 && rig.view().state == AxisState::ErrorStop; }, 2000));
    EXPECT_NEAR(rig.view().set_position, -20, 1e-9);
    EXPECT_LE(down.slower, 600 * (1 + 1e-9));
}

// Blended downwards at 40 u/s, up again at 100: the joint is passed at what both moves may have, and nothing is ever faster.
TEST(DirectionLimits, BlendedMovesKeepThem) {
    Rig rig(hoist());
    rig.power_on();
    Peaks up, down;
    rig.program = [&] { up.see(rig.view(), 1), down.see(rig.view(), -1); };
    rig.accept(absolute(-20, 100));
    rig.accept(absolute(-40, 100, mcBlendingNext));
    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_position < -20; }, 2000));
    EXPECT_NEAR(rig.view().set_velocity, -40, 1e-6) << "no stop at the joint";
    rig.accept(absolute(60, 100, mcBlendingHigh));
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 60);
    EXPECT_EQ(down.velocity, 40);
    EXPECT_EQ(up.velocity, 100);
}

// What is superimposed counts for the sum: 30 u/s downwards leave 10 for it, whatever it asks for.
TEST(DirectionLimits, HoldForWhatIsSuperimposed) {
    Rig rig(hoist());
    rig.power_on();
    rig.accept(at_velocity(-30));
    rig.run(300);
    double fastest = 0;
    rig.program = [&] { fastest = std::min(fastest, rig.view().set_velocity); };
    const auto id = rig.accept(on_top(-5, 100));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(id) == CommandStatus::done; }, 5000));
    EXPECT_NEAR(fastest, -40, 1e-6);
}

TEST(DirectionLimits, AreParametersToBeRead) {
    Rig rig(hoist());
    const auto read = [&](std::int32_t number) { return find_parameter(number)->read(rig.view()); };
    EXPECT_EQ(read(1023), 100);
    EXPECT_EQ(read(1024), 40);
    EXPECT_EQ(read(1025), 1000);
    EXPECT_EQ(read(1026), 400);
    EXPECT_EQ(read(1027), 1000);
    EXPECT_EQ(read(1028), 600);
    ASSERT_EQ(rig.axis.set(WriteParameter{velocity_of_application, 30}, Owner::program), ErrorId::none);
    EXPECT_EQ(read(1023), 30) << "lowered for both";
    EXPECT_EQ(read(1024), 30);
    EXPECT_EQ(rig.axis.set(WriteParameter{1024, 50}, Owner::program), ErrorId::read_only_parameter);
}

TEST(DirectionLimits, AreNoMoreThanThoseOfBoth) {
    auto config = plain_axis();
    config.limits.positive = {.velocity = 101, .acceleration = 1001, .deceleration = -1};
    std::string subjects;
    for (const auto& problem : check(config)) subjects += problem.subject.substr(sizeof("axes.x.limits.") - 1) + " ";
    EXPECT_EQ(subjects, "positive.velocity positive.acceleration positive.deceleration ");
}

// The words go by the velocity, the planner's by the sign of the acceleration: what brakes a positive velocity is negative.
TEST(DirectionLimits, BecomeThoseOfASign) {
    AxisLimits axis{.velocity = 100, .acceleration = 1000, .deceleration = 2000, .jerk = 5000};
    const MotionLimits commanded{80, 900, 2000, 4000};
    EXPECT_EQ(in_each_direction(commanded, axis), SignedLimits{commanded});
    axis.negative = {.velocity = 40, .acceleration = 400, .deceleration = 600};
    EXPECT_EQ(in_each_direction(commanded, axis), (SignedLimits{{80, 900, 600, 4000}, {40, 400, 2000, 4000}}));
    const MotionLimits harder{80, 900, 3000, 4000};
    EXPECT_EQ(towards(harder, axis, -1), (MotionLimits{40, 400, 3000, 4000})) << "given on purpose";
    EXPECT_EQ(gentlest(commanded, axis), (MotionLimits{80, 400, 600, 4000}));
}

}  // namespace
}  // namespace taktwerk::axes::test
