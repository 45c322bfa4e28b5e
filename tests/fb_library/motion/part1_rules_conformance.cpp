// General rules of PLCopen Part 1 v2.0 (sections 2.1 to 2.4) by blocks on a real axis: what the timing figures do not show.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "fb_library/all_blocks.hpp"
#include "fb_library/block_types.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::AxisState;

/// The table of section 2.4.2; suppliers may add after them.
static_assert(mcAborting == 0 && mcBuffered == 1 && mcBlendingLow == 2 && mcBlendingPrevious == 3 && mcBlendingNext == 4 &&
              mcBlendingHigh == 5);

// P1-011, P1-014: names of the standard, in its order, with its prefix. The names stand in the pin tables, the numbers in the enumerators.
TEST(Part1Enumerators, AreTheStandards) {
    const auto names = [](const PinType& type) { return std::vector<std::string_view>(type.values.begin(), type.values.end()); };
    using Names = std::vector<std::string_view>;
    EXPECT_EQ(names(PinTypeOf<MC_BufferMode>::value),
              (Names{"mcAborting", "mcBuffered", "mcBlendingLow", "mcBlendingPrevious", "mcBlendingNext", "mcBlendingHigh"}));
    EXPECT_EQ(names(PinTypeOf<MC_Direction>::value),
              (Names{"mcPositiveDirection", "mcShortestWay", "mcNegativeDirection", "mcCurrentDirection"}));
    EXPECT_EQ(names(PinTypeOf<MC_ExecutionMode>::value), (Names{"mcImmediately", "mcQueued", "mcDelayed"}))
        << "the last one is Part 4's: blocks of Part 1 refuse it";
    EXPECT_EQ(names(PinTypeOf<MC_Source>::value), (Names{"mcCommandedValue", "mcSetValue", "mcActualValue"}));
    EXPECT_EQ(names(PinTypeOf<MC_StartMode>::value), (Names{"mcAbsolute", "mcRelative", "mcRampIn"}));
    EXPECT_EQ(names(PinTypeOf<MC_SyncMode>::value), (Names{"mcShortest", "mcCatchUp", "mcSlowDown"}));
    EXPECT_EQ(names(PinTypeOf<MC_CombineMode>::value), (Names{"mcAddAxes", "mcSubAxes"}));
    for (const BlockType& type : motion_block_types())
        for (const Pin& pin : type.pins)
            for (const auto value : pin.type.values) EXPECT_EQ(value.substr(0, 2), "mc") << type.name << '.' << pin.name;
}

struct OneMove : testing::Test {
    OneMove() {
        move.Axis = Plc::x;
        move.Position = 100, move.Velocity = 100, move.Acceleration = move.Deceleration = 100;
        plc.program = [this](const MotionContext& ctx) { move(ctx); };
    }
    Plc plc;
    MC_MoveAbsolute move;
};

// P1-101, P1-028: Execute held over Done starts nothing; then the axis is at Standstill with velocity zero.
TEST_F(OneMove, ExecuteHeldOverDoneDoesNotStartAgain) {
    move.Execute = true;
    plc.run_until([&] { return move.Done; }, 10s);
    ASSERT_TRUE(move.Done);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
    EXPECT_EQ(plc.velocity(), 0);

    move.Position = 0;
    plc.run_for(500ms);

    EXPECT_TRUE(move.Done);
    EXPECT_FALSE(move.Busy);
    EXPECT_EQ(plc.position(), 100);
}

// P1-005, P1-056: what is not set again keeps its value from the call before; in a new instance it is 0.
TEST_F(OneMove, InputsThatAreNotSetKeepTheirValue) {
    EXPECT_EQ(MC_MoveAbsolute{}.Velocity, 0);
    EXPECT_EQ(MC_MoveAbsolute{}.BufferMode, mcAborting);
    move.Execute = true;
    plc.run_until([&] { return move.Done; }, 10s);
    move.Execute = false;
    plc.scan();

    move.Position = 0;  // the other inputs as they were
    move.Execute = true;
    double fastest = 0;
    plc.run_until(
        [&] {
            fastest = std::max(fastest, -plc.velocity());
            return move.Done;
        },
        10s);

    EXPECT_TRUE(move.Done);
    EXPECT_NEAR(fastest, 100, 0.11) << "s = v2 / a: 100 u are just enough to reach 100 u/s, up to the step of one cycle";
}

