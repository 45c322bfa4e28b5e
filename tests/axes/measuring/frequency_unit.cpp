// Frequency responses against those of loops that can be written down, margins against a calculation by hand.

#include <numbers>

#include <gtest/gtest.h>

#include "axes/measuring/frequency_response.hpp"
#include "tests/axes/measuring/played_run.hpp"

namespace taktwerk::axes::measuring {
namespace {

using Complex = std::complex<double>;
constexpr double pi = std::numbers::pi;

/// w^2 / (s^2 + 2 d w s + w^2), integrated in steps of 10 us while the input runs straight from one set-point to the next.
struct SecondOrder {
    double w, d;
    double y = 100, v = 0, u = 100;
    Answer operator()(const MotionState& s, double) {
        constexpr int parts = 100;
        constexpr double dt = 1e-3 / parts;
        const double from = u;
        for (int i = 0; i < parts; ++i) {  // midpoint rule
            const double input = from + (s.position - from) * (i + 0.5) / parts;
            const double vm = v + dt / 2 * (w * w * (input - y) - 2 * d * w * v), ym = y + dt / 2 * v;
            v += dt * (w * w * (input - ym) - 2 * d * w * vm);
            y += dt * vm;
        }
        u = s.position;
        return {y, v, 0};
    }
    [[nodiscard]] Complex at(double f) const {
        const Complex s{0, 2 * pi * f};
        return w * w / (s * s + 2 * d * w * s + w * w);
    }
};
/// What straight lines between samples of 1 kHz make of a sine.
double straight_lines(double f) {
    const double x = pi * f * 1e-3;
    return std::pow(std::sin(x) / x, 2);
}

MeasureOrder sweep(double from = 1, double to = 100, std::uint16_t count = 20) {
    MeasureOrder order{MeasureKind::sweep};
    order.distance = 2, order.velocity = 150, order.acceleration = 4000, order.from_hz = from, order.to_hz = to, order.count = count;
    return order;
}

TEST(FrequencyResponse, OfASecondOrderLoopIsItsTransferFunction) {
    for (const double damping : {0.3, 0.7, 1.2}) {
        SecondOrder loop{2 * pi * 20, damping};
        const auto run = play(sweep(), 0, std::ref(loop));
        const auto response = frequency_response(align(run), run.plan);
        ASSERT_EQ(response.points.size(), 20u);
        for (const auto& p : response.points) {
            const auto truth = loop.at(p.frequency) * straight_lines(p.frequency);
            EXPECT_NEAR(std::abs(p.closed - truth), 0, 0.01 * std::abs(truth) + 2e-4) << p.frequency << " Hz, damping " << damping;
            EXPECT_TRUE(p.usable) << p.frequency;
        }
    }
}

// |T| of damping d has its peak 1 / (2 d sqrt(1 - d^2)) at w sqrt(1 - 2 d^2): for 0.3 4.85 dB at 18.11 Hz; -3 dB at
// w sqrt(1 - 2 d^2 + sqrt((1 - 2 d^2)^2 + 1)) = 29.08 Hz, and -90 degrees at w.
TEST(FrequencyResponse, ResonanceAndBandwidthAreThoseOfTheLoop) {
    SecondOrder loop{2 * pi * 20, 0.3};
    const auto run = play(sweep(2, 80, 40), 0, std::ref(loop));
    const auto m = frequency_response(align(run), run.plan).margins;
    ASSERT_TRUE(m.resonance && m.bandwidth && m.phase_bandwidth);
    EXPECT_NEAR(m.resonance->value, 4.85, 0.1);
    EXPECT_NEAR(m.resonance->frequency, 18.11, 0.3);
    EXPECT_NEAR(m.bandwidth->value, 29.08, 0.4);
    EXPECT_NEAR(m.phase_bandwidth->value, 20, 0.2);
}

// With feed-forward L = T / (1 - T) begins with a phase that may be a turn away. |L| is 1 at 20 sqrt(2) Hz, half way from 170 to 200 degrees: 185 are -175, a
// margin of 5. From 200 to 160 it passes 180, which is -180, at 40 sqrt(2) Hz and at -(6.02 + 13.98) / 2 dB.
TEST(FrequencyResponse, MarginsAreThoseOfAPhaseWithinATurn) {
    const auto at = [](double f, double gain, double degrees) {
        FrequencyPoint p;
        p.frequency = f, p.open = std::polar(gain, degrees * pi / 180), p.open_usable = true;
        return p;
    };
    const std::vector points{at(10, 4, 150), at(20, 2, 170), at(40, 0.5, 200), at(80, 0.2, 160)};
    const auto m = margins_of(points);
    ASSERT_TRUE(m.phase && m.gain);
    EXPECT_NEAR(m.phase->value, 5, 0.01);
    EXPECT_NEAR(m.phase->frequency, 28.28, 0.01);
    EXPECT_NEAR(m.gain->value, 10, 0.01);
    EXPECT_NEAR(m.gain->frequency, 56.57, 0.01);
}

TEST(FrequencyResponse, NoiseAndQuantisationWidenWhatItSaysOfItself) {
    std::mt19937_64 dice(11);
    std::normal_distribution<> noise(0, 2e-3);
    SecondOrder loop{2 * pi * 20, 0.7};
    const auto run = play(
        sweep(1, 60), 2,
        [&](const MotionState& s, double t) {
            auto a = loop(s, t);
            a.position += noise(dice);
            return a;
        },
        1e-3);
    const auto response = frequency_response(align(run), run.plan);
    for (const auto& p : response.points) {
        // Two cycles of dead time are found and taken out.
        const auto truth = loop.at(p.frequency) * straight_lines(p.frequency);
        if (p.usable) {
            EXPECT_LT(std::abs(p.closed - truth), 5 * p.deviation + 0.02 * std::abs(truth)) << p.frequency;
        }
        EXPECT_GT(p.deviation, 0);
    }
    EXPECT_TRUE(response.points.front().usable);
    EXPECT_LT(response.points.back().quality, response.points.front().quality);
}

TEST(FrequencyResponse, SaysWhatStandsInTheNoise) {
    std::mt19937_64 dice(12);
    std::normal_distribution<> noise(0, 0.5);
    auto order = sweep(5, 50, 6);
    order.distance = 0.001;
    const auto run = play(order, 2, [&](const MotionState& s, double) { return Answer{s.position + noise(dice), 0, 0}; });
    const auto response = frequency_response(align(run), run.plan);
    EXPECT_EQ(response.doubt, Doubt::nothing_to_see);
    EXPECT_FALSE(response.margins.phase || response.margins.gain || response.margins.bandwidth);
}

/// Points of an open loop that is known.
std::vector<FrequencyPoint> points_of(const std::function<Complex(double)>& open, double from, double to, int count) {
    std::vector<FrequencyPoint> points;
    for (int i = 0; i < count; ++i) {
        FrequencyPoint p;
        p.frequency = from * std::pow(to / from, static_cast<double>(i) / (count - 1));
        p.open = open(2 * pi * p.frequency);
        p.closed = p.open / (1.0 + p.open);
        p.usable = p.open_usable = true;
        points.push_back(p);
    }
    return points;
}

// L = 50 exp(-5 ms s) / s: |L| is 1 at 50 rad/s = 7.958 Hz, the phase there -90 - 50 * 0.005 * 180 / pi = -104.32 degrees: margin 75.68 degrees. The
// phase is -180 degrees at pi / 2 / 5 ms = 314.16 rad/s = 50 Hz, where |L| is 50 / 314.16: 15.96 dB.
TEST(Margins, OfAnIntegratorWithDeadTimeAreThoseByHand) {
    const auto m = margins_of(points_of([](double w) { return 50.0 / Complex(0, w) * std::polar(1.0, -0.005 * w); }, 1, 100, 60));
    ASSERT_TRUE(m.phase && m.gain);
    EXPECT_NEAR(m.phase->value, 75.68, 0.05);
    EXPECT_NEAR(m.phase->frequency, 7.958, 0.005);
    EXPECT_NEAR(m.gain->value, 15.96, 0.05);
    EXPECT_NEAR(m.gain->frequency, 50, 0.1);
}

// L = 4 / (1 + s)^3: -180 degrees where each of the three has -60: s = sqrt(3) rad/s = 0.2757 Hz, |L| = 4 / 8: 6.02 dB. |L| = 1 at
// sqrt(4^(2/3) - 1) = 1.2329 rad/s = 0.1962 Hz, phase -3 * 50.95 = -152.85: margin 27.14 degrees.
TEST(Margins, OfThreeLagsAreThoseByHand) {
    const auto m = margins_of(points_of([](double w) { return 4.0 / std::pow(Complex(1, w), 3); }, 0.02, 2, 60));
    ASSERT_TRUE(m.phase && m.gain);
    EXPECT_NEAR(m.gain->value, 6.02, 0.03);
    EXPECT_NEAR(m.gain->frequency, 0.2757, 0.001);
    EXPECT_NEAR(m.phase->value, 27.14, 0.1);
    EXPECT_NEAR(m.phase->frequency, 0.1962, 0.001);
}

TEST(Margins, OutsideTheSweepThereAreNone) {
    const auto m = margins_of(points_of([](double w) { return 50.0 / Complex(0, w) * std::polar(1.0, -0.005 * w); }, 0.1, 3, 20));
    EXPECT_FALSE(m.phase || m.gain || m.bandwidth || m.resonance);
}

}  // namespace
}  // namespace taktwerk::axes::measuring
