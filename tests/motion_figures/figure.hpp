#pragma once
// A run of blocks on axes as a picture: curves over time, the state, and the blocks' outputs as bars below. Pure: the same run gives
// the same text.

#include <array>
#include <string>
#include <vector>

namespace taktwerk::figures {

enum class Ink {
    owner,   ///< each part in the colour of the block that controls the axis there
    master,  ///< grey: what is followed
    actual,  ///< wide and pale, below the others
    plain,
};

struct Curve {
    std::string label;  ///< at its end; empty = none
    Ink ink = Ink::owner;
    std::vector<double> values;  ///< one a sample
};

struct Panel {
    std::string quantity, unit;
    double height = 90;  ///< pixels
    std::vector<Curve> curves;
};

/// A BOOL over time, TRUE as a bar. Those that are never TRUE are left out.
struct Trace {
    std::string label;
    int block = 0;  ///< whose colour; the order in which blocks were named; -1 = grey
    std::vector<bool> on;
};

struct Figure {
    std::string name;                        ///< of its file, without .svg
    double period = 0.001;                   ///< s between samples
    std::vector<int> owner;                  ///< one a sample: the block that controls the first axis, -1 = none
    std::vector<std::string> state;          ///< one a sample, of the first axis
    std::vector<std::array<double, 2>> way;  ///< one a sample, or none: of a tool, from above, mm, each part in the colour of its block
    double way_height = 0;                   ///< pixels
    std::vector<Panel> panels;
    std::vector<Trace> traces;
};

[[nodiscard]] std::string svg(const Figure& figure);

/// The fewest of the samples that stay within `tolerance` of all of them: indices, first and last among them (Douglas and Peucker).
/// x is the index times `dx`.
[[nodiscard]] std::vector<std::size_t> simplified(const std::vector<double>& y, double dx, double tolerance);
/// The same of points in a plane.
[[nodiscard]] std::vector<std::size_t> simplified(const std::vector<std::array<double, 2>>& points, double tolerance);

}  // namespace taktwerk::figures
