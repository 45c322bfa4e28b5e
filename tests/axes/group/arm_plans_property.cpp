// Plans of programs of 1 to 200 moves on every kind of arm, without a machine around them: a hundredth of what a program of group_programs_property.cpp costs, so that very many can be
// looked at. From rest, and from states on the way to rest and to a lowered override: limits between all nodes by exact derivatives, continuity, the end.
// A move that no curve leads to begins a run of its own, as at a corner at rest.
//
// TAKTWERK_PROGRAMS_FIRST=<seed> begins there; TAKTWERK_SOAK_FACTOR multiplies how many are planned.

#include <gtest/gtest.h>

#include <cstdio>
#include <memory>

#include "axes/group/move_shape.hpp"
#include "axes/group/run_curve.hpp"
#include "axes/path_time/along_limits.hpp"
#include "axes/path_time/braking.hpp"
#include "tests/axes/group/drawn_program.hpp"
#include "tests/axes/path_time/plan_look.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr int per_piece = 7;  // instants that are looked at: the curve of an arm is dear

struct ArmTotals {
    PlanTotals plans, disturbed;
    std::size_t moves = 0, rounded = 0, halts = 0, slower = 0;  // found ones
};

MoveSpace space_of(const JogArm& arm, const Kinematics& kinematics) {
    MoveSpace space{&kinematics, arm.turning.size(), {}};
    for (std::size_t i = 0; i < space.members; ++i) {
        auto& limits = space.limits[i];
        limits.velocity = arm.turning[i] ? 90 : 200;
        limits.acceleration = arm.turning[i] ? 900 : 2000;
        limits.jerk = arm.turning[i] ? 18'000 : 40'000;
        limits.low = -150;
        limits.high = 150;
    }
    return space;
}

/// The runs of a program, one after the other.
class RunsOf {
public:
    RunsOf(const JogArm& arm, const Kinematics& kinematics) : space_(space_of(arm, kinematics)) {
        for (std::size_t i = 0; i < space_.members; ++i) end_.members[i] = arm.start[i];
        end_.configuration.branch = kinematics.configuration(joints_of(end_.members)).branch;
    }

    void add(const GroupCommand& command) {
        GroupOrder order;
        order.command = command;
        order.id = ++ids_;
        for (std::size_t i = 0; i < space_.members; ++i) order.target[i] = command.target[i];  // of a move of the axes
        const MoveShape shape = shape_of(order, end_, space_);
        ASSERT_EQ(shape.error, ErrorId::none) << "move " << ids_;
        if (shape.empty) return;
        if (runs.empty() || runs.back()->seen.back().run.through_arm != shape.through_arm || !append(*runs.back(), order, shape)) {
            runs.push_back(std::make_unique<RunCurve>(space_.arm, space_.members, space_.limits));
            ASSERT_TRUE(append(*runs.back(), order, shape)) << "move " << ids_;
        }
        end_ = shape.end;
    }

    std::vector<std::unique_ptr<RunCurve>> runs;
    std::size_t rounded = 0;

private:
    bool append(RunCurve& curve, const GroupOrder& order, const MoveShape& shape) {
        const bool first = curve.path.sections().empty();
        const auto& d = order.command.dynamics;
        PathMove move;
        move.element = shape.element;
        move.chart = shape.chart;
        move.feed = {d.velocity, d.acceleration, d.deceleration, d.jerk};
        move.command = order.id;
        const bool deviation = order.command.transition == mcTMMaxCornerDeviation;
        const BlendRequest asked{deviation ? BlendRule::corner_deviation : BlendRule::corner_distance, order.command.transition_parameter};
        const auto kept = curve.path.mark();
        const auto joint = curve.path.append(move, first ? BlendRequest{} : asked, 0);
        if (!joint.ok()) return false;
        const auto& all = curve.path.sections();
        RunCurve::Seen seen;
        seen.run.through_arm = shape.through_arm;
        seen.run.configuration = end_.configuration;
        const bool corner = all.size() > 1 && all[all.size() - 2].blend && all[all.size() - 2].command == order.id;
        if (!first &&
            (joint.value() == PathJoint::stop || (corner && refuse_blend(all[all.size() - 2], seen.run, end_, space_) != ErrorId::none))) {
            curve.path.back_to(kept);
            return false;
        }
        curve.seen.resize(all.size() - (corner ? 2 : 1));  // a section that its corners take as a whole is gone
        if (corner) {
            seen.members = {end_.members};
            curve.seen.push_back(seen);
            ++rounded;
        }
        seen.members = shape.members;
        curve.seen.push_back(seen);
        EXPECT_EQ(curve.seen.size(), all.size());
        return true;
    }

    MoveSpace space_;
    MoveEnd end_;
    CommandId ids_ = 0;
};

