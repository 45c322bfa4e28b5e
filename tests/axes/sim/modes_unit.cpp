// The simulated drive in cyclic velocity and cyclic torque: it answers because motor, load and loops are computed.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/axes/sim/axis_bench.hpp"

namespace taktwerk::axes::sim {
namespace {

constexpr double rad_per_count = 2 * 3.14159265358979323846 / 10000;

/// No friction, no load: what the motor does is torque over inertia.
PlantConfig free_motor() {
    PlantConfig plant;
    plant.viscous_friction = plant.coulomb_friction = 0;
    return plant;
}

// a = T / J: 0.2 of 1.27 N m on 2e-4 kg m2 is 1270 rad/s2; after 50 ms 63.5 rad/s.
TEST(CyclicTorque, AFreeMotorAcceleratesByTorqueOverInertia) {
    Bench bench(free_motor());
    bench.in.mode = 10;
    bench.enable();
    bench.in.target_torque = 200;
    bench.run(51);  // the first exchange brings the torque
    EXPECT_EQ(bench.out.mode, 10);
    EXPECT_EQ(bench.out.torque, 200);
    EXPECT_NEAR(static_cast<double>(bench.out.velocity) * rad_per_count, 63.5, 0.01);
    EXPECT_NE(bench.out.status & 0x1000u, 0u) << "bit 12: it follows";
}

TEST(CyclicTorque, TheMaximumSpeedBoundsItInBothSenses) {
    for (const int torque : {200, -200}) {
        Bench bench(free_motor());
        bench.in.mode = 10;
        bench.in.maximum_velocity = 40000;
        bench.enable();
        bench.in.target_torque = torque;
        bench.run(400);
        EXPECT_NEAR(std::abs(static_cast<double>(bench.out.velocity)), 40000, 400);
        EXPECT_EQ(bench.out.velocity > 0, torque > 0);
    }
}

// With friction the velocity loop needs its torque; taken over in CSP or CSV, the motor feels nothing.
TEST(CyclicTorque, LeavingItForVelocityOrPositionIsBumpless) {
    for (const int mode : {9, 8}) {
        PlantConfig plant;
        plant.coulomb_friction = 0.254;  // 0.2 rated
        plant.viscous_friction = 0;
        Bench bench(plant);
        bench.in.mode = 10;
        bench.enable();
        bench.in.target_torque = 300;
        bench.run(40);
        bench.in.target_torque = 200;  // holds the speed
        bench.run(10);
        const double speed = static_cast<double>(bench.out.velocity);
        ASSERT_GT(speed, 20000);
        bench.in.mode = mode;
        bench.in.target_velocity = bench.out.velocity;
        // The motor is a cycle further when the drive takes the mode, and gets to its target a cycle later.
        bench.in.target_position = bench.out.position + std::llround(speed / 1000);
        double least = speed, most = speed;
        for (int i = 0; i < 50; ++i) {
            bench.in.target_position += std::llround(speed / 1000);
            bench.cycle();
            least = std::min(least, static_cast<double>(bench.out.velocity));
            most = std::max(most, static_cast<double>(bench.out.velocity));
        }
        EXPECT_GT(least, 0.98 * speed) << mode;
        EXPECT_LT(most, 1.02 * speed) << mode;
    }
}

TEST(CyclicVelocity, TheMotorRunsAtTheTargetVelocityUnderLoad) {
    PlantConfig plant;
    plant.load_torque = 0.5;
    Bench bench(plant);
    bench.in.mode = 9;
    bench.enable();
    bench.in.target_velocity = 30000;
    bench.run(500);
    EXPECT_NEAR(static_cast<double>(bench.out.velocity), 30000, 10);
    EXPECT_NE(bench.out.status & 0x1000u, 0u);
}

// 60B2h: the torque that the acceleration needs comes at once, not through a following error.
TEST(CyclicPosition, TorqueFeedForwardTakesTheFollowingErrorOfAnAcceleration) {
    const auto worst = [](bool feed_forward) {
        Bench bench(free_motor());
        bench.enable();
        const double acceleration = 1e6;  // counts/s2 = 628 rad/s2 = 0.1257 N m = 9.9 % of rated torque
        const auto start = bench.out.position;
        double largest = 0;
        for (int i = 1; i <= 50; ++i) {
            const double t = i * 1e-3;
            bench.in.target_position = start + std::llround(acceleration * t * t / 2);
            bench.in.torque_offset = feed_forward ? 99 : 0;
            bench.cycle();
            largest = std::max(largest, std::abs(static_cast<double>(bench.out.following_error)));
        }
        return largest;
    };
    EXPECT_LT(worst(true), 0.5 * worst(false));
}

}  // namespace
}  // namespace taktwerk::axes::sim