// P1-138: Acceleration while the motion gets faster, Deceleration while it gets slower, also in negative direction.
TEST_F(OneMove, AccelerationDrivesAndDecelerationBrakesInBothSenses) {
    for (const double target : {100.0, 0.0}) {
        move.Position = target;
        move.Acceleration = 200, move.Deceleration = 50;
        move.Execute = true;
        const double sense = target > 0 ? 1 : -1;
        double driving = 0, braking = 0;
        plc.run_until(
            [&] {
                const double a = sense * plc.axis.view().set_acceleration;
                driving = std::max(driving, a);
                braking = std::min(braking, a);
                return move.Done;
            },
            10s);
        EXPECT_NEAR(driving, 200, 1e-9);
        EXPECT_NEAR(braking, -50, 1e-9);
        move.Execute = false;
        plc.scan();
    }
}

// P1-139: a linear axis has one way to a target, whatever Direction says: the same trajectory to the last bit.
TEST(OnALinearAxis, DirectionIsIgnored) {
    std::vector<std::vector<double>> ways;
    for (const auto direction : {mcPositiveDirection, mcShortestWay, mcNegativeDirection, mcCurrentDirection}) {
        Plc plc;
        MC_MoveAbsolute move;
        move.Axis = Plc::x;
        move.Position = -100, move.Velocity = 100, move.Direction = direction, move.Execute = true;
        plc.program = [&](const MotionContext& ctx) { move(ctx); };
        ways.emplace_back();
        for (int i = 0; i < 1500; ++i) {
            plc.scan();
            ways.back().push_back(plc.position());
        }
        EXPECT_TRUE(move.Done) << direction;
    }
    for (const auto& way : ways) EXPECT_EQ(way, ways.front());
}

// P1-100: u, u/s, u/s2 belong together: an axis in units a thousandth as large, with all values a thousand times as large, takes the same time.
TEST(Units, ScaleTogether) {
    std::vector<Duration> times;
    std::vector<double> ends;
    for (const double k : {1.0, 1000.0}) {
        auto config = Plc::roomy_axis();
        config.gearing.feed *= k;
        config.limits = {.velocity = 1000 * k, .acceleration = 10000 * k, .deceleration = 10000 * k, .jerk = 100000 * k};
        Plc plc{config};
        MC_MoveRelative move;
        move.Axis = Plc::x;
        move.Distance = 70 * k, move.Velocity = 90 * k, move.Acceleration = 300 * k, move.Deceleration = 200 * k, move.Jerk = 2000 * k;
        move.Execute = true;
        plc.program = [&](const MotionContext& ctx) { move(ctx); };
        times.push_back(plc.run_until([&] { return move.Done; }, 10s));
        ends.push_back(plc.position() / k);
    }
    EXPECT_EQ(times[0], times[1]);
    EXPECT_NEAR(ends[0], ends[1], 1e-9);
}

// P1-073, P1-070: InVelocity looks at the set velocity: the motor is held by something and does not move at all.
TEST(InVelocity, DoesNotDependOnTheActualVelocity) {
    Plc plc;
    plc.drive.blocked = true;
    MC_MoveVelocity run;
    run.Axis = Plc::x;
    run.Velocity = 10, run.Acceleration = 100, run.Execute = true;
    plc.program = [&](const MotionContext& ctx) { run(ctx); };

    const auto took = plc.run_until([&] { return run.InVelocity; }, 1s);

    EXPECT_TRUE(run.InVelocity);
    EXPECT_LE(took, 103ms);
    EXPECT_EQ(plc.axis.view().actual_velocity, 0);
}

// P1-082: ramps are positive; a velocity may have a sign where it has a meaning.
TEST_F(OneMove, NegativeRampsAreRefusedAndTheAxisStaysWhereItIs) {
    for (double MC_MoveAbsolute::*ramp : {&MC_MoveAbsolute::Acceleration, &MC_MoveAbsolute::Deceleration, &MC_MoveAbsolute::Jerk}) {
        move.*ramp = -1;
        move.Execute = true;
        plc.scan();
        EXPECT_TRUE(move.Error);
        EXPECT_EQ(move.ErrorID, ErrorId::invalid_dynamics);
        move.*ramp = 100;
        move.Execute = false;
        plc.scan();
    }
    EXPECT_EQ(plc.position(), 0);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
    MC_MoveVelocity back;
    back.Axis = Plc::x;
    back.Velocity = -10, back.Execute = true;
    plc.program = [&](const MotionContext& ctx) { back(ctx); };
    plc.run_until([&] { return back.InVelocity; }, 1s);
    EXPECT_EQ(plc.velocity(), -10);
}

