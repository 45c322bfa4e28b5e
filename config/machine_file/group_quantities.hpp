#pragma once
// How lengths and angles of a group are written: in its own unit, and in any unit of angles as rad.

#include <numbers>

#include "config/reading/codecs.hpp"

namespace taktwerk::config {

/// rad, written in any unit of angles.
[[nodiscard]] inline Codec<double> angle_in_rad() {
    constexpr double degree = std::numbers::pi / 180;
    Codec<double> c = quantity(Dimension::angle);
    c.read = [read = c.read](Reader& reader, const Node& node, double& out) {
        double degrees = 0;
        const bool good = read(reader, node, degrees);
        if (good) out = degrees * degree;
        return good;
    };
    c.show = [](const double& rad) { return show_number(rad / degree) + " deg"; };
    return c;
}

[[nodiscard]] inline Codec<double> length_of_group() { return quantity(Dimension::position); }

}  // namespace taktwerk::config
