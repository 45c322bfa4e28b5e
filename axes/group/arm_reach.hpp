#pragma once
// Where an arm's tool comes: its point over the travels of the axes. For who checks a machine file before anything moves. Service side: allocates, some ms.
//
// Places of the axes are drawn evenly; from the outermost ones, and from those that stand nearest to a room, a search goes on to where it is outermost, or nearest.
// So a hole in the reach counts as well as what lies around it.

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "axes/group/group_config.hpp"
#include "axes/group/workspace.hpp"

namespace taktwerk::axes {

class ArmPlaces;

/// Between the software limits of an axis, in its unit. Without ends those of its joint count; a rotary one that has none there either is looked at over a turn.
struct AxisTravel {
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
};

struct ArmReach {
    std::vector<std::array<double, 3>> points{};  ///< of the tool (that of the beginning) in the machine (MCS), u; those that have a pose
    std::array<double, 3> least{}, most{};        ///< of all that the point comes to; to a thousandth of size() or so
    std::size_t looked_at = 0;  ///< places of the axes; more than points where the arm does not close or its joints end before

    [[nodiscard]] double size() const noexcept;  ///< u, from corner to corner
    /// How near the point comes to the room, u; 0: inside. Infinite without points.
    [[nodiscard]] double distance_to(const WorkspaceRoom& room) const;
    /// By more than the search may be wrong.
    [[nodiscard]] bool far_from(const WorkspaceRoom& room) const { return distance_to(room) > size() * most_error; }
    /// Nothing that the point comes to is allowed.
    [[nodiscard]] bool outside_of(const Workspace& space) const;

    [[nodiscard]] std::string shown(double length) const;  ///< to a thousandth of size(), never with an exponent
    [[nodiscard]] std::string text() const;                ///< "X -350 to 350, Y -350 to 350, Z 0 to 80"

    static constexpr double most_error = 0.002;     ///< of size()
    std::vector<std::array<double, 6>> stood_at{};  ///< for each point: its place, of the travels' shares
    std::shared_ptr<const ArmPlaces> places{};
};

/// `travels`: of the members, in their order. A beam gantry is looked at square alone. Nothing: it has no arm, fewer members than joints, or a straight axis without ends.
[[nodiscard]] std::optional<ArmReach> arm_reach(const AxisGroupConfig& group, std::span<const AxisTravel> travels);

}  // namespace taktwerk::axes
