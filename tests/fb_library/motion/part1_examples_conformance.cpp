// Longer examples of PLCopen Part 1 v2.0, replayed by the blocks on real axes (fake drives, virtual time, infinite jerk): a torque that
// meets its velocity limit, a profile over time against a cam, a wave laid over a conveyor. Expected values are the figures' and hand
// calculation.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/motion/coupled_plc.hpp"
#include "tests/patience.hpp"

namespace taktwerk::fb {
namespace {

using axes::AxisState;

// Figures 30 and 31 (P1-186), with 1 u for 1 mm and a motor whose rated torque is 10 Nm and gives the free load 2000 u/s2. The material
// holds with up to 5 Nm, gives way with 1 Nm for a while, and holds again.
TEST(TorqueFigure, Figure31TorqueUpThroughTheVelocityLimitAndDown) {
    auto config = Plc::roomy_axis();
    config.control.rated_acceleration = 2000;
    Plc plc{config};
    MC_TorqueControl first, second;
    first.Axis = second.Axis = Plc::x;
    first.Torque = 0.4, second.Torque = 0;
    first.TorqueRamp = second.TorqueRamp = 0.1;
    first.Velocity = second.Velocity = 200;
    first.Acceleration = first.Deceleration = second.Acceleration = second.Deceleration = 100;
    plc.program = [&](const MotionContext& ctx) {
        first(ctx);
        second(ctx);
    };
    const auto pulse = [&](MC_TorqueControl& block) {
        block.Execute = true;
        plc.run_for(5ms);
        block.Execute = false;
    };
    double fastest_change = 0;
    const auto run_watching = [&](Duration time) {
        for (Duration t{}; t < time; t += Plc::period) {
            const double before = plc.axis.view().actual_velocity;
            plc.scan();
            fastest_change = std::max(fastest_change, std::abs(plc.axis.view().actual_velocity - before));
        }
    };

    plc.drive.friction = 0.5;
    pulse(first);
    EXPECT_TRUE(first.Busy);
    EXPECT_FALSE(first.InTorque);
    const auto ramp = plc.run_until([&] { return first.InTorque; }, 10s);
    EXPECT_NEAR(to_seconds(ramp), 4, 0.02) << "4 Nm with 1 Nm/s, less the pulse, more the change of mode";
    EXPECT_TRUE(first.Busy);
    EXPECT_EQ(plc.drive.last.torque, 0.4);

    plc.drive.friction = 0.1;
    run_watching(4s);
    EXPECT_NEAR(plc.axis.view().actual_velocity, 200, 1);
    EXPECT_LE(fastest_change, 100 * 0.001 + 2.1) << "Acceleration, and a count more or less in what is measured";
    EXPECT_FALSE(first.InTorque) << "the velocity limit is reached, the torque cannot be held";
    EXPECT_TRUE(first.Busy);

    plc.drive.friction = 0.5;
    plc.run_until([&] { return first.InTorque; }, 10s);
    EXPECT_TRUE(first.InTorque) << "held again";
    EXPECT_EQ(plc.drive.last.torque, 0.4);

    pulse(second);
    EXPECT_FALSE(first.Busy || first.InTorque);
    EXPECT_TRUE(second.Busy);
    EXPECT_FALSE(second.InTorque);
    const auto down = plc.run_until([&] { return second.InTorque; }, 10s);
    EXPECT_NEAR(to_seconds(down), 4, 0.02);
    EXPECT_TRUE(second.Busy);
    EXPECT_EQ(plc.drive.last.torque, 0);
}

/// Rest to rest over `stroke` in 2 s, fifth order.
double smooth_step(double seconds, double stroke) {
    const double x = std::clamp(seconds / 2, 0.0, 1.0);
    return stroke * x * x * x * (10 - 15 * x + 6 * x * x);
}

// P1-192: what MC_PositionProfile makes of a list of points over time, MC_CamIn makes of them over a virtual master that runs at 1 u/s.
TEST(ProfileAgainstCam, TheSamePointsGiveTheSameMotion) {
    constexpr double stroke = 80;
    constexpr int rows = 40;
    std::vector<axes::TimePoint> over_time;
    std::vector<axes::CamPoint> over_master;
    for (int i = 0; i <= rows; ++i) {
        const double at = smooth_step(i * 0.05, stroke);
        if (i > 0) over_time.push_back({50ms, at});  // each row a time after the one before; the first is where the axis is
        over_master.push_back({.master = i * 0.05, .slave = at, .segment = axes::CamSegment::spline});
    }
    axes::MotionTables tables;
    const auto points_over_time = tables.add_time_table(over_time);
    const auto points_over_master = tables.add_cam(over_master);
    CoupledPlc plc{3, std::move(tables)};
    constexpr AxisRef clock{0}, by_cam{1}, by_profile{2};
    MC_MoveAbsolute run_clock;
    run_clock.Axis = clock;
    run_clock.Position = 2, run_clock.Velocity = 1;
    MC_CamTableSelect select;
    select.Slave = by_cam;
    select.CamTable = points_over_master;
    select.MasterAbsolute = select.SlaveAbsolute = true;
    MC_CamIn cam;
    cam.Master = clock, cam.Slave = by_cam;
    MC_PositionProfile profile;
    profile.Axis = by_profile;
    profile.TimePosition = points_over_time;
    plc.program = [&](const MotionContext& ctx) {
        select(ctx);
        cam.CamTableID = select.CamTableID;
        cam(ctx);
        run_clock(ctx);
        profile(ctx);
    };
    select.Execute = true;
    plc.run_until([&] { return select.Done; }, 1s);
    cam.Execute = true;
    plc.run_until([&] { return cam.InSync; }, 1s);

    run_clock.Execute = profile.Execute = true;
    double apart = 0, from_curve = 0;
    plc.run_until(
        [&] {
            apart = std::max(apart, std::abs(plc.position(by_cam) - plc.position(by_profile)));
            from_curve = std::max(from_curve, std::abs(plc.position(by_cam) - smooth_step(plc.position(clock), stroke)));
            return profile.Done;
        },
        4s);
    EXPECT_TRUE(profile.Done) << static_cast<int>(profile.ErrorID);
    // At 75 u/s at most (15/8 of 80 u in 2 s) a start that is up to a cycle apart is 0.075 u; between points 50 ms apart splines err far less.
    EXPECT_LE(apart, 0.1);
    EXPECT_LE(from_curve, 0.01);
    EXPECT_NEAR(plc.position(by_cam), stroke, 1e-6);
    EXPECT_NEAR(plc.position(by_profile), stroke, 1e-6);
}

/// Figures 50 and 51: a wave laid over a conveyor, on virtual axes, and the real axis brought in sync with their sum.
struct WaveOverConveyor : testing::Test {
    static constexpr AxisRef conveyor{0}, first_virtual{1}, second_virtual{2}, combined_virtual{3}, real{4};
    static constexpr double speed = 4, swing = 0.25;  // u/s; u of the wave, one a u of conveyor, so below 2 u/s

