// An override that is lowered on a straight line, where braking is known in closed form: nothing bends, so nothing may take longer than that, stand, or be below. Axes that brake
// for seconds and have their deceleration within milliseconds are among them. G-070, docs/motion/path.md (from a moving state).

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "axes/path_time/path_player.hpp"
#include "axes/path_time/path_service.hpp"
#include "tests/axes/path_time/path_curve.hpp"

namespace taktwerk::axes {
namespace {

constexpr double full_velocity = 100;  // u/s

struct Lowered {
    double braking = 0;       // s, that it takes with all of the limits
    double obeyed = -1;       // s, until it is at most 2 % above what is wanted
    double least = 1e9;       // velocity, in parts of what is wanted, within 2 s from then on
    bool stood = false;       // where the path goes on
    std::uint32_t tries = 0;  // from the wish on
};

/// `stopping` [s] from full_velocity velocity to rest, `ramp` [s] until the deceleration is there; told at this part of the line, which is ten times as long as braking.
Lowered lowered(double stopping, double ramp, double factor, double part) {
    const double deceleration = full_velocity / stopping, most_jerk = deceleration / ramp;
    PathVector to = PathVector::Zero();
    to[0] = 10 * full_velocity * (stopping + ramp) / 2;
    PathMove move;
    move.element = PathElement::line(PathVector::Zero(), to);
    move.feed = {full_velocity, deceleration, deceleration, most_jerk};
    Path path;
    EXPECT_TRUE(path.append(move, {}).ok());
    const PathCurve curve(path, 1);
    const auto exchange = std::make_unique<StretchExchange>();
    PathPlayer player(*exchange);
    PathService service({{10 * full_velocity, deceleration, most_jerk}}, *exchange, 0.02);
    PathWish wish;
    long cycles = 0;
    const auto step = [&] {
        if (cycles++ % 5 == 0) (void)service.step(curve, path.length(), wish);
        (void)player.step(1e-3);
    };
    while (player.now().s < part * path.length() && cycles < 1'000'000) step();
    Lowered found;
    const double v = player.now().velocity, a = std::max(player.now().acceleration, 0.0);
    EXPECT_GT(v, factor * full_velocity);
    // What acceleration there is goes first, and what is gained meanwhile has to be braked too.
    found.braking = (v + a * a / (2 * most_jerk) - factor * full_velocity) / deceleration + ramp + a / most_jerk;
    const auto tries = service.tries();
    wish.velocity_factor = factor;
    for (long told = cycles; static_cast<double>(cycles - told) < 1000 * (6 * found.braking + 2);) {
        step();
        const double part_of_wanted = player.now().velocity / (factor * full_velocity);
        if (found.obeyed < 0 && part_of_wanted <= 1.02) found.obeyed = static_cast<double>(cycles - told) * 1e-3;
        found.stood = found.stood || (player.now().velocity == 0 && player.now().s < path.length() * (1 - 1e-9));
        if (player.now().s < 0.98 * path.length()) found.least = std::min(found.least, part_of_wanted);
        if (found.obeyed >= 0 && static_cast<double>(cycles - told) > 1e3 * (found.obeyed + 2)) break;
    }
    found.tries = service.tries() - tries;
    return found;
}

std::string name_of(double stopping, double ramp, double factor, double part) {
    return std::to_string(stopping) + " s to rest, ramp of " + std::to_string(ramp) + " s, to " + std::to_string(factor) + " at " +
           std::to_string(part);
}

TEST(LoweredOnALine, NeverStandsAndIsNeverFarBelow) {
    for (const double stopping : {0.5, 2.0})
        for (const double ramp : {0.003, 0.05})
            for (const double factor : {0.5, 0.1, 0.02}) {
                SCOPED_TRACE(name_of(stopping, ramp, factor, 0.3));
                const Lowered found = lowered(stopping, ramp, factor, 0.3);
                EXPECT_FALSE(found.stood);
                EXPECT_GT(found.least, 0.95);
                EXPECT_GT(found.obeyed, 0);
            }
}

// Also where the deceleration is there within a thousandth of the braking (300 mm/s, 150 mm/s2, 50,000 mm/s3): the cells are as short as its ramps there, and the search begins with a
// braking that has these ramps.
TEST(LoweredOnALine, IsComeToInWhatBrakingTakesHoweverShortTheJerksRampIs) {
    constexpr double share = 0.7;  // of the limits that a lowered velocity is braked to with
    for (const double stopping : {2.0, 4.25})
        for (const double ramp : {0.003, 0.013, 0.05})
            for (const double factor : {0.7, 0.3, 0.1, 0.02}) {
                SCOPED_TRACE(name_of(stopping, ramp, factor, 0.3));
                const Lowered found = lowered(stopping, ramp, factor, 0.3);
                EXPECT_GT(found.obeyed, 0);
                EXPECT_LE(found.obeyed, 1.25 * found.braking / share + 0.2) << "braking takes " << found.braking;
                EXPECT_LE(found.tries, 4u);
            }
}

// A ramp of a third of a millisecond, which is less than a cycle: it is found in some tries, though it may pass below for a moment.
TEST(LoweredOnALine, IsNotPlannedInEveryStepForASecond) {
    for (const double factor : {0.02, 0.003}) {
        SCOPED_TRACE(name_of(1, 0.0003, factor, 0.05));
        const Lowered found = lowered(1, 0.0003, factor, 0.05);
        EXPECT_GT(found.obeyed, 0);
        EXPECT_LE(found.tries, 60u);
        EXPECT_FALSE(found.stood);
    }
}

TEST(LoweredOnALine, IsComeToThoughItIsHardlyAnything) {
    for (const double stopping : {1.0, 4.0}) {
        SCOPED_TRACE(name_of(stopping, 0.01, 0.0005, 0.3));
        const Lowered found = lowered(stopping, 0.01, 0.0005, 0.3);
        EXPECT_GT(found.obeyed, 0);
        EXPECT_LE(found.obeyed, 2.2 * found.braking + 0.5);
    }
}

}  // namespace
}  // namespace taktwerk::axes
