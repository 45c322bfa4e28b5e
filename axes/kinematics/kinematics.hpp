#pragma once
// The arm of a group, held by value: from axes to the pose of its tool and back. All of it but make() is pure, re-entrant and real-time safe:
// no allocation, no lock, no exception, bounded work. docs/motion/kinematics.md shows each arm with its zero pose and its flags.
//
// Frames: poses are those of the tool's point in the machine (MCS). The tool comes with each call, as a frame seen from the flange, because
// a command keeps the one that it was given with. Axes are what drives are told, each in its own unit; joints are the arm's, in rad and the
// unit of length (axis_map.hpp).

#include <cstdint>
#include <optional>
#include <variant>

#include "axes/kinematics/description.hpp"
#include "axes/kinematics/fault.hpp"
#include "axes/kinematics/joints.hpp"
#include "axes/kinematics/six_arm.hpp"
#include "core/result.hpp"

namespace taktwerk::axes {

/// Components of a pose, in this order everywhere: x, y, z, then turns about X, Y, Z.
inline constexpr std::array<std::string_view, 6> pose_component_names{"X", "Y", "Z", "A", "B", "C"};

struct ForwardResult {
    Pose pose;
    Miss miss;
};

struct AxisSolution {
    Joints axes{};
    Configuration configuration;  ///< of rotary joints; turns of the others are 0
    Miss miss;                    ///< joint_limit: the joints are right, and one of them is outside

    [[nodiscard]] bool ok() const noexcept { return miss.ok(); }
};

/// Where the tool's point is, and how fast: velocity and angular velocity in the machine.
struct MovingPose {
    Pose pose;
    std::array<double, 6> velocity{};
    Miss miss;
};

struct AllAxisSolutions {
    std::array<AxisSolution, 8> at{};
    int count = 0;
    Miss miss;
};

/// How a pose goes on along a path, by its parameter: velocity, acceleration, jerk of the tool's point, and angular velocity with its first two
/// derivatives, all in the machine's directions.
struct PathDerivatives {
    std::array<std::array<double, 3>, 3> position{};
    std::array<std::array<double, 3>, 3> turn{};
};
/// First, second and third derivative of the axes by the same parameter; those that were not asked for are 0.
struct AxisDerivatives {
    std::array<Joints, 3> of{};
    Miss miss;
};

class Kinematics {
public:
    /// Errors: kinematics.length (one that must be above 0, or is not a number; its subject is the length's name: "scara.second"), kinematics.geometry (six axes that are no arm),
    /// kinematics.joint (sign, unit, zero or limits), kinematics.coupling (a matrix without inverse, or that couples what is no joint),
    /// kinematics.base (an orientation whose length is not 1). Not for the cycle.
    [[nodiscard]] static Result<Kinematics> make(const KinematicsDescription& description);

    [[nodiscard]] std::size_t joint_count() const noexcept { return joint_count_; }
    [[nodiscard]] const std::array<bool, max_joints>& rotary() const noexcept { return rotary_; }
    /// Which components of a pose the arm commands, in its own base.
    [[nodiscard]] std::array<bool, 6> commands() const noexcept;

    [[nodiscard]] ForwardResult forward(const Joints& axes, const Pose& tool) const noexcept;
    /// The axes nearest to `near` that reach `tool_point` and answer `wanted`, within the joints' limits. Nearest: in the sum of squares of the
    /// joints' ways, rad, lengths over the arm's reach. Where a joint is free it stays as in `near`.
    [[nodiscard]] AxisSolution inverse(const Pose& tool_point, const Pose& tool, const Configuration& wanted,
                                       const Joints& near) const noexcept;
    /// Every way, each with the turns nearest to `near`; those outside the limits too, with their miss.
    [[nodiscard]] AllAxisSolutions inverse_all(const Pose& tool_point, const Pose& tool, const Joints& near) const noexcept;

    /// Velocity and angular velocity of the tool's point, in the machine, for those of the axes. Columns of joints that there are not are 0.
    [[nodiscard]] Jacobian jacobian(const Joints& axes, const Pose& tool) const noexcept;
    /// `orders`: 1 to 3.
    [[nodiscard]] AxisDerivatives derivatives(const Joints& axes, const Pose& tool, const PathDerivatives& path,
                                              int orders = 3) const noexcept;
    /// forward(), and with it what jacobian() makes of `velocities`; in one pass.
    [[nodiscard]] MovingPose moving(const Joints& axes, const Joints& velocities, const Pose& tool) const noexcept;

    [[nodiscard]] Configuration configuration(const Joints& axes) const noexcept;
    [[nodiscard]] Singularity singularity(const Joints& axes) const noexcept;
    /// The first joint outside its limits, as a miss.
    [[nodiscard]] Miss limits_of(const Joints& axes) const noexcept;
    /// By how much the second master of a beam gantry is ahead of the first, unit of length; 0 for other arms.
    [[nodiscard]] double skew(const Joints& axes) const noexcept;

    [[nodiscard]] const AxisMap& map() const noexcept { return map_; }
    [[nodiscard]] const Pose& base() const noexcept { return base_pose_; }
    /// Which of ArmDescription's kinds it was made of: its index.
    [[nodiscard]] std::uint8_t kind() const noexcept { return kind_; }
    /// Denavit and Hartenberg's table of the nominal arm, joints as the arm counts them: as written, or what its lengths are (classic). Of six
    /// joints only.
    [[nodiscard]] const std::optional<SixJoints::Table>& rows() const noexcept { return rows_; }
    /// Is each inverse a closed form? False: Newton's method ends it.
    [[nodiscard]] bool closed_form() const noexcept;
    /// Are there axes that have no pose: rods of a delta that do not meet?
    [[nodiscard]] bool may_not_close() const noexcept;

private:
    using Arm = std::variant<Cartesian, BeamGantry, Scara, Palletizer, RotaryDelta, LinearDelta, SixArm>;

    Kinematics() = default;
    [[nodiscard]] Miss to_flange(const Pose& tool_point, const Pose& tool, Frame<double>& flange) const noexcept;
    /// Of one way of the arm: turns, limits.
    [[nodiscard]] AxisSolution placed(const ArmSolution& way, const Configuration& wanted, const Joints& near_joints) const noexcept;
    [[nodiscard]] double way_between(const Joints& a, const Joints& b) const noexcept;

    Arm arm_;
    AxisMap map_;
    Pose base_pose_;
    Frame<double> base_;
    Frame<double> to_base_;
    double reach_ = 1;
    std::size_t joint_count_ = 0;
    std::array<bool, max_joints> rotary_{};
    std::uint8_t kind_ = 0;
    std::optional<SixJoints::Table> rows_;
};

}  // namespace taktwerk::axes
