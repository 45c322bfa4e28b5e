#pragma once
// How lengths and angles of a group are written: in its own unit, and in any unit of angles as rad.

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
        const bool good = read(reader, node, degrees);
        if (good) out = degrees * degree;
        return good;
    };
    c.show = [](const double& rad) { return show_number(rad / degree) + " deg"; };
    return c;
}

[[nodiscard]] inline Codec<double> length_of_group() { return quantity(Dimension::position); }

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
