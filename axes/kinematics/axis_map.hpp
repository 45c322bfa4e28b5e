#pragma once
// Between the axes of a group, as the drives have them, and the joints of its arm: sense, zero, unit, and gears in which a motor moves more
// than its own joint. Pure, real-time safe.

#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "axes/kinematics/joints.hpp"

namespace taktwerk::axes {

using JointMatrix = Eigen::Matrix<double, 6, 6>;
/// Row i: how far axis i moves for one unit (rad, length) of each joint. Identity: each axis is a joint.
using Coupling = std::array<std::array<double, max_joints>, max_joints>;
inline constexpr Coupling uncoupled{
    {{1, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0}, {0, 0, 0, 1, 0, 0}, {0, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 0, 1}}};

/// How a joint is counted by those who move it. The arm's own angle is sign * joint + zero.
struct JointSettings {
    double sign = 1;  ///< 1, or -1 where the maker counts the other way than the arm's picture
    double zero =
        0;  ///< the arm's own angle (rad) or way (length) where the joint says 0: the maker's zero pose and what calibration found
    double unit = 1;                                        ///< the axis' unit in rad or in the unit of length: pi / 180 for degrees
    double low = -std::numeric_limits<double>::infinity();  ///< of the joint, rad or length; beyond a turn: then the turn counts
    double high = std::numeric_limits<double>::infinity();

    friend bool operator==(const JointSettings&, const JointSettings&) = default;
};

/// axes = coupling * joints, each in its own unit.
class AxisMap {
public:
    AxisMap() noexcept : AxisMap{{}, uncoupled} {}
    /// Where `coupling` cannot be inverted the map is not sound.
    AxisMap(const std::array<JointSettings, max_joints>& joints, const Coupling& coupling) noexcept;

    [[nodiscard]] bool sound() const noexcept { return sound_; }
    [[nodiscard]] Joints joints_of(const Joints& axes) const noexcept { return plain_ ? axes : times(to_joints_, axes); }
    [[nodiscard]] Joints axes_of(const Joints& joints) const noexcept { return plain_ ? joints : times(to_axes_, joints); }
    /// Velocities of joints for those of axes, and back.
    [[nodiscard]] const JointMatrix& to_joints() const noexcept { return to_joints_; }
    [[nodiscard]] const JointMatrix& to_axes() const noexcept { return to_axes_; }

    [[nodiscard]] Joints arm_of(const Joints& joints) const noexcept;
    [[nodiscard]] Joints joints_of_arm(const Joints& arm) const noexcept;
    [[nodiscard]] const JointSettings& settings(std::size_t joint) const noexcept { return settings_[joint]; }

private:
    [[nodiscard]] static Joints times(const JointMatrix& m, const Joints& v) noexcept;

    std::array<JointSettings, max_joints> settings_;
    JointMatrix to_axes_;
    JointMatrix to_joints_;
    bool sound_ = true;
    bool plain_ = false;  ///< each axis is a joint, in its unit
};

}  // namespace taktwerk::axes
