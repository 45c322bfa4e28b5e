// Who may measure an axis, and what ends it: it lives by renewals, as a jog, and the axis ends along its ramp whatever happens.

#include "axes/measuring/step_response.hpp"
#include "tests/runtime/measuring/measuring_rig.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::AxisState;
using axes::ErrorId;
using axes::MeasureKind;
using axes::MeasureOrder;

MeasureOrder step_order(double distance = 50) {
    MeasureOrder order{MeasureKind::step};
    order.distance = distance, order.velocity = 100, order.count = 2;
    return order;
}

struct Measured : ::testing::Test {
    MeasuringRig m;
    /// Pressed, and in the middle of the first move.
    void begin() {
        ASSERT_EQ(m.press(step_order(200)).answer, Answer::accepted);
        m.run(150ms);
        ASSERT_GT(m.axis(0).set_velocity, 50);
    }
    /// What every end has in common.
    void expect_stands(MeasureEnd how, Duration within) {
        EXPECT_TRUE(m.until([&] { return m.axis(0).set_velocity == 0 && m.axis(0).set_acceleration == 0; }, within));
        EXPECT_FALSE(m.measure_state().running);
        EXPECT_EQ(m.measure_state().end, how) << name(m.measure_state().end);
        const double at = m.axis(0).set_position;
        m.run(500ms);
        EXPECT_EQ(m.axis(0).set_position, at) << "it does not go on by itself";
        m.expect_no_jump();
    }
};
// A stop from 100 mm/s at 5000 mm/s2 and 100000 mm/s3 takes 100/5000 + 5000/100000 = 70 ms.
constexpr Duration ramp = 80ms;

TEST_F(Measured, HeldToItsEndItStandsWhereItBegan) {
    const auto run = m.measure(step_order());
    EXPECT_EQ(m.measure_state().end, MeasureEnd::done);
    EXPECT_EQ(m.measure_state().lost, 0u);
    EXPECT_NEAR(static_cast<double>(run.samples.size()) * 1e-3, run.plan.duration(), 0.5);
    for (std::size_t i = 1; i < run.samples.size(); ++i) ASSERT_EQ(run.samples[i].cycle, run.samples[i - 1].cycle + 1);
    m.run(20ms);
    EXPECT_EQ(m.axis(0).state, AxisState::Standstill);
    EXPECT_NEAR(m.axis(0).set_position, 400, 1e-9);
    EXPECT_EQ(m.alarms(), "");
    m.expect_no_jump();
}

TEST_F(Measured, RenewalsThatStayOutEndItByItsLease) {
    begin();
    expect_stands(MeasureEnd::lease, 200ms + ramp);
    EXPECT_EQ(m.renew(), Answer::stale) << "a late renewal starts nothing";
}

TEST_F(Measured, AStopEndsIt) {
    begin();
    m.machine->request_stop(0);
    expect_stands(MeasureEnd::stopped, ramp);
}

TEST_F(Measured, ALostClientEndsIt) {
    begin();
    m.machine->release_jog(0);
    expect_stands(MeasureEnd::stopped, ramp);
}

TEST_F(Measured, AnotherModeEndsIt) {
    begin();
    m.mode(Mode::setup);
    expect_stands(MeasureEnd::stopped, ramp);
}

TEST_F(Measured, AnEmergencyStopEndsIt) {
    begin();
    m.world.set_input("estop_ok", false);
    m.until([&] { return m.axis(0).set_velocity == 0; }, 150ms);
    EXPECT_FALSE(m.measure_state().running);
    EXPECT_EQ(m.axis(0).set_velocity, 0);
    m.expect_no_jump();
}

TEST_F(Measured, AnAlarmOfTheAxisEndsIt) {
    begin();
    m.world.drive("x")->jam(true);
    for (int i = 0; i < 20 && m.measure_state().running; ++i) {
        m.run(45ms);
        if (m.measure_state().running) m.renew();
    }
    EXPECT_EQ(m.measure_state().end, MeasureEnd::alarm);
    EXPECT_EQ(m.axis(0).state, AxisState::ErrorStop);
}

