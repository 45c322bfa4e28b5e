// Numbers of moves whose truth is known: step response, friction, torque and following error, cogging; and what says nothing says so.

#include <gtest/gtest.h>

#include "axes/measuring/cogging.hpp"
#include "axes/measuring/feed_forward.hpp"
#include "axes/measuring/friction_curve.hpp"
#include "axes/measuring/step_response.hpp"
#include "tests/axes/measuring/played_run.hpp"

namespace taktwerk::axes::measuring {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

double sign(double v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

MeasureOrder moves(MeasureKind kind, double distance = 40, double velocity = 80) {
    MeasureOrder order{kind};
    order.distance = distance, order.velocity = velocity;
    return order;
}

/// Follows exactly; its torque is made of what a test knows.
struct Torques {
    double gravity = 0, coulomb = 0, viscous = 0, inertia = 0;
    Answer operator()(const MotionState& s, double) const {
        return {s.position, s.velocity, gravity + coulomb * sign(s.velocity) + viscous * s.velocity + inertia * s.acceleration};
    }
};

TEST(AlignedRun, FindsTheDeadTimeBetweenSetPointAndAnswer) {
    for (const double delay : {0.0, 1.0, 2.5, 3.37, 9.0}) {
        const auto run = play(moves(MeasureKind::step), delay, Torques{});
        const auto aligned = align(run);
        EXPECT_NEAR(aligned.dead_time, delay * 1e-3, 2e-6) << delay;
        for (std::size_t i = 0; i < aligned.size(); ++i) ASSERT_NEAR(aligned.reference[i], aligned.actual[i], 1e-3);
    }
}

TEST(AlignedRun, CountsWhatIsMissing) {
    auto run = play(moves(MeasureKind::step), 2, Torques{});
    run.samples.erase(run.samples.begin() + 100, run.samples.begin() + 160);
    EXPECT_EQ(align(run).lost, 60u);
    EXPECT_EQ(step_response(align(run), run.plan, 0.01).doubt, Doubt::lost_samples);
}

// It swings around its target as exp(-20 t) cos(60 t) of 0.5 u does once the set-point rests: beyond it the most is where the derivative is 0, and it
// stays inside 0.01 u from t = ln(50) / 20 = 196 ms on, but for where the cosine is small before.
TEST(StepResponse, OvershootAndSettlingAreThoseOfASwingThatIsKnown) {
    double rests_since = -1;
    double way = 1;
    const auto swinging = [&](const MotionState& s, double t) {
        if (s.velocity != 0) {
            rests_since = -1;
            way = sign(s.velocity);
            return Answer{s.position, s.velocity, 0};
        }
        if (rests_since < 0) rests_since = t;
        const double since = t - rests_since;
        return Answer{s.position + way * 0.5 * std::exp(-20 * since) * std::sin(60 * since), 0, 0};
    };
    auto order = moves(MeasureKind::step);
    order.count = 1;
    const auto run = play(order, 2, swinging);
    const auto response = step_response(align(run), run.plan, 0.01);
    ASSERT_EQ(response.moves.size(), 2u);
    // sin(60 t) exp(-20 t) is highest where tan(60 t) = 3: t = 20.8 ms; there 0.5 * 0.9487 * exp(-0.4163) = 0.3128.
    EXPECT_NEAR(response.overshoot.value, 0.3128, 0.001);
    // The envelope 0.5 exp(-20 t) is 0.01 at 195.6 ms; the last half wave that passes 0.01 is the one around (pi / 2 + 3 pi) / 60 = 183 ms.
    EXPECT_GT(response.settling_time.value, 0.170);
    EXPECT_LT(response.settling_time.value, 0.196);
    EXPECT_TRUE(response.all_settled);
    EXPECT_FALSE(step_response(align(run), run.plan, 1e-4).all_settled) << "0.5 exp(-20 * 0.3) is 1.2e-3 when the watch ends";
}

TEST(StepResponse, LagIsFollowingErrorPerVelocity) {
    const auto lagging = [](const MotionState& s, double) { return Answer{s.position - 0.004 * s.velocity, s.velocity, 0}; };
    const auto run = play(moves(MeasureKind::ramp), 2, lagging);
    const auto response = step_response(align(run), run.plan, 0.01);
    EXPECT_NEAR(response.lag, 0.004, 1e-6);
    EXPECT_NEAR(response.at_velocity.value, 0.32, 1e-6);
    EXPECT_LT(response.ripple.value, 1e-9);
}

// 90 % - 10 % of the way at constant velocity: 0.8 * 160 u / 80 u/s = 1.6 s.
TEST(StepResponse, RiseTimeIsFromATenthToNineTenths) {
    const auto run = play(moves(MeasureKind::step, 160), 2, Torques{});
    EXPECT_NEAR(step_response(align(run), run.plan, 0.01).rise_time.value, 1.6, 0.002);
}

TEST(StepResponse, AnAxisWithoutAnErrorHasNothingToShow) {
    const auto run = play(moves(MeasureKind::step), 0, Torques{});
    EXPECT_EQ(step_response(align(run), run.plan, 0.01).doubt, Doubt::nothing_to_see);
    EXPECT_EQ(step_response(AlignedRun{}, run.plan, 0.01).doubt, Doubt::no_samples);
}

TEST(StepResponse, WhatWasNotDrivenIsNotTold) {
    auto run = play(moves(MeasureKind::step), 2, [](const MotionState& s, double) {
        return Answer{s.position - 1e-3 * s.velocity, s.velocity, 0};
    });
    run.samples.resize(run.samples.size() / 2);
    const auto response = step_response(align(run), run.plan, 0.01);
    EXPECT_EQ(response.doubt, Doubt::ended_early);
    EXPECT_GE(response.moves.size(), 2u);
    EXPECT_LT(response.moves.size(), 6u);
}

TEST(FrictionCurve, FindsBothFrictionsAndGravity) {
    const Torques truth{0.12, 0.05, 3e-4, 1e-4};
    const auto run = play(moves(MeasureKind::friction), 3.4, truth, 1e-3, 1e-3);
    const auto f = friction_curve(align(run), run.plan, no_limit);
    EXPECT_EQ(f.doubt, Doubt::none);
    EXPECT_EQ(f.points.size(), 16u);
    EXPECT_NEAR(f.gravity.value, 0.12, 5e-4) << "half of the last digit of the torque";
    EXPECT_NEAR(f.coulomb.value, 0.05, 5e-4);
    EXPECT_NEAR(f.viscous.value, 3e-4, 1e-5);
    EXPECT_NEAR(f.coulomb_positive.value, 0.05, 1e-3);
    EXPECT_NEAR(f.coulomb_negative.value, 0.05, 1e-3);
}

TEST(FrictionCurve, EachDirectionHasItsOwn) {
    const auto run = play(moves(MeasureKind::friction), 2, [](const MotionState& s, double) {
        return Answer{s.position, s.velocity, s.velocity > 0 ? 0.06 + 4e-4 * s.velocity : s.velocity < 0 ? -0.06 + 1e-4 * s.velocity : 0};
    });
    const auto f = friction_curve(align(run), run.plan, no_limit);
    EXPECT_NEAR(f.viscous_positive.value, 4e-4, 1e-6);
    EXPECT_NEAR(f.viscous_negative.value, 1e-4, 1e-6);
}

TEST(FrictionCurve, SaysWhenTheTorqueWasAtItsLimitOrNotThere) {
    const auto run = play(moves(MeasureKind::friction), 2, Torques{0, 0.3, 0, 0});
    EXPECT_EQ(friction_curve(align(run), run.plan, 0.3).doubt, Doubt::saturated);
    const auto none = play(moves(MeasureKind::friction), 2, Torques{});
    EXPECT_EQ(friction_curve(align(none), none.plan, no_limit).doubt, Doubt::nothing_to_see);
}

// Encoder of 1 um, torque in per mille, noise of 0.5 % on it.
TEST(TorqueModel, FindsInertiaThroughQuantisationAndNoise) {
    std::mt19937_64 dice(3);
    std::normal_distribution<> noise(0, 0.005);
    const Torques truth{-0.03, 0.04, 2e-4, 6e-5};
    const auto noisy = [&](const MotionState& s, double t) {
        auto a = truth(s, t);
        a.torque += noise(dice);
        return a;
    };
    const auto run = play(moves(MeasureKind::following), 2.3, noisy, 1e-3, 1e-3);
    const auto model = torque_model(align(run), no_limit);
    EXPECT_EQ(model.doubt, Doubt::none);
    EXPECT_NEAR(model.inertia.value, 6e-5, 0.02 * 6e-5);
    EXPECT_NEAR(model.coulomb.value, 0.04, 0.002);
    EXPECT_NEAR(model.gravity.value, -0.03, 0.001);
    EXPECT_NEAR(model.viscous.value, 2e-4, 4e-5);
    for (const auto& e : {model.inertia, model.coulomb, model.gravity, model.viscous}) EXPECT_GT(e.deviation, 0);
    EXPECT_LT(std::abs(model.inertia.value - 6e-5), 4 * model.inertia.deviation);
}

TEST(TorqueModel, GentleMovesSayNothingOfTheInertia) {
    std::mt19937_64 dice(4);
    std::normal_distribution<> noise(0, 0.02);
    auto order = moves(MeasureKind::following, 40, 80);
    order.acceleration = 100;
    const auto run = play(
        order, 2,
        [&](const MotionState& s, double) {
            return Answer{s.position, s.velocity, noise(dice)};
        },
        1e-3);
    EXPECT_FALSE(torque_model(align(run), no_limit).inertia.known) << "noise alone is no inertia";
}

TEST(FeedForward, TellsVelocityAccelerationAndFrictionApart) {
    const auto behind = [](const MotionState& s, double) {
        return Answer{s.position - (0.002 * s.velocity + 2.5e-5 * s.acceleration + 0.01 * sign(s.velocity)), s.velocity,
                      0.05 * sign(s.velocity)};
    };
    const auto run = play(moves(MeasureKind::following), 2, behind, 1e-3);
    const auto f = feed_forward(align(run), no_limit);
    EXPECT_EQ(f.doubt, Doubt::none);
    EXPECT_NEAR(f.lag.value, 0.002, 2e-5);
    EXPECT_NEAR(f.per_acceleration.value, 2.5e-5, 5e-7);
    EXPECT_NEAR(f.per_direction.value, 0.01, 1e-3);
    EXPECT_LT(f.rms_left, 0.01 * f.rms);
    const auto none = play(moves(MeasureKind::following), 2, [](const MotionState& s, double) {
        return Answer{s.position, s.velocity, 0};
    });
    EXPECT_EQ(feed_forward(align(none), no_limit).doubt, Doubt::nothing_to_see);
}

// 12 waves of 3 % and 2 of 1 % in a turn of 10 u.
TEST(Cogging, FindsWavesOfAPeriodWithTheirAmplitude) {
    MeasureOrder order{MeasureKind::cogging};
    order.distance = 40, order.velocity = 10;
    const auto cogged = [](const MotionState& s, double) {
        const double turn = 2 * std::numbers::pi * s.position / 10;
        return Answer{s.position, s.velocity, 0.05 * sign(s.velocity) + 0.03 * std::sin(12 * turn) + 0.01 * std::cos(2 * turn)};
    };
    const auto run = play(order, 2, cogged, 1e-3, 1e-3);
    const auto c = cogging(align(run), run.plan);
    EXPECT_EQ(c.doubt, Doubt::none);
    ASSERT_GE(c.harmonics.size(), 12u);
    EXPECT_NEAR(c.harmonics[11].torque, 0.03, 3e-4);
    EXPECT_NEAR(c.harmonics[1].torque, 0.01, 3e-4);
    for (const auto& h : c.harmonics)
        if (h.order != 12 && h.order != 2) {
            EXPECT_LT(h.torque, 5e-4) << h.order;
        }
    EXPECT_NEAR(c.peak_to_peak, 0.08, 0.004) << "0.06 + 0.02 where the crests meet";
    order.distance = 40;
    const auto flat = play(order, 2, Torques{0, 0.05, 0, 0}, 1e-3, 1e-3);
    EXPECT_EQ(cogging(align(flat), flat.plan).doubt, Doubt::nothing_to_see);
}

}  // namespace
}  // namespace taktwerk::axes::measuring
