#pragma once
// What a picture needs of a trace: as many points as it has pixels, coloured spans, ticks a person would have chosen. Pure.

#include <cstddef>
#include <string>
#include <vector>

namespace taktwerk::apps {

struct Point {
    double t, value;
};

/// Rows [first, last) of a trace.
struct Window {
    std::size_t first = 0, last = 0;
};

/// Rows whose time lies in [from, to]; empty when there are none.
[[nodiscard]] Window window_of(const std::vector<double>& time, double from, double to);

/// The parts of `rows` in which every value is a finite number: between them a curve has a gap.
[[nodiscard]] std::vector<Window> finite_runs(const std::vector<double>& values, Window rows);

/// At most about four points a bin: first, lowest, highest and last of it, in the order of time. No peak is lost, however
/// narrow. Fewer rows than that come through as they are.
[[nodiscard]] std::vector<Point> decimate(const std::vector<double>& time, const std::vector<double>& values, Window rows,
                                          std::size_t bins);

/// A time over which a whole-numbered signal (a state, a switch) has one value.
struct Span {
    double from, to;
    int value;
};
/// The window in `cells` equal times; each has the most important value that occurs in it (`rank` says how important), so an error
/// of one cycle stays visible. Equal neighbours are one span. The spans join without gaps.
[[nodiscard]] std::vector<Span> spans(const std::vector<double>& time, const std::vector<double>& values, Window rows, std::size_t cells,
                                      int (*rank)(int));

struct Ticks {
    double low = 0, high = 1;  ///< of the panel, with a margin
    double step = 1;
    std::vector<double> at;
};
/// Two to `most` + 1 ticks (`most` of at least 5) at 1, 2 or 5 times a power of ten around the values; a constant gets a range of its own.
[[nodiscard]] Ticks ticks(double lowest, double highest, std::size_t most);
/// "20k", "1.5M", "0.25": short, exact for ticks() of `step`.
[[nodiscard]] std::string tick_text(double value, double step);

}  // namespace taktwerk::apps
