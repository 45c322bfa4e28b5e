#pragma once
// The cases of independent_*_property.cpp: the project's own, a stranger's, those with a feed, and ones drawn at random.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "axes/path/path.hpp"
#include "axes/path_time/curve.hpp"
#include "tests/axes/path/points.hpp"
#include "tests/axes/path_time/path_curve.hpp"
#include "tests/axes/path_time/random_program.hpp"

namespace taktwerk::axes {

struct Case {
    std::string name;
    std::shared_ptr<Path> path;
    std::shared_ptr<TimedCurve> curve;
    std::vector<PathAxisLimits> limits;
    double factor = 1;
};

inline const PathFeed unlimited_feed{1e9, 1e12, 1e12, 1e15};
inline void append_element(Path& path, const PathElement& element, const PathFeed& feed = unlimited_feed, const BlendRequest& blend = {}) {
    PathMove move;
    move.element = element;
    move.feed = feed;
    ASSERT_TRUE(path.append(move, blend).ok());
}
inline PathElement plane_arc(const PathVector& from, double radius, double heading, double angle, double sense) {
    const PathVector out = sense * radius * at(std::sin(heading), -std::cos(heading)),
                     along = radius * at(std::cos(heading), std::sin(heading));
    return PathElement::arc(from - out, out, along, at(0, 0), angle);
}
inline Path polygon(const std::vector<PathVector>& points, double distance, const PathFeed& feed = unlimited_feed) {
    Path path;
    for (std::size_t i = 1; i < points.size(); ++i)
        append_element(path, PathElement::line(points[i - 1], points[i]), feed, {BlendRule::corner_distance, distance});
    return path;
}
inline Path corner_path(double distance, double angle, double first = 100, double second = 100, const PathFeed& feed = unlimited_feed) {
    return polygon({at(0, 0), at(first, 0), at(first + second * std::cos(angle), second * std::sin(angle))}, distance, feed);
}
inline Case of_path(const std::string& name, const Path& path, const std::vector<PathAxisLimits>& limits, double factor = 1,
                    PathCurve::Machine machine = PathCurve::Machine::cartesian) {
    Case c{name, std::make_shared<Path>(path), nullptr, limits, factor};
    c.curve = std::make_shared<PathCurve>(*c.path, static_cast<int>(limits.size()), machine);
    return c;
}

/// A curve that no Path knows: axes as functions of s, which need not be a length.
class FreeCurve final : public TimedCurve {
public:
    using Axes = std::function<std::vector<Jet>(const Jet&)>;
    FreeCurve(double length, double feature, const PathLimits& path, Axes axes)
        : length_(length),
          feature_(feature),
          path_(path),
          axes_(std::move(axes)),
          count_(static_cast<int>(axes_(Jet{0, 1, 0, 0}).size())) {}
    [[nodiscard]] int axes() const noexcept override { return count_; }
    [[nodiscard]] double begin() const noexcept override { return 0; }
    [[nodiscard]] double end() const noexcept override { return length_; }
    [[nodiscard]] TimedCurvePoint at(double s, CurveSide) const noexcept override {
        TimedCurvePoint p;
        p.path = path_;
        const auto q = axes_(Jet{s, 1, 0, 0});
        for (std::size_t i = 0; i < q.size(); ++i) p.first[i] = q[i].d1, p.second[i] = q[i].d2, p.third[i] = q[i].d3;
        return p;
    }
    [[nodiscard]] double next_break(double) const noexcept override { return length_; }
    [[nodiscard]] std::uint32_t part_at(double) const noexcept override { return 0; }
    [[nodiscard]] double next_stop(double) const noexcept override { return length_; }
    [[nodiscard]] double feature(double, CurveSide) const noexcept override { return feature_; }

private:
    double length_, feature_;
    PathLimits path_;
    Axes axes_;
    int count_;
};
inline Jet sine(const Jet& a) { return chain(a, std::sin(a.v), std::cos(a.v), -std::sin(a.v), -std::cos(a.v)); }
inline Jet cosine(const Jet& a) { return chain(a, std::cos(a.v), -std::sin(a.v), -std::cos(a.v), std::sin(a.v)); }
inline Case of_axes(const std::string& name, double length, double feature, const PathLimits& path,
                    const std::vector<PathAxisLimits>& limits, FreeCurve::Axes axes) {
    return {name, nullptr, std::make_shared<FreeCurve>(length, feature, path, std::move(axes)), limits, 1};
}
/// Joints of two links that carry the tool to (x, y), elbow to one side.
inline std::vector<Jet> two_links(const Jet& x, const Jet& y, double upper, double fore) {
    const Jet square = x * x + y * y, bend = (0.5 / (upper * fore)) * (square - Jet{upper * upper + fore * fore});
    const Jet side = root(Jet{1} - bend * bend);
    return {angle(y, x) - angle(fore * side, Jet{upper} + fore * bend), angle(side, bend)};
}

inline const std::vector<PathAxisLimits> uneven_axes{{200, 1000, 20'000}, {150, 800, 16'000}};
inline const PathLimits no_path_limits{1e9, 1e12, 1e12, 1e15};
inline const PathFeed some_feed{120, 700, 500, 9'000};

inline std::vector<Case> cases_of_the_project() {
    using std::numbers::pi;
    std::vector<Case> all;
    all.push_back(of_path("P corner 90, curve of 20", corner_path(20, pi / 2), uneven_axes));
    all.push_back(of_path("P corner 90, curve of 5", corner_path(5, pi / 2), uneven_axes));
    all.push_back(of_path("P corner 90, curve of 2", corner_path(2, pi / 2), uneven_axes));
    all.push_back(of_path("P corner 30, curve of 10", corner_path(10, pi / 6), uneven_axes));
    all.push_back(of_path("P corner 140, curve of 20", corner_path(20, 7 * pi / 9), uneven_axes));
    all.push_back(of_path("P corner with limits of the path", corner_path(20, pi / 2, 100, 100, some_feed), uneven_axes));
    all.push_back(of_path("P the same, a tenth", corner_path(20, pi / 2, 100, 100, some_feed), uneven_axes, 0.1));
    all.push_back(of_path("P the same, half", corner_path(20, pi / 2, 100, 100, some_feed), uneven_axes, 0.5));
    Path quarter, circle, slalom, line, rounded;
    append_element(quarter, plane_arc(at(0, 0), 50, 0, pi / 2, 1));
    append_element(circle, plane_arc(at(0, 0), 50, 0, 2 * pi, 1));
    append_element(slalom, plane_arc(at(0, 0), 50, 0, pi / 2, 1));
    append_element(slalom, plane_arc(at(50, 50), 50, pi / 2, pi / 2, -1), unlimited_feed, {BlendRule::corner_distance, 15});
    all.push_back(of_path("P quarter of a circle", quarter, uneven_axes));
    all.push_back(of_path("P circle", circle, uneven_axes));
    all.push_back(of_path("P S of two arcs", slalom, uneven_axes));
    const std::vector<PathAxisLimits> joints{{3, 20, 400}, {4, 30, 600}};
    append_element(line, PathElement::line(at(0, 0), at(-150, 200)));
    append_element(rounded, PathElement::line(at(0, 0), at(150, 100)));
    append_element(rounded, PathElement::line(at(150, 100), at(0, 200)), unlimited_feed, {BlendRule::corner_distance, 30});
    all.push_back(of_path("P two links, line", line, joints, 1, PathCurve::Machine::arm));
    all.push_back(of_path("P two links, corner", rounded, joints, 1, PathCurve::Machine::arm));
    return all;
}

inline std::vector<Case> own_cases() {
    using std::numbers::pi;
    std::vector<Case> all;
    all.push_back(of_path("line of 10", polygon({at(0, 0), at(10, 0)}, 0), uneven_axes));
    all.push_back(of_path("line of 0.01", polygon({at(0, 0), at(0.008, 0.006)}, 0), uneven_axes));
    all.push_back(of_path("line of 60 with a feed", polygon({at(0, 0), at(48, 36)}, 0, some_feed), uneven_axes));
    all.push_back(of_path("corner 60, curve of 1", corner_path(1, pi / 3), uneven_axes));
    all.push_back(of_path("corner 120, curve of 8", corner_path(8, 2 * pi / 3, 40, 70), uneven_axes));
    all.push_back(of_path("corner 155, curve of 10", corner_path(10, 155 * pi / 180, 60, 60), uneven_axes));
    all.push_back(of_path("corner 5, curve of 0.5", corner_path(0.5, 5 * pi / 180, 50, 50), uneven_axes));
    all.push_back(of_path("corner 90, all curve, 0.02", corner_path(0.01, pi / 2, 0.01, 0.01), uneven_axes));
    all.push_back(of_path("corner 90, all curve, 2", corner_path(1, pi / 2, 1, 1), uneven_axes));
    all.push_back(of_path("corner 100, curve in 2 of 300", corner_path(2, 100 * pi / 180, 300, 3), uneven_axes));
    all.push_back(of_path("zigzag, curves of 6", polygon({at(0, 0), at(40, 0), at(50, 40), at(90, 30)}, 6), uneven_axes));
    all.push_back(of_path("stairs, curves of 3", polygon({at(0, 0), at(10, 0), at(10, 10), at(20, 10), at(20, 20)}, 3), uneven_axes));
    all.push_back(of_path("corner 90, axes 50 to 1", corner_path(10, pi / 2), {{500, 5000, 100'000}, {10, 100, 2000}}));
    all.push_back(of_path("corner 60, second axis a 20th of jerk", corner_path(10, pi / 3), {{200, 1000, 20'000}, {200, 1000, 1000}}));
    all.push_back(of_path("corner 90, second axis much jerk", corner_path(10, pi / 2), {{200, 1000, 3'000}, {200, 1000, 1e6}}));
    Path helix, small_arc, tangent, three_arcs;
    {
        PathVector a = PathVector::Zero(), b = a, drift = a;
        a[0] = b[1] = 20;
        drift[2] = 5;
        append_element(helix, PathElement::arc(-a, a, b, drift, 4));
        append_element(small_arc, plane_arc(at(0, 0), 2, 0.3, 2.5, 1));
        append_element(tangent, PathElement::line(at(0, 0), at(60, 0)));
        append_element(tangent, plane_arc(at(60, 0), 15, 0, pi, 1), unlimited_feed, {BlendRule::corner_distance, 8});
        append_element(tangent, PathElement::line(at(60, 30), at(0, 30)), unlimited_feed, {BlendRule::corner_distance, 8});
        append_element(three_arcs, plane_arc(at(0, 0), 30, 0, 1.2, 1));
        const PathVector one = three_arcs.section_at(three_arcs.length()).at(three_arcs.length()).at;
        append_element(three_arcs, plane_arc(one, 18, 1.2, 2.0, -1), unlimited_feed, {BlendRule::corner_distance, 6});
        const PathVector two = one + plane_arc(one, 18, 1.2, 2.0, -1).at(36).at - one;
        append_element(three_arcs, plane_arc(two, 40, -0.8, 1.0, 1), unlimited_feed, {BlendRule::corner_distance, 6});
    }
    all.push_back(of_path("helix", helix, {{200, 1000, 20'000}, {150, 800, 16'000}, {60, 300, 5000}}));
    all.push_back(of_path("arc of radius 2", small_arc, uneven_axes));
    all.push_back(of_path("line, half a circle, line", tangent, uneven_axes));
    all.push_back(of_path("three arcs", three_arcs, uneven_axes));
    all.push_back(of_path("corner 90, feed of much jerk", corner_path(10, pi / 2, 80, 80, {100, 400, 1500, 1e6}), uneven_axes));
    // Not by a length.
    all.push_back(of_axes("sine", 100, 3, no_path_limits, uneven_axes, [](const Jet& s) {
        return std::vector<Jet>{s, 8.0 * sine(0.12 * s)};
    }));
    all.push_back(of_axes("one axis that turns back (q' = 0 of all)", 6, 0.3, {5, 30, 30, 1000}, {{200, 1000, 20'000}},
                          [](const Jet& s) { return std::vector<Jet>{30.0 * cosine(s - Jet{0.5})}; }));
    all.push_back(
        of_axes("an axis with q' = q'' = 0 midway", 2, 0.1, {20, 200, 200, 8000}, {{50, 400, 6000}, {50, 400, 6000}}, [](const Jet& s) {
            const Jet x = s - Jet{1};
            return std::vector<Jet>{20.0 * (x * x * x), 6.0 * s};
        }));
    all.push_back(of_axes("three axes in turn at q' = 0", 6, 0.2, no_path_limits, {{100, 900, 15'000}, {60, 900, 9'000}, {30, 200, 9'000}},
                          [](const Jet& s) {
                              return std::vector<Jet>{20.0 * sine(s), 20.0 * cosine(s), 10.0 * sine(2 * s + Jet{0.3})};
                          }));
    all.push_back(of_axes("two links, line past the shoulder", 600, 12, {400, 1e12, 1e12, 1e15}, {{3, 20, 400}, {4, 30, 600}},
                          [](const Jet& s) { return two_links(s - Jet{300}, Jet{180}, 300, 250); }));
    all.push_back(of_axes("two links, far out", 300, 5, no_path_limits, {{3, 20, 400}, {4, 30, 600}}, [](const Jet& s) {
        return two_links(Jet{530} - 0.00002 * (s - Jet{150}) * (s - Jet{150}), s - Jet{150}, 300, 260);
    }));
    all.push_back(of_axes("SCARA, circle of 40", 2 * pi, 0.15, no_path_limits, {{4, 30, 500}, {5, 40, 800}, {100, 800, 9000}, {8, 80, 900}},
                          [](const Jet& s) {
                              auto q = two_links(Jet{320} + 40.0 * cosine(s), Jet{60} + 40.0 * sine(s), 250, 210);
                              q.push_back(8.0 * sine(2 * s));
                              q.push_back(Jet{0} - q[0] - q[1]);
                              return q;
                          }));
    all.push_back(of_axes("SCARA past its column", 300, 4, no_path_limits, {{4, 30, 500}, {5, 40, 800}, {100, 800, 9000}, {8, 80, 900}},
                          [](const Jet& s) {
                              auto q = two_links(s - Jet{150}, Jet{90} + 0.1 * s, 220, 200);
                              q.push_back(0.2 * s);
                              q.push_back(Jet{0} - q[0] - q[1]);
                              return q;
                          }));
    all.push_back(of_axes("spiral, unequal axes", 9, 0.2, no_path_limits, {{200, 2000, 60'000}, {40, 200, 2500}}, [](const Jet& s) {
        const Jet r = Jet{12} + 3.0 * s;
        return std::vector<Jet>{r * cosine(s), r * sine(s)};
    }));
    return all;
}

inline std::vector<Case> fed_cases() {
    using std::numbers::pi;
    std::vector<Case> all;
    const PathFeed feed{120, 700, 500, 9'000}, quick{120, 1200, 1200, 40'000};
    all.push_back(of_path("F line of 200", polygon({at(0, 0), at(160, 120)}, 0, feed), uneven_axes));
    all.push_back(of_path("F corner 90, curve of 20", corner_path(20, pi / 2, 100, 100, feed), uneven_axes));
    all.push_back(of_path("F corner 90, curve of 2", corner_path(2, pi / 2, 100, 100, feed), uneven_axes));
    all.push_back(of_path("F corner 45, curve of 5", corner_path(5, pi / 4, 60, 90, quick), uneven_axes));
    all.push_back(
        of_path("F zigzag, curves of 6", polygon({at(0, 0), at(60, 0), at(70, 50), at(120, 30), at(180, 60)}, 6, quick), uneven_axes));
    Path slalom, circle;
    append_element(slalom, plane_arc(at(0, 0), 50, 0, pi / 2, 1), feed);
    append_element(slalom, plane_arc(at(50, 50), 50, pi / 2, pi / 2, -1), feed, {BlendRule::corner_distance, 15});
    append_element(circle, plane_arc(at(0, 0), 40, 0, 2 * pi, 1), quick);
    all.push_back(of_path("F S of two arcs", slalom, uneven_axes));
    all.push_back(of_path("F circle", circle, uneven_axes));
    Path rounded;
    const PathFeed of_arm{300, 3000, 2000, 50'000};
    append_element(rounded, PathElement::line(at(0, 0), at(150, 100)), of_arm);
    append_element(rounded, PathElement::line(at(150, 100), at(0, 200)), of_arm, {BlendRule::corner_distance, 30});
    all.push_back(of_path("F two links, corner", rounded, {{3, 20, 400}, {4, 30, 600}}, 1, PathCurve::Machine::arm));
    all.push_back(of_axes("F SCARA, circle of 40", 2 * pi, 0.15, {5, 40, 30, 700},
                          {{4, 30, 500}, {5, 40, 800}, {100, 800, 9000}, {8, 80, 900}}, [](const Jet& s) {
                              auto q = two_links(Jet{320} + 40.0 * cosine(s), Jet{60} + 40.0 * sine(s), 250, 210);
                              q.push_back(8.0 * sine(2 * s));
                              q.push_back(Jet{0} - q[0] - q[1]);
                              return q;
                          }));
    all.push_back(of_axes("F an axis that turns back", 6, 0.3, {5, 30, 30, 1000}, {{200, 1000, 20'000}},
                          [](const Jet& s) { return std::vector<Jet>{30.0 * cosine(s - Jet{0.5})}; }));
    return all;
}

/// A run at random: a program of one to three moves, the same through two links, or axes that are sums of waves.
inline Case drawn_case(std::uint64_t seed) {
    using std::numbers::pi;
    RandomProgram random(seed * 7919 + 17);
    const std::string name = "drawn " + std::to_string(seed);
    const int kind = random.whole(0, 3);
    if (kind == 0) {
        const int axes = random.whole(1, 4);
        std::vector<double> amplitudes, phases, frequencies;
        for (int i = 0; i < 2 * axes; ++i) {
            amplitudes.push_back(random.between_decades(0.3, 30));
            phases.push_back(random.uniform(0, 2 * pi));
            frequencies.push_back(random.between_decades(0.2, 3));
        }
        const double velocity = random.between_decades(3, 300), length = random.between_decades(0.05, 6);
        PathFeed feed = random.feed(velocity / 10);
        return of_axes(name, length, 0.1, {feed.velocity, feed.acceleration, feed.deceleration, feed.jerk}, random.limits(axes, velocity),
                       [=](const Jet& s) {
                           std::vector<Jet> q;
                           for (std::size_t i = 0; i < static_cast<std::size_t>(axes); ++i)
                               q.push_back(amplitudes[2 * i] * sine(frequencies[2 * i] * s + Jet{phases[2 * i]}) +
                                           amplitudes[2 * i + 1] * sine(frequencies[2 * i + 1] * s + Jet{phases[2 * i + 1]}));
                           return q;
                       });
    }
    const bool arm = kind == 1;
    const int axes = arm ? 2 : random.whole(1, 3), moves = random.whole(1, 3);
    const double size = arm ? random.between_decades(1, 40) : random.between_decades(0.1, 300),
                 velocity = size * random.between_decades(0.5, 8);
    Path path = random.path(moves, size, axes, velocity, 1);
    // Up to the first corner at rest.
    std::size_t count = 1;
    while (count < path.sections().size() && !path.sections()[count].stop_before) ++count;
    path.back_to({count, path.sections()[count - 1]});
    return of_path(name, path, random.limits(axes, arm ? random.between_decades(0.5, 5) : velocity), 1,
                   arm ? PathCurve::Machine::arm : PathCurve::Machine::cartesian);
}

}  // namespace taktwerk::axes