// P1-038, P1-039, P1-046: a fault of the drive shows at the block that runs and at MC_ReadAxisError; a wrong input at its block alone, with
// another number; and so does a drive that is not heard any more, as a third kind.
TEST_F(OneMove, KindsOfErrorsAreToldApart) {
    MC_ReadAxisError axis_error;
    MC_MoveAbsolute wrong;
    axis_error.Axis = wrong.Axis = Plc::x;
    axis_error.Enable = true;
    plc.program = [&](const MotionContext& ctx) {
        move(ctx);
        wrong(ctx);
        axis_error(ctx);
    };
    wrong.Execute = true;  // Velocity is 0
    plc.run_for(3ms);
    EXPECT_TRUE(wrong.Error);
    EXPECT_EQ(wrong.ErrorID, ErrorId::invalid_velocity);
    EXPECT_EQ(axis_error.AxisErrorID, 0);
    EXPECT_EQ(plc.state(), AxisState::Standstill);

    move.Execute = true;
    plc.run_for(100ms);
    plc.drive.fault_code = 0x8611;
    plc.run_for(10ms);
    EXPECT_TRUE(move.Error);
    EXPECT_TRUE(axis_error.Valid);
    const auto drive_error = axis_error.AxisErrorID;
    EXPECT_NE(drive_error, 0);
    EXPECT_EQ(wrong.ErrorID, ErrorId::invalid_velocity) << "an instance keeps its own";

    Plc other;
    MC_ReadAxisError silent_error;
    silent_error.Axis = Plc::x;
    silent_error.Enable = true;
    other.program = [&](const MotionContext& ctx) { silent_error(ctx); };
    other.drive.silent = true;
    other.run_for(50ms);
    EXPECT_NE(silent_error.AxisErrorID, 0);
    EXPECT_NE(silent_error.AxisErrorID, drive_error);
}

// P1-025: an axis error that leaves the drive its power (here: the machine's stop) brings the set velocity down along a ramp.
TEST_F(OneMove, EnteringErrorStopBringsTheAxisToRest) {
    move.Position = 1000;
    move.Execute = true;
    plc.run_until([&] { return plc.velocity() >= 100; }, 5s);
    plc.axis.stop_for_error(0x3001, false);
    plc.scan();
    EXPECT_EQ(plc.state(), AxisState::ErrorStop);
    EXPECT_GT(plc.velocity(), 0) << "no jump";
    plc.run_for(1s);
    EXPECT_EQ(plc.velocity(), 0);
    EXPECT_EQ(plc.state(), AxisState::ErrorStop);
    EXPECT_TRUE(move.Error);
}

/// Presses and releases blocks at random; every cycle the rules that join them are looked at.
struct RandomCalls : testing::TestWithParam<unsigned> {};

