#include "apps/plot/path_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/plot/gnuplot.hpp"
#include "apps/plot/plot_data.hpp"
#include "core/nearest_name.hpp"

namespace taktwerk::apps {
namespace {

using Values = std::vector<double>;

// Pixels.
constexpr double sheet_width = 1200, sheet_left = 90, sheet_right = 18, sheet_head = 64, between = 46, panel_gap = 12, plane_height = 470,
                 panel_height = 130, sheet_foot = 60;
constexpr double plane_width = (sheet_width - sheet_left - sheet_right - 70) / 2;
constexpr std::size_t path_bins = 700;
constexpr std::size_t most_points = 20'000;  ///< of the way; more are no finer on paper
constexpr std::array<const char*, 8> colours{"#14507f", "#c8641e", "#2f8f5b", "#8a4fa3", "#b03048", "#6b6f1f", "#207c8c", "#7a5a3a"};

struct FoundColumn {
    const Values* values = nullptr;
    std::string unit;
};

FoundColumn find(const Trace& trace, const std::string& name) {
    for (const auto& value : trace.values)
        if (value.name == name) return {&value.value, value.unit};
    for (const auto& bit : trace.bits)
        if (bit.name == name) return {&bit.value, {}};  // a number that was 0 or 1 all the time
    return {};
}

/// Names between "group." and what every group has.
std::set<std::string> groups_of(const Trace& trace) {
    std::set<std::string> out;
    constexpr std::string_view front = "group.", mark = ".path_velocity";
    const auto look = [&](const std::string& name) {
        if (name.starts_with(front) && name.ends_with(mark))
            out.insert(name.substr(front.size(), name.size() - front.size() - mark.size()));
    };
    for (const auto& value : trace.values) look(value.name);
    for (const auto& bit : trace.bits) look(bit.name);
    return out;
}

struct Way {
    std::array<const Values*, 3> set{}, actual{};
};
struct Extent {
    double low = HUGE_VAL, high = -HUGE_VAL;
    void take(double value) {
        if (!std::isfinite(value)) return;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    [[nodiscard]] double size() const { return high - low; }
};

Extent extent_of(const Way& way, std::size_t which, Window rows) {
    Extent out;
    for (auto row = rows.first; row < rows.last; ++row) {
        out.take((*way.set[which])[row]);
        out.take((*way.actual[which])[row]);
    }
    return out;
}

class PathScript {
public:
    PathScript(const Trace& trace, Window rows, double height) : trace_(trace), rows_(rows), height_(height) {}

    template <class... Args>
    void line(fmt::format_string<Args...> format, Args&&... args) {
        fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
        text += '\n';
    }
    [[nodiscard]] double x(double pixels) const { return pixels / sheet_width; }
    [[nodiscard]] double y(double pixels) const { return 1 - pixels / height_; }
    void label(double px, double py, std::string_view what, std::string_view align, int size, std::string_view colour) {
        line("set label {} at screen {:.6f}, screen {:.6f} {} font \",{}\" tc rgb \"{}\" noenhanced front", in_gnuplot_quotes(what), x(px),
             y(py), align, size, colour);
    }
    void margins(double from_left, double to_right, double top, double bottom) {
        line("unset label; unset object; unset xtics; unset ytics; unset key");
        line("set lmargin at screen {:.6f}; set rmargin at screen {:.6f}; set tmargin at screen {:.6f}; set bmargin at screen {:.6f}",
             x(from_left), x(to_right), y(top), y(bottom));
    }
    void tics(char which, double low, double high, std::size_t most) {
        const auto t = ticks(low, high, most);
        std::string list;
        for (const double at : t.at)
            if (at >= low - 1e-9 * t.step && at <= high + 1e-9 * t.step)
                list += fmt::format("{}{} {:.9g}", list.empty() ? "" : ", ", in_gnuplot_quotes(tick_text(at, t.step)), at);
        line("set {}tics ({}) scale 0.3 nomirror", which, list);
    }

    void way(const char* block, const std::array<const Values*, 3>& columns) {
        line("{} << EOD", block);
        const auto step = std::max<std::size_t>((rows_.last - rows_.first) / most_points, 1);
        bool gap = true, any = false;
        for (auto row = rows_.first; row < rows_.last; row += step) {
            const std::array<double, 3> at{(*columns[0])[row], (*columns[1])[row], (*columns[2])[row]};
            if (std::all_of(at.begin(), at.end(), [](double value) { return std::isfinite(value); })) {
                line("{:.9g} {:.9g} {:.9g}", at[0], at[1], at[2]);
                gap = false;
                any = true;
            } else if (!gap) {
                line("");
                gap = true;
            }
        }
        if (!any) line("NaN NaN NaN");
        line("EOD");
    }

