// The I part of the position loop that is closed in the axis.

#include "axes/axis/position_integral.hpp"

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr double never = 1e9;

// kv 20 /s, 100 ms: of 0.5 u the P part makes 10 u/s, and the I part as much in 100 ms.
TEST(IntegralPart, AddsInItsTimeWhatThePPartMakes) {
    IntegralPart part({.time = 100ms, .limit = 50}, 20, 100);
    for (int i = 0; i < 100; ++i) part.step(0.5, 10, never, 0.001);
    EXPECT_NEAR(part.value(), 10, 1e-9);
    for (int i = 0; i < 50; ++i) part.step(-0.5, -10, never, 0.001);
    EXPECT_NEAR(part.value(), 5, 1e-9);
}

// Inside the dead band it keeps what it has; beyond it only what is beyond counts, so that nothing jumps at its edge.
TEST(IntegralPart, TheDeadBandHoldsIt) {
    IntegralPart part({.time = 100ms, .limit = 50, .dead_band = 0.1}, 20, 100);
    for (int i = 0; i < 100; ++i) part.step(0.6, 12, never, 0.001);
    EXPECT_NEAR(part.value(), 10, 1e-9) << "0.5 of 0.6";
    for (const double inside : {0.1, 0.05, 0.0, -0.1})
        for (int i = 0; i < 100; ++i) part.step(inside, 0, never, 0.001);
    EXPECT_NEAR(part.value(), 10, 1e-9);
}

TEST(IntegralPart, NeverAddsMoreThanItsLimit) {
    IntegralPart given({.time = 10ms, .limit = 3}, 20, 100);
    for (int i = 0; i < 1000; ++i) given.step(1, 20, never, 0.001);
    EXPECT_EQ(given.value(), 3);
    for (int i = 0; i < 1000; ++i) given.step(-1, -20, never, 0.001);
    EXPECT_EQ(given.value(), -3);
    IntegralPart by_itself({.time = 10ms}, 20, 100);
    for (int i = 0; i < 1000; ++i) by_itself.step(1, 20, never, 0.001);
    EXPECT_EQ(by_itself.value(), 10) << "a tenth of the velocity limit";
}

// Where the velocity is cut off at 15 already it does not grow on; back it goes at once.
TEST(IntegralPart, DoesNotWindUpBehindAVelocityThatIsCutOff) {
    IntegralPart part({.time = 100ms, .limit = 50}, 20, 100);
    for (int i = 0; i < 5000; ++i) part.step(0.6, 12, 15, 0.001);
    EXPECT_NEAR(part.value(), 3, 0.13) << "12 and 3 are 15";
    const double before = part.value();
    part.step(-0.1, 12, 15, 0.001);
    EXPECT_LT(part.value(), before);
}

// An e-th part is left after its time, and nothing ever steps.
TEST(IntegralPart, RunsOutWithItsOwnTime) {
    IntegralPart part({.time = 100ms, .limit = 50}, 20, 100);
    for (int i = 0; i < 100; ++i) part.step(0.5, 10, never, 0.001);
    double before = part.value();
    for (int i = 0; i < 100; ++i) {
        const double now = part.run_out(0.001);
        EXPECT_LT(now, before);
        EXPECT_GT(now, before * 0.98);
        before = now;
    }
    EXPECT_NEAR(before, 10 * std::exp(-1.0), 0.05);
}

TEST(IntegralPart, IsNotThereUnlessItIsAskedFor) { EXPECT_FALSE(IntegralPart({}, 20, 100).used()); }

/// A loop of 20 /s in the axis, over a drive that turns by 2 u/s more than it is told.
AxisConfig drifting_axis(const PositionIntegral& integral) {
    auto config = plain_axis();
    config.control = {.mode = ControlMode::velocity, .kv = 20};
    config.control.integral = integral;
    return config;
}
void drift(FakeDrive& drive) { drive.drift = 2000; }

// 2 u/s / 20 /s = 0.1 u stay without it, none with it; with a dead band no more than that.
TEST(PositionIntegral, EndsAStandingErrorUpToTheDeadBand) {
    for (const auto& [integral, left] : {std::pair{PositionIntegral{}, 0.1},
                                         {PositionIntegral{.time = 200ms}, 0.0},
                                         {PositionIntegral{.time = 200ms, .dead_band = 0.02}, 0.02}}) {
        Rig rig(drifting_axis(integral), drift);
        rig.power_on();
        rig.run(5000);
        EXPECT_NEAR(std::abs(rig.view().following_error), left, 0.002);
        EXPECT_TRUE(rig.alarms.empty());
    }
}

// Power off and on again begins with none of it: the first velocity told is that of the P part.
TEST(PositionIntegral, BeginsAnewWithEachPower) {
    Rig rig(drifting_axis({.time = 200ms}), drift);
    rig.power_on();
    rig.run(5000);
    EXPECT_NEAR(rig.drive.last.velocity, -2000, 20);
    rig.enable = false;
    ASSERT_TRUE(rig.run_to(AxisState::Disabled));
    rig.run(50);
    rig.enable = true;
    ASSERT_TRUE(rig.run_until([&] { return rig.drive.power == PowerState::enabled; }, 100));
    rig.run(3);
    EXPECT_LT(std::abs(rig.drive.last.velocity), 300);
}

// While MC_Stop holds the axis it runs out, without a step: the axis goes to where the P part alone holds it. Afterwards it comes back.
TEST(PositionIntegral, RunsOutWhileTheAxisIsStopped) {
    Rig rig(drifting_axis({.time = 200ms}), drift);
    rig.power_on();
    rig.run(5000);
    const auto id = rig.accept(stop());
    double before = rig.drive.last.velocity;
    for (int i = 0; i < 3000; ++i) {
        rig.step();
        ASSERT_LE(std::abs(rig.drive.last.velocity - before), 100) << i << " cycles after";
        before = rig.drive.last.velocity;
    }
    EXPECT_NEAR(std::abs(rig.view().following_error), 0.1, 0.003);
    rig.axis.release_stop(id, Owner::program);
    rig.run(5000);
    EXPECT_NEAR(rig.view().following_error, 0, 0.002);
}

// A silent drive must not creep on with what was added up.
TEST(PositionIntegral, IsGoneWithoutFeedback) {
    Rig rig(drifting_axis({.time = 200ms}), drift);
    rig.power_on();
    rig.run(5000);
    rig.drive.silent = true;
    rig.run(500);
    EXPECT_EQ(rig.view().state, AxisState::ErrorStop);
    EXPECT_EQ(rig.drive.last.velocity, 0);
}

TEST(PositionIntegral, NeedsALoopHereAndSoundNumbers) {
    const auto subjects = [](const AxisConfig& config) {
        std::string out;
        for (const auto& problem : check(config)) out += problem.subject + " ";
        return out;
    };
    auto config = plain_axis();
    config.control.integral.time = 100ms;
    EXPECT_EQ(subjects(config), "axes.x.control.integral.time ") << "the loop is the drive's";
    config.control.kv = 20;
    EXPECT_EQ(subjects(config), "") << "MC_SetControllerMode may close it here";
    config.control.integral = {.time = 100us, .limit = 101, .dead_band = -1};
    EXPECT_EQ(subjects(config), "axes.x.control.integral.time axes.x.control.integral.limit axes.x.control.integral.dead_band ");
}

}  // namespace
}  // namespace taktwerk::axes::test
