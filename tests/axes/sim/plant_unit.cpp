#include "axes/sim/plant.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace taktwerk::axes::sim {
namespace {

PlantConfig frictionless() {
    PlantConfig config;
    config.counts_per_revolution = 10000;
    config.inertia = 1e-3;
    config.viscous_friction = 0;
    config.coulomb_friction = 0;
    return config;
}

void run(Plant& plant, double seconds, double torque) {
    const int steps = static_cast<int>(std::lround(seconds / 125e-6));
    for (int i = 0; i < steps; ++i) plant.step(125e-6, torque);
}

// Newton: 0.2 N m on 1e-3 kg m2 is 200 rad/s2; after 0.1 s that is 20 rad/s = 31830.99 counts/s at 10000 counts a turn.
TEST(Plant, AcceleratesByTorqueOverInertia) {
    Plant plant{frictionless()};
    run(plant, 0.1, 0.2);
    EXPECT_NEAR(plant.velocity(), 20.0 / (2 * std::numbers::pi) * 10000, 0.01);
}

TEST(Plant, SticksBelowCoulombFriction) {
    auto config = frictionless();
    config.coulomb_friction = 0.05;
    Plant plant{config};
    run(plant, 0.1, 0.049);
    EXPECT_EQ(plant.velocity(), 0.0);
    run(plant, 0.1, 0.051);
    EXPECT_GT(plant.velocity(), 0.0);
}

TEST(Plant, FrictionBringsAFreeMotorToRestAndNeverReversesIt) {
    auto config = frictionless();
    config.coulomb_friction = 0.05;
    Plant plant{config};
    run(plant, 0.05, 0.5);
    double before = plant.velocity();
    for (int i = 0; i < 40000 && plant.velocity() != 0; ++i) {
        plant.step(125e-6, 0);
        ASSERT_GE(plant.velocity(), 0.0);
        ASSERT_LE(plant.velocity(), before);
        before = plant.velocity();
    }
    EXPECT_EQ(plant.velocity(), 0.0);
}

TEST(Plant, AHardStopEndsTheTravel) {
    auto config = frictionless();
    config.positive_stop = 1000;
    Plant plant{config};
    run(plant, 1.0, 0.5);
    EXPECT_EQ(plant.position(), 1000);
    EXPECT_EQ(plant.velocity(), 0);
}

TEST(Plant, AVerticalAxisFallsWhenTheMotorIsFree) {
    auto config = frictionless();
    config.load_torque = 0.1;
    Plant plant{config};
    run(plant, 0.1, 0);
    EXPECT_LT(plant.position(), 0);
}

TEST(Plant, AJammedAxisStands) {
    Plant plant{frictionless()};
    plant.jam(true);
    run(plant, 0.1, 1.0);
    EXPECT_EQ(plant.position(), 0);
}

// On a load that turns the switch passes once a turn, both ways.
TEST(Plant, AHomeSwitchMayComeAgainEachTurn) {
    PlantConfig config;
    config.home_from = 100, config.home_to = 200;
    for (const bool turns : {false, true})
        for (const double start : {150.0, 3750.0, -3450.0, 250.0, -50.0}) {
            config.home_every = turns ? 3600 : 0;
            config.start = start;
            const bool under = start == 150 || (turns && (start == 3750 || start == -3450));
            EXPECT_EQ(Plant(config).home_switch(), under) << start << turns;
        }
}

}  // namespace
}  // namespace taktwerk::axes::sim