// P1-015, P1-076, P1-060: one state, at most one block in control, and never Valid with Error.
TEST_P(RandomCalls, OneStateAndOneBlockInControl) {
    std::mt19937 random(GetParam());
    Plc plc;
    std::array<MC_MoveAbsolute, 3> absolute;
    std::array<MC_MoveRelative, 2> relative;
    std::array<MC_MoveVelocity, 2> endless;
    MC_Halt halt;
    MC_ReadStatus status;
    MC_ReadActualPosition position;
    status.Axis = position.Axis = halt.Axis = Plc::x;
    for (auto& block : absolute) block.Axis = Plc::x, block.Velocity = 500;
    for (auto& block : relative) block.Axis = Plc::x, block.Velocity = 300;
    for (auto& block : endless) block.Axis = Plc::x, block.Velocity = 200;
    const auto any = [&](unsigned n) { return random() % n == 0; };
    int control_changes = 0, in_control_before = -1, moving = 0;
    std::vector<int> before;  // the blocks in control in the scan before
    plc.program = [&](const MotionContext& ctx) {
        int which = -1, at = 0;
        std::vector<int> in_control;
        bool pressed = false;
        const auto call = [&](auto& block) {
            if (any(60)) {
                block.Execute = !block.Execute;
                pressed = pressed || block.Execute;
                block.BufferMode = any(2) ? mcBuffered : mcAborting;
            }
            block(ctx);
        };
        const auto count = [&](const auto& block) {
            if (block.Active) in_control.push_back(at), which = at;
            ++at;
        };
        for (auto& block : absolute) block.Position = static_cast<double>(random() % 100), call(block);
        for (auto& block : relative) block.Distance = static_cast<double>(random() % 100) - 50, call(block);
        for (auto& block : endless) call(block);
        call(halt);
        if (any(100)) status.Enable = !status.Enable;
        if (any(100)) position.Enable = !position.Enable;
        plc.drive.silent = any(300);
        status(ctx);
        position(ctx);
        for (auto& block : absolute) count(block);
        for (auto& block : relative) count(block);
        for (auto& block : endless) count(block);
        count(halt);
        // From whom another block takes the axis in this very scan, that one learns of it in its next call.
        EXPECT_LE(in_control.size(), pressed ? 2u : 1u);
        const auto both = std::count_if(in_control.begin(), in_control.end(),
                                        [&](int one) { return std::find(before.begin(), before.end(), one) != before.end(); });
        EXPECT_LE(both, 1) << "two were in control, and a scan later both still are";
        before = in_control;
        moving += status.DiscreteMotion && !status.Error;
        if (in_control.size() == 1 && which != in_control_before) ++control_changes, in_control_before = which;
        const int states = status.ErrorStop + status.Disabled + status.Stopping + status.Homing + status.Standstill +
                           status.DiscreteMotion + status.ContinuousMotion + status.SynchronizedMotion;
        EXPECT_EQ(states, status.Valid ? 1 : 0);
        EXPECT_EQ(status.Valid, status.Enable);
        EXPECT_EQ(position.Valid, position.Enable);
        EXPECT_FALSE(status.Error || position.Error);
    };
    plc.run_for(5s);
    EXPECT_GT(moving, 500);
    EXPECT_GT(control_changes, 20) << "a walk in which nothing happens proves nothing";
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomCalls, testing::Range(1u, 6u));

// Figures 10 and 11 (P1-111): one instance, 10, 20 and 0 u/s; InVelocity falls with each edge and goes on after Execute fell.
TEST(VelocityFigure11, OneInstanceThreeVelocities) {
    Plc plc;
    MC_MoveVelocity run;
    run.Axis = Plc::x;
    run.Acceleration = run.Deceleration = 100;
    plc.program = [&](const MotionContext& ctx) { run(ctx); };
    struct Part {
        double velocity;
        Duration ramp;
        bool execute_falls_in_the_ramp;
    };
    for (const Part& part : {Part{10, 100ms, false}, Part{20, 100ms, true}, Part{0, 200ms, true}}) {
        run.Velocity = part.velocity;
        run.Execute = true;
        plc.scan();
        EXPECT_FALSE(run.InVelocity) << "from the edge on, " << part.velocity;
        EXPECT_FALSE(run.CommandAborted) << "by its own next edge";
        plc.run_for(50ms);
        EXPECT_FALSE(run.InVelocity);
        if (part.execute_falls_in_the_ramp) run.Execute = false;
        const auto rest = plc.run_until([&] { return run.InVelocity; }, 1s);
        EXPECT_GE(rest + 51ms, part.ramp);
        EXPECT_LE(rest + 51ms, part.ramp + 3ms);
        EXPECT_EQ(plc.velocity(), part.velocity);
        run.Execute = false;
        plc.run_for(20ms);
        EXPECT_TRUE(run.InVelocity) << "also after Execute fell";
        EXPECT_TRUE(run.Busy && run.Active);
    }
    EXPECT_EQ(plc.state(), AxisState::ContinuousMotion);
}

