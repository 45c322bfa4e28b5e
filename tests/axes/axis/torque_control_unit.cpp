// The torque of MC_TorqueControl in front of a mass with friction and load, with the dead time of a bus.

#include "axes/axis/torque_control.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>

namespace taktwerk::axes {
namespace {

using namespace std::chrono_literals;

/// 1 ms cycle; the torque acts a cycle after it is set, the velocity is two cycles old when it is seen. Rated torque gives 1000 u/s2.
struct Plant {
    static constexpr double inertia = 1e-3;
    explicit Plant(double believed = inertia) : control(believed, 100) {}

    void start(double v) {
        velocity = v;
        seen.assign(2, v);
        control.start(0, v);
    }
    void step() {
        seen.push_back(velocity);
        const double torque = control.step(seen.front(), 1ms);
        seen.pop_front();
        acting.push_back(torque);
        const double now = acting.front();
        acting.pop_front();
        for (int i = 0; i < 8; ++i) {
            const double driving = now - load;
            const double against = velocity != 0 ? std::copysign(friction, velocity) : std::clamp(driving, -friction, friction);
            const double next = velocity + (driving - against) / inertia * 125e-6;
            velocity = velocity != 0 && next * velocity < 0 && std::abs(driving) <= friction ? 0 : next;
        }
        fastest = std::max(fastest, velocity);
        slowest = std::min(slowest, velocity);
        ++cycles;
        history.push_back(velocity);
        if (history.size() > 21) {  // over 20 ms: the limit of the mean, not of a single cycle
            history.pop_front();
            steepest_up = std::max(steepest_up, (history.back() - history.front()) / 0.02);
            steepest_down = std::min(steepest_down, (history.back() - history.front()) / 0.02);
        }
    }
    void run(int n) {
        for (int i = 0; i < n; ++i) step();
    }

