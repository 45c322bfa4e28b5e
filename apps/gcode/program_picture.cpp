#include "apps/gcode/program_picture.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <fmt/format.h>

#include "apps/plot/gnuplot.hpp"
#include "apps/plot/plot_data.hpp"

namespace taktwerk::apps {
namespace {

constexpr std::size_t most_points = 2'000'000;

// Pixels.
constexpr double picture_width = 1000, left_margin = 84, right_margin = 20, heading = 64, footing = 50, between = 46;
constexpr double panel_width = picture_width - left_margin - right_margin;
constexpr double highest_plan = 720, lowest_plan = 90, highest_side = 320, lowest_side = 70, stretched_side = 160;

PathPoint position_of(const gcode::AxisValues& at) { return {at[0], at[1], at[2]}; }
double apart(const PathPoint& a, const PathPoint& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// A range around a middle.
struct Side {
    double low, high;
};
Side around(const gcode::Extent& extent, double width) {
    const double middle = (extent.least + extent.most) / 2;
    return {middle - width / 2, middle + width / 2};
}

class PictureScript {
public:
    explicit PictureScript(double height) : height_(height) {}

    template <class... Args>
    void line(fmt::format_string<Args...> format, Args&&... args) {
        fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
        text += '\n';
    }
    double x(double pixels) const { return pixels / picture_width; }
    double y(double pixels) const { return 1 - pixels / height_; }
    void label(double px, double py, std::string_view what, std::string_view align, int size, std::string_view colour) {
        line("set label {} at screen {:.6f}, screen {:.6f} {} font \",{}\" tc rgb \"{}\" noenhanced front", in_gnuplot_quotes(what), x(px),
             y(py), align, size, colour);
    }
    void tics(const char* axis, const Side& side, std::size_t most) {
        const auto t = ticks(side.low, side.high, most);
        std::string list;
        for (const double at : t.at)
            if (at >= side.low && at <= side.high)
                list += fmt::format("{}{} {:.9g}", list.empty() ? "" : ", ", in_gnuplot_quotes(tick_text(at, t.step)), at);
        line("set {}tics ({}) scale 0.3 nomirror", axis, list);
    }
    void panel(double top, double panel_height, const Side& across, const Side& up, const char* up_name, const char* columns) {
        line("unset label; unset xtics; unset ytics");
        line("set lmargin at screen {:.6f}; set rmargin at screen {:.6f}; set tmargin at screen {:.6f}; set bmargin at screen {:.6f}",
             x(left_margin), x(picture_width - right_margin), y(top), y(top + panel_height));
        line("set xrange [{:.9g}:{:.9g}]; set yrange [{:.9g}:{:.9g}]", across.low, across.high, up.low, up.high);
        tics("x", across, 12), tics("y", up, panel_height > 200 ? 10 : 5);
        label(12, top + panel_height / 2, up_name, "left", 11, "#202020");
        line(
            "plot $rapids using {0} with lines lw 1 lc rgb \"#b08a5a\" dt (5,4) notitle, $cuts using {0} with lines lw 1.4 lc rgb "
            "\"#14507f\" notitle, "
            "$start using {0} with points pt 7 ps 0.6 lc rgb \"#2f8f5b\" notitle",
            columns);
    }

    std::string text;

private:
    double height_;
};

}  // namespace

void ProgramPath::put(const PathPoint& point, bool last) {
    auto& points = runs_.back().points;
    if (!last && apart(points.back(), point) < finest_) {
        pending_ = true, end_ = point;
        return;
    }
    if (points_ >= most_points) {
        cut_off_ = true;
        return;
    }
    if (points.back() != point) points.push_back(point), ++points_;
    pending_ = false, end_ = point;
}

void ProgramPath::add(const gcode::Move& move) {
    const bool rapid = move.feed.kind == gcode::Feed::Kind::rapid;
    const auto from = position_of(move.from);
    if (runs_.empty() || runs_.back().rapid != rapid || end_ != from) {
        if (!runs_.empty() && pending_) put(end_, true);
        if (points_ >= most_points) {
            cut_off_ = true;
            return;
        }
        runs_.push_back({rapid, {from}});
        ++points_, pending_ = false, end_ = from;
    }
    if (move.kind == gcode::Move::Kind::arc) {
        // As many chords as look like the circle, and at least twelve a turn.
        const auto first = (move.normal + 1u) % 3, second = (move.normal + 2u) % 3;
        const double radius = std::hypot(move.from[first] - move.centre[first], move.from[second] - move.centre[second]);
        const double sagitta = finest_ / 10;
        const double step = sagitta < radius / 30 ? std::max(2 * std::acos(1 - sagitta / radius), 0.005) : std::numbers::pi / 6;
        const auto chords = static_cast<std::size_t>(std::ceil(std::fabs(move.angle) / step));
        for (std::size_t i = 1; i < chords && !cut_off_; ++i)
            put(position_of(gcode::point_of(move, static_cast<double>(i) / static_cast<double>(chords))), false);
    }
    put(position_of(move.to), false);
    end_ = position_of(move.to);
}

Result<std::string> program_picture(const gcode::ProgramSummary& summary, const ProgramPath& path, const PictureWords& words) {
    if (path.runs().empty())
        return Error{"gcode.nothing_to_draw", words.title, "the program has no move", "Check whether it is the file that was meant."};
    const auto& extents = summary.extents();
    const auto size_of = [](const gcode::Extent& extent) { return extent.most - extent.least; };
    // mm per pixel, with a margin of a twentieth. Z has the same scale as long as that is a picture of it: a retract of 100 mm shall not make a dot of a small part.
    const double mm = 1.05 * std::max({size_of(extents[0]) / panel_width, size_of(extents[1]) / highest_plan,
                                       size_of(extents[2]) / 50 / highest_side, 1e-6});
    const double plan = std::clamp(1.05 * size_of(extents[1]) / mm, lowest_plan, highest_plan);
    const double true_side = 1.05 * size_of(extents[2]) / mm;
    const bool scaled = size_of(extents[2]) > 0 && (true_side > highest_side || true_side < lowest_side / 2);
    const double side = scaled ? stretched_side : std::clamp(true_side, lowest_side, highest_side);
    const double side_mm = scaled ? 1.05 * size_of(extents[2]) / stretched_side : mm;
    const double height = heading + plan + between + side + footing;

    PictureScript script(height);
    script.line("set terminal svg size {:.0f},{:.0f} dynamic enhanced font \"DejaVu Sans,10\" background rgb \"#ffffff\"", picture_width,
                height);
    script.line("set output {}", gnuplot_file(words.output));
    for (const bool rapid : {true, false}) {
        script.line("{} << EOD", rapid ? "$rapids" : "$cuts");
        bool any = false;
        for (const auto& run : path.runs()) {
            if (run.rapid != rapid || run.points.size() < 2) continue;
            for (const auto& point : run.points) script.line("{:.9g} {:.9g} {:.9g}", point[0], point[1], point[2]);
            script.line("");
            any = true;
        }
        if (!any) script.line("NaN NaN NaN");
        script.line("EOD");
    }
    const auto& start = path.runs().front().points.front();
    script.line("$start << EOD\n{:.9g} {:.9g} {:.9g}\nEOD", start[0], start[1], start[2]);
    script.line(
        "set encoding utf8; set multiplot; set border 3 lc rgb \"#909090\"; set grid lc rgb \"#e4e4e4\" lt 1 lw 0.7; set tics font \",9\" "
        "tc rgb \"#404040\"");
    const auto across = around(extents[0], panel_width * mm);
    script.panel(heading, plan, across, around(extents[1], plan * mm), "Y", "1:2");
    const double below = heading + plan + between;
    script.panel(below, side, across, around(extents[2], side * side_mm), scaled ? "Z *" : "Z", "1:3");
    script.line("unset label; unset xtics; unset ytics; unset border; unset grid; set yrange [0:1]");
    script.label(left_margin, 22, words.title, "left", 16, "#101010");
    script.label(left_margin, 44,
                 fmt::format("{} moves; mm, machine coordinates; dashed: rapids; the point: its start{}{}", summary.moves(),
                             scaled ? "; * has a scale of its own" : "", path.cut_off() ? "; cut off: there was too much of it" : ""),
                 "left", 10, "#606060");
    script.label(left_margin + panel_width / 2, height - 14, "X", "center", 11, "#202020");
    script.line("plot NaN notitle");
    script.line("unset multiplot; unset output");
    return std::move(script.text);
}

}  // namespace taktwerk::apps
