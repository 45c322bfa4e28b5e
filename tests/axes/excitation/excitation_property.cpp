// Set-points of drawn measurements: continuous, inside every limit, inside the path that was told before.

#include "axes/excitation/excitation.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

constexpr double rounding = 1 + 1e-9;

struct Drawn {
    MeasureOrder order;
    ExcitationBounds bounds;
};

Drawn draw(std::mt19937_64& dice) {
    const auto between = [&](double low, double high) { return low * std::pow(high / low, std::uniform_real_distribution<>(0, 1)(dice)); };
    const auto coin = [&] { return std::uniform_int_distribution<>(0, 1)(dice) == 1; };
    Drawn d;
    auto& b = d.bounds;
    b.velocity = between(1, 2000);
    b.usual_velocity = b.velocity * between(0.05, 1);
    b.acceleration = b.velocity * between(2, 50);
    b.stop = b.acceleration;
    b.jerk = coin() ? b.acceleration * between(10, 200) : std::numeric_limits<double>::infinity();
    b.cycle = coin() ? 1e-3 : 250e-6;
    b.revolution = b.velocity * between(0.001, 0.05);
    b.start = between(1, 1000) * (coin() ? 1 : -1);
    if (coin()) {
        b.position_min = b.start - b.velocity * between(0.1, 10);
        b.position_max = b.start + b.velocity * between(0.1, 10);
    }
    auto& o = d.order;
    o.kind = static_cast<MeasureKind>(std::uniform_int_distribution<>(1, 6)(dice));
    if (coin()) o.velocity = b.velocity * between(0.01, 3);  // also more than it may
    if (coin()) o.acceleration = b.acceleration * between(0.01, 3);
    if (coin()) o.distance = b.velocity * between(0.001, 2) * (coin() ? 1 : -1);
    if (coin()) o.count = static_cast<std::uint16_t>(std::uniform_int_distribution<>(1, 6)(dice));
    if (coin()) o.from_hz = between(0.5, 20), o.to_hz = o.from_hz * between(1.1, 20);
    return d;
}

TEST(ExcitationProperty, EverySetPointKeepsTheLimitsAndThePathAndIsContinuous) {
    std::mt19937_64 dice(20261125);
    std::size_t driven = 0, refused = 0;
    std::array<int, 7> of_kind{};
    for (std::size_t n = 0; n < property_cases(300); ++n) {
        const auto drawn = draw(dice);
        const ExcitationPlan plan(drawn.order, drawn.bounds);
        if (plan.refusal() != ExcitationRefusal::none) {
            ++refused;
            continue;
        }
        ++driven;
        ++of_kind[static_cast<std::size_t>(drawn.order.kind)];
        SCOPED_TRACE(testing::Message() << "case " << n << ", " << name(drawn.order.kind));
        const auto& b = drawn.bounds;
        EXPECT_GE(plan.lowest() - plan.margin(), b.position_min);
        EXPECT_LE(plan.highest() + plan.margin(), b.position_max);
        Excitation excitation(plan);
        MotionState before{b.start, 0, 0}, now;
        double jerk = 0, seconds = 0;
        const double grain = 1e-9 * (std::abs(b.start) + b.velocity);
        for (bool goes_on = true; goes_on; before = now) {
            goes_on = excitation.step(now);
            seconds += b.cycle;
            ASSERT_LE(std::abs(now.velocity), b.velocity * ExcitationPlan::share * rounding);
            ASSERT_LE(std::abs(now.acceleration), b.acceleration * ExcitationPlan::share * rounding);
            ASSERT_GE(now.position, plan.lowest() - grain);
            ASSERT_LE(now.position, plan.highest() + grain);
            jerk = std::max(jerk, std::abs(now.acceleration - before.acceleration) / b.cycle);
            // One motion: what it moved is what its velocities say, to the third power of the cycle.
            const double mean = (now.position - before.position) / b.cycle;
            ASSERT_NEAR(mean, (now.velocity + before.velocity) / 2, plan.jerk() * b.cycle * b.cycle + grain / b.cycle);
            ASSERT_NEAR((now.velocity - before.velocity) / b.cycle, (now.acceleration + before.acceleration) / 2,
                        plan.jerk() * b.cycle + 1e-6 * b.acceleration);
        }
        EXPECT_LE(jerk, plan.jerk() * (1 + 1e-6));
        if (std::isfinite(b.jerk)) {
            EXPECT_LE(plan.jerk(), b.jerk * ExcitationPlan::share * rounding);
        }
        EXPECT_NEAR(now.position, b.start, grain) << "it ends where it began";
        EXPECT_EQ(now.velocity, 0);
        EXPECT_EQ(now.acceleration, 0);
        EXPECT_LT(std::abs(seconds - plan.duration()), 0.25 * plan.duration() + 0.5);
    }
    EXPECT_GT(driven, 60u);
    EXPECT_GT(refused, 30u);
    for (std::size_t kind = 1; kind < of_kind.size(); ++kind) EXPECT_GT(of_kind[kind], 3) << measure_words[kind];
}

