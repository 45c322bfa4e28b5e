#include "tests/motion_figures/figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace taktwerk::figures {
namespace {

// Pixels. The page of a browser or of a printed manual shows this width as it is.
constexpr double width = 760, left = 144, right = 58, top = 12, state_height = 16, panel_gap = 12, bit_height = 15, bits_gap = 30,
                 block_gap = 5, foot = 8, way_gap = 34;
constexpr double plot = width - left - right;
constexpr double line_tolerance = 0.12;

constexpr std::array<const char*, 6> block_colours{"#1f6fb2", "#d9730d", "#2f8f5b", "#8a4fa8", "#b0313f", "#5b6b7b"};
constexpr const char* idle_colour = "#56616b";
constexpr const char* master_colour = "#9aa3ab";
constexpr const char* actual_colour = "#f4c08a";
constexpr const char* plain_colour = "#14507f";

struct StateLook {
    std::string_view name;
    const char* colour;
};
constexpr std::array<StateLook, 14> looks{{{"Disabled", "#d0d4d8"},
                                           {"GroupDisabled", "#d0d4d8"},
                                           {"GroupStandby", "#eef1f3"},
                                           {"GroupHoming", "#cdbcec"},
                                           {"GroupMoving", "#b5d7f0"},
                                           {"GroupStopping", "#f9dca0"},
                                           {"GroupErrorStop", "#f0a49d"},
                                           {"Standstill", "#eef1f3"},
                                           {"Homing", "#cdbcec"},
                                           {"DiscreteMotion", "#b5d7f0"},
                                           {"ContinuousMotion", "#aee3d8"},
                                           {"SynchronizedMotion", "#c8e3b4"},
                                           {"Stopping", "#f9dca0"},
                                           {"ErrorStop", "#f0a49d"}}};

const char* state_colour(std::string_view state) {
    const auto found = std::find_if(looks.begin(), looks.end(), [&](const auto& look) { return look.name == state; });
    return found == looks.end() ? "#ffffff" : found->colour;
}

const char* block_colour(int block) {
    return block < 0 ? idle_colour : block_colours[static_cast<std::size_t>(block) % block_colours.size()];
}

struct Range {
    double low, high;
};

Range range_of(const Panel& panel) {
    double low = 0, high = 0;
    for (const auto& curve : panel.curves)
        for (const double value : curve.values) low = std::min(low, value), high = std::max(high, value);
    if (high - low < 1e-9) high = low + 1;
    return {low, high};
}

/// 1, 2 or 5 times a power of ten, at least `span` / `most`.
double tick_step(double span, double most) {
    const double least = span / most, power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= least * (1 - 1e-9)) return factor * power;
    return 10 * power;
}

/// One decimal, no "-0.0", no trailing ".0": short files.
std::string px(double value) {
    auto text = fmt::format("{:.1f}", value);
    if (text.size() > 2 && text.compare(text.size() - 2, 2, ".0") == 0) text.resize(text.size() - 2);
    return text == "-0" ? "0" : text;
}

class Drawing {
public:
    explicit Drawing(const Figure& figure) : figure_(figure), samples_(figure.owner.size()) {}

    std::string text() {
        double y = top;
        state_band(y);
        y += state_height + 6;
        if (!figure_.way.empty()) {
            draw_way(y);
            y += figure_.way_height + way_gap;
        }
        const double panels_top = y;
        for (const auto& panel : figure_.panels) {
            draw(panel, y);
            y += panel.height + panel_gap;
        }
        const double panels_bottom = y - panel_gap;
        time_axis(panels_bottom);
        y = panels_bottom + bits_gap;
        const double bits_top = y;
        int block = 0;
        for (const auto& trace : figure_.traces) {
            if (std::find(trace.on.begin(), trace.on.end(), true) == trace.on.end()) continue;
            if (y > bits_top && trace.block != block) y += block_gap;
            block = trace.block;
            draw(trace, y);
            y += bit_height;
        }
        hand_overs(panels_top, panels_bottom, bits_top, y);
        const double height = y + foot;
        return fmt::format(
                   "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
                   "font-family=\"Helvetica,Arial,sans-serif\" font-size=\"11\">\n"
                   "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
                   px(width), px(height)) +
               below_ + body_ + "</svg>\n";
    }

private:
    template <class... Args>
    void put(fmt::format_string<Args...> format, Args&&... args) {
        fmt::format_to(std::back_inserter(body_), format, std::forward<Args>(args)...);
        body_ += '\n';
    }
    double x(double sample) const { return left + plot * sample / static_cast<double>(samples_ - 1); }

