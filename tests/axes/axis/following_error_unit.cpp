// Following error with dead time: whatever the delays, an axis that follows perfectly has none; one that lags shows its lag.

#include "axes/axis/following_error.hpp"

#include "axes/axis/parameters.hpp"
#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

TEST(SetpointHistory, InterpolatesBetweenTheSetpointsInEffect) {
    SetpointHistory history;
    EXPECT_EQ(history.error_at(Instant{5ms}, 100), 0);  // nothing known
    history.record(Instant{10ms}, 1000);
    history.record(Instant{12ms}, 1200);

    EXPECT_EQ(history.error_at(Instant{9ms}, 990), 10);  // before the first: the first
    EXPECT_EQ(history.error_at(Instant{10ms}, 990), 10);
    EXPECT_EQ(history.error_at(Instant{11ms}, 990), 110);  // half way: 1100
    EXPECT_EQ(history.error_at(Instant{15ms}, 1200), 0);   // after the last it holds
}

TEST(SetpointHistory, ForgetsTheOldestWhenFull) {
    SetpointHistory history;
    for (int i = 0; i < 40; ++i) history.record(Instant{i * 1ms}, i);

    EXPECT_EQ(history.error_at(Instant{0ms}, 0), 8);  // 40 - 32 forgotten
    EXPECT_EQ(history.error_at(Instant{39ms}, 0), 39);
}

class DeadTime : public ::testing::TestWithParam<std::pair<int, int>> {};

// Constant acceleration 1000 u/s2 without jerk limit. Without matching, two cycles late at 100 u/s would show 0.2 u.
TEST_P(DeadTime, APerfectFollowerHasNoFollowingError) {
    auto config = plain_axis();
    config.limits.jerk = std::numeric_limits<double>::infinity();
    config.following = {.window = 0.002, .time = 1ms};  // two counts: rounding of the set-point and of the actual value
    Rig rig(config, [](FakeDrive& drive) { std::tie(drive.dead_cycles, drive.latch_age) = GetParam(); });
    rig.power_on();
    rig.accept(absolute(30));
    double largest = 0;
    rig.program = [&] { largest = std::max(largest, std::abs(rig.view().following_error)); };

    ASSERT_TRUE(rig.run_until([&] { return rig.view().set_position == 30; }, 2000));
    rig.run(20);

    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_LE(largest, 0.002);
    EXPECT_FALSE(rig.raised(AxisAlarm::following_error));
}
INSTANTIATE_TEST_SUITE_P(CyclesToTheDriveAndBack, DeadTime,
                         ::testing::Values(std::pair{0, 0}, std::pair{1, 0}, std::pair{2, 0}, std::pair{0, 1}, std::pair{1, 1},
                                           std::pair{2, 1}, std::pair{2, 2}));

// A motor 250 counts behind is 0.25 u behind, at any velocity.
TEST(FollowingError, ShowsTheRealLag) {
    Rig rig;
    rig.power_on();
    rig.drive.lag = 250;
    rig.accept(at_velocity(50));
    rig.run(300);

    EXPECT_NEAR(rig.view().following_error, 0.25, 0.0021);
}

// Beyond the window for the time: ErrorStop, the axis ramps down, no jump. For a shorter time: nothing.
TEST(FollowingError, BeyondTheWindowForTheTimeStopsTheAxis) {
    auto config = plain_axis();
    config.following = {.window = 0.5, .time = 10ms};
    Rig rig(config);
    rig.power_on();
    const auto id = rig.accept(at_velocity(50));
    rig.run(300);

    rig.drive.lag = 600;
    rig.run(8);
    rig.drive.lag = 0;
    rig.run(20);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);

    rig.drive.lag = 600;
    rig.run(14);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_EQ(rig.view().error, AlarmId{0x3001});
    EXPECT_EQ(rig.error_of(id), static_cast<ErrorId>(0x3001));
    rig.drive.lag = 0;
    rig.run(300);
    EXPECT_EQ(rig.view().set_velocity, 0);
    EXPECT_EQ(rig.drive.power, PowerState::enabled);  // the reaction is stop_axis: power stays
    EXPECT_LE(rig.largest_step, 0.1 + 1e-9);

    // note 4: reset with power gives Standstill
    rig.axis.reset(Owner::program);
    rig.run(2);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    EXPECT_EQ(rig.view().error, 0);
}