// Two runs of one plan are the same bits: a recording replays.
TEST(ExcitationProperty, TheSamePlanGivesTheSameBits) {
    std::mt19937_64 dice(7);
    for (int n = 0; n < 40; ++n) {
        const auto drawn = draw(dice);
        const ExcitationPlan plan(drawn.order, drawn.bounds);
        if (plan.refusal() != ExcitationRefusal::none) continue;
        Excitation one(plan), two(plan);
        MotionState a, b;
        for (bool on = true; on;) {
            on = one.step(a);
            ASSERT_EQ(two.step(b), on);
            ASSERT_EQ(a, b);
        }
    }
}

ExcitationBounds rail() {
    ExcitationBounds b;
    b.start = 100;
    b.velocity = 200, b.usual_velocity = 50;
    b.acceleration = b.stop = 5000;
    b.jerk = 100000;
    b.position_min = 0, b.position_max = 800;
    b.revolution = 10;
    b.cycle = 1e-3;
    return b;
}

TEST(ExcitationPlan, APathBeyondALimitIsRefusedByHowMuchAndWhich) {
    // 705 mm up from 100 mm is 5 mm beyond 800 mm; a stop from 100 mm/s at 5000 mm/s2 and 90000 mm/s3 takes
    // 100 * (100 / 5000 + 5000 / 90000) / 2 = 3.78 mm more.
    MeasureOrder order{MeasureKind::step};
    order.distance = 705, order.velocity = 100;
    const ExcitationPlan up(order, rail());
    EXPECT_EQ(up.refusal(), ExcitationRefusal::above_limit);
    EXPECT_EQ(up.room(), 700);
    EXPECT_NEAR(up.needed(), 708.78, 0.01);
    order.distance = -99;
    const ExcitationPlan down(order, rail());
    EXPECT_EQ(down.refusal(), ExcitationRefusal::below_limit);
    EXPECT_EQ(down.room(), 100);
    order.distance = -90;
    EXPECT_EQ(ExcitationPlan(order, rail()).refusal(), ExcitationRefusal::none);
}

TEST(ExcitationPlan, WhatIsLeftOpenIsSmallAndGoesWhereThereIsRoom) {
    auto bounds = rail();
    bounds.start = 790;
    const ExcitationPlan plan({MeasureKind::step}, bounds);
    ASSERT_EQ(plan.refusal(), ExcitationRefusal::none);
    EXPECT_EQ(plan.order().velocity, 50) << "the slow jogging speed";
    EXPECT_LT(plan.order().distance, 0);
    EXPECT_LT(-plan.order().distance, 50);
    EXPECT_EQ(plan.order().acceleration, 2500) << "half the limit";
}

TEST(ExcitationPlan, MoreThanTheAxisMayIsTakenForWhatItMay) {
    MeasureOrder order{MeasureKind::step};
    order.distance = 100, order.velocity = 1e6, order.acceleration = 1e9;
    const ExcitationPlan plan(order, rail());
    EXPECT_EQ(plan.order().velocity, 180);
    EXPECT_EQ(plan.order().acceleration, 4500);
}

