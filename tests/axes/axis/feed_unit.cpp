// Set-points from outside, one per cycle: what is followed, what is refused, and what happens when none comes.

#include "tests/axes/axis/axis_rig.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::test {
namespace {

AxisCommand external(MC_BufferMode mode = mcAborting) { return {.kind = CommandKind::external, .buffer_mode = mode}; }

/// Feeds x(t) = a t^2 / 2 up to `top` u/s, then on at that velocity.
struct FedRig : Rig {
    explicit FedRig(const AxisConfig& config = plain_axis()) : Rig(config) {
        power_on();
        program = [this] {
            if (!feeding) return;
            const double before = velocity;
            velocity = std::min(top, velocity + acceleration * 1e-3);
            position += (before + velocity) / 2 * 1e-3;
            answer = axis.set(SetpointFeed{position, velocity, 0}, Owner::program);
        };
    }
    bool feeding = false;
    double top = 50, acceleration = 500;
    double position = 0, velocity = 0;
    ErrorId answer = ErrorId::none;
};

TEST(SetpointFeed, IsFollowedInTheCycleInWhichItComes) {
    FedRig rig;
    const auto id = rig.accept(external());
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    rig.run(100);  // nothing comes: an axis that stands waits
    EXPECT_EQ(rig.status(id), CommandStatus::active);

    rig.feeding = true;
    for (int i = 0; i < 300; ++i) {
        rig.step();
        ASSERT_EQ(rig.answer, ErrorId::none);
        EXPECT_EQ(rig.view().set_position, rig.position);
        EXPECT_EQ(rig.view().set_velocity, rig.velocity);
        EXPECT_EQ(rig.drive.last.position, std::llround(rig.position * 1000));
    }
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
    rig.expect_no_jump();
}

// P1-037: a jerk above the axis' own, 20000 u/s3, is that of the axis. A stop takes over what the feed declares: it would have braked with all of 30000 as well.
TEST(SetpointFeed, DeclaresNoMoreJerkThanTheAxisHas) {
    FedRig rig;
    auto fed = external();
    fed.jerk = 30'000;
    const auto id = rig.accept(fed);
    rig.step();
    double velocity = 0, position = 0, before = 0;
    const auto feed = [&](double acceleration) {
        position += velocity * 1e-3 + (2 * before + acceleration) * 1e-6 / 6;
        velocity += (before + acceleration) / 2 * 1e-3;
        before = acceleration;
        const auto answer = rig.axis.set(SetpointFeed{position, velocity, acceleration}, Owner::program);
        rig.step();
        return answer;
    };
    EXPECT_EQ(feed(20), ErrorId::none);
    EXPECT_EQ(feed(30), ErrorId::none);
    rig.accept({.kind = CommandKind::halt});
    double most = 0;
    for (Patience patience; patience.lasts(rig.view().state != AxisState::Standstill);) {
        const double acceleration = rig.view().set_acceleration;
        rig.step();
        most = std::max(most, std::abs(rig.view().set_acceleration - acceleration));
    }
    EXPECT_LE(most, 20 * (1 + 1e-9));
    EXPECT_EQ(rig.status(id), CommandStatus::aborted);

    position = rig.view().set_position, velocity = before = 0;
    rig.accept(fed);
    rig.step();
    EXPECT_EQ(feed(25), ErrorId::invalid_dynamics);
}

// A feed of 70 u/s beside an addition of 40: the sum passes 100 u/s, so the feed is refused where it does, and the axis brakes.
TEST(SetpointFeed, WithWhatIsSuperimposedItKeepsTheVelocity) {
    FedRig rig;
    const auto id = rig.accept(external());
    rig.accept({.kind = CommandKind::move_superimposed, .position = 60, .velocity = 40});
    rig.top = 70;
    rig.feeding = true;
    ASSERT_TRUE(rig.run_until([&] { return rig.answer != ErrorId::none; }, 500));
    EXPECT_EQ(rig.answer, ErrorId::invalid_velocity);
    EXPECT_NEAR(rig.velocity, 60, 0.51);
    EXPECT_EQ(rig.status(id), CommandStatus::error);
    rig.feeding = false;
    rig.run(500);
    rig.expect_no_jump();
}

TEST(SetpointFeed, AMotionCommandTakesOverFromTheFedState) {
    FedRig rig;
    const auto id = rig.accept(external());
    rig.feeding = true;
    rig.run(200);
    rig.feeding = false;
    const auto next = rig.accept(absolute(30, 60));
    EXPECT_EQ(rig.status(id), CommandStatus::aborted);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(next), CommandStatus::done);
    EXPECT_LE(rig.largest_acceleration, 1000 * (1 + 1e-9));
    rig.expect_no_jump();
}