// Figure 24 (P1-167): First V 3000, Second V 2000; Second on (First.InVelocity AND Next) OR Test.
TEST(VelocityFigure24, SecondAfterAndInsteadOfFirst) {
    Plc plc;
    MC_MoveVelocity first, second;
    first.Axis = second.Axis = Plc::x;
    first.Velocity = 3000, second.Velocity = 2000;
    first.Acceleration = first.Deceleration = second.Acceleration = second.Deceleration = 3000;
    bool go = false, next = false, test = false;
    plc.program = [&](const MotionContext& ctx) {
        first.Execute = go;
        first(ctx);
        second.Execute = (first.InVelocity && next) || test;
        second(ctx);
    };
    go = true;
    plc.run_until([&] { return first.InVelocity; }, 5s);
    EXPECT_EQ(plc.velocity(), 3000);
    next = true;
    plc.run_for(3ms);
    EXPECT_FALSE(first.InVelocity);
    EXPECT_TRUE(first.CommandAborted) << "while GO";
    EXPECT_FALSE(second.Execute);
    plc.run_until([&] { return second.InVelocity; }, 5s);
    EXPECT_EQ(plc.velocity(), 2000);
    next = false;
    plc.run_for(10ms);
    EXPECT_TRUE(second.InVelocity);
    go = false;
    plc.run_for(10ms);
    EXPECT_FALSE(first.CommandAborted);
    EXPECT_TRUE(second.InVelocity);

    go = true;
    plc.run_for(100ms);
    EXPECT_GT(plc.velocity(), 2000);
    EXPECT_FALSE(second.InVelocity);
    test = true;
    plc.run_for(3ms);
    EXPECT_TRUE(first.CommandAborted);
    EXPECT_FALSE(first.InVelocity);
    plc.run_until([&] { return second.InVelocity; }, 5s);
    EXPECT_EQ(plc.velocity(), 2000);
    go = test = false;
    plc.run_for(3ms);
    EXPECT_TRUE(second.InVelocity);
}

// P1-133: DiscreteMotion in every cycle of the ramp; Done and Standstill together.
TEST(Halt, IsADiscreteMotionUntilDone) {
    Plc plc;
    MC_MoveVelocity run;
    MC_Halt halt;
    run.Axis = halt.Axis = Plc::x;
    run.Velocity = 100, run.Acceleration = 1000, halt.Deceleration = 200;
    plc.program = [&](const MotionContext& ctx) {
        run(ctx);
        halt(ctx);
    };
    run.Execute = true;
    plc.run_until([&] { return run.InVelocity; }, 1s);
    halt.Execute = true;
    for (int i = 0; i < 499; ++i) {  // 0.5 s of ramp, at rest with the last cycle
        plc.scan();
        EXPECT_EQ(plc.state(), AxisState::DiscreteMotion) << i;
        ASSERT_FALSE(halt.Done);
    }
    plc.run_until([&] { return halt.Done; }, 10ms);
    EXPECT_TRUE(halt.Done);
    EXPECT_EQ(plc.velocity(), 0);
    EXPECT_EQ(plc.state(), AxisState::Standstill);
}

// Appendix A, example 1 (P1-307): FB2 starts after Done of FB1; 11 s and 20.5 s, standing in between.
TEST(BufferExample1, OneAfterTheOther) {
    Plc plc;
    MC_MoveAbsolute fb1, fb2;
    fb1.Axis = fb2.Axis = Plc::x;
    fb1.Position = 1000, fb1.Velocity = 100, fb2.Position = 2000, fb2.Velocity = 50;
    fb1.Acceleration = fb1.Deceleration = fb2.Acceleration = fb2.Deceleration = 100;
    plc.program = [&](const MotionContext& ctx) {
        fb1(ctx);
        fb2(ctx);
    };
    fb1.Execute = true;
    const auto first = plc.run_until([&] { return fb1.Done; }, 20s);
    EXPECT_GE(first, 11s);
    EXPECT_LE(first, 11s + 3ms);
    EXPECT_EQ(plc.velocity(), 0);
    EXPECT_FALSE(fb1.CommandAborted);
    plc.run_for(100ms);
    fb2.Execute = true;
    const auto second = plc.run_until([&] { return fb2.Done; }, 30s);
    EXPECT_GE(second, 20500ms);
    EXPECT_LE(second, 20503ms);
    EXPECT_EQ(plc.position(), 2000);
}

}  // namespace
}  // namespace taktwerk::fb
