#pragma once
// Arms as their makers (or who measured them) publish them, in metres and in the makers' sense and zero of each joint. Facts with their source.

#include <numbers>
#include <string>
#include <vector>

#include "axes/kinematics/kinematics.hpp"

namespace taktwerk::axes {

inline constexpr double degree = std::numbers::pi / 180;
inline constexpr double right = std::numbers::pi / 2;

struct PublishedArm {
    std::string name;
    KinematicsDescription description;
    Joints low{}, high{};  ///< where cases are drawn: axes
    bool closed_form = true;
};

inline Joints all_joints(double value) { return {value, value, value, value, value, value}; }
inline Joints degrees(Joints q) {
    for (double& v : q) v *= degree;
    return q;
}

inline KinematicsDescription with_wrist(const WristArmLengths& lengths, const Joints& signs, const Joints& zeros) {
    KinematicsDescription d{.arm = SixJoints{.geometry = lengths}};
    for (std::size_t i = 0; i < 6; ++i) {
        d.joints[i].sign = signs[i];
        d.joints[i].zero = zeros[i];
    }
    return d;
}

// ABB, product specification IRB 120 (3HAC035960): 290, 270, 70, 302, 72 mm; at 0 the forearm is level.
inline PublishedArm irb_120() {
    return {"ABB IRB 120",
            with_wrist({.a2 = -.070, .c1 = .290, .c2 = .270, .c3 = .302, .c4 = .072}, all_joints(1), degrees({0, 0, 90, 0, 0, 0})),
            all_joints(-std::numbers::pi), all_joints(std::numbers::pi)};
}
// ABB, data sheet IRB 140: 352, 70, 360, 380, 65 mm.
inline PublishedArm irb_140() {
    return {"ABB IRB 140",
            with_wrist({.a1 = .070, .c1 = .352, .c2 = .360, .c3 = .380, .c4 = .065}, all_joints(1), degrees({0, 0, 90, 0, 0, 0})),
            all_joints(-std::numbers::pi), all_joints(std::numbers::pi)};
}
// ABB IRB 2400/10: 615, 100, 705, 135, 755, 85 mm.
inline PublishedArm irb_2400() {
    return {
        "ABB IRB 2400",
        with_wrist({.a1 = .100, .a2 = -.135, .c1 = .615, .c2 = .705, .c3 = .755, .c4 = .085}, all_joints(1), degrees({0, 0, 90, 0, 0, 0})),
        all_joints(-std::numbers::pi), all_joints(std::numbers::pi)};
}
// KUKA, KR 6 R900 sixx, specification: 400, 25, 455, 35, 420, 80 mm; at 0 the arm lies level to the front, and axes 1, 4 and 6 count clockwise.
inline PublishedArm kr6_r900() {
    return {"KUKA KR 6 R900",
            with_wrist({.a1 = .025, .a2 = -.035, .c1 = .400, .c2 = .455, .c3 = .420, .c4 = .080}, {-1, 1, 1, -1, 1, -1},
                       degrees({0, 90, 0, 0, 0, 0})),
            all_joints(-std::numbers::pi), all_joints(std::numbers::pi)};
}
// Staubli TX40: 320, 225, 225, 65 mm, the arm 35 mm beside axis 1.
inline PublishedArm tx40() {
    return {"Staubli TX40", with_wrist({.b = .035, .c1 = .320, .c2 = .225, .c3 = .225, .c4 = .065}, all_joints(1), all_joints(0)),
            all_joints(-std::numbers::pi), all_joints(std::numbers::pi)};
}
// Universal Robots, "DH parameters for calculations of kinematics and dynamics", UR5e (classic convention).
inline SixJoints::Table ur5e_table() {
    return {{{{0, right, .1625, 0}, {-.425, 0, 0, 0}, {-.3922, 0, 0, 0}, {0, right, .1333, 0}, {0, -right, .0997, 0}, {0, 0, .0996, 0}}},
            DhConvention::classic};
}
inline PublishedArm ur5e() {
    return {
        "Universal Robots UR5e", {.arm = SixJoints{.geometry = ur5e_table()}}, all_joints(-std::numbers::pi), all_joints(std::numbers::pi)};
}
// Abbes, Poisson: Geometric approach for inverse kinematics of the FANUC CRX collaborative robot, Robotics 2024, 13, 91, table 2 (modified
// convention). Axis 5 passes axis 4 at 150 mm: no closed form. Joint 3 of the table is the sum of the maker's J2 and J3.
inline PublishedArm crx_10ia() {
    const SixJoints::Table table{{{{0, 0, 0, 0},
                                   {0, -right, 0, -right},
                                   {.540, 2 * right, 0, 0},
                                   {0, -right, -.540, 0},
                                   {0, right, .150, 0},
                                   {0, -right, -.160, 0}}},
                                 DhConvention::modified};
    PublishedArm arm{"FANUC CRX-10iA", {.arm = SixJoints{.geometry = table}}, all_joints(-std::numbers::pi), all_joints(std::numbers::pi)};
    arm.description.coupling[2][1] = -1;
    arm.closed_form = false;
    return arm;
}
// Epson, G10 series manual: arm 2 is 400 mm long; type 650, so arm 1 is 250 mm. Joint 1 at 0 faces +X, joint 2 at 0 is in line, both positive
// counter-clockwise; joint 3 is 0 at the top and negative below. +-152, +-152.5 degrees, 180 mm, +-360 degrees.
inline PublishedArm epson_g10() {
    return {"Epson G10-650",
            {.arm = ScaraLengths{.first = .250, .second = .400}},
            {-152 * degree, -152.5 * degree, -.180, -360 * degree, 0, 0},
            {152 * degree, 152.5 * degree, 0, 360 * degree, 0, 0}};
}
// ABB IRB 460 (palletizer): 745, 260, 945, 1025, 225, 251.5 mm.
inline PublishedArm irb_460() {
    return {"ABB IRB 460",
            {.arm = PalletizerLengths{.shoulder = .260, .height = .745, .upper = .945, .fore = 1.025, .wrist = .225, .drop = .2515}},
            {-165 * degree, -40 * degree, -20 * degree, -300 * degree, 0, 0},
            {165 * degree, 85 * degree, 120 * degree, 300 * degree, 0, 0}};
}
// ABB FlexPicker, as those who drive one measured it: 200, 52, 354.5, 800 mm; upper arms -40 to 100 degrees.
inline PublishedArm flexpicker() {
    return {"ABB FlexPicker",
            {.arm = RotaryDeltaLengths{.base_radius = .200, .platform_radius = .052, .upper = .3545, .rod = .800, .turns = true}},
            {-40 * degree, -40 * degree, -40 * degree, -180 * degree, 0, 0},
            {80 * degree, 80 * degree, 80 * degree, 180 * degree, 0, 0}};
}
// SeeMeCNC's linear delta (Smoothieware's file for it): rods of 269 mm; 199 mm to the towers, 37.5 mm to the carriage's joint, 33 mm platform.
inline PublishedArm linear_delta() {
    return {"SeeMeCNC linear delta",
            {.arm = LinearDeltaLengths{.base_radius = .1615, .platform_radius = .033, .rod = .269, .first_arm_at = 210 * degree}},
            {.2, .2, .2, 0, 0, 0},
            {.35, .35, .35, 0, 0, 0}};
}
inline PublishedArm cartesian() {
    return {"Cartesian X Y Z C", {.arm = CartesianAxes{.turn_about = 2}}, {-1, -2, -.5, -3, 0, 0}, {1, 2, .5, 3, 0, 0}};
}
inline PublishedArm core_xy() { return {"CoreXY Z", {.arm = CoreXyAxes{.lift = true}}, {-1, -1, -1, 0, 0, 0}, {1, 1, 1, 0, 0, 0}}; }
inline PublishedArm beam_gantry() {
    return {"Gantry X1 X2 Y Z C", {.arm = BeamGantryShape{.span = 2.4, .turns = true}}, {0, 0, 0, -1, -3, 0}, {4, 4, 2.4, 0, 3, 0}};
}

/// The IRB 120 and the UR5e as calibration may find one: tenths of a millimetre and of a degree. Values drawn once by hand.
inline LinkDeviations found_by_calibration() {
    return {{{{.0003, -.0002, .0001}, {.0015, -.0008, .0011}},
             {{-.0001, .0004, .0002}, {-.0021, .0013, -.0009}},
             {{.0002, .0001, -.0003}, {.0007, .0018, -.0016}},
             {{-.0004, .0002, .0001}, {-.0012, -.0006, .0022}},
             {{.0001, -.0003, .0002}, {.0009, .0014, .0005}},
             {{.0002, .0003, -.0001}, {-.0005, .0011, -.0017}}}};
}
inline PublishedArm calibrated(PublishedArm arm) {
    arm.name += ", calibrated";
    arm.closed_form = false;
    std::get<SixJoints>(arm.description.arm).deviations = found_by_calibration();
    return arm;
}

inline std::vector<PublishedArm> published_arms() {
    return {irb_120(),          irb_140(),    irb_2400(),  kr6_r900(), tx40(),       ur5e(),         calibrated(irb_120()),
            calibrated(ur5e()), crx_10ia(),   epson_g10(), irb_460(),  flexpicker(), linear_delta(), cartesian(),
            core_xy(),          beam_gantry()};
}

inline Kinematics made(const PublishedArm& arm) { return Kinematics::make(arm.description).value(); }

}  // namespace taktwerk::axes
