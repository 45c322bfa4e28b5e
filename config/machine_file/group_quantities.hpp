#pragma once
// How lengths and angles of a group are written: in its own unit, and in any unit of angles as rad.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "config/reading/codecs.hpp"

namespace taktwerk::config {

/// rad, written in any unit of angles.
[[nodiscard]] inline Codec<double> angle_in_rad() {
    constexpr double degree = std::numbers::pi / 180;
    Codec<double> c = quantity(Dimension::angle);
    c.read = [read = c.read](Reader& reader, const Node& node, double& out) {
        double degrees = 0;
        if (!read(reader, node, degrees)) return false;
        if (std::abs(degrees) > 360) {
            reader.problem(node.at, "config.out_of_range",
                           "`" + reader.path() + "` is " + show_number(degrees) + " deg, more than a whole turn",
                           "write it within a turn; 90 deg are not 90 rad");
            return false;
        }
        out = degrees * degree;
        return true;
    };
    c.show = [](const double& rad) { return show_number(rad / degree) + " deg"; };
    return c;
}

/// Beyond it arms do not compute (KinematicFault::not_finite), in any unit.
inline constexpr double longest_length = 1e12;

/// Whether a length of that size means anything; else it is told.
[[nodiscard]] inline bool check_size(Reader& reader, const Node& node, double length) {
    if (std::abs(length) <= longest_length) return true;
    reader.problem(node.at, "config.out_of_range",
                   "`" + reader.path() + "` is " + show_number(length) + " " + reader.axis_unit + ", longer than anything",
                   "write it as the drawing has it, with its unit");
    return false;
}

[[nodiscard]] inline Codec<double> length_of_group() {
    Codec<double> c = quantity(Dimension::position);
    c.read = [read = c.read](Reader& reader, const Node& node, double& out) {
        return read(reader, node, out) && check_size(reader, node, out);
    };
    return c;
}

/// x to rz of six numbers that `six(T&)` gives.
template <class T, class Six>
void six_fields(std::vector<Field<T>>& into, Six six, const std::string& what) {
    constexpr const char* keys[] = {"x", "y", "z", "rx", "ry", "rz"};
    constexpr const char* turns[] = {"turned about the new X last", "then about the new Y", "first about Z"};
    for (std::size_t i = 0; i < 6; ++i) {
        const auto get = [six, i](T& object) -> double& { return six(object)[i]; };
        into.push_back(field_at<T>(keys[i], get, i < 3 ? length_of_group() : angle_in_rad(), i < 3 ? "of " + what : turns[i - 3]));
    }
}

}  // namespace taktwerk::config
