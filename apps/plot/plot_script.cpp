#include "apps/plot/plot_script.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>

#include <fmt/format.h>

#include "apps/plot/gnuplot.hpp"
#include "apps/plot/plot_data.hpp"
#include "axes/words/types.hpp"
#include "core/nearest_name.hpp"

namespace taktwerk::apps {
namespace {

// Pixels. The width is what a screen or a page shows without scaling.
constexpr double width = 1200, left = 120, right = 18, head = 64, foot = 62, axis_head = 30, band_height = 18, gap = 9, axis_gap = 38,
                 bit_height = 15, value_height = 74;
constexpr double plot_width = width - left - right;
constexpr std::size_t bins = 700;

struct StateLook {
    axes::AxisState state;
    const char* colour;
    int rank;  ///< which one stays visible where several share a pixel
};
constexpr std::array<StateLook, axes::axis_state_count> looks{{
    {axes::AxisState::Disabled, "#d0d4d8", 0},
    {axes::AxisState::Standstill, "#eef1f3", 1},
    {axes::AxisState::Homing, "#b9a0e0", 5},
    {axes::AxisState::DiscreteMotion, "#8fc1e8", 2},
    {axes::AxisState::ContinuousMotion, "#7fd0c0", 3},
    {axes::AxisState::SynchronizedMotion, "#a8d08d", 4},
    {axes::AxisState::Stopping, "#f5c26b", 6},
    {axes::AxisState::ErrorStop, "#e5695f", 7},
}};
constexpr const char* emergency_colour = "#ffd9d6";
constexpr const char* error_colour = "#fdeede";
constexpr const char* command_colour = "#2f8f5b";
constexpr const char* bit_colour = "#4a7ba6";
constexpr int error_state = static_cast<int>(axes::AxisState::ErrorStop);

const StateLook& look(int state) { return looks[static_cast<std::size_t>(std::clamp(state, 0, static_cast<int>(looks.size()) - 1))]; }
std::string_view state_name(int state) { return axes::name(look(state).state); }
int state_rank(int state) { return look(state).rank; }
int same(int value) { return value; }

struct Curve {
    const std::vector<double>* values;
    const char *title, *colour;
    double line;
    bool commanded = false;  ///< steps, and only where a motion has a target
};
struct Panel {
    std::string quantity, unit;
    double height;
    std::vector<Curve> curves;
};

std::vector<Panel> panels_of(const AxisTrace& axis, bool following_error) {
    const auto& u = axis.unit;
    // The actual value lies below, wide and pale: where the axis follows well it is the glow around the set-point.
    std::vector<Panel> out{
        {"position", u, 118, {{&axis.actual_position, "actual", "#f6bd84", 4.0}, {&axis.set_position, "set-point", "#14507f", 1.3}}},
        {"velocity", u + "/s", 84, {{&axis.actual_velocity, "", "#f6bd84", 3.0}, {&axis.set_velocity, "", "#14507f", 1.3}}},
        {"acceleration", u + "/s²", 74, {{&axis.set_acceleration, "", "#14507f", 1.2}}},
        {"jerk", u + "/s³", 74, {{&axis.set_jerk, "", "#14507f", 1.2}}},
    };
    if (!axis.target_position.empty()) {
        auto& curves = out.front().curves;
        curves.insert(curves.begin(), {&axis.target_position, "commanded", command_colour, 1.2, true});
    }
    if (following_error) out.insert(out.begin() + 1, {"following error", u, 74, {{&axis.following_error, "", "#a03050", 1.2}}});
    return out;
}

class Script {
public:
    Script(const Trace& trace, Window rows, double height) : trace_(trace), rows_(rows), height_(height) {
        from_ = trace.time_s[rows.first];
        to_ = std::max(trace.time_s[rows.last - 1], from_ + 1e-6);
    }

    template <class... Args>
    void line(fmt::format_string<Args...> format, Args&&... args) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
        text_ += '\n';
    }

    /// Pixels from the top left corner to gnuplot's screen coordinates.
    double x(double pixels) const { return pixels / width; }
    double y(double pixels) const { return 1 - pixels / height_; }

