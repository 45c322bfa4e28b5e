// The planner against exhaustive search. On a lattice (time steps of 1 s, jerk -1, 0 or 1 u/s3 in each) every motion is a path in a
// finite graph of integer states: acceleration a, velocity V/2, position P/6. Breadth first search finds the fewest steps to every
// state. Each such path is a motion inside the limits, so no plan may take longer than its steps. The other side, that no plan is too
// short, is the business of the property tests: what they check of each plan makes it a motion inside the limits.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "axes/planner/plan.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

/// s. Many ends lie exactly on a turning point of the way, where a rounding error costs the square root of itself.
constexpr double tolerance = 1e-7;

/// In lattice units: accelerations in u/s2, velocities in half u/s.
struct LatticeLimits {
    int velocity_up, velocity_down;
    int speeding_up, slowing_up;      // acceleration > 0 with velocity > 0, < 0
    int speeding_down, slowing_down;  // acceleration < 0 with velocity < 0, > 0

    [[nodiscard]] SignedLimits for_planner() const {
        return {{velocity_up / 2.0, double(speeding_up), double(slowing_up), 1},
                {velocity_down / 2.0, double(speeding_down), double(slowing_down), 1}};
    }
};

struct LatticeState {
    int a = 0;
    int v = 0;
    int p = 0;

    [[nodiscard]] MotionState real() const { return {p / 6.0, v / 2.0, double(a)}; }
};

class Lattice {
public:
    static constexpr int steps = 16;

    Lattice(const LatticeLimits& limits, LatticeState start)
        : limits_{limits},
          top_{std::max({limits.speeding_up, limits.slowing_up, limits.speeding_down, limits.slowing_down})},
          reach_{3 * std::max(limits.velocity_up, limits.velocity_down) * steps + 3 * top_ * steps} {
        fewest_.assign(std::size_t(2 * top_ + 1) * std::size_t(limits.velocity_up + limits.velocity_down + 1) * std::size_t(2 * reach_ + 1),
                       unreached);
        std::vector<LatticeState> edge{start};
        fewest_[index(start)] = 0;
        for (int n = 1; n <= steps; ++n) {
            std::vector<LatticeState> next;
            for (const LatticeState& s : edge) {
                for (int jerk = -1; jerk <= 1; ++jerk) {
                    const LatticeState to{s.a + jerk, s.v + 2 * s.a + jerk, s.p + 3 * s.v + 3 * s.a + jerk};
                    if (!allowed(s, to) || fewest_[index(to)] != unreached) continue;
                    fewest_[index(to)] = std::int8_t(n);
                    next.push_back(to);
                    reached_.push_back(to);
                }
            }
            edge.swap(next);
        }
    }

    [[nodiscard]] const std::vector<LatticeState>& reached() const { return reached_; }
    [[nodiscard]] int fewest_steps(const LatticeState& s) const { return fewest_[index(s)]; }

private:
    static constexpr std::int8_t unreached = -1;

    [[nodiscard]] std::size_t index(const LatticeState& s) const {
        return (std::size_t(s.a + top_) * std::size_t(limits_.velocity_up + limits_.velocity_down + 1) +
                std::size_t(s.v + limits_.velocity_down)) *
                   std::size_t(2 * reach_ + 1) +
               std::size_t(s.p + reach_);
    }

    /// The acceleration changes its sign only between steps, so the velocity is monotone within one: its ends decide.
    [[nodiscard]] bool allowed(const LatticeState& from, const LatticeState& to) const {
        if (to.v > limits_.velocity_up || to.v < -limits_.velocity_down) return false;
        const bool positive = from.v > 0 || to.v > 0;
        const bool negative = from.v < 0 || to.v < 0;
        const int up = std::max(from.a, to.a);
        const int down = -std::min(from.a, to.a);
        if (positive && (up > limits_.speeding_up || down > limits_.slowing_down)) return false;
        if (negative && (up > limits_.slowing_up || down > limits_.speeding_down)) return false;
        return true;
    }

    LatticeLimits limits_;
    int top_;
    int reach_;
    std::vector<std::int8_t> fewest_;
    std::vector<LatticeState> reached_;
};

