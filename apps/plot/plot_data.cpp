#include "apps/plot/plot_data.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace taktwerk::apps {

Window window_of(const std::vector<double>& time, double from, double to) {
    const auto first = std::lower_bound(time.begin(), time.end(), from);
    const auto last = std::upper_bound(first, time.end(), to);
    return {static_cast<std::size_t>(first - time.begin()), static_cast<std::size_t>(last - time.begin())};
}

std::vector<Window> finite_runs(const std::vector<double>& values, Window rows) {
    std::vector<Window> runs;
    for (auto row = rows.first; row < rows.last; ++row) {
        if (!std::isfinite(values[row])) continue;
        const auto first = row;
        while (row < rows.last && std::isfinite(values[row])) ++row;
        runs.push_back({first, row});
    }
    return runs;
}

std::vector<Point> decimate(const std::vector<double>& time, const std::vector<double>& values, Window rows, std::size_t bins) {
    std::vector<Point> out;
    const auto count = rows.last - rows.first;
    const auto put = [&](std::size_t row) {
        if (out.empty() || out.back().t < time[row] || out.back().value != values[row]) out.push_back({time[row], values[row]});
    };
    if (count <= 4 * bins) {
        for (auto row = rows.first; row < rows.last; ++row) put(row);
        return out;
    }
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const auto first = rows.first + count * bin / bins, last = rows.first + count * (bin + 1) / bins;
        auto low = first, high = first;
        for (auto row = first; row < last; ++row) {
            if (values[row] < values[low]) low = row;
            if (values[row] > values[high]) high = row;
        }
        put(first);
        put(std::min(low, high));
        if (low != high) put(std::max(low, high));
        put(last - 1);
    }
    return out;
}

std::vector<Span> spans(const std::vector<double>& time, const std::vector<double>& values, Window rows, std::size_t cells,
                        int (*rank)(int)) {
    std::vector<Span> out;
    if (rows.first == rows.last || cells == 0) return out;
    const double begin = time[rows.first], width = (time[rows.last - 1] - begin) / static_cast<double>(cells);
    const auto value_at = [&](std::size_t row) { return static_cast<int>(std::lround(values[row])); };
    auto row = rows.first;
    int held = value_at(row);  // a value holds until the next row: a cell without rows has the one before
    for (std::size_t cell = 0; cell < cells; ++cell) {
        const double from = begin + width * static_cast<double>(cell), to = from + width;
        int value = held;
        const bool last = cell + 1 == cells;
        if (row < rows.last && time[row] <= from) value = value_at(row);
        for (; row < rows.last && (last || time[row] < to); ++row) {
            held = value_at(row);
            if (rank(held) > rank(value)) value = held;
        }
        if (!out.empty() && out.back().value == value) out.back().to = to;
        else out.push_back({from, to, value});
    }
    return out;
}

Ticks ticks(double lowest, double highest, std::size_t most) {
    if (lowest > highest) lowest = highest = 0;  // nothing was drawn
    // A span that the numbers themselves hardly resolve is none: its steps would not change them.
    if (!(highest - lowest > 1e-12 * std::max(std::abs(lowest), std::abs(highest)))) {
        const double room = lowest == 0 ? 1 : std::abs(lowest) * 0.1;
        lowest -= room;
        highest += room;
    }
    const double span = highest - lowest;
    const double least = span / static_cast<double>(most);
    const double power = std::pow(10, std::floor(std::log10(least)));
    double step = 10 * power;
    for (const double factor : {1.0, 2.0, 5.0})
        if (factor * power >= least * (1 - 1e-9)) {
            step = factor * power;
            break;
        }
    Ticks out{lowest - 0.08 * span, highest + 0.08 * span, step, {}};
    const double first = std::ceil(lowest / step - 1e-9);
    for (std::size_t i = 0; i <= most + 1; ++i)
        if (const double at = (first + static_cast<double>(i)) * step; at <= highest + 1e-9 * span) out.at.push_back(at);
    return out;
}

std::string tick_text(double value, double step) {
    if (std::abs(value) < step * 1e-6) return "0";
    const char* suffix = "";
    double scale = 1;
    if (std::abs(value) >= 1e6) suffix = "M", scale = 1e6;
    else if (std::abs(value) >= 1e4) suffix = "k", scale = 1e3;
    const int digits = std::max(0, static_cast<int>(std::ceil(-std::log10(step / scale) - 1e-9)));
    return fmt::format("{:.{}f}{}", value / scale, std::min(digits, 9), suffix);
}

}  // namespace taktwerk::apps
