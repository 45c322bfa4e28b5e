#pragma once
// How the tool's point moves at an instant, and how a frame that moves carries it. Pure, real-time safe. For this room: it includes Eigen.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "axes/group/frame_track.hpp"
#include "axes/kinematics/kinematics.hpp"
#include "axes/planner/motion.hpp"

namespace taktwerk::axes {

/// Everything seen from the machine: u, u/s, u/s2, rad/s, rad/s2.
struct ToolMotion {
    Eigen::Vector3d position = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero(), acceleration = Eigen::Vector3d::Zero();
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
    Eigen::Vector3d turning = Eigen::Vector3d::Zero(), turning_faster = Eigen::Vector3d::Zero();
    Configuration configuration{};  ///< of the arm
    Pose tool{};                    ///< its point, seen from the flange
};

/// A frame that goes along a line or turns about one: one number says where it is.
struct Conveyance {
    bool turns = false;
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< of length 1, seen from the machine
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double angle = 0;  ///< rad per u of its axis; where it turns
};
/// `machine`: seen from the world. `turn`: u of the axis in a turn of the table.
[[nodiscard]] Conveyance conveyance_of(const FrameTrack& track, const Pose& machine, double turn) noexcept;

/// What it moves on the frame at rest, while that has gone `way` and goes on as it says.
[[nodiscard]] ToolMotion carried_by(const Conveyance& frame, const MotionState& way, const ToolMotion& still) noexcept;

/// By the way of the frame alone: velocity and angular velocity of a point there, per u/s of the axis.
[[nodiscard]] PathDerivatives drag_at(const Conveyance& frame, const Eigen::Vector3d& point) noexcept;

}  // namespace taktwerk::axes