    void plane(double from_left, const Extent& across, const Extent& up, double unit_a_pixel, const char* across_name, const char* up_name,
               const char* columns) {
        margins(from_left, from_left + plane_width, sheet_head, sheet_head + plane_height);
        const auto around = [&](const Extent& extent, double pixels) {
            const double middle = (extent.low + extent.high) / 2, half = pixels * unit_a_pixel / 2;
            return std::pair{middle - half, middle + half};
        };
        const auto [low, high] = around(across, plane_width);
        const auto [bottom, top] = around(up, plane_height);
        line("set xrange [{:.9g}:{:.9g}]; set yrange [{:.9g}:{:.9g}]", low, high, bottom, top);
        tics('x', low, high, 8);
        tics('y', bottom, top, 8);
        label(from_left + plane_width / 2, sheet_head + plane_height + 32, across_name, "center", 11, "#202020");
        label(from_left + 8, sheet_head + 12, up_name, "left", 11, "#202020");
        line(
            "plot $actual using {0} with lines lw 4 lc rgb \"#f6bd84\" notitle, $set using {0} with lines lw 1.3 lc rgb \"#14507f\" "
            "notitle, "
            "$start using {0} with points pt 7 ps 0.6 lc rgb \"#2f8f5b\" notitle",
            columns);
    }

    struct Curve {
        const Values* values;
        std::string name;
        const char* colour;
        double width;
    };
    void panel(double top, const std::string& title, const std::vector<Curve>& curves, bool last) {
        margins(sheet_left, sheet_width - sheet_right, top, top + panel_height);
        const double from = trace_.time_s[rows_.first], to = std::max(trace_.time_s[rows_.last - 1], from + 1e-6);
        Extent range;
        range.take(0);
        for (const auto& curve : curves)
            for (auto row = rows_.first; row < rows_.last; ++row) range.take((*curve.values)[row]);
        const auto t = ticks(range.low, range.high, 5);
        line("set xrange [{:.9g}:{:.9g}]; set yrange [{:.9g}:{:.9g}]", from, to, t.low, t.high);
        tics('y', t.low, t.high, 5);
        const auto times = ticks(from, to, 13);
        std::string list;
        for (const double at : times.at)
            if (at >= from - 1e-9 && at <= to + 1e-9)
                list += fmt::format("{}{} {:.9g}", list.empty() ? "" : ", ", in_gnuplot_quotes(last ? tick_text(at, times.step) : ""), at);
        line("set xtics ({}) scale 0.3 nomirror", list);
        label(sheet_left, top - 7, title, "left", 10, "#202020");
        double at = sheet_left + 380;
        for (const auto& curve : curves) {
            label(at, top - 7, curve.name, "left", 10, curve.colour);
            at += 30 + 7 * static_cast<double>(curve.name.size());
        }
        if (last) label(12, top + panel_height + 14, "time in s", "left", 9, "#707070");
        std::string plots;
        for (const auto& curve : curves) {
            plots +=
                fmt::format("{}'-' using 1:2 with lines lw {} lc rgb \"{}\" notitle", plots.empty() ? "" : ", ", curve.width, curve.colour);
        }
        line("plot {}", plots);
        for (const auto& curve : curves) {
            bool any = false;
            for (const auto& run : finite_runs(*curve.values, rows_)) {
                for (const auto& point : decimate(trace_.time_s, *curve.values, run, path_bins))
                    line("{:.6f} {:.9g}", point.t, point.value);
                line("");
                any = true;
            }
            if (!any) line("{:.6f} NaN", from);
            line("e");
        }
    }

