#pragma once
// The curve that leaves one element before a corner and joins the next behind it. It depends on the geometry alone: no velocity, no limit,
// no override bends a path.

#include <cstdint>
#include <optional>

#include "axes/path/path_element.hpp"

namespace taktwerk::axes {

enum class BlendRule : std::uint8_t {
    none,              ///< to the corner
    corner_distance,   ///< leaves and joins at this length from the corner
    corner_deviation,  ///< passes the corner at this distance at most (exactly, between straight lines that are long enough)
};

struct BlendRequest {
    BlendRule rule = BlendRule::none;
    double parameter = 0;  ///< u of the path's metric, >= 0
    double share = 0.5;    ///< of each element, that it may take at most
};

struct Blend {
    PathElement curve;
    double before = 0;     ///< length cut off the end of the first element
    double behind = 0;     ///< and off the beginning of the second
    double deviation = 0;  ///< distance of the curve from the corner, at its middle
};

/// What is left of the elements for the blend: of the first from `room_before` before its end, of the second up to `room_behind` behind its
/// beginning (half of each where both of its ends are blended). A larger request is cut to that. Both in one chart: the first one's end is the
/// second one's beginning. Nothing where no curve can be passed: no room, a rule of none, a
/// reversal. Not real-time safe by time alone: up to forty curves are tried.
[[nodiscard]] std::optional<Blend> blend(const PathElement& first, const PathElement& second, const BlendRequest& request,
                                         double room_before, double room_behind) noexcept;

/// Whether the elements meet so that they can be passed without a curve: tangent and curvature agree.
[[nodiscard]] bool meet_smoothly(const PathElement& first, const PathElement& second) noexcept;

}  // namespace taktwerk::axes
