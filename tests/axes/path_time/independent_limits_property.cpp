// Limits alone, beside independent_time_property.cpp: of plans drawn at random, where a factor is lowered, and where the end moves on.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>

#include <gtest/gtest.h>

#include "axes/path_time/run_plan.hpp"
#include "tests/axes/path/points.hpp"
#include "tests/axes/path_time/independent_cases.hpp"
#include "tests/axes/path_time/independent_comparison.hpp"
#include "tests/axes/path_time/random_program.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

/// Limits alone: from rest, from states, lowered, raised, grown.
TEST(IndependentTime, DrawnPlansKeepEveryLimit) {
    Uses rest, moving;
    std::size_t plans = 0, lost = 0, went_on = 0, not_found = 0, instants = 0, lowered = 0, above_both = 0;
    double furthest_above = 0;
    const std::size_t cases = property_cases(6);
    const std::uint64_t first = first_program();
    RunPlanner planner;
    for (std::uint64_t seed = first; seed < first + cases && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "drawn " << seed);
        const Case c = drawn_case(seed);
        RandomProgram random(seed + 1'000'000);
        RunTask task;
        task.to = c.curve->end();
        task.velocity_factor = random.uniform(0, 1) < 0.5 ? 1 : random.between_decades(0.05, 1);
        RunPlan plan, next;
        planner.plan(*c.curve, c.limits, task, plan);
        ++plans;
        if (!plan.found) {
            ++lost;
            std::printf("drawn %llu: not planned\n", static_cast<unsigned long long>(seed));
            continue;
        }
        const Uses u = uses_of(plan, *c.curve, c.limits, task.velocity_factor);
        instants += plan.pieces.size() * 201;
        rest.widen(u);
        EXPECT_LE(u.velocity, 1 + 1e-6);
        EXPECT_LE(u.acceleration, 1 + 1e-6);
        EXPECT_LE(u.jerk, 1 + 1e-3);
        if (plan.pieces.size() < 4) continue;
        for (int k = 0; k < 3; ++k) {
            State s = state_of(plan, random.uniform(0, 0.95));
            s.task.to = task.to;
            s.task.velocity_factor = k == 0 ? task.velocity_factor : random.between_decades(0.05, 1);
            planner.plan(*c.curve, c.limits, s.task, next, &plan.shape);
            if (!next.found) {
                ++not_found;
                continue;
            }
            ++went_on;
            instants += next.pieces.size() * 201;
            // Above a lowered velocity it may be, not above the path's own.
            const Uses n = uses_of(next, *c.curve, c.limits, s.task.velocity_factor < task.velocity_factor ? 1 : s.task.velocity_factor);
            moving.widen(n);
            if (s.task.velocity_factor < task.velocity_factor) {
                const Uses before = uses_of(next, *c.curve, c.limits, task.velocity_factor);
                above_both += before.velocity > 1 + 1e-6 ? 1 : 0;
                furthest_above = std::max(furthest_above, before.velocity);
                ++lowered;
            }
            // Where a factor scales it, it is kept to at nodes, and within 2.5e-4 between them (drawn 389).
            const bool scaled = s.task.velocity_factor >= task.velocity_factor && s.task.velocity_factor < 1;
            EXPECT_LE(n.velocity, 1 + (scaled ? 1e-3 : 1e-6)) << "from " << s.task.from << " to the factor " << s.task.velocity_factor;
            EXPECT_LE(n.acceleration, 1 + 1e-6) << "from " << s.task.from << " to the factor " << s.task.velocity_factor;
            EXPECT_LE(n.jerk, 1 + 1e-3) << "from " << s.task.from << " to the factor " << s.task.velocity_factor;
        }
    }
    std::printf(
        "%zu plans from rest, %zu not planned: uses 1%+.1e 1%+.1e 1%+.1e; %zu from states, %zu not found: 1%+.1e 1%+.1e 1%+.1e; %zu "
        "instants\n",
        plans, lost, rest.velocity - 1, rest.acceleration - 1, rest.jerk - 1, went_on, not_found, moving.velocity - 1,
        moving.acceleration - 1, moving.jerk - 1, instants);
    std::printf("%zu told to be slower, %zu of them above what the factor before allows as well: %.3f times that at most\n", lowered,
                above_both, furthest_above);
    EXPECT_LE(furthest_above, 1 + 1e-3);
}

// ------------------------------------------------------------------------------------------------------------------ what did not hold

/// The highest velocity of a plan.
double top_of(const RunPlan& plan) {
    double top = 0;
    for (const TimePiece& p : plan.pieces)
        for (int i = 0; i <= 20; ++i) top = std::max(top, p.at(p.duration * i / 20).velocity);
    return top;
}

