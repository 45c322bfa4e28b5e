// A halt and a lowered override, whenever they come: in a ramp up, in a cruise. On a straight line, where the least time is known by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "axes/path_time/braking.hpp"
#include "axes/path_time/path_player.hpp"
#include "axes/path_time/path_service.hpp"
#include "tests/axes/path_time/path_curve.hpp"

namespace taktwerk::axes {
namespace {

constexpr double acceleration = 1000, jerk = 10'000, cycle = 1e-3;

/// From v and a: what is left of the acceleration goes, then the deceleration comes, holds, and goes.
double least_time(double v, double a) {
    const double first = std::max(a, 0.0) / jerk, top = v + std::max(a, 0.0) * first / 2;
    const double brakes = top * jerk >= acceleration * acceleration ? top / acceleration + acceleration / jerk : 2 * std::sqrt(top / jerk);
    return first + brakes;
}

struct Line {
    Line(double length, double velocity) {
        PathVector to = PathVector::Zero();
        to[0] = length;
        PathMove move;
        move.element = PathElement::line(PathVector::Zero(), to);
        move.feed = {velocity, acceleration, acceleration, jerk};
        EXPECT_TRUE(path.append(move, {}).ok());
    }
    void step(const PathWish& wish) {
        (void)player.step(cycle);
        (void)service.step(curve, path.length(), wish);
    }

