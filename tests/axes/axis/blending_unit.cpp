// The six buffer modes. PLCopen Part 1 v2.0, section 2.4.2 and appendix A; times of the examples are trapezoids worked out by hand.

#include <array>

#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

AxisCommand with_ramps(AxisCommand command, double ramp) {
    command.acceleration = command.deceleration = ramp;
    return command;
}

/// What was seen of one command's end.
/// Room for a chain of moves.
AxisConfig chained() {
    auto config = trapezoids();
    config.queue_depth = 8;
    return config;
}

struct Joint {
    double time = 0;      ///< s since the start, end of the cycle in which it was done
    double position = 0;  ///< at the end of that cycle
    double velocity = 0;
    double before = 0;  ///< velocity one cycle earlier
};

struct JointRig : Rig {
    using Rig::Rig;
    std::vector<CommandId> ids;
    std::vector<Joint> joints;
    double farthest = -infinity, slowest = infinity;  ///< slowest |velocity| before the last command's own end

    /// Runs until all are done; the commands of `commands` are given in the same cycle.
    void play(const std::vector<AxisCommand>& commands) {
        const auto begin = now;
        for (const auto& command : commands) ids.push_back(accept(command));
        joints.resize(ids.size());
        std::size_t next = 0;
        double before = view().set_velocity;
        ASSERT_TRUE(run_until(
            [&] {
                while (next < ids.size() && status(ids[next]) == CommandStatus::done) {
                    joints[next] = {to_seconds(now - begin), view().set_position, view().set_velocity, before};
                    // Active passes over in the cycle of Done.
                    if (++next < ids.size()) {
                        EXPECT_TRUE(status(ids[next]) == CommandStatus::active || status(ids[next]) == CommandStatus::in_target);
                    }
                }
                before = view().set_velocity;
                farthest = std::max(farthest, view().set_position);
                return next == ids.size();
            },
            100'000));
    }
};

// P1-310, P1-088, P1-314: appendix A, example 4. 10.625 + 20 + 10.625 s; 50 at both joints and between them.
TEST(Blending, LowTakesTheLowerOfBothVelocities) {
    JointRig rig(chained());
    rig.power_on();
    rig.play({with_ramps(absolute(1000, 100), 100), with_ramps(absolute(2000, 50, mcBlendingLow), 50),
              with_ramps(absolute(3000, 100, mcBlendingLow), 100)});

    EXPECT_NEAR(rig.joints[0].time, 10.625, 0.0011);
    EXPECT_NEAR(rig.joints[0].velocity, 50, 1e-9);
    EXPECT_NEAR(rig.joints[0].position, 1000, 0.05);
    EXPECT_NEAR(rig.joints[1].time, 30.625, 0.0011);
    EXPECT_NEAR(rig.joints[1].before, 50, 1e-9);
    EXPECT_NEAR(rig.joints[2].time, 41.25, 0.0011);
    EXPECT_EQ(rig.view().set_position, 3000);
    EXPECT_EQ(rig.farthest, 3000);
}

// P1-311, P1-089, P1-314: example 5. 100 at 1000, 50 at 2000; 10.5 + 19.875 + 10.625 s.
TEST(Blending, PreviousKeepsTheVelocityOfTheFirst) {
    JointRig rig(chained());
    rig.power_on();
    rig.play({with_ramps(absolute(1000, 100), 100), with_ramps(absolute(2000, 50, mcBlendingPrevious), 200),
              with_ramps(absolute(3000, 100, mcBlendingPrevious), 100)});

    EXPECT_NEAR(rig.joints[0].time, 10.5, 0.0011);
    EXPECT_NEAR(rig.joints[0].before, 100, 1e-9);
    EXPECT_NEAR(rig.joints[1].time, 30.375, 0.0011);
    EXPECT_NEAR(rig.joints[1].before, 50, 1e-9);
    EXPECT_NEAR(rig.joints[2].time, 41.0, 0.0011);
    EXPECT_EQ(rig.farthest, 3000);
}

// P1-312, P1-090, P1-314: example 6. Brakes to 50 inside the first, speeds up to 100 inside the second; 10.625 + 19.5 + 10.5 s.
TEST(Blending, NextHasTheVelocityOfTheSecondAtTheJoint) {
    JointRig rig(chained());
    rig.power_on();
    rig.play({with_ramps(absolute(1000, 100), 100), with_ramps(absolute(2000, 50, mcBlendingNext), 50),
              with_ramps(absolute(3000, 100, mcBlendingNext), 100)});

    EXPECT_NEAR(rig.joints[0].time, 10.625, 0.0011);
    EXPECT_NEAR(rig.joints[0].velocity, 50, 1e-9);
    EXPECT_NEAR(rig.joints[1].time, 30.125, 0.0011);
    EXPECT_NEAR(rig.joints[1].velocity, 100, 1e-9);
    EXPECT_NEAR(rig.joints[2].time, 40.625, 0.0011);
    EXPECT_EQ(rig.farthest, 3000);
}

// P1-313, P1-091, P1-314: example 7. 100 at both joints, 50 between them: the second exceeds its own velocity before 2000; 10.5 + 19.75 + 10.5 s.
TEST(Blending, HighTakesTheHigherOfBothVelocities) {
    JointRig rig(chained());
    rig.power_on();
    rig.play({with_ramps(absolute(1000, 100), 100), with_ramps(absolute(2000, 50, mcBlendingHigh), 200),
              with_ramps(absolute(3000, 100, mcBlendingHigh), 100)});

    EXPECT_NEAR(rig.joints[0].time, 10.5, 0.0011);
    EXPECT_NEAR(rig.joints[0].before, 100, 1e-9);
    EXPECT_NEAR(rig.joints[1].time, 30.25, 0.0011);
    EXPECT_NEAR(rig.joints[1].velocity, 100, 1e-9);
    EXPECT_NEAR(rig.joints[2].time, 40.75, 0.0011);
    EXPECT_EQ(rig.farthest, 3000);
}

// P1-308: example 2, aborting: 100 to 50 in 0.25 s, the first is aborted, the end is 2000.
TEST(Blending, AbortingTakesOverAtOnce) {
    Rig rig(chained());
    rig.power_on();
    const auto first = rig.accept(with_ramps(absolute(1000, 100), 100));
    rig.run(5000);
    const auto second = rig.accept(with_ramps(absolute(2000, 50), 200));
    EXPECT_EQ(rig.status(first), CommandStatus::aborted);
    EXPECT_EQ(rig.status(second), CommandStatus::active);
    rig.run(249);
    EXPECT_GT(rig.view().set_velocity, 50.0);
    rig.run(2);
    EXPECT_NEAR(rig.view().set_velocity, 50, 1e-9);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill, 50'000));
    EXPECT_EQ(rig.view().set_position, 2000);
}

// The joint lies inside a cycle: what is left of it belongs to the second move. At 100 u/s P1 = 10.0437 is passed at v = 100 in both modes,
// so the whole blended way is one trapezoid: 20 u at 100 u/s and 1000 u/s2 take 0.2 + 0.1 s, and each set-point is the trapezoid's.
TEST(Blending, ThePointIsPassedInsideACycleWithoutATrace) {
    JointRig rig(chained());
    rig.power_on();
    const auto start = rig.now;
    rig.program = [&] {
        const double t = to_seconds(rig.now - Rig::cycle - start);  // the view still shows the cycle before
        const double expected = t <= 0.1   ? 500 * t * t
                                : t <= 0.2 ? 5 + 100 * (t - 0.1)
                                           : 20 - 500 * std::max(0.3 - t, 0.0) * std::max(0.3 - t, 0.0);
        if (t >= 0 && t <= 0.3) {
            EXPECT_NEAR(rig.view().set_position, expected, 1e-9) << t;
        }
    };
    rig.play({absolute(10.0437, 100), absolute(20, 100, mcBlendingPrevious)});
    EXPECT_NEAR(rig.joints[0].time, 0.1505, 0.0006);  // 0.1 s + 5.0437 u at 100 u/s = 0.150437 s: the 151st cycle
}

// Rule 3: in the other direction the joint is passed with 0, and it is visited exactly.
TEST(Blending, ReversalStopsAtTheJoint) {
    JointRig rig(chained());
    rig.power_on();
    rig.play({absolute(100, 50), absolute(20, 80, mcBlendingHigh)});
    EXPECT_NEAR(rig.joints[0].before, 0, 1.01);  // one cycle before the stop: 1000 u/s2 * 1 ms
    EXPECT_NEAR(rig.farthest, 100, 0.001);
    EXPECT_LE(rig.farthest, 100);
    EXPECT_EQ(rig.view().set_position, 20);
}

// Rule 4: 2 u behind the joint with 1000 u/s2 can be stopped from sqrt(2 * 1000 * 2) = 63.2456 u/s. With 50 u more behind it (blended too) from more.
TEST(Blending, ShortSecondMoveLimitsTheVelocityAtTheJoint) {
    for (const bool longer : {false, true}) {
        JointRig rig(chained());
        rig.power_on();
        std::vector<AxisCommand> moves{absolute(50, 200), absolute(52, 200, mcBlendingHigh)};
        if (longer) moves.push_back(absolute(102, 200, mcBlendingHigh));
        rig.play(moves);
        EXPECT_EQ(rig.farthest, longer ? 102 : 52);
        if (longer) {
            EXPECT_NEAR(rig.joints[0].before, 200, 1e-9);
        } else {
            EXPECT_NEAR(rig.joints[0].before, 63.2456, 1.01);  // at most one cycle of 1000 u/s2 away from the joint
            EXPECT_NEAR(rig.joints[0].velocity, 63.2456, 1.01);
        }
    }
}

// Rule 2, faster than it can be: from rest 5 u with 1000 u/s2 reach sqrt(2 * 1000 * 5) = 100 u/s, not 400.
TEST(Blending, VelocityOutOfReachBecomesTheNearestOne) {
    JointRig rig(chained());
    rig.power_on();
    rig.play({absolute(5, 300), absolute(500, 400, mcBlendingNext)});
    EXPECT_NEAR(rig.joints[0].before, 100, 1.01);
    EXPECT_EQ(rig.farthest, 500);
}

// Rule 6: given inside the braking ramp of the first, from there on the best is made of it.
TEST(Blending, LateCommandIsNoErrorAndStopsNothing) {
    Rig rig(chained());
    rig.power_on();
    const auto first = rig.accept(with_ramps(absolute(100, 100), 100));  // brakes over the last 50 u, from 1.0 s on
    rig.run(1500);
    const double late = rig.view().set_velocity;
    ASSERT_LT(late, 75);
    ASSERT_GT(late, 20);
    const auto second = rig.accept(with_ramps(absolute(300, 80, mcBlendingNext), 100));
    double at_joint = 0, slowest = infinity, farthest = 0;
    ASSERT_TRUE(rig.run_until([&] {
        if (rig.status(first) == CommandStatus::active) at_joint = rig.view().set_velocity;
        if (rig.status(second) != CommandStatus::done) slowest = std::min(slowest, rig.view().set_velocity);
        farthest = std::max(farthest, rig.view().set_position);
        return rig.view().set_position > 150;
    }));
    // v^2 = late^2 + 2 * 100 * rest, at most 80: with late near 50 and 12.5 u left about 70.
    const double rest = late * late / 200;
    EXPECT_NEAR(at_joint, std::min(80.0, std::sqrt(late * late + 200 * rest)), 0.11);
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.view().set_position, 300);
}

// P1-097: behind MC_MoveVelocity every blending mode acts like BlendingPrevious: the second starts at the first's velocity.
TEST(Blending, BehindVelocityEveryModeIsPrevious) {
    std::array<Instant, 4> ends{};
    for (int mode = mcBlendingLow; mode <= mcBlendingHigh; ++mode) {
        Rig rig(chained());
        rig.power_on();
        const auto first = rig.accept(at_velocity(60));
        const auto second = rig.accept(absolute(200, 120, static_cast<MC_BufferMode>(mode)));
        double at_start = 0;
        ASSERT_TRUE(rig.run_until([&] {
            if (rig.status(first) == CommandStatus::in_target) at_start = rig.view().set_velocity;
            return rig.status(second) == CommandStatus::done;
        }));
        EXPECT_EQ(at_start, 60);
        EXPECT_EQ(rig.status(first), CommandStatus::aborted);
        EXPECT_EQ(rig.view().set_position, 200);
        ends[static_cast<std::size_t>(mode - mcBlendingLow)] = rig.now;
    }
    for (const auto end : ends) EXPECT_EQ(end, ends[0]);
}

// Into an endless motion: MC_MoveVelocity behind a move takes over at the joint with the velocity of the rule.
TEST(Blending, VelocityCommandTakesOverAtTheJoint) {
    JointRig rig(chained());
    rig.power_on();
    const auto move = rig.accept(absolute(50, 100));
    const auto endless = rig.accept(at_velocity(40, mcBlendingNext));
    ASSERT_TRUE(rig.run_until([&] { return rig.status(move) == CommandStatus::done; }));
    EXPECT_NEAR(rig.view().set_velocity, 40, 1e-9);
    EXPECT_EQ(rig.status(endless), CommandStatus::in_target);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
}

// P1-304: fast forward, feed, in one go: with blending the velocity is zero only at the end.
TEST(Blending, FastForwardIntoFeedDoesNotStop) {
    for (const auto mode : {mcBuffered, mcBlendingLow}) {
        Rig rig(chained());
        rig.power_on();
        rig.accept(absolute(30, 100));
        rig.accept(relative(10, 25, mode));
        int stops = 0;
        bool moved = false;
        ASSERT_TRUE(rig.run_until([&] {
            const bool slow = rig.view().set_velocity < 1;  // one cycle of 1000 u/s2
            if (moved && slow) ++stops;
            moved = !slow;
            return rig.view().state == AxisState::Standstill && rig.view().set_position > 0;
        }));
        EXPECT_EQ(stops, mode == mcBuffered ? 2 : 1);
        EXPECT_EQ(rig.view().set_position, 40);
    }
}

// P1-040: an axis error is the error of the active command and of all that wait, whatever their mode.
TEST(Blending, AxisErrorEndsActiveAndWaitingWithErrors) {
    Rig rig(chained());
    rig.power_on();
    std::array<CommandId, 3> ids{rig.accept(absolute(100, 50)), rig.accept(absolute(200, 50, mcBlendingHigh)),
                                 rig.accept(absolute(300, 50, mcBuffered))};
    rig.run(500);
    rig.drive.fault_code = 0x7500;
    rig.run(5);
    for (const auto id : ids) EXPECT_EQ(rig.status(id), CommandStatus::error);
    EXPECT_EQ(rig.error_of(ids[1]), ErrorId::aborted_by_axis_error);
    EXPECT_EQ(rig.view().queued_count, 0);
}

// A follower that cannot run is no reason to pass the joint: the first stops at its end, the second ends with its own error.
TEST(Blending, ImpossibleFollowerIsNotBlendedInto) {
    auto config = chained();
    config.limits.position_min = -10;
    config.limits.position_max = 100;
    config.homing.kind = HomingKind::set_here;
    Rig rig(config);
    rig.power_on();
    rig.accept(home(0));
    rig.run(3);
    const auto first = rig.accept(absolute(50, 50));
    const auto second = rig.accept(relative(60, 50, mcBlendingHigh));  // 110 is beyond
    ASSERT_TRUE(rig.run_to(AxisState::Standstill));
    EXPECT_EQ(rig.status(first), CommandStatus::done);
    EXPECT_EQ(rig.error_of(second), ErrorId::beyond_software_limit);
    EXPECT_EQ(rig.view().set_position, 50);
}

}  // namespace
}  // namespace taktwerk::axes::test
