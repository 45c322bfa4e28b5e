#pragma once
// A trace as a gnuplot script that draws one SVG: per axis a band of states and panels with one time axis. The data stand in the
// script, so one file is all gnuplot needs.

#include <string>
#include <vector>

#include "apps/plot/trace_file.hpp"
#include "core/result.hpp"

namespace taktwerk::apps {

struct PlotRequest {
    std::string title;
    std::string output;                 ///< SVG file
    std::vector<std::string> axes;      ///< names; empty = all
    double from_s = 0, to_s = 0;        ///< since the start of the run; to 0 = until the end
    bool following_error = false;       ///< a panel more
    std::vector<std::string> bits{};    ///< names of BOOLs to draw below the axes; empty = all that change in the window
    std::vector<std::string> values{};  ///< names of numbers (points, variables of programs) that get a panel each
};

/// Errors: plot.unknown_axis, plot.unknown_bit, plot.unknown_value, plot.empty_window.
[[nodiscard]] Result<std::string> plot_script(const Trace& trace, const PlotRequest& request);

}  // namespace taktwerk::apps
