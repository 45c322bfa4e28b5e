#pragma once
// The way of a group's tool as gnuplot's script for one SVG: XY and XZ to one scale, set and actual; below them over time the speed, and how much of its limits
// each axis uses, so that is seen which axis holds the path back where.

#include <string>

#include "apps/plot/trace_file.hpp"
#include "core/result.hpp"

namespace taktwerk::apps {

struct PathRequest {
    std::string title, output;    ///< any bytes; output: SVG file
    std::string group;            ///< its name in the machine file
    double from_s = 0, to_s = 0;  ///< as of PlotRequest
};

/// Errors: plot.unknown_group, plot.no_tool (it has no arm, or no place of it is known in the window), plot.empty_window.
[[nodiscard]] Result<std::string> path_script(const Trace& trace, const PathRequest& request);

}  // namespace taktwerk::apps
