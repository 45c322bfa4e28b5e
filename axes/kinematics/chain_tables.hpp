#pragma once
// How the geometry of a six-joint arm is written down, and what chain that is. Lengths in the machine's unit, angles in rad.

#include <array>

#include "axes/kinematics/chain.hpp"

namespace taktwerk::axes {

/// An arm with a shoulder that is orthogonal or parallel and a spherical wrist, by seven lengths (Brandstoetter, Angerer, Hofbaur: An analytical
/// solution of the inverse kinematics problem of industrial serial manipulators with an ortho-parallel basis and a spherical wrist, 2014).
/// With all joints at 0 it stands straight up, x to the front: joint 1 turns about z, 2 and 3 about y (forward is positive), 4 about z,
/// 5 about y, 6 about z; the flange has the orientation of the base.
struct WristArmLengths {
    double a1 = 0;  ///< axis 1 to axis 2, forward
    double a2 = 0;  ///< axis 3 to the wrist's centre, forward; negative where the forearm's axis runs above axis 3 when it is level
    double b = 0;   ///< axis 1 to the wrist's centre, to the left (y)
    double c1 = 0;  ///< base to axis 2, up
    double c2 = 0;  ///< axis 2 to axis 3
    double c3 = 0;  ///< axis 3 to the wrist's centre, up
    double c4 = 0;  ///< the wrist's centre to the flange
};

/// One row of Denavit and Hartenberg.
struct DhRow {
    double a = 0;
    double alpha = 0;
    double d = 0;
    double theta = 0;  ///< of the joint at 0
};
using DhTable = std::array<DhRow, 6>;

/// Denavit and Hartenberg's two conventions.
enum class DhConvention : std::uint8_t {
    classic,   ///< Rz(theta + q) Tz(d) Tx(a) Rx(alpha): as Universal Robots publish theirs
    modified,  ///< Craig: Rx(alpha) Tx(a) Rz(theta + q) Tz(d), a and alpha of the link before the joint
};

/// How far a real link is from the written one, as calibration finds it: applied behind joint i's link, in the next joint's frame, first the
/// shift, then turns about x, y, z. Small; the turn about z of a frame is the zero offset of the joint that follows.
struct LinkDeviation {
    std::array<double, 3> shift{};
    std::array<double, 3> turn{};

    friend bool operator==(const LinkDeviation&, const LinkDeviation&) = default;
};
using LinkDeviations = std::array<LinkDeviation, 6>;

[[nodiscard]] JointChain chain_of(const WristArmLengths& lengths) noexcept;
[[nodiscard]] JointChain chain_of(const DhTable& table, DhConvention convention) noexcept;
/// The same chain in the classic convention.
[[nodiscard]] DhTable table_of(const WristArmLengths& lengths) noexcept;
[[nodiscard]] JointChain deviated(const JointChain& chain, const LinkDeviations& by) noexcept;

}  // namespace taktwerk::axes