/// Lattices with random limits and starts, a few hundred random ends each.
template <typename Draw>
void compare(std::uint64_t seed, Draw draw) {
    std::mt19937_64 random{seed};
    const auto pick = [&](int low, int high) { return low + int(random() % std::uint64_t(high - low + 1)); };
    std::size_t compared = 0, exact = 0;
    const std::size_t lattices = property_cases(40);
    for (std::size_t k = 0; k < lattices; ++k) {
        const LatticeLimits limits = draw(pick);
        const int gentlest = std::min({limits.speeding_up, limits.slowing_up, limits.speeding_down, limits.slowing_down});
        const LatticeState start{pick(-gentlest, gentlest), pick(-limits.velocity_down, limits.velocity_up), 0};
        const SignedLimits for_planner = limits.for_planner();
        const Lattice lattice{limits, start};
        if (lattice.reached().empty()) continue;
        for (int i = 0; i < 400; ++i) {
            const LatticeState& end = lattice.reached()[random() % lattice.reached().size()];
            const Plan plan = plan_to_state(start.real(), end.real(), for_planner);

            SCOPED_TRACE(::testing::Message() << "a, v, p from " << start.a << " " << start.v / 2.0 << " 0 to " << end.a << " "
                                              << end.v / 2.0 << " " << end.p << "/6; limits up " << limits.velocity_up / 2.0 << " "
                                              << limits.speeding_up << " " << limits.slowing_up << " down " << limits.velocity_down / 2.0
                                              << " " << limits.speeding_down << " " << limits.slowing_down);
            ASSERT_EQ(plan.error, PlanError::none);
            ASSERT_LE(plan.profile.duration(), lattice.fewest_steps(end) + tolerance);
            ++compared;
            exact += plan.profile.duration() > lattice.fewest_steps(end) - tolerance;
        }
    }
    EXPECT_GT(compared, lattices * 100);
    EXPECT_GT(exact, compared / 100);  // where the fastest motion is on the lattice, it is this one
}

TEST(PlanLattice, NoMotionOfExhaustiveSearchIsFasterWithLimitsPerSign) {
    compare(1, [](auto pick) {
        const int up = pick(1, 3), down = pick(1, 3);
        return LatticeLimits{pick(1, 8), pick(1, 8), up, up, down, down};
    });
}

TEST(PlanLattice, NoMotionOfExhaustiveSearchIsFasterWithAccelerationAndDeceleration) {
    compare(2, [](auto pick) {
        const int acceleration = pick(1, 3), deceleration = pick(1, 3);
        return LatticeLimits{pick(1, 8), pick(1, 8), acceleration, deceleration, acceleration, deceleration};
    });
}

TEST(PlanLattice, NoMotionOfExhaustiveSearchIsFasterWithoutReachingAnyLimit) {
    compare(3, [](auto) { return LatticeLimits{12, 12, 4, 4, 4, 4}; });
}

// Any walk on the lattice proves that its end can be reached in the time it took: whatever times are left out, this one is not.
TEST(PlanLattice, TheTimeOfEveryWalkHasASolution) {
    std::mt19937_64 random{4};
    const auto pick = [&](int low, int high) { return low + int(random() % std::uint64_t(high - low + 1)); };
    for (std::size_t k = 0; k < property_cases(20'000); ++k) {
        const int up = pick(1, 3), down = pick(1, 3), fastest = pick(1, 8);
        const LatticeState start{pick(-1, 1), pick(-fastest / 2, fastest / 2), 0};
        LatticeState s = start;
        const int steps = pick(1, 12);
        for (int i = 0; i < steps; ++i) {
            const int jerk = pick(-1, 1);
            const LatticeState to{s.a + jerk, s.v + 2 * s.a + jerk, s.p + 3 * s.v + 3 * s.a + jerk};
            s = to.a <= up && -to.a <= down ? to : LatticeState{s.a, s.v + 2 * s.a, s.p + 3 * s.v + 3 * s.a};
        }
        // Velocity limits that both ends release into and the walk need not know.
        const SignedLimits limits{{100, double(up), double(up), 1}, {100, double(down), double(down), 1}};
        SCOPED_TRACE(::testing::Message() << "a, v, p from " << start.a << " " << start.v / 2.0 << " 0 to " << s.a << " " << s.v / 2.0
                                          << " " << s.p << "/6 in " << steps << " limits " << up << " " << down);
        const Plan plan = plan_in_time(start.real(), s.real(), steps, limits);
        ASSERT_EQ(plan.error, PlanError::none);
        ASSERT_NEAR(plan.profile.duration(), steps, 1e-9);
    }
}

}  // namespace
}  // namespace taktwerk::axes