TEST_F(Measured, AnotherPartyThatTakesControlEndsIt) {
    begin();
    OperatorCommand c;
    c.action = OperatorAction::take_control;
    c.owner = axes::Owner::commissioning;
    c.axis = 0;
    EXPECT_EQ(m.command(c).answer, Answer::accepted);
    expect_stands(MeasureEnd::stopped, ramp);
}

TEST_F(Measured, ItIsRefusedWithItsReason) {
    auto far = step_order(401);
    EXPECT_EQ(m.press(far).error, ErrorId::beyond_software_limit);
    EXPECT_EQ(m.press({}).answer, Answer::bad_value);
    m.mode(Mode::automatic);
    EXPECT_EQ(m.press(step_order()).answer, Answer::wrong_mode);
    m.mode(Mode::manual);
    EXPECT_EQ(m.press(step_order()).error, ErrorId::not_powered) << "automatic mode took the operator's power";
    m.enable(0);
    ASSERT_EQ(m.command(OperatorAction::jog, 0, true, 20).answer, Answer::accepted);
    m.run(50ms);
    EXPECT_EQ(m.press(step_order()).error, ErrorId::not_at_standstill);
    m.run(1s);
    EXPECT_EQ(m.axis(0).state, AxisState::Standstill);
    OperatorCommand c;
    c.action = OperatorAction::measure;
    c.owner = axes::Owner::commissioning;
    c.axis = 0, c.flag = true, c.measure = step_order();
    EXPECT_EQ(m.command(c).answer, Answer::no_control);
    EXPECT_EQ(m.axis(0).set_velocity, 0);
}

TEST(MeasuredUnhomed, AnAxisWithSoftwareLimitsMustKnowWhereItIs) {
    TestMachine m(MeasuringRig::measured());
    ASSERT_TRUE(m.up());
    m.enable(0);
    OperatorCommand c;
    c.action = OperatorAction::measure;
    c.axis = 0, c.flag = true, c.measure = step_order();
    EXPECT_EQ(m.command(c).error, ErrorId::not_homed);
}

// The modulo axis stands at 9.5 of 10 u and turns on over 10: its set-points have no leap there.
TEST(MeasuredModulo, TheTurnIsNoEnd) {
    auto config = MeasuringRig::measured();
    auto& axis = config.axes[0].axis;
    axis.modulo = 10;
    axis.limits.position_min = -std::numeric_limits<double>::infinity();
    axis.limits.position_max = std::numeric_limits<double>::infinity();
    axis.homing.offset = 9.5;
    MeasuringRig m(config);
    auto run = m.measure(step_order(25));
    EXPECT_EQ(m.measure_state().end, MeasureEnd::done) << name(m.measure_state().end) << " " << int(m.measure_state().error);
    axes::measuring::unwrap(run.samples, 10);
    double furthest = 0;
    for (const auto& s : run.samples) furthest = std::max(furthest, s.actual_position - 9.5);
    EXPECT_NEAR(furthest, 25, 0.1);
    EXPECT_LE(m.world.drive("x")->largest_increment(), 500 + 2) << "counts in a cycle at 500 u/s, the limit: its targets did not jump";
}

// Kv 500 1/s and Kp 80 1/s: a move that the loop was made for overshoots next to nothing and settles; the numbers agree with a look at the samples.
TEST_F(Measured, AStepResponseTellsWhatTheSamplesShow) {
    const auto run = m.measure(step_order());
    const auto aligned = axes::measuring::align(run);
    EXPECT_EQ(aligned.lost, 0u);
    const auto response = axes::measuring::step_response(aligned, run.plan, 0.01);
    EXPECT_EQ(response.doubt, axes::measuring::Doubt::none);
    ASSERT_EQ(response.moves.size(), 4u);
    EXPECT_TRUE(response.all_settled);
    EXPECT_NEAR(response.resolution, 0.001, 1e-6) << "10000 counts on 10 mm";
    double largest = 0;
    for (const auto& s : run.samples) largest = std::max(largest, std::abs(s.following_error));
    EXPECT_NEAR(response.largest_error.value, largest, 0.2 * largest);
    EXPECT_LT(response.overshoot.value, 0.1);
    EXPECT_GE(response.settling_time.value, 0);
    EXPECT_LT(response.settling_time.value, 0.2);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