    void margins(double top, double bottom) {
        line("set lmargin at screen {:.6f}; set rmargin at screen {:.6f}; set tmargin at screen {:.6f}; set bmargin at screen {:.6f}",
             x(left), x(width - right), y(top), y(bottom));
        line("set xrange [{:.9g}:{:.9g}]", from_, to_);
    }

    void label(double px, double py, std::string_view what, std::string_view align, int size, std::string_view colour) {
        line("set label {} at screen {:.6f}, screen {:.6f} {} font \",{}\" tc rgb \"{}\" noenhanced front", in_gnuplot_quotes(what), x(px),
             y(py), align, size, colour);
    }

    void shade(const std::vector<Span>& where, int value, const char* colour) {
        for (const auto& span : where)
            if (span.value == value)
                line(
                    "set object rectangle from first {:.6f}, graph 0 to first {:.6f}, graph 1 behind fillcolor rgb \"{}\" fillstyle solid "
                    "noborder",
                    span.from, span.to, colour);
    }

    void reset_panel() { line("unset label; unset object; unset arrow; unset xtics; unset ytics; unset key; unset xlabel"); }

    void time_tics(bool with_numbers) {
        const auto t = ticks(from_, to_, 13);
        std::string list;
        for (const double at : t.at)
            if (at >= from_ - 1e-9 && at <= to_ + 1e-9)
                list +=
                    fmt::format("{}{} {:.9g}", list.empty() ? "" : ", ", in_gnuplot_quotes(with_numbers ? tick_text(at, t.step) : ""), at);
        line("set xtics ({}) scale 0.3 nomirror offset 0,0.35", list);
    }

    void band(const AxisTrace& axis, double top) {
        reset_panel();
        margins(top, top + band_height);
        line("set yrange [0:1]; unset grid");
        for (const auto& span : spans(trace_.time_s, axis.state, rows_, bins, state_rank)) {
            line(
                "set object rectangle from first {:.6f}, graph 0 to first {:.6f}, graph 1 front fillcolor rgb \"{}\" fillstyle solid "
                "noborder",
                span.from, span.to, look(span.value).colour);
            const auto name = state_name(span.value);
            const double pixels = (span.to - span.from) / (to_ - from_) * plot_width;
            if (pixels > 7.0 * static_cast<double>(name.size()) + 8)
                line("set label {} at first {:.6f}, graph 0.47 center font \",9\" tc rgb \"#303030\" noenhanced front",
                     in_gnuplot_quotes(name), (span.from + span.to) / 2);
        }
        line("plot NaN notitle");
    }

    /// `axis`: whose quantity it is; nullptr: nobody's.
    void panel(const AxisTrace* axis, const Panel& panel, double top, bool first, bool last) {
        reset_panel();
        margins(top, top + panel.height);
        // Emergency stop is the machine's, the error is this axis': where both hold, the machine's reason is shown.
        if (axis) shade(spans(trace_.time_s, axis->state, rows_, bins, state_rank), error_state, error_colour);
        shade(spans(trace_.time_s, trace_.emergency_stop, rows_, bins, same), 1, emergency_colour);
        double low = HUGE_VAL, high = -HUGE_VAL;
        std::string plots;
        for (const auto& curve : panel.curves) {
            const auto block = fmt::format("$data{}", ++blocks_);
            line("{} << EOD", block);
            // Each run of rows is a line of its own: between targets there is nothing to draw.
            for (const auto& part : curve.commanded&& axis ? with_a_target(*axis) : std::vector<Window>{rows_})
                for (const auto& run : finite_runs(*curve.values, part)) {
                    for (const auto& point : decimate(trace_.time_s, *curve.values, run, bins)) {
                        line("{:.6f} {:.9g}", point.t, point.value);
                        low = std::min(low, point.value);
                        high = std::max(high, point.value);
                    }
                    line("");
                }
            if (low > high) line("{:.6f} NaN", from_);  // gnuplot wants a row
            line("EOD");
            plots += fmt::format("{}{} using 1:2 with {} lw {} lc rgb \"{}\" {} {}", plots.empty() ? "" : ", ", block,
                                 curve.commanded ? "steps" : "lines", curve.line, curve.colour, curve.commanded ? "dt (4,3)" : "",
                                 *curve.title ? "title " + in_gnuplot_quotes(curve.title) : std::string("notitle"));
        }
        if (axis) hand_overs(*axis);
        const auto t = ticks(low, high, panel.height > 100 ? 6 : 5);
        std::string list;
        for (const double at : t.at)
            list += fmt::format("{}{} {:.9g}", list.empty() ? "" : ", ", in_gnuplot_quotes(tick_text(at, t.step)), at);
        line("set yrange [{:.9g}:{:.9g}]; set ytics ({}) scale 0.3 nomirror; set grid", t.low, t.high, list);
        time_tics(last);
        label(12, top + panel.height / 2 - 7, panel.quantity, "left", 10, "#202020");
        label(12, top + panel.height / 2 + 8, panel.unit, "left", 9, "#707070");
        if (first)
            line("set key at screen {:.6f}, screen {:.6f} right center horizontal samplen 2.2 font \",10\" noenhanced", x(width - right),
                 y(top - gap - band_height - axis_head / 2));
        line("plot {}", plots);
    }