    TorqueControl control;
    double velocity = 0, load = 0, friction = 0;
    double fastest = -1e9, slowest = 1e9, steepest_up = 0, steepest_down = 0;
    int cycles = 0;
    std::deque<double> seen{0, 0}, acting{0}, history;
};

constexpr TorqueLimits limits{50, 200, 300};

// P1-178: TorqueRamp is the slope, exactly; 0.5 at 2/s takes 250 cycles. P1-179: InTorque with the last of them.
TEST(TorqueControl, TheRampIsTheSlope) {
    TorqueControl control(0, 0);
    control.start(0.1, 0);
    control.command(0.6, 2, limits, TorqueSense::both);
    double before = 0.1;
    for (int i = 1; i < 250; ++i) {
        const double torque = control.step(0, 1ms);
        EXPECT_NEAR(torque - before, 0.002, 1e-12);
        EXPECT_FALSE(control.in_torque());
        before = torque;
    }
    EXPECT_EQ(control.step(0, 1ms), 0.6);
    EXPECT_TRUE(control.in_torque());
    control.command(-0.2, 0, limits, TorqueSense::both);
    EXPECT_EQ(control.step(0, 1ms), -0.2) << "no ramp: at once";
}

// P1-180, P1-181: a free motor gets to the velocity limit and no further, in both senses; there the torque is below the command.
TEST(TorqueControl, AFreeMotorEndsAtTheVelocityLimit) {
    for (const double sign : {1.0, -1.0}) {
        Plant plant;
        plant.start(0);
        plant.control.command(sign * 0.5, 0, limits, TorqueSense::both);
        plant.run(1000);
        EXPECT_NEAR(plant.velocity, sign * 50, 0.05);
        EXPECT_LT(std::max(plant.fastest, -plant.slowest), 50.1);
        EXPECT_LT(std::abs(plant.control.torque()), 0.01);
        EXPECT_TRUE(plant.control.limited());
        EXPECT_FALSE(plant.control.in_torque());
        // P1-183: torque and velocity have the same sign: Acceleration.
        EXPECT_LT(std::max(plant.steepest_up, -plant.steepest_down), 200 * 1.1);
    }
}

// A torque that accelerates less than allowed is given as commanded: 0.15 is 150 u/s2.
TEST(TorqueControl, WhatStaysInsideTheLimitsIsNotTouched) {
    Plant plant;
    plant.start(0);
    plant.control.command(0.15, 0, limits, TorqueSense::both);
    plant.run(200);
    EXPECT_EQ(plant.control.torque(), 0.15);
    EXPECT_TRUE(plant.control.in_torque());
    EXPECT_NEAR(plant.velocity, 30, 0.2);
}

// P1-183: against the motion it is the deceleration that bounds.
TEST(TorqueControl, AgainstTheMotionTheDecelerationBounds) {
    Plant plant;
    plant.start(40);
    plant.control.command(-0.9, 0, limits, TorqueSense::both);
    plant.run(100);
    EXPECT_GT(plant.steepest_down, -300 * 1.1);
    EXPECT_LT(plant.steepest_down, -300 * 0.9);
    plant.run(500);
    EXPECT_NEAR(plant.velocity, -50, 0.05);
}

// P1-187: a brake. Material pulls the motor; it holds against it with the commanded torque as long as there is tension. At a break the
// torque falls off, the velocity goes to 0 with the deceleration and not below.
TEST(TorqueControl, ABrakeHoldsTensionAndStandsAfterABreak) {
    Plant plant;
    plant.start(40);
    plant.load = -0.25;  // the material pulls forward, a little less than the brake holds back
    plant.control.command(-0.3, 1, limits, TorqueSense::only_positive);
    plant.run(100);
    plant.run(400);
    EXPECT_EQ(plant.control.torque(), -0.3);
    EXPECT_TRUE(plant.control.in_torque());
    EXPECT_GT(plant.velocity, 5);
    plant.load = 0;
    plant.run(600);
    EXPECT_NEAR(plant.velocity, 0, 0.01);
    EXPECT_GT(plant.slowest, -0.01) << "never backwards";
    EXPECT_GT(plant.steepest_down, -300 * 1.1);
    EXPECT_FALSE(plant.control.in_torque()) << "the torque is missing";
}

// A load that is stronger than the commanded torque does not run away: the limit holds it.
TEST(TorqueControl, AnOverhaulingLoadIsHeldAtTheLimit) {
    Plant plant;
    plant.start(0);
    plant.load = 0.4;
    plant.control.command(0.1, 0, limits, TorqueSense::both);
    plant.run(1500);
    EXPECT_NEAR(plant.velocity, -50, 0.1);
    EXPECT_GT(plant.slowest, -51);
    EXPECT_NEAR(plant.control.torque(), 0.4, 0.01);
}

// Taken over at standstill with the torque that holds it, a load does not fall for a moment while the observer finds out.
TEST(TorqueControl, AHeldLoadIsHeldFromTheFirstCycle) {
    Plant plant;
    plant.load = 0.3;
    plant.seen.assign(2, 0);
    plant.acting.assign(1, 0.3);
    plant.control.start(0.3, 0);
    plant.control.command(0.3, 0, {.velocity = 10, .acceleration = 100, .deceleration = 100}, TorqueSense::both);
    plant.run(200);
    EXPECT_NEAR(plant.fastest, 0, 1e-9);
    EXPECT_NEAR(plant.slowest, 0, 1e-9);
    EXPECT_NEAR(plant.control.torque(), 0.3, 1e-12);
}

TEST(TorqueControl, AnInertiaThatIsWrongByTwoIsForgiven) {
    for (const double believed : {Plant::inertia / 2, Plant::inertia * 2}) {
        Plant plant(believed);
        plant.friction = 0.05;
        plant.start(0);
        plant.control.command(0.8, 0, limits, TorqueSense::both);
        plant.run(1000);
        EXPECT_NEAR(plant.velocity, 50, 0.1);
        EXPECT_LT(plant.fastest, 52);
    }
}

TEST(TorqueControl, BrakingEndsAtStandstillWithTheDeceleration) {
    Plant plant;
    plant.friction = 0.05;
    plant.start(0);
    plant.control.command(0.5, 0, limits, TorqueSense::both);
    plant.run(200);
    ASSERT_GT(plant.velocity, 30);
    const double from = plant.velocity;
    plant.steepest_down = 0;
    plant.control.brake(300);
    plant.run(static_cast<int>(from / 300 * 1000 * 0.8));
    EXPECT_GT(plant.velocity, 0);
    plant.run(static_cast<int>(from / 300 * 1000 * 0.3) + 100);
    EXPECT_NEAR(plant.velocity, 0, 0.1) << "the default window of standstill, in which an axis leaves torque";
    EXPECT_GT(plant.slowest, -0.01);
    EXPECT_GT(plant.steepest_down, -300 * 1.1);
}

}  // namespace
}  // namespace taktwerk::axes
