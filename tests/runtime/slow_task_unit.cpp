// A task at a divisor: inputs latched at release, outputs applied at the next one, whenever it finishes (docs/architecture.md).

#include "runtime/tasks/object_requests.hpp"
#include "runtime/tasks/slow_task.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <stdexcept>

#include "fb_library/motion/administration.hpp"
#include "fb_library/motion/moves.hpp"
#include "tests/fb_library/fake_axes.hpp"

namespace taktwerk::runtime {
namespace {

/// Runs whatever the test wants in its task.
struct Body final : Program {
    std::function<void(TaskContext&)> run;
    double shown = 0;
    void declare(Declaration&) override {}
    void scan(TaskContext& ctx) {
        if (run) run(ctx);
    }
};

struct Slow : ::testing::Test {
    Slow() : task{host_task(), &body, {{VariableType::real, &body.shown, 0}}, 1, 1, 2, 1, objects.of(0), tables} {}

    static ProgramHost::Task host_task() {
        ProgramHost::Task t;
        t.config.name = "slow";
        t.config.divisor = 4;
        t.function = [](void* p, TaskContext& ctx) { static_cast<Body*>(static_cast<Program*>(p))->scan(ctx); };
        return t;
    }
    /// What the cycle does at a release.
    void release() {
        task.apply(axes, outputs, alarms);
        axes.next_scan();
        CycleContext now;
        now.now = axes.context.now;
        now.period = std::chrono::milliseconds{1};
        task.release(now, axes.context.axes, {inputs, input_values}, outputs, parameters, alarms);
    }