    /// Dashed, where one command takes the axis from another. Where they are too dense to be told apart there is one.
    void hand_overs(const AxisTrace& axis) {
        const double least = 3 * (to_ - from_) / plot_width;
        double before = from_ - least;
        for (auto row = rows_.first + 1; !axis.active.empty() && row < rows_.last; ++row) {
            const double old = axis.active[row - 1], now = axis.active[row], at = trace_.time_s[row];
            if (old == now || old == 0 || now == 0 || at - before < least) continue;
            line("set arrow from first {0:.6f}, graph 0 to first {0:.6f}, graph 1 nohead back lw 0.8 dt (2,3) lc rgb \"#8a949e\"", at);
            before = at;
        }
    }

    /// TRUE as a bar.
    void bit(const BitTrace& trace, double top, bool last) {
        reset_panel();
        margins(top, top + bit_height);
        line("set yrange [0:1]; unset grid; set border {} lc rgb \"#b0b8c0\"", 1);
        for (const auto& span : spans(trace_.time_s, trace.value, rows_, 2 * bins, same))
            if (span.value != 0)
                line(
                    "set object rectangle from first {:.6f}, graph 0.12 to first {:.6f}, graph 0.8 front fillcolor rgb \"{}\" fillstyle "
                    "solid "
                    "noborder",
                    span.from, span.to, bit_colour);
        label(left - 8, top + bit_height / 2, trace.name, "right", 9, "#404040");
        if (last) time_tics(true);
        line("plot NaN notitle");
    }

    std::string& text() { return text_; }
    double from() const { return from_; }
    double to() const { return to_; }

private:
    [[nodiscard]] std::vector<Window> with_a_target(const AxisTrace& axis) const {
        constexpr int homing = static_cast<int>(axes::AxisState::Homing), discrete = static_cast<int>(axes::AxisState::DiscreteMotion);
        const auto has = [&](std::size_t row) { return axis.state[row] == discrete || axis.state[row] == homing; };
        std::vector<Window> runs;
        for (auto row = rows_.first; row < rows_.last; ++row) {
            if (!has(row)) continue;
            const auto first = row;
            while (row < rows_.last && has(row)) ++row;
            runs.push_back({first, row});
        }
        return runs;
    }