struct LoweredInARamp {
    int told = 0, above_both = 0, above_though_below = 0;
    double beside_former = 0, beside_new = 0;
};
/// A line of 400 at this factor; told lower ones at every border of its ramp up.
LoweredInARamp lowered_in_a_ramp(double factor) {
    const PathFeed feed{100, 1000, 1000, 10'000};
    const Case c = of_path("line", polygon({at(0, 0), at(400, 0)}, 0, feed), {{1000, 1e5, 1e7}});
    RunPlanner planner;
    RunPlan plan, next;
    RunTask task;
    task.to = 400;
    task.velocity_factor = factor;
    planner.plan(*c.curve, c.limits, task, plan);
    LoweredInARamp found;
    const double former = factor * feed.velocity;
    for (std::size_t i = 1; i < plan.pieces.size() && plan.pieces[i].velocity < 0.999 * former; ++i)
        for (const double part : {0.95, 0.8, 0.5}) {
            const RunTask on = task_at(plan.pieces[i], 400, part * factor);
            planner.plan(*c.curve, c.limits, on, next, &plan.shape);
            if (!next.found) continue;
            ++found.told;
            const double top = top_of(next);
            found.beside_former = std::max(found.beside_former, top / former);
            found.above_both += top > former * (1 + 1e-3) ? 1 : 0;
            // What acceleration there is goes with all of the jerk: on a line that is a motion, and none stays lower.
            const double rising = std::max(on.acceleration, 0.0), least = on.velocity + rising * rising / (2 * feed.jerk);
            if (least > 0.97 * part * former) continue;
            found.beside_new = std::max(found.beside_new, top / (part * former));
            found.above_though_below += top > part * former * (1 + 1e-3) ? 1 : 0;
        }
    std::printf(
        "%d told: %d above the former factor's velocity, %.3f of it at most; %d above the new one's that could stay below, %.3f of it at "
        "most\n",
        found.told, found.above_both, found.beside_former, found.above_though_below, found.beside_new);
    return found;
}
// Who is told to be slower while it speeds up is never faster than it was allowed to be before. It was: its acceleration went as if it had to come back to the velocity of now. Of 60 u/s,
// told 48 at 29 u/s and 738 u/s2: 68 u/s.
TEST(IndependentTime, WhoIsToldToBeSlowerIsNeverFasterThanBefore) { EXPECT_EQ(lowered_in_a_ramp(0.6).above_both, 0); }
TEST(IndependentTime, WhoIsBelowALoweredVelocityAndCanStayThereDoes) { EXPECT_EQ(lowered_in_a_ramp(0.6).above_though_below, 0); }

// Where the end moves on while a run brakes for the former one, it goes on while it can. On a line its deceleration goes with all of the jerk; here more than half of the
// velocity is left then.
TEST(IndependentTime, AnEndThatMovesOnIsGoneOnTo) {
    const Case c = of_path("line of 10", polygon({at(0, 0), at(10, 0)}, 0), uneven_axes);
    RunPlanner planner;
    RunPlan plan, next;
    RunTask task;
    task.to = 5.5;
    planner.plan(*c.curve, c.limits, task, plan);
    int easy = 0, lost = 0;
    for (std::size_t i = 1; i + 1 < plan.pieces.size(); ++i) {
        const RunTask on = task_at(plan.pieces[i], 10);
        const double falling = std::min(on.acceleration, 0.0);
        if (falling * falling / (2 * uneven_axes[0].jerk) > 0.5 * on.velocity) continue;
        ++easy;
        planner.plan(*c.curve, c.limits, on, next, &plan.shape);
        if (next.found) continue;
        if (lost++ == 0) std::printf("from %.6g, %.6g u/s, %.6g u/s2: not found\n", on.from, on.velocity, on.acceleration);
    }
    std::printf("%d borders, %d not found\n", easy, lost);
    EXPECT_EQ(lost, 0);
}
// On an arc none was found from states that still speed up, where this search comes to a motion that keeps every limit.
TEST(IndependentTime, AnEndThatMovesOnIsGoneOnToOnAnArc) {
    Path small_arc;
    append_element(small_arc, plane_arc(at(0, 0), 2, 0.3, 2.5, 1));
    const Case c = of_path("arc of radius 2", small_arc, uneven_axes);
    RunPlanner planner;
    RunPlan full, plan, next;
    RunTask task;
    task.to = c.curve->end();
    planner.plan(*c.curve, c.limits, task, full);
    task.to *= 0.55;
    planner.plan(*c.curve, c.limits, task, plan);
    for (const double part : {0.25, 0.35, 0.45, 0.55}) {
        const RunTask on = [&] {
            RunTask t = state_of(plan, part).task;
            t.to = c.curve->end();
            return t;
        }();
        planner.plan(*c.curve, c.limits, on, next, &plan.shape);
        if (next.found) continue;
        double low = 0, high = full.duration;
        for (int i = 0; i < 100; ++i) (PlanMotion{full}((low + high) / 2).s < on.from ? low : high) = (low + high) / 2;
        const FoundMotion f =
            faster_than(*c.curve, c.limits, {.from = on.from, .to = on.to, .velocity = on.velocity, .acceleration = on.acceleration},
                        PlanMotion{full, low}, full.duration - low, 150);
        EXPECT_FALSE(f.holds) << "from " << on.from << " with " << on.velocity << " u/s and " << on.acceleration
                              << " u/s2 there is a way of " << f.duration << " s, and none is planned";
    }
}

}  // namespace
}  // namespace taktwerk::axes