// Three missing set-points are bridged at the last velocity, with the fourth the axis brakes with its own deceleration.
TEST(SetpointFeed, WhenNoneComesTheAxisBrakesFromWhereItIs) {
    FedRig rig;
    const auto id = rig.accept(external());
    rig.feeding = true;
    rig.run(200);
    ASSERT_EQ(rig.view().set_velocity, 50);
    rig.feeding = false;
    const double here = rig.view().set_position;
    rig.run(3);
    EXPECT_EQ(rig.view().set_velocity, 50);
    EXPECT_NEAR(rig.view().set_position, here + 0.15, 1e-12);
    EXPECT_EQ(rig.status(id), CommandStatus::active) << "nothing followed: not in target";
    rig.step();
    EXPECT_EQ(rig.status(id), CommandStatus::error);
    EXPECT_EQ(rig.error_of(id), ErrorId::setpoint_missing);
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);  // Stopping is MC_Stop's (figure 2)
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.expect_no_jump();
    EXPECT_LE(rig.largest_acceleration, 1000 * (1 + 1e-9));
}

TEST(SetpointFeed, AFewMissingOnesAreBridged) {
    FedRig rig;
    const auto id = rig.accept(external());
    rig.feeding = true;
    rig.run(200);
    rig.feeding = false;
    rig.run(2);
    rig.position += 0.1;  // the source has gone on
    rig.feeding = true;
    rig.run(50);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
    EXPECT_EQ(rig.view().set_position, rig.position);
}

struct BadFeed {
    const char* what;
    SetpointFeed fed;  // position and velocity relative to a good one
    ErrorId error;
};

class SetpointFeedRefused : public ::testing::TestWithParam<BadFeed> {};

// The axis runs at 50 u/s, 0.05 u per cycle; limits 100 u/s and 1000 u/s2: 1 u/s per cycle.
TEST_P(SetpointFeedRefused, IsNotFollowedAndTheAxisBrakes) {
    FedRig rig;
    const auto id = rig.accept(external());
    rig.feeding = true;
    rig.run(200);
    ASSERT_EQ(rig.view().set_velocity, 50);
    rig.feeding = false;
    const auto& bad = GetParam().fed;
    const double good = rig.view().set_position + 0.05;
    EXPECT_EQ(rig.axis.set(SetpointFeed{good + bad.position, 50 + bad.velocity, bad.acceleration}, Owner::program), GetParam().error);
    EXPECT_EQ(rig.status(id), CommandStatus::error);
    EXPECT_EQ(rig.error_of(id), GetParam().error);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    rig.expect_no_jump();
    EXPECT_LE(rig.largest_acceleration, 1000 * (1 + 1e-9));
}
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
INSTANTIATE_TEST_SUITE_P(Kinds, SetpointFeedRefused,
                         ::testing::Values(BadFeed{"leap", {0.06, 0, 0}, ErrorId::invalid_velocity},             // 110 u/s in this cycle
                                           BadFeed{"step", {0.01, 0, 0}, ErrorId::invalid_dynamics},             // 60 u/s, says 50
                                           BadFeed{"kink", {0.0005, 1.1, 0}, ErrorId::invalid_dynamics},         // 1100 u/s2
                                           BadFeed{"speed", {0, 51, 0}, ErrorId::invalid_velocity},              // 101 u/s
                                           BadFeed{"acceleration", {0, 0, 1001}, ErrorId::invalid_dynamics},     // of another unit, say
                                           BadFeed{"no_position", {nan, 0, 0}, ErrorId::invalid_position},       //
                                           BadFeed{"no_velocity", {0, nan, 0}, ErrorId::invalid_velocity},       //
                                           BadFeed{"no_acceleration", {0, 0, nan}, ErrorId::invalid_dynamics}),  //
                         [](const auto& tested) { return tested.param.what; });