    std::string text;

private:
    const Trace& trace_;
    Window rows_;
    double height_;
};

/// Of velocity, acceleration and jerk the most, in each cycle.
Values most_used(const Trace& trace, const std::string& front) {
    Values out;
    for (const char* what : {"_velocity_use", "_acceleration_use", "_jerk_use"}) {
        const auto column = find(trace, front + what);
        if (column.values == nullptr) continue;
        out.resize(column.values->size());
        for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::max(out[i], (*column.values)[i]);
    }
    return out;
}

/// By the names of their columns, in the order of the file.
std::vector<std::string> members_of(const Trace& trace, const std::string& front) {
    std::vector<std::string> out;
    constexpr std::string_view mark = "_velocity_use";
    const auto look = [&](const std::string& name) {
        if (name.starts_with(front) && name.ends_with(mark))
            out.push_back(name.substr(front.size(), name.size() - front.size() - mark.size()));
    };
    for (const auto& value : trace.values) look(value.name);
    for (const auto& bit : trace.bits) look(bit.name);
    return out;
}

}  // namespace

Result<std::string> path_script(const Trace& trace, const PathRequest& request) {
    const auto known = groups_of(trace);
    if (!known.contains(request.group)) {
        const std::vector<std::string> names(known.begin(), known.end());
        const auto near = nearest_name(request.group, names);
        return Error{"plot.unknown_group", "--path " + request.group, "the trace has no group of axes of this name",
                     !near.empty()   ? fmt::format("Did you mean '{}'?", near)
                     : names.empty() ? std::string("The machine of this trace has no groups.")
                                     : fmt::format("It has: {}.", fmt::join(names, ", "))};
    }
    const std::string front = "group." + request.group + ".";
    Way way;
    std::string unit;
    for (std::size_t i = 0; i < 3; ++i) {
        const char* name = std::array{"x", "y", "z"}[i];
        const auto set = find(trace, front + "tool_" + name), actual = find(trace, front + "tool_actual_" + name);
        if (set.values == nullptr || actual.values == nullptr)
            return Error{"plot.no_tool", "--path " + request.group, "the group has no arm, so its tool has no place in the machine",
                         "Draw its axes: leave --path out. Or give the group `kinematics`."};
        way.set[i] = set.values;
        way.actual[i] = actual.values;
        if (!set.unit.empty()) unit = set.unit;
    }
    const auto rows = window_of(trace.time_s, request.from_s, request.to_s > 0 ? request.to_s : HUGE_VAL);
    if (rows.last < rows.first + 2)
        return Error{
            "plot.empty_window", "--from/--to",
            fmt::format("the trace has no cycles there; it goes from {:.3f} s to {:.3f} s", trace.time_s.front(), trace.time_s.back()),
            "Choose a part inside the trace."};
    std::array<Extent, 3> extents;
    for (std::size_t i = 0; i < 3; ++i) extents[i] = extent_of(way, i, rows);
    if (!(extents[0].size() >= 0 && extents[1].size() >= 0 && extents[2].size() >= 0))
        return Error{"plot.no_tool", "--path " + request.group, "in this window nobody knew where the tool was",
                     "Choose another part with --from and --to."};

    const double height = sheet_head + plane_height + between + 2 * (panel_height + panel_gap + 14) + sheet_foot;
    PathScript script(trace, rows, height);
    script.line("set terminal svg size {:.0f},{:.0f} dynamic enhanced font \"DejaVu Sans,10\" background rgb \"#ffffff\"", sheet_width,
                height);
    script.line("set output {}", gnuplot_file(request.output));
    script.way("$set", way.set);
    script.way("$actual", way.actual);
    auto first = rows.first;
    while (first + 1 < rows.last && !std::isfinite((*way.set[0])[first])) ++first;
    script.line("$start << EOD\n{:.9g} {:.9g} {:.9g}\nEOD", (*way.set[0])[first], (*way.set[1])[first], (*way.set[2])[first]);
    script.line(
        "set encoding utf8; set multiplot; set border 3 lc rgb \"#909090\"; set grid lc rgb \"#e4e4e4\" lt 1 lw 0.7; set tics font \",9\" "
        "tc rgb \"#404040\"");
    // One scale for both pictures, so that an angle is one.
    const double unit_a_pixel =
        1.08 * std::max({extents[0].size() / plane_width, extents[1].size() / plane_height, extents[2].size() / plane_height, 1e-6});
    const auto axis_name = [&](const char* name) { return unit.empty() ? std::string(name) : fmt::format("{} [{}]", name, unit); };
    script.plane(sheet_left, extents[0], extents[1], unit_a_pixel, axis_name("X").c_str(), axis_name("Y").c_str(), "1:2");
    script.plane(sheet_width - sheet_right - plane_width, extents[0], extents[2], unit_a_pixel, axis_name("X").c_str(),
                 axis_name("Z").c_str(), "1:3");

    const double speed_top = sheet_head + plane_height + between + 14, use_top = speed_top + panel_height + panel_gap + 14;
    std::vector<PathScript::Curve> speeds;
    if (const auto speed = find(trace, front + "tool_actual_speed"); speed.values) speeds.push_back({speed.values, "actual", "#f6bd84", 3});
    if (const auto speed = find(trace, front + "tool_speed"); speed.values) speeds.push_back({speed.values, "set", "#14507f", 1.3});
    script.panel(speed_top, "speed of the tool" + (unit.empty() ? std::string{} : fmt::format(" [{}/s]", unit)), speeds, false);
    const auto members = members_of(trace, front);
    std::vector<Values> used;
    used.reserve(members.size());
    std::vector<PathScript::Curve> uses;
    for (std::size_t i = 0; i < members.size(); ++i) {
        used.push_back(most_used(trace, front + members[i]));
        uses.push_back({&used.back(), members[i], colours[i % colours.size()], 1.2});
    }
    if (!uses.empty()) script.panel(use_top, "part of its limits that an axis uses [%]", uses, true);
    script.margins(sheet_left, sheet_width - sheet_right, sheet_head, height - sheet_foot);
    script.line("unset border; unset grid; set yrange [0:1]");
    script.label(sheet_left, 22, request.title, "left", 16, "#101010");
    script.label(sheet_left, 44,
                 fmt::format("tool of group {}, {:.2f} s to {:.2f} s; set-point over actual, the point: its start", request.group,
                             trace.time_s[rows.first], trace.time_s[rows.last - 1]),
                 "left", 10, "#606060");
    script.line("plot NaN notitle");
    script.line("unset multiplot; unset output");
    return std::move(script.text);
}

}  // namespace taktwerk::apps
