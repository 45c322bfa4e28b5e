// MC_GroupHome, MC_GroupWriteSWLimits, MC_GroupWriteParameter and their readers, scan by scan.

#include <gtest/gtest.h>

#include <limits>

#include "tests/fb_library/groups/group_plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::GroupState;

struct SettingsPlc : GroupPlc {
    SettingsPlc() : GroupPlc(homed_here(), axes::test::GroupRig::all_of(homed_here(), {})) {
        MC_GroupEnable enable;
        carry_out(enable);
    }
    static std::vector<axes::AxisConfig> homed_here() {
        auto configs = axes::test::GroupRig::named(2);
        for (auto& config : configs) config.homing.kind = axes::HomingKind::set_here;
        return configs;
    }
};

// G-011: the block's outputs while its group is in GroupHoming.
TEST(GroupSettings, HomeShowsItsWay) {
    SettingsPlc plc;
    MC_GroupHome home;
    home.Position.A.Axes = {3, 4};
    home.AxesGroup = plc.group;
    home.Execute = true;
    bool active = false, homing = false;
    plc.program = [&](const MotionContext& ctx) {
        home(ctx);
        active = active || (home.Active && home.Busy && home.CommandAccepted);
        homing = homing || plc.rig.view().state == GroupState::GroupHoming;
    };
    ASSERT_TRUE(plc.until([&] { return home.Done; }, 50));
    EXPECT_TRUE(active);
    EXPECT_TRUE(homing);
    EXPECT_FALSE(home.Busy || home.Active || home.Error || home.CommandAborted);
    EXPECT_EQ(plc.rig.point()[0], 3);
    EXPECT_EQ(plc.rig.point()[1], 4);
    home.Execute = false;
    plc.scan();
    home.CoordSystem = mcMCS;
    home.Execute = true;
    plc.scan();
    EXPECT_EQ(home.ErrorID, ErrorId::not_supported);
}

// G-024: what is read may be written back; all or none.
TEST(GroupSettings, LimitsAreWrittenAndRead) {
    SettingsPlc plc;
    MC_GroupHome home;
    plc.carry_out(home);
    MC_GroupReadSWLimits read;
    read.AxesGroup = plc.group;
    read.Enable = true;
    const auto values = [&] {
        plc.program = [&](const MotionContext& ctx) { read(ctx); };
        plc.run(2);
        EXPECT_TRUE(read.Valid);
        return read.LimitValues;
    };
    MC_GroupWriteSWLimits write;
    write.LimitValues = values();  // infinite: none
    EXPECT_EQ(plc.carry_out(write), ErrorId::none);
    EXPECT_EQ(values().Axes[0].SWLimitPos, std::numeric_limits<double>::infinity());
    write.LimitValues.Axes[0] = {50, -5};
    write.LimitValues.Axes[1] = {60, -6};
    EXPECT_EQ(plc.carry_out(write), ErrorId::none);
    EXPECT_EQ(values().Axes[1].SWLimitPos, 60);
    EXPECT_EQ(values().Axes[0].SWLimitNeg, -5);
    write.LimitValues.Axes[1] = {-1, 1};
    write.LimitValues.Axes[0] = {70, -7};
    EXPECT_EQ(plc.carry_out(write), ErrorId::invalid_parameter);
    EXPECT_EQ(values().Axes[0].SWLimitPos, 50) << "none of them";
    write.ExecutionMode = mcQueued;
    EXPECT_EQ(plc.carry_out(write), ErrorId::not_supported);
}

// G-030: percents of the reference dynamics.
TEST(GroupSettings, DynamicsInPercent) {
    SettingsPlc plc;
    MC_GroupWriteReferenceDynamics reference;
    reference.Velocity = 40;
    plc.carry_out(reference);
    MC_GroupWriteParameter mode;
    mode.Value = 1;
    EXPECT_EQ(plc.carry_out(mode), ErrorId::none);
    EXPECT_FALSE(mode.CommandAccepted);
    EXPECT_EQ(mode.CommandID.id, 0u);
    MC_GroupReadParameter read;
    MC_GroupReadReferenceDynamics known;
    read.AxesGroup = known.AxesGroup = plc.group;
    read.Enable = known.Enable = true;
    MC_MoveLinearAbsolute move;
    move.Position.A.Axes = {60, 0};
    move.Velocity = 25;
    double fastest = 0;
    plc.program = [&](const MotionContext& ctx) {
        read(ctx);
        known(ctx);
        fastest = std::max(fastest, plc.rig.view().path_velocity);
    };
    EXPECT_EQ(plc.carry_out(move, 8000), ErrorId::none);
    EXPECT_EQ(read.Value, 1);
    EXPECT_EQ(known.Velocity, 40);
    EXPECT_EQ(known.Jerk, 0);
    EXPECT_NEAR(fastest, 10, 0.02) << "a quarter of 40";
    move.Velocity = 120;
    EXPECT_EQ(plc.carry_out(move), ErrorId::invalid_velocity);
    mode.ParameterNumber = mcTransitionReferencePoint;
    EXPECT_EQ(plc.carry_out(mode), ErrorId::not_supported);
    mode.ParameterNumber = mcDynamicsMode;
    mode.Value = 2;
    EXPECT_EQ(plc.carry_out(mode), ErrorId::invalid_parameter);
    read.ParameterNumber = static_cast<MC_GroupParameter>(9);
    plc.run(2);
    EXPECT_EQ(read.ErrorID, ErrorId::unknown_parameter);
    EXPECT_EQ(read.Value, 0);
}

}  // namespace
}  // namespace taktwerk::fb