/// From one of its borders to rest, and to a lowered velocity: as often as there is such a way.
void disturb(RunPlanner& planner, const RunPlan& runs, const RunCurve& curve, const std::vector<PathAxisLimits>& limits,
             ProgramDraws& draws, ArmTotals& totals) {
    if (runs.pieces.size() < 4) return;
    const auto& from = runs.pieces[static_cast<std::size_t>(draws.whole(1, static_cast<int>(runs.pieces.size()) - 2))];
    RunTask task;
    task.from = from.begin;
    task.velocity = from.velocity;
    task.acceleration = from.slope;
    RunPlan plan;
    RunTask halt = task;
    const AlongLimits l = along_limits(curve.at(task.from, CurveSide::after), limits, 1);
    for (const double share : {0.93, 0.56, 0.24}) {
        halt.halt_share = share;
        halt.to = halt.from + Braking(halt.velocity, halt.acceleration, share * l.deceleration, share * l.jerk).way();
        if (!(halt.to > halt.from) || !(halt.to < runs.shape.end)) continue;
        planner.plan(curve, limits, halt, plan, &runs.shape);
        if (!plan.found) continue;
        look_at(plan, curve, limits, halt, totals.disturbed, per_piece);
        ++totals.halts;
        break;
    }
    task.to = runs.shape.end;
    task.velocity_factor = draws.between_decades(0.05, 0.95);
    planner.plan(curve, limits, task, plan, &runs.shape);
    if (!plan.found) return;
    task.velocity_factor = 1;  // what is above it at the beginning is above no limit
    look_at(plan, curve, limits, task, totals.disturbed, per_piece);
    ++totals.slower;
}

void plan_program(std::uint64_t seed, const JogArm& arm, const Arm& kinematics, ArmTotals& totals) {
    ProgramDraws draws(seed, arm, kinematics);
    const auto moves = draws.program(draws.how_many());
    RunsOf program(arm, *kinematics);
    for (const auto& move : moves) {
        program.add(move.command);
        if (::testing::Test::HasFailure()) return;
    }
    ++totals.plans.programs;
    totals.moves += moves.size();
    totals.rounded += program.rounded;
    RunPlanner planner;
    RunPlan plan;
    for (const auto& curve : program.runs) {
        const std::vector<PathAxisLimits> limits(curve->axis_limits().begin(), curve->axis_limits().end());
        RunTask task;
        task.to = curve->end();
        planner.plan(*curve, limits, task, plan);
        ++totals.plans.runs;
        if (!plan.found) {
            ++totals.plans.lost;
            std::printf("seed %llu: a run to %g is not planned\n", static_cast<unsigned long long>(seed), task.to);
            continue;
        }
        look_at(plan, *curve, limits, task, totals.plans, per_piece);
        if (!::testing::Test::HasFailure()) disturb(planner, plan, *curve, limits, draws, totals);
        if (::testing::Test::HasFailure()) return;
    }
}

TEST(ArmPlans, OfEveryLengthKeepEveryLimit) {
    const auto arms = arms_of_programs();
    std::vector<Arm> kinematics;
    for (const auto& arm : arms) kinematics.push_back(arm_of(arm.description));
    ArmTotals t;
    const std::uint64_t first = first_program();
    for (std::uint64_t seed = first; seed < first + property_cases(arms.size()) && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << " on " << arms[seed % arms.size()].name);
        plan_program(seed, arms[seed % arms.size()], kinematics[seed % arms.size()], t);
    }
    report_plans(("on every arm, from seed " + std::to_string(first)).c_str(), t.plans);
    std::printf(
        "  %zu moves, %zu corners with a curve; %zu halts, %zu lowered overrides: worst use: velocity 1%+.1e, acceleration 1%+.1e, jerk "
        "1%+.1e\n",
        t.moves, t.rounded, t.halts, t.slower, t.disturbed.worst.velocity - 1, t.disturbed.worst.acceleration - 1,
        t.disturbed.worst.jerk - 1);
    EXPECT_EQ(t.plans.lost, 0u);
    if (first != 1) return;
    EXPECT_GT(t.rounded, 5u);
    EXPECT_GT(t.halts, 5u);
    EXPECT_GT(t.slower, 5u);
}

// A border at the beginning of a corner's curve, and an override lowered from there: cells of 2e-8 u, in which q' does not change, were taken for straight ones, though q''' v3 was as
// much as the limit (jerk 2 times and 1.2 times its limit, for a microsecond).
TEST(ArmPlans, ThatFailedOnce) {
    const auto arms = arms_of_programs();
    ArmTotals t;
    for (const std::uint64_t seed : {636, 1061}) {
        const auto& arm = arms[seed % arms.size()];
        SCOPED_TRACE(::testing::Message() << "seed " << seed << " on " << arm.name);
        plan_program(seed, arm, arm_of(arm.description), t);
    }
    EXPECT_EQ(t.plans.lost, 0u);
    EXPECT_GT(t.slower, 10u);
}

}  // namespace
}  // namespace taktwerk::axes::test