    Path path;
    PathCurve curve{path, 1};
    std::unique_ptr<StretchExchange> exchange = std::make_unique<StretchExchange>();
    PathService service{{{1e3, acceleration, jerk}}, *exchange, 0.008};
    PathPlayer player{*exchange};
};

TEST(Halt, BrakingEndsAtRest) {
    for (const double v : {0.01, 3.0, 250.0})
        for (const double a : {-40.0, 0.0, 700.0}) {
            const Braking braking(v, a, acceleration, jerk);
            const double end = braking.duration();
            if (a < 0 && v < a * a / (2 * jerk)) continue;  // it brakes too hard for what is left
            EXPECT_NEAR(braking.at(end).velocity, 0, 1e-9 * v);
            if (a >= 0) {
                EXPECT_NEAR(end, least_time(v, a), 1e-9);
            }
            double way = 0;
            constexpr int parts = 20'000;
            for (int i = 0; i < parts; ++i) way += braking.at(end * (i + 0.5) / parts).velocity * end / parts;
            EXPECT_NEAR(braking.way(), way, 1e-6 * way);
        }
}

// It begins behind the piece under way (20 ms at most) and the lead of 8 ms with the piece in which that ends; until then the motion goes on. From
// there it takes a fifth longer than the hardest one, at most. A ramp up is no exception: there halts were often not found before its end.
TEST(Halt, ComesSoonWheneverItIsWished) {
    int halts = 0, in_ramps = 0;
    for (const double velocity : {5.0, 20.0, 100.0})
        for (const double length : {0.5, 5.0, 100.0, 1000.0})
            for (int when = 3; when < 2000; when += when < 200 ? 18 : 290) {
                if (length > 50 * velocity) break;  // more than 2500 pieces of 20 ms: they are longer there
                Line line(length, velocity), free(length, velocity);
                const PathWish go, stand{.motion = PathWish::Motion::stand};
                for (int i = 0; i < when; ++i) {
                    line.step(go);
                    free.step(go);
                }
                if (!(line.player.now().velocity > 0) || line.player.now().acceleration < 0) continue;
                constexpr int delay = 50;  // cycles
                double longest = 0, furthest = 0;
                for (int i = 0; i < delay; ++i) {
                    free.step(go);
                    const auto& now = free.player.now();
                    const double left = (i + 1) * cycle + 1.2 * least_time(now.velocity, std::max(now.acceleration, 0.0));
                    longest = std::max(longest, left);
                    furthest = std::max(furthest, now.s + now.velocity * 1.2 * least_time(now.velocity, std::max(now.acceleration, 0.0)));
                }
                ++halts;
                in_ramps += line.player.now().acceleration > 0.1 * acceleration ? 1 : 0;
                int cycles = 0;
                while (!line.player.standing() && cycles < 5000) {
                    line.step(stand);
                    ++cycles;
                }
                ASSERT_LE(cycles * cycle, longest + 2 * cycle) << velocity << " u/s over " << length << " after " << when;
                ASSERT_LE(line.player.now().s, furthest) << velocity << " u/s over " << length << " after " << when;
            }
    EXPECT_GT(halts, 100);
    EXPECT_GT(in_ramps, 40);
}

// However short a halt's ramps are beside it: from the first cycle that brakes to rest it takes 13 % longer, and a way 19 % longer, than the least ones, at most; half of them 2 %. (A deceleration of 20 u/s2 at 10,000 u/s3
// took half as long again: its ramps were a hundredth of a cell.)
TEST(Halt, BrakesAsHardAsItMay) {
    int halts = 0, short_ones = 0;
    for (const double deceleration : {5.0, 20.0, 80.0, 400.0, 1000.0})
        for (const double own_jerk : {100.0, 1e3, 1e4, 1e5, 1e6})
            for (const double velocity : {50.0, 500.0}) {
                SCOPED_TRACE(::testing::Message() << velocity << " u/s, " << deceleration << " u/s2, " << own_jerk << " u/s3");
                PathVector to = PathVector::Zero();
                to[0] = 100'000;
                PathMove move;
                move.element = PathElement::line(PathVector::Zero(), to);
                move.feed = {velocity, 1000, deceleration, own_jerk};
                Path path;
                ASSERT_TRUE(path.append(move, {}).ok());
                PathCurve curve(path, 1);
                const auto exchange = std::make_unique<StretchExchange>();
                const std::vector<PathAxisLimits> limits{{1e4, 1e5, 1e7}};
                PathService service(limits, *exchange, 0.008);
                PathPlayer player(*exchange);
                const auto step = [&](const PathWish& wish) {
                    (void)player.step(cycle);
                    (void)service.step(curve, path.length(), wish);
                };
                const PathWish go, stand{.motion = PathWish::Motion::stand};
                for (int i = 0; i < 30'000 && player.now().velocity < 0.999 * velocity; ++i) step(go);
                for (int i = 0; i < 200; ++i) step(go);
                const double top = player.now().velocity;
                double begins = 0;
                int waits = 0, brakes = 0;
                while (!player.standing() && brakes < 200'000) {
                    const double before = player.now().s;
                    step(stand);
                    if (brakes == 0 && player.now().velocity > 0.9999 * top) {
                        begins = before;
                        ++waits;
                    } else {
                        ++brakes;
                    }
                }
                const Braking least(top, 0, deceleration, own_jerk);
                // The piece under way and the lead, and until a ten-thousandth of the velocity is gone: with a slack of 1 % of it.
                EXPECT_LE(waits * cycle, 0.06 + 0.013 * least.duration() + 2 * std::sqrt(2e-4 * top / own_jerk));
                EXPECT_LE(brakes * cycle, 1.13 * least.duration() + 2 * cycle);
                EXPECT_LE(player.now().s - begins, 1.19 * least.way() + 2 * cycle * top);
                ++halts;
                short_ones += brakes * cycle <= 1.02 * least.duration() + 2 * cycle ? 1 : 0;
            }
    EXPECT_GE(2 * short_ones, halts);
}

// As long as it may last, an hour, a day: from a cruise a halt has taken a fiftieth of the velocity as soon as in a short run. By hand: the piece under way and the lead with the one
// in which that ends, 48 ms at most, and the first fiftieth with nine tenths of the jerk, sqrt(2 * 2 / 9000) = 21 ms. A lowered override likewise, with seven tenths: 24 ms.
TEST(Halt, ComesAsSoonInARunOfHours) {
    constexpr double velocity = 100;
    for (const double seconds : {60.0, 600.0, 3600.0, 86'400.0})
        for (const bool stands : {true, false}) {
            Line line(velocity * seconds, velocity);
            const PathWish go, wish{.motion = stands ? PathWish::Motion::stand : PathWish::Motion::go, .velocity_factor = stands ? 1 : 0.5};
            int worst = 0;
            for (int when = 0; when < 12; ++when) {
                for (int i = 0; i < 1237; ++i) line.step(go);
                const double top = line.player.now().velocity;
                ASSERT_GT(top, 0.99 * velocity) << seconds << ' ' << stands << ' ' << when;
                int cycles = 0;
                while (line.player.now().velocity > 0.98 * top && cycles < 5000) {
                    line.step(wish);
                    ++cycles;
                }
                worst = std::max(worst, cycles);
                for (int i = 0; i < 700; ++i) line.step(wish);
                for (int i = 0; i < 700; ++i) line.step(go);
            }
            EXPECT_LE(worst, 80) << seconds << " s, ms";
        }
}

// The same motion, cut anew as it is gone: s, v and a of a long run are those of its plan.
TEST(Halt, ALongRunIsGoneAsItWasPlanned) {
    constexpr double velocity = 100, seconds = 600;
    Line line(velocity * seconds, velocity);
    line.step({});
    const RunPlan plan = line.service.last_plan();
    ASSERT_GT(plan.duration, seconds);
    double off = 0, fastest_change = 0, before = 0, a_before = 0;
    std::size_t i = 0;
    for (int cycles = 0; cycles < 12'000; ++cycles) {
        line.step({});
        const double t = (cycles + 1) * cycle;
        while (i + 1 < plan.pieces.size() && plan.pieces[i + 1].begin_time <= t) ++i;
        const PathMotion m = plan.pieces[i].at(t - plan.pieces[i].begin_time);
        const auto& now = line.player.now();
        off = std::max(off, std::fabs(now.s - m.s));
        fastest_change = std::max(fastest_change, std::fabs(now.velocity - before - cycle * (now.acceleration + a_before) / 2));
        before = now.velocity;
        a_before = now.acceleration;
    }
    EXPECT_LE(off, 1e-8 * plan.pieces.back().begin);
    EXPECT_LE(fastest_change, jerk * cycle * cycle / 2 * 1.001);
}

// The same of a lowered override, with seven tenths of the limits: on the cells of the former plan none was found in a cruise, and it had no effect.
TEST(Halt, ALoweredOverrideIsComeToSoon) {
    int lowered = 0;
    for (const double velocity : {5.0, 20.0, 100.0})
        for (const double length : {20.0, 100.0, 1000.0})
            for (const double factor : {0.05, 0.4})
                for (int when = 12; when < 2000; when += when < 200 ? 24 : 390) {
                    if (length > 50 * velocity) break;
                    Line line(length, velocity), free(length, velocity);
                    const PathWish go, slower{.velocity_factor = factor};
                    for (int i = 0; i < when; ++i) {
                        line.step(go);
                        free.step(go);
                    }
                    if (free.player.now().acceleration < -1 || free.player.now().velocity < factor * velocity) continue;
                    constexpr int delay = 50;  // cycles
                    double longest = 0;
                    for (int i = 0; i < delay; ++i) {
                        free.step(go);
                        const auto& now = free.player.now();
                        longest = std::max(longest, (i + 1) * cycle + least_time(now.velocity, std::max(now.acceleration, 0.0)) / 0.65);
                    }
                    ++lowered;
                    int cycles = 0;
                    while (line.player.now().velocity > factor * velocity * (1 + 1e-3) && cycles < 5000) {
                        line.step(slower);
                        ++cycles;
                    }
                    ASSERT_LE(cycles * cycle, longest + 2 * cycle)
                        << velocity << " u/s over " << length << " after " << when << " to " << factor;
                }
    EXPECT_GT(lowered, 50);
}

// It is come to from above and kept: nobody who slows a machine down expects that it nearly stands for a moment. A ramp up may go on until its
// acceleration is gone.
TEST(Halt, ALoweredOverrideIsNotUndershot) {
    int lowered = 0;
    for (const double velocity : {5.0, 20.0, 100.0})
        for (const double length : {20.0, 100.0, 1000.0})
            for (const double factor : {0.05, 0.4, 0.7, 0.9})
                for (const int when : {100, 160, 330, 800}) {
                    Line line(length, velocity);
                    const PathWish go, slower{.velocity_factor = factor};
                    for (int i = 0; i < when; ++i) line.step(go);
                    const double wanted = factor * velocity, way = 1.5 * velocity * least_time(velocity, 0) + 0.1 * velocity;
                    if (line.player.now().velocity < wanted || line.player.now().acceleration < -1) continue;
                    ++lowered;
                    double before = 1e9, slowest = 1e9, top = 0;
                    int there = 0;  // cycles
                    while (there < 300 && line.player.now().s + way < length) {
                        line.step(slower);
                        const auto& now = line.player.now();
                        there += there > 0 || now.velocity <= wanted * (1 + 2e-3) ? 1 : 0;
                        // In a cruise velocity may differ by a thousandth: down is where it has left its top.
                        top = std::max(top, now.velocity);
                        if (now.velocity < 0.98 * top) before = std::min(before, now.velocity);
                        ASSERT_LE(now.velocity, std::max(before, wanted) * (1 + 2e-3))
                            << "it rises again; " << velocity << " u/s over " << length << " after " << when << " to " << factor;
                        slowest = std::min(slowest, now.velocity / wanted);
                    }
                    if (length > 5 * way) {
                        ASSERT_GT(there, 0) << velocity << " u/s over " << length << " after " << when << " to " << factor;
                    }
                    ASSERT_GE(slowest, 0.99) << velocity << " u/s over " << length << " after " << when << " to " << factor;
                }
    EXPECT_GT(lowered, 40);
}

}  // namespace
}  // namespace taktwerk::axes
