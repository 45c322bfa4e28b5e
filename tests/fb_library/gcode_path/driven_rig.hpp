#pragma once
// MC_SyncGroupToAxis on a portal, and a fourth axis beside it that drives the path. The rig asserts the limits and the continuity of every member in every cycle.

#include "tests/axes/group/track_rig.hpp"
#include "tests/fb_library/gcode_path/path_rig.hpp"

namespace taktwerk::fb {

// From where the tool stands, (0, 0, 0), as all of them.
inline constexpr const char* straight = "G21 G90 G61\nG1 X60 F3000\nM2\n";
inline constexpr const char* corner = "G21 G90 G64 P0.5\nG1 X40 F3000\nG1 Y30\nM2\n";
inline constexpr const char* circle = "G21 G90 G17 G61\nG2 I20 J0 F3000\nM2\n";  // about (20, 0), from its leftmost point upwards

/// The master: 100 u/s, 250 u/s2, 2500 u/s3.
struct DrivenRig {
    explicit DrivenRig(const std::string& text, const axes::AxisConfig& master_axis = axes::test::belt_axis(),
                       const axes::AxisGroupConfig& group = PathRig::group(), std::vector<axes::AxisConfig> members = PathRig::axes_of(0))
        : plc(with(master_axis, std::move(members)), {group}, PathRig::makers(text, {})) {
        MC_GroupEnable enable;
        plc.carry_out(enable);
        select.AxesGroup = sync.AxesGroup = plc.group;
        select.PathDescription.Path = {0};
        sync.Master = master;
        plc.program = [this](const MotionContext& ctx) {
            select(ctx);
            sync.PathData = select.PathData;
            sync(ctx);
        };
        select.Execute = true;
        EXPECT_TRUE(plc.until([&] { return select.Done || select.Error; }, 2000) && select.Done);
    }
    static std::vector<axes::AxisConfig> with(const axes::AxisConfig& master_axis,
                                              std::vector<axes::AxisConfig> all = PathRig::axes_of(0)) {
        all.push_back(master_axis);
        return all;
    }
    void begin() {
        sync.Execute = true;
        plc.run(8);  // the planner lays the path out
        EXPECT_TRUE(sync.Active) << static_cast<int>(sync.ErrorID);
    }
    ErrorId refused() {
        sync.Execute = false;
        plc.scan();
        sync.Execute = true;
        EXPECT_TRUE(plc.until([&] { return sync.Error || sync.InSync; }, 200));
        return sync.ErrorID;
    }
    void master_to(double position, double velocity) {
        plc.rig.step([&] {
            EXPECT_EQ(
                plc.rig.axes[3]
                    .submit({.kind = axes::CommandKind::move_absolute, .position = position, .velocity = velocity}, axes::Owner::program)
                    .error,
                ErrorId::none);
        });
    }
    void master_at(double velocity) {
        plc.rig.step([&] {
            EXPECT_EQ(plc.rig.axes[3].submit({.kind = axes::CommandKind::move_velocity, .velocity = velocity}, axes::Owner::program).error,
                      ErrorId::none);
        });
    }
    void halt_master() {
        plc.rig.step([&] { (void)plc.rig.axes[3].submit({.kind = axes::CommandKind::halt}, axes::Owner::program); });
    }
    [[nodiscard]] double at_master() const { return plc.rig.axis(3).set_position; }
    [[nodiscard]] bool master_stands() const { return plc.rig.axis(3).set_velocity == 0; }
    [[nodiscard]] gcode::Point tool() const {
        return {plc.rig.axis(0).set_position, plc.rig.axis(1).set_position, plc.rig.axis(2).set_position};
    }
    [[nodiscard]] double speed() const {
        return std::hypot(plc.rig.axis(0).set_velocity, plc.rig.axis(1).set_velocity, plc.rig.axis(2).set_velocity);
    }
    [[nodiscard]] axes::GroupState state() const { return plc.rig.view().state; }
    /// Until the members stand; how far they ever were from the line or the corner's two.
    bool comes_to_rest(int most = 2000) {
        return plc.until([&] { return speed() == 0; }, most);
    }

    static constexpr AxisRef master{3};
    GroupPlc plc;
    MC_PathSelect select;
    MC_SyncGroupToAxis sync;
};

}  // namespace taktwerk::fb
