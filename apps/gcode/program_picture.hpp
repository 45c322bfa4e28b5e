#pragma once
// A program's path as gnuplot's script for one SVG: XY above, XZ below; X and Y have one scale, Z too where that shows something. Rapids are dashed.

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "fb_library/gcode/program_summary.hpp"

namespace taktwerk::apps {

using PathPoint = std::array<double, 3>;  ///< mm

/// The path in points that lie no further apart than a pixel needs, in runs without gaps. Bounded: 2,000,000 points.
class ProgramPath {
public:
    /// `size`: the longest side of what will be shown [mm]; finer than a three-thousandth of it nothing is kept.
    explicit ProgramPath(double size) : finest_(size / 3000) {}

    void add(const gcode::Move& move);

    struct Run {
        bool rapid = false;
        std::vector<PathPoint> points;
    };
    [[nodiscard]] const std::vector<Run>& runs() const noexcept { return runs_; }
    /// Whether there was more than fits.
    [[nodiscard]] bool cut_off() const noexcept { return cut_off_; }

private:
    void put(const PathPoint& point, bool last);

    double finest_;
    std::vector<Run> runs_;
    PathPoint end_{};
    std::size_t points_ = 0;
    bool pending_ = false, cut_off_ = false;
};

struct PictureWords {
    std::string title, output;  ///< any bytes
};

/// Errors: gcode.nothing_to_draw.
[[nodiscard]] Result<std::string> program_picture(const gcode::ProgramSummary& summary, const ProgramPath& path, const PictureWords& words);

}  // namespace taktwerk::apps