// A source that tells an acceleration which is not there. What a stop or a motion takes over from it carries the axis past no limit and back
// beyond no standstill.
class SetpointFeedLeft : public ::testing::TestWithParam<double> {};

TEST_P(SetpointFeedLeft, KeepsTheAxisInsideItsLimits) {
    using Leave = std::function<void(Rig&)>;
    const std::vector<std::pair<const char*, Leave>> ways{
        {"emergency stop", [](Rig& r) { r.axis.demand_emergency_stop(EmergencyStop::stop_and_power_off); }},
        {"halt", [](Rig& r) { r.accept(halt()); }},
        {"stop", [](Rig& r) { r.accept(stop()); }},
        {"move", [](Rig& r) { r.accept(relative(60, 100)); }},
        {"velocity", [](Rig& r) { r.accept(at_velocity(100)); }},
        {"nothing more", [](Rig&) {}},
    };
    for (const double velocity : {1.0, 20.0, 99.0}) {
        for (const auto& [name, leave] : ways) {
            SCOPED_TRACE(std::string(name) + " at " + std::to_string(velocity));
            FedRig rig;
            rig.accept(external());
            rig.top = velocity;
            rig.feeding = true;
            ASSERT_TRUE(rig.run_until([&] { return rig.velocity == velocity; }, 1000));
            rig.feeding = false;
            rig.position += velocity * 1e-3;
            ASSERT_EQ(rig.axis.set(SetpointFeed{rig.position, velocity, GetParam()}, Owner::program), ErrorId::none);
            rig.step();
            leave(rig);
            for (int i = 0; i < 2000; ++i) {
                rig.step();
                ASSERT_GE(rig.view().set_velocity, -1e-9) << i;
                ASSERT_LE(rig.view().set_velocity, 100 * (1 + 1e-9)) << i;
            }
            rig.expect_no_jump();
        }
    }
}
INSTANTIATE_TEST_SUITE_P(Told, SetpointFeedLeft, ::testing::Values(-1000.0, -300.0, 0.0, 300.0, 1000.0));

TEST(SetpointFeed, StopsInsideTheSoftwareLimits) {
    auto config = plain_axis();
    config.homing.kind = HomingKind::set_here;
    config.limits.position_min = -1;
    config.limits.position_max = 10;
    FedRig rig(config);
    rig.accept(home(0));
    rig.run(5);
    const auto id = rig.accept(external());
    rig.feeding = true;
    ASSERT_TRUE(rig.run_until([&] { return rig.answer != ErrorId::none; }, 2000));
    EXPECT_EQ(rig.error_of(id), ErrorId::beyond_software_limit);
    rig.feeding = false;
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_LE(rig.view().set_position, 10);
    EXPECT_GE(rig.view().set_position, 9.9);
}

TEST(SetpointFeed, WithoutItsCommandAFeedIsRefusedAndNothingCanWaitBehindIt) {
    FedRig rig;
    EXPECT_EQ(rig.axis.set(SetpointFeed{0, 0, 0}, Owner::program), ErrorId::state_forbids);
    rig.accept(external());
    EXPECT_EQ(rig.refuse(absolute(1, 1, mcBuffered)), ErrorId::buffer_mode_not_supported);
    EXPECT_EQ(rig.axis.set(SetpointFeed{0, 0, 0}, Owner::operator_panel), ErrorId::owned_by_other);
}

}  // namespace
}  // namespace taktwerk::axes::test
