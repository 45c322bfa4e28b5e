// Where no motion is found: it is said, and it costs no more than once.

#include <gtest/gtest.h>

#include <memory>

#include "axes/path_time/path_player.hpp"
#include "axes/path_time/path_service.hpp"
#include "tests/axes/path_time/path_curve.hpp"

namespace taktwerk::axes {
namespace {

constexpr double stuck_period = 1e-3, length = 60, velocity = 50;  // s, u, u/s
constexpr double nothing = 1e-200;                                 // u/s: its square is 0

/// A line whose velocity may become impossible.
class MoodyLine final : public PathCurve {
public:
    explicit MoodyLine(const Path& path) : PathCurve(path, 1) {}
    [[nodiscard]] TimedCurvePoint at(double s, CurveSide side) const noexcept override {
        TimedCurvePoint p = PathCurve::at(s, side);
        if (impossible) p.path.velocity = nothing;
        return p;
    }
    bool impossible = false;
};

struct Walk {
    Walk() {
        PathVector to = PathVector::Zero();
        to[0] = length;
        PathMove move;
        move.element = PathElement::line(PathVector::Zero(), to);
        move.feed = {velocity, 1000, 1000, 10'000};
        EXPECT_TRUE(path.append(move, {}).ok());
    }
    PathAnswer step(const PathWish& wish) {
        (void)player.step(stuck_period);
        return service.step(curve, path.length(), wish);
    }

    Path path;
    MoodyLine curve{path};
    std::unique_ptr<StretchExchange> exchange = std::make_unique<StretchExchange>();
    PathService service{{{1e3, 1000, 10'000}}, *exchange, 0.008};
    PathPlayer player{*exchange};
};

TEST(Stuck, AtRestItIsTriedOnceForEachWish) {
    Walk walk;
    walk.curve.impossible = true;
    for (int i = 0; i < 300; ++i) EXPECT_EQ(walk.step({}), PathAnswer::stuck);
    EXPECT_EQ(walk.service.tries(), 1U);
    EXPECT_EQ(walk.step({.velocity_factor = 0.5}), PathAnswer::stuck) << "another wish, another try";
    EXPECT_EQ(walk.service.tries(), 2U);
    walk.curve.impossible = false;
    EXPECT_EQ(walk.step({.velocity_factor = 0.5}), PathAnswer::stuck) << "nobody has said that anything is different";
    EXPECT_EQ(walk.step({.velocity_factor = 0.5, .revision = 1}), PathAnswer::offered);
    while (walk.player.now().s < length - 1e-9) ASSERT_NE(walk.step({.velocity_factor = 0.5, .revision = 1}), PathAnswer::stuck);
}

// In motion each border between pieces is tried once: what runs goes on to its end, and no step repeats what another one has tried.
TEST(Stuck, InMotionEachBorderIsTriedOnce) {
    Walk walk;
    for (int i = 0; i < 300; ++i) (void)walk.step({});
    ASSERT_GT(walk.player.now().velocity, 0.9 * velocity);
    const auto before = walk.service.tries();
    const auto pieces = static_cast<std::uint32_t>(walk.service.last_plan().pieces.size());
    walk.curve.impossible = true;
    int steps = 0;
    bool kept = false;
    for (; !walk.player.standing() && steps < 5000; ++steps) kept = walk.step({.revision = 1}) == PathAnswer::kept || kept;
    EXPECT_TRUE(kept);
    EXPECT_NEAR(walk.player.now().s, length, 1e-9) << "it went on as it was";
    EXPECT_GT(walk.service.tries(), before);
    EXPECT_LE(walk.service.tries() - before, pieces);
    // A possible wish is taken up at once, as before: the first border that it leads from.
    Walk other;
    for (int i = 0; i < 300; ++i) (void)other.step({});
    other.curve.impossible = true;
    for (int i = 0; i < 100; ++i) (void)other.step({.revision = 1});
    other.curve.impossible = false;
    EXPECT_EQ(other.step({.velocity_factor = 0.5, .revision = 2}), PathAnswer::offered);
}

}  // namespace
}  // namespace taktwerk::axes