    fb::FakeAxes axes{1};
    Body body;
    std::vector<std::int64_t> inputs{0}, outputs{0, 0};
    std::vector<PointValue> input_values{{}};
    std::vector<double> parameters{0};
    std::uint64_t alarms = 0;
    ObjectRequests objects{1, 0};
    axes::MotionTables tables;
    SlowTask task;
};

TEST_F(Slow, InputsAreThoseOfTheReleaseAndOutputsApplyAtTheNext) {
    body.run = [](TaskContext& ctx) { ctx.outputs[0] = ctx.inputs[0] + 1; };
    inputs[0] = 10;
    release();
    inputs[0] = 20;  // changes while the task has not run yet: it does not see it
    EXPECT_TRUE(task.run_if_released());
    EXPECT_EQ(outputs[0], 0) << "not before the next release";
    release();
    EXPECT_EQ(outputs[0], 11);
}

TEST_F(Slow, OnlyOutputsThatItChangedAreWritten) {
    body.run = [](TaskContext& ctx) { ctx.outputs[0] = 5; };
    release();
    task.run_if_released();
    outputs[1] = 77;  // somebody else's, written meanwhile
    release();
    EXPECT_EQ(outputs[0], 5);
    EXPECT_EQ(outputs[1], 77);
}

TEST_F(Slow, OnlyAlarmsThatItChangedAreWritten) {
    body.run = [](TaskContext& ctx) { ctx.alarm(3, true); };
    release();
    task.run_if_released();
    alarms = 1;  // the base task's, raised meanwhile
    release();
    EXPECT_EQ(alarms, 0b1001u);
    body.run = [](TaskContext& ctx) { ctx.alarm(3, false); };
    task.run_if_released();
    release();
    EXPECT_EQ(alarms, 1u);
}

TEST_F(Slow, ItRunsOncePerRelease) {
    int runs = 0;
    body.run = [&](TaskContext&) { ++runs; };
    EXPECT_FALSE(task.run_if_released());
    release();
    EXPECT_FALSE(task.finished());
    EXPECT_TRUE(task.run_if_released());
    EXPECT_FALSE(task.run_if_released());
    EXPECT_TRUE(task.finished());
    EXPECT_EQ(runs, 1);
}

TEST_F(Slow, ItsPeriodIsTheDivisorsAndItsFirstScanIsTheFirstAfterEachStart) {
    std::vector<bool> first;
    Duration period{};
    body.run = [&](TaskContext& ctx) {
        first.push_back(ctx.first_scan);
        period = ctx.period;
    };
    for (int i = 0; i < 2; ++i) {
        release();
        task.run_if_released();
    }
    task.restart();
    release();
    task.run_if_released();
    EXPECT_EQ(first, (std::vector{true, false, true}));
    EXPECT_EQ(period, std::chrono::milliseconds{4});
}

// What a run before the stop asked for must not move the axis after the next start.
TEST_F(Slow, WhatWasAskedBeforeAStopIsNotCarriedOutAfterIt) {
    fb::MC_MoveAbsolute move;
    body.run = [&](TaskContext& ctx) {
        move.Axis = {0};
        move.Execute = true;
        move(ctx);
        ctx.requests->power({0}, true, true, true, ctx.owner);
        ctx.outputs[0] = 1;
    };
    release();
    task.run_if_released();
    task.restart();
    task.renew(axes);
    body.run = {};
    release();
    task.renew(axes);
    EXPECT_TRUE(axes.calls.empty());
    EXPECT_EQ(outputs[0], 0);
}

TEST_F(Slow, VariablesShowTheLastAppliedRun) {
    body.run = [&](TaskContext&) { body.shown = 42; };
    release();
    task.run_if_released();
    EXPECT_EQ(task.variables()[0], 0.0) << "until the release nobody knows that it has finished";
    release();
    EXPECT_EQ(task.variables()[0], 42.0);
}

TEST_F(Slow, WhatItThrowsIsKeptInItsOwnWords) {
    body.run = [](TaskContext&) { throw std::runtime_error("no more bottles"); };
    release();
    task.run_if_released();
    EXPECT_TRUE(task.threw());
    EXPECT_EQ(task.fault().text(), "no more bottles");
    task.forget();
    EXPECT_FALSE(task.threw());
}

TEST_F(Slow, ThePowerWishIsGivenInEveryCycleOnceTheReleaseHasAppliedIt) {
    axes::ErrorId answered{};
    body.run = [&](TaskContext& ctx) { answered = ctx.requests->power({0}, true, true, false, ctx.owner); };
    release();
    task.run_if_released();
    task.renew(axes);
    EXPECT_TRUE(axes.calls_of("power").empty());

    axes.refuse_with = axes::ErrorId::power_conflict;
    release();
    for (int i = 0; i < 4; ++i) task.renew(axes);
    const auto calls = axes.calls_of("power");
    ASSERT_EQ(calls.size(), 4u);
    EXPECT_TRUE(calls[0].enable);
    EXPECT_FALSE(calls[0].negative);
    task.run_if_released();
    release();
    task.run_if_released();
    EXPECT_EQ(answered, axes::ErrorId::power_conflict) << "the answer of the release before";
}

// --- answers that come a release later -----------------------------------------------------------------------------------------

struct Answers : Slow {
    /// A release and the run after it.
    void scan(std::function<void(TaskContext&)> what) {
        release();
        body.run = std::move(what);
        task.run_if_released();
    }
};

// A block shows what became of its command, however many others were refused in the same scan.
TEST_F(Answers, AGoodMoveShowsDoneBehindTwentyRefusedOnes) {
    fb::MC_MoveAbsolute good;
    std::array<fb::MC_MoveAbsolute, 20> bad;
    const auto call = [&](TaskContext& ctx) {
        good.Axis = {0};
        good.Execute = true;
        good(ctx);
        for (auto& move : bad) {
            move.Axis = {0};
            move(ctx);
        }
    };
    scan(call);
    scan(call);
    ASSERT_TRUE(good.Active);
    for (auto& move : bad) move.Execute = true;
    scan(call);
    axes.refuse_with = axes::ErrorId::not_homed;
    scan(call);
    axes.finish(axes::Outcome::done);
    for (int i = 0; i < 4; ++i) {
        scan(call);
        EXPECT_FALSE(good.CommandAborted || good.Error);
    }
    EXPECT_TRUE(good.Done);
    for (const auto& move : bad) {
        EXPECT_TRUE(move.Error);
        EXPECT_EQ(move.ErrorID, axes::ErrorId::not_homed);
    }
}

// A move that lasts long is still known when a hundred others have come and gone on another axis.
TEST_F(Answers, ALongMoveIsNotForgotten) {
    fb::MC_MoveAbsolute lasting, other;
    scan([&](TaskContext& ctx) {
        lasting.Axis = {0};
        lasting.Execute = true;
        lasting(ctx);
    });
    axes.refuse_with = axes::ErrorId::none;
    for (int i = 0; i < 200; ++i) {
        scan([&](TaskContext& ctx) {
            lasting(ctx);
            axes.refuse_with = axes::ErrorId::not_homed;  // everything after the first
            other.Axis = {0};
            other.Execute = !other.Execute;
            other(ctx);
        });
    }
    EXPECT_TRUE(lasting.Active);
    axes.finish(axes::Outcome::done);
    scan([&](TaskContext& ctx) { lasting(ctx); });
    EXPECT_TRUE(lasting.Done);
}

TEST_F(Answers, ARefusedResetReachesItsBlock) {
    axes.axis().state = axes::AxisState::ErrorStop;
    axes.refuse_with = axes::ErrorId::interlocked;
    fb::MC_Reset reset;
    const auto call = [&](TaskContext& ctx) {
        reset.Axis = {0};
        reset.Execute = true;
        reset(ctx);
    };
    for (int i = 0; i < 4; ++i) scan(call);
    EXPECT_TRUE(reset.Error);
    EXPECT_EQ(reset.ErrorID, axes::ErrorId::interlocked);
}

TEST_F(Answers, SetPositionIsCheckedAgainstTheLatchedView) {
    const auto ask = [&](double position) {
        axes::ErrorId error{};
        scan([&](TaskContext& ctx) { error = ctx.requests->set({0}, axes::SetPosition{position, false}, ctx.owner).error; });
        return error;
    };
    axes.axis().owner = axes::Owner::program;
    EXPECT_EQ(ask(5), axes::ErrorId::none);
    EXPECT_EQ(ask(std::numeric_limits<double>::quiet_NaN()), axes::ErrorId::invalid_position);
    axes.axis().state = axes::AxisState::Homing;
    EXPECT_EQ(ask(5), axes::ErrorId::state_forbids);
    axes.axis().online = false;
    EXPECT_EQ(ask(5), axes::ErrorId::drive_not_ready);
    axes.axis().owner = axes::Owner::operator_panel;
    EXPECT_EQ(ask(5), axes::ErrorId::owned_by_other);
    release();
    EXPECT_EQ(axes.calls_of("set").size(), 1u);
}

TEST_F(Answers, MoreRequestsThanFitAreRefusedAtOnce) {
    axes::Submitted last;
    std::size_t taken = 0;
    scan([&](TaskContext& ctx) {
        axes::AxisCommand halt;
        halt.kind = axes::CommandKind::halt;
        for (std::size_t i = 0; i <= LatchedRequests::capacity; ++i) {
            last = ctx.requests->submit({0}, halt, ctx.owner);
            taken += last.error == axes::ErrorId::none;
        }
    });
    EXPECT_EQ(taken, LatchedRequests::capacity);
    EXPECT_EQ(last.error, axes::ErrorId::queue_full);
}

}  // namespace
}  // namespace taktwerk::runtime
