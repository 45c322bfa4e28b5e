// Drawn plants are measured in whole machines, through real frames, encoders of whole counts and torque in per mille, and compared with what they are
// made of. The tolerances are what docs/measuring.md may be read by.

#include <numbers>
#include <random>

#include "axes/measuring/cogging.hpp"
#include "axes/measuring/feed_forward.hpp"
#include "axes/measuring/frequency_response.hpp"
#include "axes/measuring/friction_curve.hpp"
#include "axes/measuring/step_response.hpp"
#include "axes/sim/inner_step.hpp"
#include "tests/property_cases.hpp"
#include "tests/runtime/measuring/measuring_rig.hpp"

namespace taktwerk::runtime::testing {
namespace {

using axes::MeasureKind;
using axes::MeasureOrder;
using axes::measuring::align;
using axes::measuring::Doubt;
using std::numbers::pi;

constexpr double no_limit = std::numeric_limits<double>::infinity();
/// 10 u are a turn of the motor.
constexpr double radians_per_u = 2 * pi / 10;
constexpr double inner = axes::sim::inner_seconds;  // s: a step of the simulated drive's loops

struct Drawn {
    MachineConfig config = MeasuringRig::measured();
    [[nodiscard]] AxisSimulation& plant() { return config.axes[0].simulation; }
    // As parts of the rated torque, per u/s and u/s2.
    [[nodiscard]] double coulomb() { return plant().coulomb_friction / plant().rated_torque; }
    [[nodiscard]] double viscous() { return plant().viscous_friction * radians_per_u / plant().rated_torque; }
    [[nodiscard]] double gravity() { return plant().load_torque / plant().rated_torque; }
    [[nodiscard]] double inertia() { return plant().inertia * radians_per_u / plant().rated_torque; }
};

Drawn draw(std::mt19937_64& dice) {
    const auto between = [&](double low, double high) { return low * std::pow(high / low, std::uniform_real_distribution<>(0, 1)(dice)); };
    Drawn d;
    auto& p = d.plant();
    p.rated_torque = between(0.6, 5);
    p.inertia = p.rated_torque * between(1e-4, 4e-4);
    p.coulomb_friction = p.rated_torque * between(0.02, 0.12);
    p.viscous_friction = p.rated_torque * between(3e-4, 3e-3);
    // A weight that friction holds while the drive has no power.
    p.load_torque = std::uniform_int_distribution<>(0, 1)(dice) == 1 ? 0.8 * p.coulomb_friction : 0.0;
    return d;
}

MeasureOrder order_of(MeasureKind kind, double distance, double velocity, double acceleration = 0, std::uint16_t count = 0) {
    MeasureOrder order{kind};
    order.distance = distance, order.velocity = velocity, order.acceleration = acceleration, order.count = count;
    return order;
}

// Within 3 % of the friction and half of the last digit of the torque (0.05 % of rated).
TEST(MeasuredPlants, FrictionAndGravityAreThoseOfThePlant) {
    std::mt19937_64 dice(101);
    for (std::size_t n = 0; n < property_cases(6); ++n) {
        auto drawn = draw(dice);
        SCOPED_TRACE(n);
        MeasuringRig m(drawn.config);
        const auto run = m.measure(order_of(MeasureKind::friction, 60, 150, 2000, 6));
        ASSERT_EQ(m.measure_state().end, MeasureEnd::done);
        const auto f = friction_curve(align(run), run.plan, no_limit);
        EXPECT_EQ(f.doubt, Doubt::none);
        EXPECT_NEAR(f.coulomb.value, drawn.coulomb(), 0.03 * drawn.coulomb() + 5e-4);
        EXPECT_NEAR(f.gravity.value, drawn.gravity(), 0.03 * drawn.gravity() + 5e-4);
        // From 5 to 150 u/s the last digit of the torque is 7e-6 per u/s.
        EXPECT_NEAR(f.viscous.value, drawn.viscous(), 0.03 * drawn.viscous() + 7e-6);
        EXPECT_NEAR(f.coulomb_positive.value, drawn.coulomb(), 0.05 * drawn.coulomb() + 1e-3);
        EXPECT_NEAR(f.coulomb_negative.value, drawn.coulomb(), 0.05 * drawn.coulomb() + 1e-3);
    }
}

TEST(MeasuredPlants, BreakawayIsThatOfThePlant) {
    for (const double factor : {1.0, 1.5, 2.0}) {
        Drawn drawn;
        auto& p = drawn.plant();
        p.coulomb_friction = 0.08 * p.rated_torque;
        p.breakaway_torque = factor * p.coulomb_friction;
        MeasuringRig m(drawn.config);
        const auto run = m.measure(order_of(MeasureKind::friction, 40, 64, 1000, 5));
        const auto f = friction_curve(align(run), run.plan, no_limit);
        ASSERT_TRUE(f.breakaway_positive.known && f.breakaway_negative.known);
        // Seen only from the first count on that the motor has moved: where it breaks away, its torque has begun to fall by then, and the mean of 4 ms
        // has some of that. Within a third of the Coulomb friction.
        EXPECT_NEAR(f.breakaway_positive.value, 0.08 * factor, 0.08 / 3) << factor;
        EXPECT_NEAR(f.breakaway_negative.value, 0.08 * factor, 0.08 / 3) << factor;
    }
}

// Inertia within 3 %; its inverse is what `rated_acceleration` wants. With the drive's velocity feed-forward, which comes in steps of a bus cycle, and without,
// at every cycle.
TEST(MeasuredPlants, InertiaAndFrictionFromMovesAreThoseOfThePlant) {
    std::mt19937_64 dice(102);
    for (std::size_t n = 0; n < property_cases(6); ++n) {
        auto drawn = draw(dice);
        SCOPED_TRACE(n);
        drawn.plant().gains.feed_forward = static_cast<double>(n % 2);
        drawn.config.cycle = drawn.config.bus.cycle = std::array<Duration, 3>{1ms, 4ms, 250us}[n % 3];
        MeasuringRig m(drawn.config);
        const auto run = m.measure(order_of(MeasureKind::following, 60, 200, 3000));
        ASSERT_EQ(m.measure_state().end, MeasureEnd::done);
        const auto f = feed_forward(align(run), no_limit);
        EXPECT_EQ(f.torque.doubt, Doubt::none);
        ASSERT_TRUE(f.torque.inertia.known);
        // The torque is the mean of a cycle, so half a cycle old: by then the viscous friction has grown by that of half a cycle's acceleration.
        const double late = drawn.viscous() * to_seconds(drawn.config.cycle) / 2;
        EXPECT_NEAR(f.torque.inertia.value, drawn.inertia() - late, 0.03 * drawn.inertia());
        EXPECT_NEAR(f.torque.coulomb.value, drawn.coulomb(), 0.05 * drawn.coulomb() + 1e-3);
        EXPECT_NEAR(f.torque.gravity.value, drawn.gravity(), 0.03 * drawn.gravity() + 1e-3);
        EXPECT_NEAR(f.torque.viscous.value, drawn.viscous(), 0.1 * drawn.viscous() + 2e-5);
        EXPECT_GT(f.torque.explained, 0.95);
    }
}

// Without feed-forward in the drive a position gain K leaves v / K behind, less the step of 125 us by which the drive's demand is ahead of the encoder it is
// compared with. Within 1 % of 1 / K: what a ramp has stirred up is e^-Kt of a / K^2, some thousandths where the velocity lasts a few 1 / K.
TEST(MeasuredPlants, LagIsThatOfThePositionGainAndFeedForward) {
    for (const double gain : {30.0, 80.0})
        for (const double forward : {0.0, 0.6, 1.0}) {
            Drawn drawn;
            drawn.plant().gains.position = gain;
            drawn.plant().gains.feed_forward = forward;
            MeasuringRig m(drawn.config);
            const auto run = m.measure(order_of(MeasureKind::following, 40, 100, 1000));
            const auto f = feed_forward(align(run), no_limit);
            EXPECT_NEAR(f.lag.value, (1 - forward) / gain - inner, 0.01 / gain) << gain << " 1/s, " << forward;
            const auto ramp = m.measure(order_of(MeasureKind::ramp, 60, 100, 1000, 1));
            EXPECT_NEAR(step_response(align(ramp), ramp.plan, 0.01).lag, (1 - forward) / gain - inner, 0.01 / gain);
        }
}

/// The simulated loops as they are computed (axes/sim/servo_loop.hpp, plant.hpp), step by step of 125 us: PI of the velocity, C = p + i dt / (z - 1), on
/// P = dt / (z - 1), semi-implicit, so that the position has z dt / (z - 1) of it; the position loop compares the demand at the end of a step with
/// the encoder at its beginning; and the straight lines between the set-points of 1 ms, eight steps of the demand.
std::complex<double> closed_loop(const axes::sim::ServoGains& g, double f) {
    const double angle = 2 * pi * f * inner;
    const auto z = std::polar(1.0, angle);
    const auto step = inner / (z - 1.0), loop = step * (g.velocity + g.integral * step);
    const auto demand = g.feed_forward * (1.0 - 1.0 / z) / inner + g.position;
    const auto velocity = loop * demand / (1.0 + loop * (1.0 + g.position * z * step));
    const double lines = std::pow(std::sin(4 * angle) / (8 * std::sin(angle / 2)), 2);
    return velocity * z * step * z * lines;  // both as they are at the end of the step
}

// Within 0.3 % of it, in gain and phase, and half a count: by that the drive's loop is wrong itself, whose answer at 40 Hz is a few counts.
TEST(MeasuredPlants, TheBodePlotIsThatOfTheDrivesLoops) {
    constexpr double half_a_count = 0.5e-3;
    for (const double gain : {30.0, 80.0}) {
        Drawn drawn;
        auto& p = drawn.plant();
        p.gains = {gain, 300, 4000, 0};
        p.coulomb_friction = 0;
        p.viscous_friction = 0;
        drawn.config.axes[0].axis.limits.jerk = 1e6;
        MeasuringRig m(drawn.config);
        auto order = order_of(MeasureKind::sweep, 2, 150, 4000, 14);
        order.from_hz = 1, order.to_hz = 40;
        const auto run = m.measure(order);
        ASSERT_EQ(m.measure_state().end, MeasureEnd::done);
        const auto response = frequency_response(align(run), run.plan);
        EXPECT_EQ(response.doubt, Doubt::none);
        std::vector<axes::measuring::FrequencyPoint> truth;
        for (const auto& point : response.points) {
            const auto is = closed_loop(p.gains, point.frequency);
            ASSERT_TRUE(point.usable) << point.frequency;
            EXPECT_NEAR(std::abs(point.closed - is), 0, 0.003 * std::abs(is) + half_a_count / point.amplitude) << point.frequency;
            truth.push_back(point);
            truth.back().closed = is;
            truth.back().open = is / (1.0 - is);
        }
        const auto margins = axes::measuring::margins_of(truth);
        ASSERT_TRUE(margins.phase && response.margins.phase && margins.bandwidth && response.margins.bandwidth);
        EXPECT_LT(response.points[7].deviation, 0.001) << "in the middle the answer is a thousand counts";
        EXPECT_NEAR(response.margins.phase->value, margins.phase->value, 0.5);
        EXPECT_NEAR(response.margins.phase->frequency, margins.phase->frequency, 0.01 * margins.phase->frequency);
        EXPECT_NEAR(response.margins.bandwidth->value, margins.bandwidth->value, 0.01 * margins.bandwidth->value);
    }
}

// A load that swings at f while the motor is held is a zero of whatever loop: the motor does not move there. Found to the grid of the sweep.
TEST(MeasuredPlants, TheValleyIsWhereTheLoadSwings) {
    std::mt19937_64 dice(103);
    for (std::size_t n = 0; n < property_cases(3); ++n) {
        Drawn drawn;
        auto& p = drawn.plant();
        const double f = std::uniform_real_distribution<>(12, 30)(dice);
        p.elastic = {p.inertia * 0.5, f, 1e-4};
        p.gains = {20, 200, 1000, 0};
        p.coulomb_friction = 0;
        drawn.config.axes[0].axis.limits.jerk = 1e6;
        drawn.config.axes[0].axis.following.window = 50;
        MeasuringRig m(drawn.config);
        auto order = order_of(MeasureKind::sweep, 2, 150, 4000, 40);
        order.from_hz = 5, order.to_hz = 60;
        const auto run = m.measure(order);
        ASSERT_EQ(m.measure_state().end, MeasureEnd::done) << f;
        const auto response = frequency_response(align(run), run.plan);
        ASSERT_TRUE(response.margins.notch) << f;
        EXPECT_NEAR(response.margins.notch->frequency, f, 0.07 * f) << "the grid is 6.6 % wide";
    }
}

// Amplitude within 5 % and half of the last digit, at its place among the harmonics; so slowly that the motor hardly swings with it.
TEST(MeasuredPlants, CoggingIsThatOfThePlant) {
    std::mt19937_64 dice(104);
    for (std::size_t n = 0; n < property_cases(4); ++n) {
        auto drawn = draw(dice);
        auto& p = drawn.plant();
        const int periods = std::uniform_int_distribution<>(4, 24)(dice);
        const double amplitude = std::uniform_real_distribution<>(0.01, 0.05)(dice);
        p.load_torque = 0;
        p.cogging = {amplitude * p.rated_torque, static_cast<double>(periods)};
        MeasuringRig m(drawn.config);
        const auto run = m.measure(order_of(MeasureKind::cogging, 22, 2));
        ASSERT_EQ(m.measure_state().end, MeasureEnd::done);
        const auto c = cogging(align(run), run.plan);
        EXPECT_EQ(c.doubt, Doubt::none);
        ASSERT_GE(c.harmonics.size(), static_cast<std::size_t>(periods));
        const auto strongest = std::ranges::max_element(c.harmonics, {}, &axes::measuring::Harmonic::torque);
        EXPECT_EQ(strongest->order, periods);
        EXPECT_NEAR(strongest->torque, amplitude, 0.05 * amplitude + 5e-4);
    }
}

// Position gain 150 1/s in front of a velocity loop of 150 1/s swings; the numbers are those of a look at the encoder alone.
TEST(MeasuredPlants, OvershootAndSettlingAreThoseOfTheMotor) {
    Drawn drawn;
    drawn.plant().gains = {150, 150, 500, 1};
    MeasuringRig m(drawn.config);
    std::vector<double> motor;  // u, at each cycle
    m.on_cycle = [&] {
        if (m.measure_state().running) motor.push_back(m.world.drive("x")->plant().position() / 1000);
    };
    const auto run = m.measure(order_of(MeasureKind::step, 30, 200, 4000, 1));
    m.on_cycle = nullptr;
    const auto response = step_response(align(run), run.plan, 0.02);
    ASSERT_EQ(response.moves.size(), 2u);
    const double start = motor.front();
    const double furthest = *std::ranges::max_element(motor) - start - 30;
    ASSERT_GT(furthest, 0.02) << "this loop overshoots";
    EXPECT_NEAR(response.moves[0].overshoot, furthest, 0.006) << "but for some counts, and what lies between two looks";
    EXPECT_TRUE(response.all_settled);
    EXPECT_GT(response.settling_time.value, 0.005);
}

TEST(MeasuredPlants, AVirtualAxisHasNothingToMeasure) {
    auto config = MeasuringRig::measured();
    axes::AxisConfig axis = config.axes[0].axis;
    axis.name = "v";
    AxisBinding virtual_axis;
    virtual_axis.axis = axis;
    config.axes.push_back(virtual_axis);
    MeasuringRig m(config);
    m.enable(1);
    m.home(1);
    ASSERT_EQ(m.press(order_of(MeasureKind::friction, 40, 50, 1000, 2), 1).answer, Answer::accepted);
    OperatorCommand renewal;
    renewal.action = OperatorAction::measure;
    renewal.axis = 1;
    for (int i = 0; i < 2000 && m.measure_state().running; ++i) {
        m.run(45ms);
        if (m.measure_state().running) m.command(renewal);
    }
    const axes::measuring::SampleRun run{m.measure_state().plan, m.samples};
    EXPECT_EQ(friction_curve(align(run), run.plan, no_limit).doubt, Doubt::nothing_to_see);
    EXPECT_EQ(step_response(align(run), run.plan, 0.01).doubt, Doubt::nothing_to_see);
}

}  // namespace
}  // namespace taktwerk::runtime::testing