    void state_band(double y) {
        put("<text x=\"{}\" y=\"{}\" text-anchor=\"end\" fill=\"#667\">state</text>", px(left - 8), px(y + 12));
        for (std::size_t from = 0; from < samples_;) {
            std::size_t to = from;
            while (to < samples_ && figure_.state[to] == figure_.state[from]) ++to;
            const double a = x(static_cast<double>(from)), b = x(static_cast<double>(std::min(to, samples_ - 1)));
            put("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>", px(a), px(y), px(b - a), px(state_height),
                state_colour(figure_.state[from]));
            if (b - a > 6.2 * static_cast<double>(figure_.state[from].size()))
                put("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-size=\"10\" fill=\"#333\">{}</text>", px((a + b) / 2),
                    px(y + 11.5), figure_.state[from]);
            from = to;
        }
    }

    void draw(const Panel& panel, double y0) {
        const auto [low, high] = range_of(panel);
        const double room = 0.06 * (high - low), span = high - low + 2 * room;
        const auto y = [&, low = low](double value) { return y0 + panel.height * (1 - (value - low + room) / span); };
        put("<text x=\"{}\" y=\"{}\" fill=\"#222\">{}</text>", px(10.0), px(y0 + panel.height / 2 - 2), panel.quantity);
        put("<text x=\"{}\" y=\"{}\" fill=\"#778\" font-size=\"10\">{}</text>", px(10.0), px(y0 + panel.height / 2 + 11), panel.unit);
        const double step = tick_step(high - low, panel.height / 22);
        for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * span; ++k) {
            put("<path d=\"M{} {}H{}\" stroke=\"{}\"/>", px(left), px(y(k * step)), px(left + plot), k == 0 ? "#c4cad0" : "#eceff1");
            put("<text x=\"{}\" y=\"{}\" text-anchor=\"end\" font-size=\"10\" fill=\"#667\">{:.6g}</text>", px(left - 6),
                px(y(k * step) + 3.5), k == 0 ? 0.0 : k * step);
        }
        std::vector<double> labels;
        for (const auto& curve : panel.curves) {
            std::vector<double> pixels;
            for (const double value : curve.values) pixels.push_back(y(value));
            if (curve.ink == Ink::owner) owned_line(pixels);
            else
                line(pixels, 0, samples_ - 1,
                     curve.ink == Ink::master   ? master_colour
                     : curve.ink == Ink::actual ? actual_colour
                                                : plain_colour,
                     curve.ink == Ink::actual ? 4 : 1.6);
            if (curve.label.empty()) continue;
            double at = pixels.back() + 3.5;
            while (std::any_of(labels.begin(), labels.end(), [&](double other) { return std::abs(at - other) < 10.9; })) at += 1;
            labels.push_back(at);
            put("<text x=\"{}\" y=\"{}\" font-size=\"10\" fill=\"#556\">{}</text>", px(left + plot + 5), px(at), curve.label);
        }
    }

    /// To one scale: what is round is round.
    void draw_way(double y0) {
        std::array<double, 2> low = figure_.way.front(), high = low;
        for (const auto& point : figure_.way)
            for (std::size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], point[k]), high[k] = std::max(high[k], point[k]);
        const double room = 10, scale = std::min((plot - 2 * room) / std::max(high[0] - low[0], 1e-9),
                                                 (figure_.way_height - 2 * room) / std::max(high[1] - low[1], 1e-9));
        const double x0 = left + (plot - scale * (high[0] - low[0])) / 2;
        const auto at_x = [&](double value) { return x0 + scale * (value - low[0]); };
        const auto at_y = [&](double value) { return y0 + figure_.way_height - room - scale * (value - low[1]); };
        put("<text x=\"10\" y=\"{}\" fill=\"#222\">way of the tool</text>", px(y0 + figure_.way_height / 2 - 2));
        put("<text x=\"10\" y=\"{}\" fill=\"#778\" font-size=\"10\">mm, from above</text>", px(y0 + figure_.way_height / 2 + 11));
        const double bottom = y0 + figure_.way_height, step = tick_step(std::max(high[0] - low[0], high[1] - low[1]), 8);
        for (double k = std::ceil(low[0] / step - 1e-9); k * step <= high[0] + 1e-9; ++k) {
            put("<path d=\"M{} {}V{}\" stroke=\"#eceff1\"/>", px(at_x(k * step)), px(y0), px(bottom));
            put("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-size=\"10\" fill=\"#667\">{:.6g}</text>", px(at_x(k * step)),
                px(bottom + 12), k == 0 ? 0.0 : k * step);
        }
        for (double k = std::ceil(low[1] / step - 1e-9); k * step <= high[1] + 1e-9; ++k) {
            put("<path d=\"M{} {}H{}\" stroke=\"#eceff1\"/>", px(x0 - room), px(at_y(k * step)), px(at_x(high[0]) + room));
            put("<text x=\"{}\" y=\"{}\" text-anchor=\"end\" font-size=\"10\" fill=\"#667\">{:.6g}</text>", px(x0 - room - 4),
                px(at_y(k * step) + 3.5), k == 0 ? 0.0 : k * step);
        }
        for (std::size_t from = 0; from + 1 < samples_;) {
            std::size_t to = from + 1;
            while (to + 1 < samples_ && figure_.owner[to] == figure_.owner[from]) ++to;
            std::vector<std::array<double, 2>> part;
            for (std::size_t i = from; i <= to; ++i) part.push_back({at_x(figure_.way[i][0]), at_y(figure_.way[i][1])});
            std::string points;
            for (const auto i : simplified(part, line_tolerance))
                points += fmt::format("{}{},{}", points.empty() ? "" : " ", px(part[i][0]), px(part[i][1]));
            put("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-linejoin=\"round\"/>", points,
                block_colour(figure_.owner[from]));
            from = to;
        }
    }

    void owned_line(const std::vector<double>& pixels) {
        for (std::size_t from = 0; from + 1 < samples_;) {
            std::size_t to = from + 1;
            while (to + 1 < samples_ && figure_.owner[to] == figure_.owner[from]) ++to;
            line(pixels, from, to, block_colour(figure_.owner[from]), 2);
            from = to;
        }
    }

    void line(const std::vector<double>& pixels, std::size_t from, std::size_t to, const char* colour, double wide) {
        const std::vector<double> part(pixels.begin() + static_cast<std::ptrdiff_t>(from),
                                       pixels.begin() + static_cast<std::ptrdiff_t>(to) + 1);
        std::string points;
        for (const auto i : simplified(part, plot / static_cast<double>(samples_ - 1), line_tolerance))
            points += fmt::format("{}{},{}", points.empty() ? "" : " ", px(x(static_cast<double>(from + i))), px(part[i]));
        put("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"/>", points, colour,
            px(wide));
    }

    void time_axis(double y) {
        const double end = figure_.period * static_cast<double>(samples_ - 1), step = tick_step(end, 9);
        put("<path d=\"M{} {}H{}\" stroke=\"#99a\"/>", px(left), px(y), px(left + plot));
        for (double k = 0; k * step <= end * (1 + 1e-9); ++k) {
            const double at = x(k * step / figure_.period);
            put("<path d=\"M{} {}v3\" stroke=\"#99a\"/><text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-size=\"10\" "
                "fill=\"#667\">{:.6g}</text>",
                px(at), px(y), px(at), px(y + 14), k * step);
        }
        put("<text x=\"{}\" y=\"{}\" font-size=\"10\" fill=\"#667\">s</text>", px(left + plot + 5), px(y + 14));
    }

    void draw(const Trace& trace, double y) {
        put("<text x=\"{}\" y=\"{}\" text-anchor=\"end\" font-size=\"10\" fill=\"#333\">{}</text>", px(left - 8), px(y + 10.5),
            trace.label);
        put("<path d=\"M{} {}H{}\" stroke=\"#dde2e6\"/>", px(left), px(y + 11.5), px(left + plot));
        for (std::size_t from = 0; from < samples_; ++from) {
            if (!trace.on[from]) continue;
            std::size_t to = from;
            while (to < samples_ && trace.on[to]) ++to;
            // One scan is less than a pixel: it is shown all the same.
            const double a = x(static_cast<double>(from)), b = std::max(x(static_cast<double>(std::min(to, samples_ - 1))), a + 1.8);
            put("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"8.5\" fill=\"{}\" fill-opacity=\"0.8\"/>", px(a), px(y + 3), px(b - a),
                block_colour(trace.block));
            from = to;
        }
    }

    /// Where another block takes the axis.
    void hand_overs(double y1, double y2, double y3, double y4) {
        std::string out;
        for (std::size_t i = 1; i < samples_; ++i)
            if (figure_.owner[i] != figure_.owner[i - 1])
                out += fmt::format("M{0} {1}V{2}M{0} {3}V{4}", px(x(static_cast<double>(i))), px(y1), px(y2), px(y3), px(y4));
        if (!out.empty()) below_ = fmt::format("<path d=\"{}\" stroke=\"#b8c0c8\" stroke-dasharray=\"3 3\"/>\n", out);
    }

    const Figure& figure_;
    std::size_t samples_;
    std::string body_, below_;
};

}  // namespace