    const Trace& trace_;
    Window rows_;
    double height_, from_ = 0, to_ = 0;
    int blocks_ = 0;
    std::string text_;
};

/// Which colours mean what: only those that occur.
void legend(Script& script, const Trace& trace, const std::vector<const AxisTrace*>& axes, Window rows, double top) {
    std::array<bool, looks.size()> seen{};
    bool emergency = false;
    for (auto row = rows.first; row < rows.last; ++row) {
        for (const auto* axis : axes) seen[static_cast<std::size_t>(std::clamp(axis->state[row], 0.0, looks.size() - 1.0))] = true;
        emergency = emergency || trace.emergency_stop[row] != 0;
    }
    double at = left;
    const auto entry = [&](std::string_view colour, std::string_view text) {
        script.line(
            "set object rectangle from screen {:.6f}, screen {:.6f} to screen {:.6f}, screen {:.6f} front fillcolor rgb \"{}\" fillstyle "
            "solid border lc rgb \"#a0a0a0\"",
            script.x(at), script.y(top), script.x(at + 14), script.y(top + 12), colour);
        script.label(at + 19, top + 6, text, "left", 9, "#404040");
        at += 19 + 6.3 * static_cast<double>(text.size()) + 18;
    };
    for (std::size_t i = 0; i < looks.size(); ++i)
        if (seen[i]) entry(looks[i].colour, axes::name(looks[i].state));
    if (seen[static_cast<std::size_t>(error_state)]) entry(error_colour, "axis in error");
    if (emergency) entry(emergency_colour, "emergency stop");
}

Result<std::vector<const ValueTrace*>> chosen_values(const Trace& trace, const std::vector<std::string>& wanted) {
    std::vector<const ValueTrace*> out;
    for (const auto& name : wanted) {
        const auto found = std::find_if(trace.values.begin(), trace.values.end(), [&](const auto& value) { return value.name == name; });
        if (found != trace.values.end()) {
            out.push_back(&*found);
            continue;
        }
        std::vector<std::string> names;
        for (const auto& value : trace.values) names.push_back(value.name);
        const auto near = nearest_name(name, names);
        return Error{"plot.unknown_value", "--values " + name, "the trace has no number of this name",
                     !near.empty()   ? fmt::format("Did you mean '{}'?", near)
                     : names.empty() ? std::string("All it has beside the axes is 0 or 1 all the time: see --bits.")
                                     : fmt::format("It has: {}.", fmt::join(names, ", "))};
    }
    return out;
}

/// Those asked for, or those that change in the window.
Result<std::vector<const BitTrace*>> chosen_bits(const Trace& trace, const std::vector<std::string>& wanted, Window rows) {
    std::vector<const BitTrace*> out;
    for (const auto& bit : trace.bits) {
        const auto first = bit.value.begin() + static_cast<std::ptrdiff_t>(rows.first);
        const auto last = bit.value.begin() + static_cast<std::ptrdiff_t>(rows.last);
        if (wanted.empty() && std::adjacent_find(first, last, std::not_equal_to<>{}) != last) out.push_back(&bit);
    }
    for (const auto& name : wanted) {
        const auto found = std::find_if(trace.bits.begin(), trace.bits.end(), [&](const auto& bit) { return bit.name == name; });
        if (found != trace.bits.end()) {
            out.push_back(&*found);
            continue;
        }
        std::vector<std::string> names;
        for (const auto& bit : trace.bits) names.push_back(bit.name);
        const auto near = nearest_name(name, names);
        return Error{"plot.unknown_bit", "--bits " + name, "the trace has no BOOL of this name",
                     near.empty() ? fmt::format("It has: {}.", fmt::join(names, ", ")) : fmt::format("Did you mean '{}'?", near)};
    }
    return out;
}

Result<std::vector<const AxisTrace*>> chosen(const Trace& trace, const std::vector<std::string>& wanted) {
    std::vector<const AxisTrace*> out;
    if (wanted.empty())
        for (const auto& axis : trace.axes) out.push_back(&axis);
    for (const auto& name : wanted) {
        const auto found = std::find_if(trace.axes.begin(), trace.axes.end(), [&](const auto& axis) { return axis.name == name; });
        if (found != trace.axes.end()) {
            out.push_back(&*found);
            continue;
        }
        std::vector<std::string> names;
        for (const auto& axis : trace.axes) names.push_back(axis.name);
        const auto near = nearest_name(name, names);
        return Error{"plot.unknown_axis", "--axis " + name, "the trace has no axis of this name",
                     near.empty() ? fmt::format("It has: {}.", fmt::join(names, ", ")) : fmt::format("Did you mean '{}'?", near)};
    }
    return out;
}

}  // namespace