// 200 counts in 2 ms are 100000 counts/s; before the first and after the last two set-points it is that of the nearest two.
TEST(SetpointHistory, KnowsHowFastTheSetpointInEffectMoves) {
    SetpointHistory history;
    EXPECT_EQ(history.velocity_at(Instant{5ms}), 0);
    history.record(Instant{10ms}, 1000);
    EXPECT_EQ(history.velocity_at(Instant{10ms}), 0) << "one place is no velocity";
    history.record(Instant{12ms}, 1200);
    history.record(Instant{14ms}, 1100);

    EXPECT_DOUBLE_EQ(history.velocity_at(Instant{11ms}), 100'000);
    EXPECT_DOUBLE_EQ(history.velocity_at(Instant{9ms}), 100'000);
    EXPECT_DOUBLE_EQ(history.velocity_at(Instant{13ms}), -50'000);
    EXPECT_DOUBLE_EQ(history.velocity_at(Instant{20ms}), -50'000);
}

// 0.1 u and 10 ms: 0.6 u are allowed at 50 u/s, in either direction, 0.3 u at 20 u/s. The view and parameter 1009 say which, so does the alarm.
TEST(FollowingError, TheWindowGrowsWithTheVelocityOfTheSameInstant) {
    for (const double sense : {1.0, -1.0}) {
        auto config = plain_axis();
        config.gearing.inverted = sense < 0;
        config.following = {.window = 0.1, .time = 5ms, .per_velocity = 10ms};
        Rig rig(config);
        rig.power_on();
        EXPECT_EQ(rig.view().following_window, 0.1);
        rig.accept(at_velocity(50));
        rig.run(300);
        rig.drive.lag = 500;
        rig.run(100);
        EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
        EXPECT_NEAR(rig.view().following_window, 0.6, 0.011) << "a count more or less in a cycle is 1 u/s";
        EXPECT_EQ(find_parameter(1009)->read(rig.view()), rig.view().following_window);

        rig.accept(at_velocity(20));
        rig.run(300);
        EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
        ASSERT_TRUE(rig.raised(AxisAlarm::following_error));
        EXPECT_GT(rig.alarms.front().b, 0.29);
        EXPECT_LT(rig.alarms.front().b, 0.5);
        EXPECT_LT(rig.alarms.front().b, std::abs(rig.alarms.front().a));
    }
}

// At standstill the window is the fixed one: an axis that stands where it should not is found as before.
TEST(FollowingError, AtStandstillTheWindowIsTheFixedOne) {
    auto config = plain_axis();
    config.following = {.window = 0.1, .time = 5ms, .per_velocity = 1s};
    Rig rig(config);
    rig.power_on();
    rig.drive.lag = 150;
    rig.run(20);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_EQ(rig.alarms.front().b, 0.1);
}

TEST(FollowingError, TheTimeForEachVelocityIsAParameter) {
    auto config = plain_axis();
    config.following = {.window = 0.1, .time = 5ms};
    Rig rig(config);
    rig.power_on();
    EXPECT_EQ(find_parameter(lag_per_velocity)->read(rig.view()), 0);
    ASSERT_EQ(rig.axis.set(WriteParameter{lag_per_velocity, 0.01}, Owner::program), ErrorId::none);
    rig.accept(at_velocity(50));
    rig.run(300);
    EXPECT_NEAR(rig.view().following_window, 0.6, 0.011);
    ASSERT_EQ(rig.axis.set(WriteParameter{lag_per_velocity, 0}, Owner::program), ErrorId::none);
    rig.run(2);
    EXPECT_EQ(rig.view().following_window, 0.1);
    EXPECT_EQ(rig.axis.set(WriteParameter{lag_per_velocity, -0.01}, Owner::program), ErrorId::invalid_parameter);
}

TEST(FollowingError, TheTimeForEachVelocityHasItsBounds) {
    auto config = plain_axis();
    for (const auto time : {Duration{-1}, Duration{10s} + Duration{1}}) {
        config.following = {.window = 1, .per_velocity = time};
        ASSERT_EQ(check(config).size(), 1u);
        EXPECT_EQ(check(config)[0].subject, "axes.x.following.per_velocity");
    }
    config.following = {.window = infinity, .per_velocity = 10ms};
    ASSERT_EQ(check(config).size(), 1u) << "it widens nothing";
    EXPECT_EQ(check(config)[0].subject, "axes.x.following.per_velocity");
}

}  // namespace
}  // namespace taktwerk::axes::test
