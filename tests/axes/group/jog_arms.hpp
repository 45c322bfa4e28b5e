#pragma once
// One arm of each kind with its axes and a place from where it can be jogged. Lengths in mm, turning axes in degrees.

#include <numbers>
#include <string>
#include <vector>

#include "tests/axes/group/jog_rig.hpp"

namespace taktwerk::axes::test {

struct JogArm {
    std::string name;
    KinematicsDescription description;
    std::vector<bool> turning;  ///< of the members
    JointVector start{};
    bool askew = false;  ///< members 1 and 2 only together
};

inline constexpr double one_degree = std::numbers::pi / 180;

inline KinematicsDescription in_degrees(KinematicsDescription description, const std::vector<bool>& turning) {
    for (std::size_t i = 0; i < turning.size(); ++i)
        if (turning[i]) description.joints[i].unit = one_degree;
    return description;
}
inline JogArm arm_in_degrees(const std::string& name, ArmDescription arm, const std::vector<bool>& turning, const JointVector& start) {
    return {name, in_degrees({.arm = std::move(arm)}, turning), turning, start};
}

inline std::vector<JogArm> every_kind_of_arm() {
    std::vector<JogArm> arms;
    arms.push_back(arm_in_degrees("cartesian", CartesianAxes{.turn_about = 2}, {false, false, false, true}, {10, 20, 30, 15}));
    arms.push_back(arm_in_degrees("core_xy", CoreXyAxes{.lift = true}, {false, false, false}, {50, 10, 5}));
    arms.push_back(arm_in_degrees("beam_gantry", BeamGantryShape{.span = 800, .turns = true}, {false, false, false, false, true},
                                  {20, 20, 30, 40, 0}));
    arms.back().askew = true;
    arms.push_back(arm_in_degrees("scara", ScaraLengths{.first = 200, .second = 150}, {true, true, false, true}, {-30, 80, 0, 0}));
    arms.push_back(arm_in_degrees("palletizer",
                                  PalletizerLengths{.shoulder = 150, .height = 400, .upper = 600, .fore = 600, .wrist = 100, .drop = 50},
                                  {true, true, true, true}, {20, 10, 20, 0}));
    arms.push_back(arm_in_degrees("rotary_delta", RotaryDeltaLengths{.base_radius = 100, .platform_radius = 40, .upper = 150, .rod = 350},
                                  {true, true, true}, {20, 20, 20}));
    arms.push_back(arm_in_degrees("linear_delta", LinearDeltaLengths{.base_radius = 200, .platform_radius = 40, .rod = 300},
                                  {false, false, false}, {100, 100, 100}));
    // ABB, product specification IRB 120 (3HAC035960).
    const std::vector<bool> six(6, true);
    JogArm wrist =
        arm_in_degrees("six_with_wrist", SixJoints{.geometry = WristArmLengths{.a2 = -70, .c1 = 290, .c2 = 270, .c3 = 302, .c4 = 72}}, six,
                       {10, 15, 10, 20, 40, 10});
    wrist.description.joints[2].zero = std::numbers::pi / 2;
    arms.push_back(wrist);
    // Universal Robots, UR5e, DH parameters in mm: a, alpha, d, theta.
    constexpr double right = std::numbers::pi / 2;
    const SixJoints::Table ur{
        {{{0, right, 162.5, 0}, {-425, 0, 0, 0}, {-392.2, 0, 0, 0}, {0, right, 133.3, 0}, {0, -right, 99.7, 0}, {0, 0, 99.6, 0}}}};
    arms.push_back(arm_in_degrees("six_without_wrist", SixJoints{.geometry = ur}, six, {20, -80, 80, -60, -70, 10}));
    return arms;
}

/// Turning members: 90 degrees/s, 900, 18000; others 200 u/s, 2000, 40000. All of them may go by 150 from the place where they were homed.
inline std::vector<AxisConfig> axes_of(const JogArm& arm) {
    std::vector<AxisConfig> axes;
    for (std::size_t i = 0; i < arm.turning.size(); ++i) {
        AxisLimits limits{.velocity = 200, .acceleration = 2000, .deceleration = 2000, .jerk = 40000};
        if (arm.turning[i]) limits = {.velocity = 90, .acceleration = 900, .deceleration = 900, .jerk = 18000};
        limits.position_min = -150;
        limits.position_max = 150;
        auto axis = group_axis("a" + std::to_string(i + 1), limits);
        axis.homing.kind = HomingKind::set_here;
        axes.push_back(axis);
    }
    return axes;
}

/// The tool at 100 u/s, members at most at 40 u/s; half of what the members can do in acceleration.
inline JoggingDynamics jogging_of_arms() {
    JoggingDynamics d{.path = {100, 500, 800, 20000}};
    d.velocity.fill(40);
    d.acceleration.fill(300);
    d.deceleration.fill(450);
    d.jerk.fill(9000);
    return d;
}

}  // namespace taktwerk::axes::test