Result<std::string> plot_script(const Trace& trace, const PlotRequest& request) {
    auto axes = chosen(trace, request.axes);
    if (!axes) return axes.error();
    const auto rows = window_of(trace.time_s, request.from_s, request.to_s > 0 ? request.to_s : HUGE_VAL);
    if (rows.last < rows.first + 2)
        return Error{
            "plot.empty_window", "--from/--to",
            fmt::format("the trace has no cycles there; it goes from {:.3f} s to {:.3f} s", trace.time_s.front(), trace.time_s.back()),
            "Choose a part inside the trace."};

    auto bit_traces = chosen_bits(trace, request.bits, rows);
    if (!bit_traces) return bit_traces.error();
    const auto value_traces = chosen_values(trace, request.values);
    if (!value_traces) return value_traces.error();

    double height = head + foot + (bit_traces->empty() ? 0 : static_cast<double>(bit_traces->size()) * bit_height + axis_gap);
    for (const auto* axis : *axes) {
        height += axis_head + band_height + axis_gap;
        for (const auto& panel : panels_of(*axis, request.following_error)) height += panel.height + gap;
    }
    height += static_cast<double>(value_traces->size()) * (value_height + gap) + (value_traces->empty() ? 0 : axis_gap);
    Script script{trace, rows, height};
    const double cycle_ms = (script.to() - script.from()) / static_cast<double>(rows.last - rows.first - 1) * 1e3;
    script.line("set terminal svg size {:.0f},{:.0f} dynamic enhanced font \"DejaVu Sans,10\" background rgb \"#ffffff\"", width, height);
    script.line("set output {}", gnuplot_file(request.output));
    script.line(
        "set encoding utf8; set multiplot; set border 3 lc rgb \"#909090\"; set grid lc rgb \"#e4e4e4\" lt 1 lw 0.7; set tics font \",9\" "
        "tc rgb \"#404040\"");

    double top = head;
    bool heading = true;
    for (const auto* axis : *axes) {
        script.band(*axis, top + axis_head);
        const auto panels = panels_of(*axis, request.following_error);
        double panel_top = top + axis_head + band_height + gap;
        for (std::size_t i = 0; i < panels.size(); ++i) {
            const bool last = i + 1 == panels.size();
            script.panel(axis, panels[i], panel_top, i == 0, last);
            panel_top += panels[i].height + gap;
        }
        // Texts outside the panels go with an invisible plot of their own: labels of one panel are cleared by the next.
        script.reset_panel();
        script.line("unset border; unset grid; set yrange [0:1]");
        script.label(left, top + axis_head / 2, "Axis " + axis->name, "left", 13, "#101010");
        script.label(12, top + axis_head + band_height / 2, "state", "left", 10, "#202020");
        script.label(12, panel_top - gap + 12, "time in s", "left", 9, "#707070");
        if (heading) {
            script.label(left, 22, request.title, "left", 16, "#101010");
            script.label(left, 44,
                         fmt::format("{:.2f} s to {:.2f} s of {:.2f} s, {} cycles of {:.3g} ms", script.from(), script.to(),
                                     trace.time_s.back(), rows.last - rows.first, cycle_ms),
                         "left", 10, "#606060");
            legend(script, trace, *axes, rows, height - 30);
        }
        heading = false;
        script.line("plot NaN notitle");
        script.line("set border 3 lc rgb \"#909090\"; set grid");
        top = panel_top - gap + axis_gap;
    }
    for (const auto* value : *value_traces) {
        const Panel panel{value->name, value->unit, value_height, {{&value->value, "", "#14507f", 1.2}}};
        script.panel(nullptr, panel, top, false, value == value_traces->back());
        top += value_height + gap;
    }
    if (!value_traces->empty()) top += axis_gap - gap;
    for (const auto* bit : *bit_traces) {
        script.bit(*bit, top, bit == bit_traces->back());
        top += bit_height;
    }
    script.line("unset multiplot; unset output");
    return std::move(script.text());
}

}  // namespace taktwerk::apps
