// Motions given over time by a table: MC_PositionProfile, MC_VelocityProfile, MC_AccelerationProfile. PLCopen Part 1 v2.0, 3.14 to 3.16.

#include <optional>

#include "axes/axis/time_curve.hpp"
#include "tests/axes/axis/axis_rig.hpp"

namespace taktwerk::axes::test {
namespace {

struct TableRig {
    explicit TableRig(std::vector<TimePoint> rows, const AxisConfig& config = plain_axis()) : rig(config) {
        table = tables.add_time_table(rows, 16);
        rig.axis.bind({&rig.axis, 1, &tables, {}});
        rig.power_on();
    }
    [[nodiscard]] AxisCommand profile(CommandKind kind, const CurveScale& scale = {}, MC_BufferMode mode = mcAborting) const {
        return {.kind = kind, .buffer_mode = mode, .details = TimeProfileDetails{table, scale.time, scale.value, scale.offset}};
    }
    [[nodiscard]] AxisCommand positions(MC_BufferMode mode = mcAborting) const { return profile(CommandKind::position_profile, {}, mode); }

    MotionTables tables;
    TimeTableRef table;
    Rig rig;
};

// P1-188, P1-189, P1-191: each point at the sum of the times up to it, no step of the velocity, once, Done at the last point.
TEST(PositionProfile, IsAtEachPointAtItsTimeAndDoneAtTheLast) {
    TableRig p({{200ms, 1.0}, {100ms, 2.5}, {400ms, 1.5}, {300ms, 3.0}});
    auto& rig = p.rig;
    const auto id = rig.accept(p.positions());
    EXPECT_EQ(rig.view().state, AxisState::DiscreteMotion);

    double before = 0;
    for (int cycle = 1; cycle <= 1000; ++cycle) {
        rig.step();
        const auto& v = rig.view();
        if (cycle == 200) {
            EXPECT_NEAR(v.set_position, 1.0, 1e-12);
        }
        if (cycle == 300) {
            EXPECT_NEAR(v.set_position, 2.5, 1e-12);
        }
        if (cycle == 700) {
            EXPECT_NEAR(v.set_position, 1.5, 1e-12);
        }
        // P1-189: smooth in velocity: what changes in a cycle is the acceleration's, which the limit of 1000 u/s2 bounds.
        EXPECT_LE(std::abs(v.set_velocity - before), 1.0 + 1e-9) << cycle;
        before = v.set_velocity;
        if (cycle < 1000) {
            EXPECT_EQ(rig.status(id), CommandStatus::active) << cycle;
        }
    }
    EXPECT_EQ(rig.status(id), CommandStatus::done);
    EXPECT_EQ(rig.view().set_position, 3.0);
    EXPECT_EQ(rig.view().state, AxisState::Standstill);
    rig.run(300);
    EXPECT_EQ(rig.view().set_position, 3.0) << "not repeated by itself";
    rig.expect_no_jump();
}

// P1-190
TEST(PositionProfile, TimeScalePositionScaleAndOffset) {
    TableRig p({{100ms, -4.0}, {100ms, -3.0}});
    p.rig.accept(p.profile(CommandKind::position_profile, {.time = 2, .value = 2, .offset = 10}));
    p.rig.run(200);
    EXPECT_NEAR(p.rig.view().set_position, 2, 1e-12);
    p.rig.run(200);
    EXPECT_EQ(p.rig.view().set_position, 4);
    EXPECT_EQ(p.rig.view().state, AxisState::Standstill);
}

// From a moving axis: the curve takes up its velocity; the set-point keeps every limit.
TEST(PositionProfile, BeginsFromAMovingAxisWithoutAStep) {
    TableRig p({{300ms, 20.0}, {300ms, 22.0}});
    p.rig.accept(at_velocity(40));
    p.rig.run(150);
    ASSERT_EQ(p.rig.view().set_velocity, 40);
    const double here = p.rig.view().set_position;
    const auto id = p.rig.accept(p.profile(CommandKind::position_profile, {.offset = here - 10}));
    p.rig.largest_acceleration = 0;
    p.rig.step();
    EXPECT_NEAR(p.rig.view().set_velocity, 40, 1.0);
    EXPECT_NEAR(p.rig.view().set_position, here + 0.04, 0.001);
    p.rig.run(599);
    EXPECT_EQ(p.rig.status(id), CommandStatus::done);
    EXPECT_NEAR(p.rig.view().set_position, here + 12, 1e-9);
    EXPECT_LE(p.rig.largest_acceleration, 1000);
    p.rig.expect_no_jump();
}

// P1-087: behind a move that ends between two cycles the profile's time runs from there on, not from the next cycle.
TEST(PositionProfile, BufferedBeginsWhereTheMoveBeforeItEnded) {
    auto config = plain_axis();
    config.limits.jerk = std::numeric_limits<double>::infinity();
    TableRig p({{100ms, 21.0}, {100ms, 22.0}}, config);
    // 20 u at 90 u/s, 1000 u/s2: 20/90 + 90/1000 = 312.22 ms
    const auto begin = p.rig.now;
    p.rig.accept(absolute(20, 90));
    const auto id = p.rig.accept(p.positions(mcBuffered));
    EXPECT_EQ(p.rig.status(id), CommandStatus::queued);
    ASSERT_TRUE(p.rig.run_to(AxisState::Standstill));
    EXPECT_EQ(p.rig.status(id), CommandStatus::done);
    EXPECT_EQ(p.rig.now - begin, 513ms);  // 312.22 + 200, seen in the next cycle
    EXPECT_EQ(p.rig.view().set_position, 22);
}

// What cannot be is refused before it begins, and the motion that runs goes on.
TEST(PositionProfile, BeyondALimitIsRefusedAndTheAxisUntouched) {
    TableRig p({{100ms, 50.0}, {100ms, 51.0}});  // 500 u/s on average
    const auto running = p.rig.accept(absolute(5, 10));
    p.rig.run(50);
    EXPECT_EQ(p.rig.refuse(p.positions()), ErrorId::invalid_velocity);
    EXPECT_EQ(p.rig.refuse(p.profile(CommandKind::position_profile, {.time = 0})), ErrorId::invalid_parameter);
    auto other = p.positions();
    std::get<TimeProfileDetails>(other.details).table = {7};
    EXPECT_EQ(p.rig.refuse(other), ErrorId::invalid_table);
    EXPECT_EQ(p.rig.status(running), CommandStatus::active);
    ASSERT_TRUE(p.rig.run_to(AxisState::Standstill));
    EXPECT_EQ(p.rig.view().set_position, 5);
}

TEST(PositionProfile, ARefusedOneDoesNotDisturbTheRunningOne) {
    TableRig p({{200ms, 2.0}, {200ms, 4.0}});
    const auto id = p.rig.accept(p.positions());
    p.rig.run(100);
    EXPECT_EQ(p.rig.refuse(p.profile(CommandKind::position_profile, {.value = 100})), ErrorId::invalid_velocity);
    p.rig.run(100);
    EXPECT_NEAR(p.rig.view().set_position, 2, 1e-12);
    p.rig.run(200);
    EXPECT_EQ(p.rig.status(id), CommandStatus::done);
}

// P1-191: the table may be exchanged; what runs is what it was when it began.
TEST(PositionProfile, EditingTheTableConcernsTheNextOneOnly) {
    TableRig p({{200ms, 2.0}, {200ms, 4.0}});
    p.rig.accept(p.positions());
    p.rig.run(10);
    p.tables.time_table(p.table)->points[1].value = 3;
    p.rig.run(390);
    EXPECT_EQ(p.rig.view().set_position, 4);
    p.rig.accept(p.positions());
    p.rig.run(400);
    EXPECT_EQ(p.rig.view().set_position, 3);
}

// Out to 1.9 u, still there a little later, and back: in between the curve is beyond its points. How far is measured first.
TEST(PositionProfile, SoftwareLimitsHoldBetweenThePoints) {
    const std::vector<TimePoint> rows{{200ms, 1.9}, {60ms, 1.9}, {200ms, 0.0}};
    TableRig free(rows);
    free.rig.accept(free.positions());
    double furthest = 0;
    ASSERT_TRUE(free.rig.run_until([&] {
        furthest = std::max(furthest, free.rig.view().set_position);
        return free.rig.view().state == AxisState::Standstill;
    }));
    ASSERT_GT(furthest, 1.95);

    for (const double room : {-0.001, 0.001}) {
        auto config = plain_axis();
        config.homing.kind = HomingKind::set_here;
        config.limits.position_min = -5;
        config.limits.position_max = furthest + room;
        TableRig p(rows, config);
        p.rig.accept(home(0));
        p.rig.run(5);
        EXPECT_EQ(p.rig.axis.submit(p.positions(), Owner::program).error, room > 0 ? ErrorId::none : ErrorId::beyond_software_limit);
    }
}

// P1-193, P1-194: the last velocity is kept, the state stays; ProfileCompleted is the status in_target.
TEST(VelocityProfile, KeepsTheLastVelocity) {
    TableRig p({{100ms, 10.0}, {200ms, -5.0}, {100ms, -2.5}});
    auto& rig = p.rig;
    const auto id = rig.accept(p.profile(CommandKind::velocity_profile, {.time = 2, .value = 2, .offset = 1}));
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    rig.run(100);
    EXPECT_NEAR(rig.view().set_velocity, 10.5, 1e-9);  // half way to 2 * 10 + 1
    rig.run(100);
    EXPECT_NEAR(rig.view().set_velocity, 21, 1e-9);
    rig.run(400);
    EXPECT_NEAR(rig.view().set_velocity, -9, 1e-9);
    rig.run(199);
    EXPECT_EQ(rig.status(id), CommandStatus::active);
    rig.step();
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
    // 0..21..-9..-4 in 0.2, 0.4, 0.2 s: 2.1 + 2.4 - 1.3 u
    EXPECT_NEAR(rig.view().set_position, 3.2, 1e-9);
    rig.run(1000);
    EXPECT_EQ(rig.view().set_velocity, -4);
    EXPECT_NEAR(rig.view().set_position, 3.2 - 4, 1e-9);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
    rig.expect_no_jump();
}

// P1-092: ProfileCompleted starts what waits.
TEST(VelocityProfile, ABufferedCommandBeginsWhenItIsCompleted) {
    TableRig p({{100ms, 10.0}});
    const auto id = p.rig.accept(p.profile(CommandKind::velocity_profile));
    const auto next = p.rig.accept(absolute(2, 10, mcBuffered));
    p.rig.run(100);
    EXPECT_EQ(p.rig.status(id), CommandStatus::in_target);
    EXPECT_EQ(p.rig.status(next), CommandStatus::queued);
    p.rig.step();
    EXPECT_EQ(p.rig.status(next), CommandStatus::active);
    ASSERT_TRUE(p.rig.run_to(AxisState::Standstill));
    EXPECT_EQ(p.rig.view().set_position, 2);
}

TEST(VelocityProfile, AVelocityThatStaysMustLeaveRoomToStop) {
    auto config = plain_axis();
    config.homing.kind = HomingKind::set_here;
    config.limits.jerk = std::numeric_limits<double>::infinity();
    config.limits.position_min = -5;
    config.limits.position_max = 6.25;
    TableRig p({{100ms, 50.0}, {75ms, 50.0}}, config);  // 2.5 + 3.75 = 6.25 u, and 50^2 / 2000 = 1.25 u to stop
    p.rig.accept(home(0));
    p.rig.run(5);
    EXPECT_EQ(p.rig.refuse(p.profile(CommandKind::velocity_profile)), ErrorId::beyond_software_limit);
    p.rig.accept(home(-1.25));
    p.rig.run(5);
    p.rig.accept(p.profile(CommandKind::velocity_profile));
    ASSERT_TRUE(p.rig.run_to(AxisState::ErrorStop));  // and then the limit stops it, as it does with MC_MoveVelocity
    ASSERT_TRUE(p.rig.run_until([&] { return p.rig.view().set_velocity == 0; }));
    EXPECT_NEAR(p.rig.view().set_position, 6.25, 1e-9);
}

// P1-195, P1-196, P1-197: ten segments of constant acceleration whose sum is zero. Velocity and position are the analytic integrals.
TEST(AccelerationProfile, TenSegmentsGiveTheirDoubleIntegral) {
    const std::vector<double> accelerations{100, 200, 100, -300, -100, -200, 50, 150, -50, 50};
    std::vector<TimePoint> rows;
    for (const double a : accelerations) rows.push_back({60ms, a});
    TableRig p(rows);
    auto& rig = p.rig;
    const auto id = rig.accept(p.profile(CommandKind::acceleration_profile));
    double v = 0, x = 0;
    for (std::size_t i = 0; i < accelerations.size(); ++i) {
        rig.run(60);
        x += v * 0.06 + accelerations[i] * 0.06 * 0.06 / 2;
        v += accelerations[i] * 0.06;
        EXPECT_NEAR(rig.view().set_position, x, 1e-9) << i;
        EXPECT_NEAR(rig.view().set_velocity, v, 1e-9) << i;
    }
    EXPECT_NEAR(v, 0, 1e-9);
    EXPECT_EQ(rig.status(id), CommandStatus::in_target);
    EXPECT_EQ(rig.view().state, AxisState::ContinuousMotion);
    EXPECT_EQ(rig.view().set_velocity, 0);
}

// P1-195: the velocity reached is kept, for 1000 cycles.
TEST(AccelerationProfile, TheVelocityReachedIsKept) {
    TableRig p({{100ms, 50.0}, {50ms, -20.0}});
    p.rig.accept(p.profile(CommandKind::acceleration_profile, {.time = 2, .value = 2, .offset = 10}));
    // 110 u/s2 in 0.2 s, -30 u/s2 in 0.1 s
    p.rig.run(300);
    EXPECT_NEAR(p.rig.view().set_velocity, 19, 1e-9);
    const double here = p.rig.view().set_position;
    p.rig.run(1000);
    EXPECT_NEAR(p.rig.view().set_velocity, 19, 1e-9);
    EXPECT_EQ(p.rig.view().set_acceleration, 0);
    EXPECT_NEAR(p.rig.view().set_position, here + 19, 1e-9);
    EXPECT_EQ(p.rig.view().state, AxisState::ContinuousMotion);
}

TEST(AccelerationProfile, ALimitSwitchOnTheWayStopsIt) {
    TableRig p({{1s, 50.0}});
    p.rig.drive.switches = true;
    p.rig.drive.positive_end = 3000;
    p.rig.accept(p.profile(CommandKind::acceleration_profile));
    ASSERT_TRUE(p.rig.run_to(AxisState::ErrorStop));
    EXPECT_TRUE(p.rig.raised(AxisAlarm::positive_limit_switch));
    ASSERT_TRUE(p.rig.run_until([&] { return p.rig.view().set_velocity == 0; }));
    p.rig.expect_no_jump();
}

}  // namespace
}  // namespace taktwerk::axes::test