    WaveOverConveyor() {
        std::vector<axes::CamPoint> wave;
        for (int i = 0; i <= 32; ++i)
            wave.push_back(
                {.master = i / 32.0, .slave = swing * std::sin(2 * std::numbers::pi * i / 32), .segment = axes::CamSegment::spline});
        run.Axis = conveyor;
        run.Velocity = speed;
        select.Slave = first_virtual;
        select.CamTable = plc.tables.add_cam(wave);
        select.Periodic = true;
        cam.Master = conveyor, cam.Slave = first_virtual, cam.StartMode = mcRelative;
        gear.Master = conveyor, gear.Slave = second_virtual, gear.Acceleration = 2, gear.Deceleration = 0.5;
        combine.Master1 = first_virtual, combine.Master2 = second_virtual, combine.Slave = combined_virtual;
        combine.CombineMode = mcAddAxes;
        join.Master = combined_virtual, join.Slave = real;
        join.MasterSyncPosition = 10, join.MasterStartDistance = 9.9, join.SlaveSyncPosition = 5;
        plc.program = [this](const MotionContext& ctx) {
            run(ctx);
            select(ctx);
            cam.CamTableID = select.CamTableID;
            cam(ctx);
            gear(ctx);
            combine(ctx);
            join(ctx);
        };
        run.Execute = select.Execute = true;
        plc.run_until([this] { return run.InVelocity && select.Done; }, 5s);
    }
    CoupledPlc plc{5};
    MC_MoveVelocity run;
    MC_CamTableSelect select;
    MC_CamIn cam;
    MC_GearIn gear;
    MC_CombineAxes combine;
    MC_GearInPos join;
};

// Figure 51 (P1-303): the table.
TEST_F(WaveOverConveyor, Figure51TheOrderOfEvents) {
    // 1. the real axis waits
    join.Execute = true;
    plc.run_for(500ms);
    EXPECT_TRUE(join.Busy);
    EXPECT_FALSE(join.StartSync || join.InSync || join.Error);
    EXPECT_EQ(plc.position(real), 0);

    // 2. the wave runs round zero, the others stand
    cam.Execute = true;
    plc.run_until([&] { return cam.InSync; }, 1s);
    double highest = 0, lowest = 0;
    for (int i = 0; i < 1000; ++i) {
        plc.scan();
        highest = std::max(highest, plc.velocity(first_virtual));
        lowest = std::min(lowest, plc.velocity(first_virtual));
    }
    EXPECT_NEAR(highest, 2 * std::numbers::pi * swing * speed, 0.05);
    EXPECT_NEAR(lowest, -2 * std::numbers::pi * swing * speed, 0.05);
    EXPECT_EQ(plc.position(combined_virtual), 0);
    EXPECT_EQ(plc.position(real), 0);

    // 3. the sum; 4. it crosses 10 - 9.9, with which the real axis begins
    plc.run_until([&] { return std::abs(plc.position(first_virtual)) < 0.01 && plc.velocity(first_virtual) > 0; }, 2s);
    combine.Execute = true;
    plc.run_until([&] { return combine.InSync; }, 1s);
    bool waited = false;
    for (Patience patience; patience.lasts(!join.StartSync);) {
        ASSERT_LE(plc.position(combined_virtual), 0.1 + 0.01);
        if (plc.position(combined_virtual) < 0.1) {
            ASSERT_EQ(plc.position(real), 0);
        }
        ASSERT_NEAR(plc.velocity(combined_virtual), plc.velocity(first_virtual) + plc.velocity(second_virtual), 1e-6);
        waited = true;
        plc.scan();
    }
    EXPECT_TRUE(waited);
    EXPECT_FALSE(join.InSync);
    EXPECT_EQ(plc.velocity(second_virtual), 0);

    // 5. SecondVirtual goes up to the conveyor in 4 / 2 = 2 s, and the sum gains as much
    gear.Execute = true;
    const auto ramp = plc.run_until([&] { return gear.InGear; }, 5s);
    EXPECT_NEAR(to_seconds(ramp), 2, 0.005);
    EXPECT_NEAR(plc.velocity(second_virtual), speed, 1e-6);
    EXPECT_FALSE(join.InSync);

    // 6. at the sync position the real axis has the wave
    plc.run_until([&] { return join.InSync; }, 5s);
    EXPECT_NEAR(plc.position(combined_virtual), 10, 0.03) << "at most 6 u/s: InSync is seen some cycles later";
    for (int i = 0; i < 2000; ++i) {
        ASSERT_TRUE(join.InSync);
        ASSERT_NEAR(plc.velocity(real), plc.velocity(combined_virtual), 1e-6);
        ASSERT_NEAR(plc.position(real) - 5, plc.position(combined_virtual) - 10, 1e-6);
        ASSERT_NEAR(plc.velocity(combined_virtual), plc.velocity(first_virtual) + plc.velocity(second_virtual), 1e-6);
        plc.scan();
    }
    EXPECT_EQ(plc.view(real).state, AxisState::SynchronizedMotion);
}

}  // namespace
}  // namespace taktwerk::fb
