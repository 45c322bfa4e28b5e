// A planner that takes longer than was thought: its plans are refused, and it looks further ahead until they come in time. G-068.

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "axes/path_time/path_player.hpp"
#include "axes/path_time/path_service.hpp"
#include "tests/axes/path_time/path_curve.hpp"

namespace taktwerk::axes {
namespace {

/// Cycles pass while it is planned on.
class CurveOfASlowPlanner final : public PathCurve {
public:
    using PathCurve::PathCurve;
    std::function<void()> meanwhile;
    [[nodiscard]] double next_stop(double s) const noexcept override {
        if (meanwhile) meanwhile();
        return PathCurve::next_stop(s);
    }
};

// 40 ms for each plan where 8 ms were thought: 8, 16, 32, 64 ms ahead, so three come late and the fourth is taken.
TEST(LatePlanner, LooksFurtherAheadUntilItsPlansComeInTime) {
    constexpr double velocity = 50, cycle = 1e-3;
    PathVector to = PathVector::Zero();
    to[0] = 200;
    PathMove move;
    move.element = PathElement::line(PathVector::Zero(), to);
    move.feed = {velocity, 1000, 1000, 10'000};
    Path path;
    ASSERT_TRUE(path.append(move, {}).ok());
    CurveOfASlowPlanner curve(path, 1);
    const auto exchange = std::make_unique<StretchExchange>();
    PathPlayer player(*exchange);
    PathService service({{1e3, 1000, 10'000}}, *exchange, 0.008);
    PathWish wish;
    for (int i = 0; i < 500; ++i) {
        (void)service.step(curve, path.length(), wish);
        (void)player.step(cycle);
    }
    ASSERT_GT(player.now().velocity, 0.98 * velocity);

    curve.meanwhile = [&] {
        for (int i = 0; i < 40; ++i) (void)player.step(cycle);
    };
    wish.velocity_factor = 0.5;
    for (int i = 0; i < 25; ++i) {  // a second
        (void)service.step(curve, path.length(), wish);
        (void)player.step(cycle);
    }

    EXPECT_LE(player.now().velocity, 0.5 * velocity * (1 + 1e-6));
    EXPECT_GT(player.now().velocity, 0.49 * velocity);
    EXPECT_GE(service.late(), 2u);
    EXPECT_LE(service.late(), 4u);
}

}  // namespace
}  // namespace taktwerk::axes
