#pragma once
// What an arm is, as a file or a test says it. Plain data; lengths in the machine's unit of length, angles in rad.

#include <array>
#include <string_view>
#include <variant>

#include "axes/kinematics/axis_map.hpp"
#include "axes/kinematics/chain_tables.hpp"
#include "axes/kinematics/delta_arms.hpp"
#include "axes/kinematics/planar_arms.hpp"
#include "axes/kinematics/straight_arms.hpp"
#include "axes/pose.hpp"

namespace taktwerk::axes {

/// CoreXY and H-bot: both motors of one belt move X and Y together, the first by x + y, the second by x - y. Otherwise as CartesianAxes.
struct CoreXyAxes {
    bool lift = false;   ///< a third joint Z
    bool turns = false;  ///< a last joint C
};

/// Six joints by lengths or by a table; how this arm deviates from it.
struct SixJoints {
    struct Table {
        DhTable rows;
        DhConvention convention = DhConvention::classic;
    };
    std::variant<WristArmLengths, Table> geometry;
    LinkDeviations deviations{};
};

using ArmDescription = std::variant<CartesianAxes, BeamGantryShape, CoreXyAxes, ScaraLengths, PalletizerLengths, RotaryDeltaLengths,
                                    LinearDeltaLengths, SixJoints>;

/// As messages name it: "scara".
[[nodiscard]] std::string_view kind_of(const ArmDescription& arm) noexcept;

struct KinematicsDescription {
    ArmDescription arm{};
    Pose base{};  ///< the arm's base, seen from the machine (MCS)
    std::array<JointSettings, max_joints> joints{};
    Coupling coupling = uncoupled;  ///< CoreXY's belt is known by itself and comes on top
};

}  // namespace taktwerk::axes