TEST(ExcitationPlan, UnusableOrdersSayWhy) {
    const auto refusal = [](const MeasureOrder& order) { return ExcitationPlan(order, rail()).refusal(); };
    EXPECT_EQ(refusal({}), ExcitationRefusal::no_kind);
    MeasureOrder order{MeasureKind::step};
    order.velocity = -1;
    EXPECT_EQ(refusal(order), ExcitationRefusal::bad_number);
    order.velocity = std::nan("");
    EXPECT_EQ(refusal(order), ExcitationRefusal::bad_number);
    order = {MeasureKind::friction};
    order.distance = 0.1, order.velocity = 100;
    EXPECT_EQ(refusal(order), ExcitationRefusal::too_short);
    order = {MeasureKind::sweep};
    order.from_hz = 10, order.to_hz = 400;  // of a cycle of 1 ms
    EXPECT_EQ(refusal(order), ExcitationRefusal::frequency);
    order.to_hz = 5;
    EXPECT_EQ(refusal(order), ExcitationRefusal::frequency);
    order = {MeasureKind::ramp};
    order.velocity = 0.1, order.distance = 50, order.count = 10;
    EXPECT_EQ(refusal(order), ExcitationRefusal::too_long);
    order = {MeasureKind::step};
    order.count = 10000;
    EXPECT_EQ(refusal(order), ExcitationRefusal::too_many);
}

// Numbers next to nothing divide to infinity: a path of them is refused, also where no limit is in its way.
TEST(ExcitationPlan, WhatIsNextToNothingIsNoPath) {
    auto free = rail();
    free.position_min = -std::numeric_limits<double>::infinity(), free.position_max = std::numeric_limits<double>::infinity();
    free.jerk = std::numeric_limits<double>::infinity();
    constexpr double least = std::numeric_limits<double>::denorm_min();
    MeasureOrder order{MeasureKind::sweep};
    order.from_hz = least, order.to_hz = 50;
    EXPECT_EQ(ExcitationPlan(order, free).refusal(), ExcitationRefusal::bad_number);
    order = {MeasureKind::step};
    order.acceleration = least, order.distance = 1;
    EXPECT_EQ(ExcitationPlan(order, free).refusal(), ExcitationRefusal::bad_number);
    // 50 mm/s pass 0.4 mm in eight cycles.
    order = {MeasureKind::cogging};
    order.velocity = 50, order.period = 0.39, order.distance = 40;
    const ExcitationPlan unseen(order, free);
    EXPECT_EQ(unseen.refusal(), ExcitationRefusal::short_period);
    EXPECT_NEAR(unseen.needed(), 0.4, 1e-12);
    order.period = 0.41;
    EXPECT_EQ(ExcitationPlan(order, free).refusal(), ExcitationRefusal::none);
}

TEST(ExcitationPlan, AnOverrideOfNothingLeavesNothing) {
    auto bounds = rail();
    bounds.velocity = bounds.usual_velocity = 0;
    EXPECT_EQ(ExcitationPlan({MeasureKind::step}, bounds).refusal(), ExcitationRefusal::no_velocity);
}

// A stop with a jerk of 20000 mm/s3 instead of 90000 needs 100 * (100 / 5000 + 5000 / 20000) / 2 = 13.5 mm.
TEST(ExcitationPlan, ASoftStopNeedsMoreRoom) {
    auto bounds = rail();
    bounds.stop_jerk = 20000;
    MeasureOrder order{MeasureKind::step};
    order.distance = -90, order.velocity = 100;
    const ExcitationPlan plan(order, bounds);
    EXPECT_NEAR(plan.margin(), 13.5, 1e-9);
    EXPECT_EQ(plan.refusal(), ExcitationRefusal::below_limit);
}

// A sine of amplitude A has A w^2: above the frequency at which that is the limit the amplitude falls.
TEST(ExcitationPlan, ASweepGetsSmallerWhereTheLimitsWantIt) {
    MeasureOrder order{MeasureKind::sweep};
    order.distance = 2, order.velocity = 100, order.acceleration = 1000, order.from_hz = 1, order.to_hz = 100, order.count = 9;
    const ExcitationPlan plan(order, rail());
    ASSERT_EQ(plan.refusal(), ExcitationRefusal::none);
    EXPECT_EQ(plan.tone(0).amplitude, 2) << "as asked";
    for (std::size_t i = 1; i < plan.legs(); ++i) EXPECT_LE(plan.tone(i).amplitude, plan.tone(i - 1).amplitude);
    const double w = 2 * 3.14159265358979 * 100;
    EXPECT_LE(plan.tone(8).amplitude * w * w, 1000);
    EXPECT_LE(plan.tone(8).amplitude * w * w * w, 90000);
    EXPECT_GT(plan.tone(8).amplitude * w * w * w, 30000) << "not smaller than it must be";
}

}  // namespace
}  // namespace taktwerk::axes
