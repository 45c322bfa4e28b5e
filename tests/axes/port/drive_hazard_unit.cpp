// When a hazard of a drive applies to a machine: each condition on both sides.

#include "axes/port/drive_hazard.hpp"

#include <gtest/gtest.h>

#include "axes/port/drive_profile.hpp"

namespace taktwerk::axes {
namespace {

constexpr ParameterAddress deceleration{0x6084, 0}, storage{0x2005, 0x0B}, torque_limit{0x60E0, 0};

class Hazards : public testing::Test {
protected:
    bool applies(const DriveHazard& hazard) {
        profile_.hazards = {hazard};
        return !hazards_of(profile_, use_).empty();
    }
    DriveProfile profile_;
    DriveUse use_;
};

TEST_F(Hazards, AFactoryValueThatNobodyReplacesStands) {
    const DriveHazard hazard{.when = HazardCondition::not_written, .objects = {deceleration}};
    EXPECT_TRUE(applies(hazard));
    use_.sent = {deceleration};
    EXPECT_FALSE(applies(hazard));
    use_.sent = {};
    use_.written = {{deceleration, 5}};
    EXPECT_FALSE(applies(hazard));
}

TEST_F(Hazards, OneOfSeveralObjectsThatIsForgottenIsEnough) {
    const DriveHazard hazard{.when = HazardCondition::not_written, .objects = {deceleration, storage}};
    use_.written = {{storage, 0}};
    EXPECT_TRUE(applies(hazard));
    use_.written = {{storage, 0}, {deceleration, 1}};
    EXPECT_FALSE(applies(hazard));
}

TEST_F(Hazards, AValueIsTheLastWrittenOneElseTheFactorys) {
    const DriveHazard wanted{.when = HazardCondition::not_set_to, .objects = {storage}, .values = {0}};
    const DriveHazard feared{.when = HazardCondition::set_to, .objects = {storage}, .values = {1, 3}};
    EXPECT_TRUE(applies(wanted)) << "what nobody knows may be the wrong one";
    EXPECT_FALSE(applies(feared)) << "and is not accused of being one";
    DriveParameter parameter;
    parameter.address = storage;
    parameter.value = 3;
    profile_.parameters = {parameter};
    EXPECT_FALSE(applies(feared)) << "a value without a known factory setting says nothing";
    parameter.factory = FactoryValue::stated;
    profile_.parameters = {parameter};
    EXPECT_TRUE(applies(wanted));
    EXPECT_TRUE(applies(feared));
    use_.written = {{storage, 1}, {storage, 0}};
    EXPECT_FALSE(applies(wanted));
    EXPECT_FALSE(applies(feared));
    use_.sent = {storage};
    EXPECT_FALSE(applies(wanted)) << "what is sent cyclically is nobody's guess";
}

TEST_F(Hazards, WhatIsMappedIsKnown) {
    EXPECT_FALSE(applies({.when = HazardCondition::mapped, .objects = {torque_limit}}));
    EXPECT_TRUE(applies({.when = HazardCondition::not_mapped, .objects = {torque_limit}}));
    use_.sent = {torque_limit, {0x6071, 0}};
    EXPECT_TRUE(applies({.when = HazardCondition::mapped, .objects = {torque_limit}}));
    EXPECT_FALSE(applies({.when = HazardCondition::not_mapped, .objects = {torque_limit}}));
    EXPECT_TRUE(applies({.when = HazardCondition::mode_mapped, .mode = DriveMode::cyclic_torque}));
    EXPECT_FALSE(applies({.when = HazardCondition::mode_mapped, .mode = DriveMode::cyclic_velocity}));
}

TEST_F(Hazards, TheAxisHasItsSay) {
    EXPECT_TRUE(applies({.when = HazardCondition::always}));
    EXPECT_FALSE(applies({.when = HazardCondition::homed_by_drive}));
    EXPECT_FALSE(applies({.when = HazardCondition::absolute_homing}));
    EXPECT_TRUE(applies({.when = HazardCondition::no_software_limits}));
    use_.homed_by_drive = use_.absolute_homing = use_.software_limits = true;
    EXPECT_TRUE(applies({.when = HazardCondition::homed_by_drive}));
    EXPECT_TRUE(applies({.when = HazardCondition::absolute_homing}));
    EXPECT_FALSE(applies({.when = HazardCondition::no_software_limits}));
}

}  // namespace
}  // namespace taktwerk::axes
