// A halt that nobody can begin yet, and then a harder one: a softer halt may have been found from a border that comes in a quarter of a second only, and its stretch waits for
// that. Who has to stand sooner does not wait with it. G-063.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "axes/path_time/path_player.hpp"
#include "axes/path_time/path_service.hpp"
#include "tests/axes/path_time/path_curve.hpp"
#include "tests/axes/path_time/random_program.hpp"
#include "tests/axes/path_time/shown_use.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

/// The path may be left as softly as somebody wishes.
class SoftenedCurve : public PathCurve {
public:
    using PathCurve::PathCurve;
    double deceleration = 1, jerk = 1;  // parts of the program's

    [[nodiscard]] TimedCurvePoint at(double s, CurveSide side) const noexcept override {
        TimedCurvePoint p = PathCurve::at(s, side);
        p.path.deceleration *= deceleration;
        p.path.jerk *= jerk;
        return p;
    }
};

struct HaltedWalk {
    HaltedWalk(const Path& path, int axes, const std::vector<PathAxisLimits>& limits)
        : curve(path, axes), service(limits, *exchange, 0.02), limits_(limits) {}

    void cycle() {
        if (cycles_++ % 5 == 0) (void)service.step(curve, curve.end(), wish);
        (void)player.step(1e-3);
        const PathMotion& now = player.now();
        // On one of both sides of a place where something jumps.
        const LimitUse one = shown_use(hard().at(now.s, CurveSide::after), limits_, 1, now),
                       other = shown_use(hard().at(now.s, CurveSide::before), limits_, 1, now);
        ASSERT_LE(std::min(one.velocity, other.velocity), 1 + 1e-6) << now.s;
        ASSERT_LE(std::min(one.acceleration, other.acceleration), 1 + 1e-6) << now.s;
        ASSERT_LE(std::min(one.jerk, other.jerk), 1 + 1e-3) << now.s;
    }
    /// The planner looks at it before the next cycle.
    void stand(double deceleration, double jerk, bool as_before = false) {
        curve.deceleration = deceleration;
        curve.jerk = jerk;
        wish.motion = PathWish::Motion::stand;
        wish.revision += as_before ? 0 : 1;
        cycles_ = 0;
    }
    int to_rest() {
        int cycles = 0;
        for (; !player.standing() && cycles < 10'000; ++cycles) cycle();
        return cycles;
    }

    SoftenedCurve curve;
    std::unique_ptr<StretchExchange> exchange = std::make_unique<StretchExchange>();
    PathService service;
    PathPlayer player{*exchange};
    PathWish wish;

private:
    [[nodiscard]] SoftenedCurve hard() const {
        SoftenedCurve all = curve;
        all.deceleration = all.jerk = 1;
        return all;
    }
    std::vector<PathAxisLimits> limits_;
    int cycles_ = 0;
};

struct HarderHalts {
    int looked = 0, worst = 0;

    void add(int with, int alone) {
        ++looked;
        worst = std::max(worst, with - alone);
    }
};

/// A path drawn at random, on which two go.
struct HaltedPair {
    explicit HaltedPair(std::uint64_t seed) : random(seed) {}
    [[nodiscard]] Path draw() {
        const double size = random.between_decades(0.5, 500);
        velocity = size * random.between_decades(0.5, 5);
        axes = random.whole(1, 3);
        return random.path(random.whole(1, 8), size, axes, velocity);
    }
    void both(int cycles) {
        for (int i = 0; i < cycles && !::testing::Test::HasFailure(); ++i) {
            walk.cycle();
            twin.cycle();
        }
    }
    [[nodiscard]] bool as_one() const { return !walk.player.standing() && walk.player.now().s == twin.player.now().s; }

    RandomProgram random;
    double velocity = 0;
    int axes = 0;
    const Path path = draw();
    const std::vector<PathAxisLimits> limits = random.limits(axes, velocity);
    HaltedWalk walk{path, axes, limits}, twin{path, axes, limits};
};

/// A soft halt that has not begun when the hard one comes costs nothing: a twin that got the hard one alone is at the same place then.
void halt_harder(std::uint64_t seed, HarderHalts& totals) {
    HaltedPair pair(seed);
    auto& random = pair.random;
    pair.both(random.whole(20, 1000));
    if (!pair.as_one()) return;
    pair.walk.stand(random.between_decades(0.01, 0.3), random.between_decades(0.01, 0.3));
    pair.both(random.whole(1, 60) * 5);
    if (!pair.as_one()) return;
    pair.walk.stand(1, 1);
    pair.twin.stand(1, 1);
    // What has nearly begun begins: its border was as near as one can be.
    constexpr int nearly = 60;
    const int with = pair.walk.to_rest();
    const int alone = pair.twin.to_rest();
    totals.add(with, alone);
    EXPECT_LE(with, alone + nearly) << "ms to rest";
}

/// Halted, told to go on, and halted again before that has begun: it stands when it would have without. Then it goes on.
void halt_again(std::uint64_t seed, HarderHalts& totals) {
    HaltedPair pair(seed);
    auto& random = pair.random;
    auto& walk = pair.walk;
    pair.both(random.whole(20, 1000));
    if (!pair.as_one()) return;
    const double goes_to = walk.player.stretch_end();
    walk.stand(1, 1);
    pair.twin.stand(1, 1);
    pair.both(random.whole(1, 20) * 5);
    if (!pair.as_one() || walk.player.stretch_end() == goes_to) return;
    walk.wish.motion = PathWish::Motion::go;
    pair.both(random.whole(1, 10) * 5);
    if (!pair.as_one()) return;
    walk.stand(1, 1, random.whole(0, 1) == 0);
    const int with = walk.to_rest();
    totals.add(with, pair.twin.to_rest());
    EXPECT_LE(walk.player.now().s, pair.twin.player.now().s);
    walk.wish.motion = PathWish::Motion::go;
    for (int i = 0; walk.player.now().s < pair.path.length() * (1 - 1e-12) && i < 600'000 && !::testing::Test::HasFailure(); ++i)
        walk.cycle();
    EXPECT_GE(walk.player.now().s, pair.path.length() * (1 - 1e-12));
}

TEST(HarderHalt, DoesNotWaitForASofterOneThatHasNotBegun) {
    HarderHalts totals;
    const std::size_t cases = property_cases(25);
    for (std::uint64_t seed = 1; seed <= cases && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        halt_harder(seed, totals);
    }
    std::printf("%d harder halts behind soft ones that had not begun: to rest %d ms later than alone, at most\n", totals.looked,
                totals.worst);
    EXPECT_GT(totals.looked, 5);
}

TEST(HarderHalt, IsNotLateForAContinueThatHasNotBegun) {
    HarderHalts totals;
    const std::size_t cases = property_cases(25);
    for (std::uint64_t seed = 1; seed <= cases && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed);
        halt_again(seed, totals);
    }
    std::printf("%d halts behind a continue that had not begun: to rest %d ms later than without it, at most\n", totals.looked,
                totals.worst);
    EXPECT_GT(totals.looked, 3);
}

}  // namespace
}  // namespace taktwerk::axes