namespace {

/// `off(from, to, i)`: how far i is from the straight line between the two.
template <class Distance>
std::vector<std::size_t> thinned(std::size_t size, double tolerance, const Distance& off) {
    std::vector<bool> keep(size, false);
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, size - 1}};
    keep.front() = keep.back() = true;
    while (!open.empty()) {
        const auto [from, to] = open.back();
        open.pop_back();
        double worst = tolerance;
        std::size_t at = from;
        for (std::size_t i = from + 1; i < to; ++i)
            if (const double distance = off(from, to, i); distance > worst) worst = distance, at = i;
        if (at == from) continue;
        keep[at] = true;
        open.push_back({from, at});
        open.push_back({at, to});
    }
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < size; ++i)
        if (keep[i]) kept.push_back(i);
    return kept;
}

}  // namespace

std::vector<std::size_t> simplified(const std::vector<double>& y, double dx, double tolerance) {
    return thinned(y.size(), tolerance, [&](std::size_t from, std::size_t to, std::size_t i) {
        const double rise = y[to] - y[from], run = dx * static_cast<double>(to - from);
        return std::abs((y[i] - y[from]) * run - dx * static_cast<double>(i - from) * rise) / std::hypot(rise, run);
    });
}

std::vector<std::size_t> simplified(const std::vector<std::array<double, 2>>& points, double tolerance) {
    return thinned(points.size(), tolerance, [&](std::size_t from, std::size_t to, std::size_t i) {
        const auto &a = points[from], &b = points[to], &p = points[i];
        const double u = b[0] - a[0], v = b[1] - a[1], length = std::hypot(u, v);
        // A way that comes back to where it began has no line between its ends; one that turns back is longer than that line.
        const double along = length > 1e-9 ? std::clamp(((p[0] - a[0]) * u + (p[1] - a[1]) * v) / (length * length), 0.0, 1.0) : 0;
        return std::hypot(p[0] - a[0] - along * u, p[1] - a[1] - along * v);
    });
}

std::string svg(const Figure& figure) { return Drawing(figure).text(); }

}  // namespace taktwerk::figures
