// Plans looked at by a stranger: whether there is a faster motion that keeps every limit, from rest and from states of motion, and whether plans keep their limits at 200 instants a piece.
// What is faster is searched for in another way than the planner and the oracle of least_time_unit.cpp work (constant_jerk_search.hpp), and looked at finely before it counts.
//
// TAKTWERK_SOAK_FACTOR takes more cases, and from 2 on finer searches; 40 has all of them. TAKTWERK_PROGRAMS_FIRST=<seed> is where the drawn ones begin.
// Tests named DISABLED_ show what does not hold today: --gtest_also_run_disabled_tests.

#include <gtest/gtest.h>

#include <cstdio>
#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "axes/path_time/run_plan.hpp"
#include "tests/axes/path/points.hpp"
#include "tests/axes/path_time/constant_jerk_search.hpp"
#include "tests/axes/path_time/path_curve.hpp"
#include "tests/axes/path_time/random_program.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

using std::numbers::pi;

const PathFeed no_feed{1e9, 1e12, 1e12, 1e15};

// ------------------------------------------------------------------------------------------------------------------ what holds of a plan

struct Uses {
    double velocity = 0, acceleration = 0, jerk = 0;
    void widen(const Uses& u) {
        velocity = std::max(velocity, u.velocity);
        acceleration = std::max(acceleration, u.acceleration);
        jerk = std::max(jerk, u.jerk);
    }
};

/// Every piece at so many instants, its ends with the curve of their own side; `cap`: of v by s, instead of the path's velocity limit.
Uses uses_of(const RunPlan& plan, const TimedCurve& curve, const std::vector<PathAxisLimits>& limits, double factor, int parts = 200,
             const std::function<double(double)>& cap = {}) {
    Uses u;
    for (const TimePiece& piece : plan.pieces)
        for (int i = 0; i <= parts; ++i) {
            const PathMotion m = piece.at(piece.duration * i / parts);
            const double s = std::clamp(m.s, piece.begin, piece.begin + piece.length);
            for (const CurveSide side : {CurveSide::before, CurveSide::after}) {
                if ((i == 0 && side == CurveSide::before) || (i == parts && side == CurveSide::after)) continue;
                const TimedCurvePoint p = curve.at(s, side);
                const double v = m.velocity, a = m.acceleration, j = m.jerk;
                u.widen({v / (cap ? cap(s) : p.path.velocity * factor), a > 0 ? a / p.path.acceleration : -a / p.path.deceleration,
                         std::fabs(j) / p.path.jerk});
                for (std::size_t x = 0; x < limits.size(); ++x)
                    u.widen({std::fabs(p.first[x] * v) / limits[x].velocity,
                             std::fabs(p.first[x] * a + p.second[x] * v * v) / limits[x].acceleration,
                             std::fabs(p.first[x] * j + 3 * p.second[x] * v * a + p.third[x] * v * v * v) / limits[x].jerk});
            }
        }
    return u;
}

/// Of a plan, or of a part of it.
struct PlanMotion {
    const RunPlan& plan;
    double from = 0;  // s of its time
    PathMotion operator()(double t) const {
        t += from;
        std::size_t low = 0, high = plan.pieces.size();
        while (high - low > 1) (plan.pieces[(low + high) / 2].begin_time <= t ? low : high) = (low + high) / 2;
        return plan.pieces[low].at(std::min(t - plan.pieces[low].begin_time, plan.pieces[low].duration));
    }
};

// ------------------------------------------------------------------------------------------------------------------ faster ones

struct Found {
    double duration = 1e300;
    ConstantJerkSearch::Looked looked;
    bool holds = false;
};

Found settled(ConstantJerkSearch& search, bool from_rest) {
    Found f;
    f.looked = search.settle(8);
    f.duration = search.duration();
    f.holds = f.looked.gap < 1e-6 && f.looked.most() < (from_rest ? 1.01 : 1 + 3e-6);
    if (from_rest) f.duration *= std::max(1.0, f.looked.most());  // all of it so much slower keeps every limit
    return f;
}

/// From this motion, which need not keep the limits.
Found faster_than(const TimedCurve& curve, const std::vector<PathAxisLimits>& limits, const ConstantJerkSearch::Problem& problem,
                  const ConstantJerkSearch::MotionAt& motion, double duration, int cells) {
    Found best;
    for (const bool own_units : {false, true}) {
        ConstantJerkSearch search(curve, limits, problem);
        if (own_units) search.take_own_units();
        search.begin(motion, duration, cells / 3);
        (void)search.solve(80, 1e-5);
        search.refine(cells);
        (void)search.solve(40, 3e-6);
        best = settled(search, problem.velocity == 0 && problem.acceleration == 0);
        if (best.holds) break;
    }
    return best;
}

/// A smooth motion from rest to rest that has nothing of a plan, in a time drawn at random.
ConstantJerkSearch::MotionAt drawn_motion(std::uint64_t seed, double from, double length, double duration) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-0.12, 0.12);
    const double one = seed == 0 ? 0 : uniform(random), two = seed == 0 ? 0 : uniform(random) / 2;
    return [=](double t) {
        // Of a time that runs unevenly: w(x) = x + one sin(2 pi x) + two sin(4 pi x).
        const double x = t / duration, p = 2 * pi;
        const double w = x + one * std::sin(p * x) + two * std::sin(2 * p * x);
        const double w1 = 1 + one * p * std::cos(p * x) + 2 * two * p * std::cos(2 * p * x);
        const double w2 = -one * p * p * std::sin(p * x) - 4 * two * p * p * std::sin(2 * p * x);
        const double y = 1 - w, g1 = 30 * w * w * y * y, g2 = 60 * w * y * (1 - 2 * w);
        return PathMotion{from + length * w * w * w * (10 - 15 * w + 6 * w * w), length * g1 * w1 / duration,
                          length * (g2 * w1 * w1 + g1 * w2) / (duration * duration), 0};
    };
}

struct Case {
    std::string name;
    std::shared_ptr<Path> path;
    std::shared_ptr<TimedCurve> curve;
    std::vector<PathAxisLimits> limits;
    double factor = 1;
};

// ------------------------------------------------------------------------------------------------------------------ cases

void append(Path& path, const PathElement& element, const PathFeed& feed = no_feed, const BlendRequest& blend = {}) {
    PathMove move;
    move.element = element;
    move.feed = feed;
    ASSERT_TRUE(path.append(move, blend).ok());
}
PathElement arc(const PathVector& from, double radius, double heading, double angle, double sense) {
    const PathVector out = sense * radius * at(std::sin(heading), -std::cos(heading)),
                     along = radius * at(std::cos(heading), std::sin(heading));
    return PathElement::arc(from - out, out, along, at(0, 0), angle);
}
Path polygon(const std::vector<PathVector>& points, double distance, const PathFeed& feed = no_feed) {
    Path path;
    for (std::size_t i = 1; i < points.size(); ++i)
        append(path, PathElement::line(points[i - 1], points[i]), feed, {BlendRule::corner_distance, distance});
    return path;
}
Path corner(double distance, double angle, double first = 100, double second = 100, const PathFeed& feed = no_feed) {
    return polygon({at(0, 0), at(first, 0), at(first + second * std::cos(angle), second * std::sin(angle))}, distance, feed);
}
Case of_path(const std::string& name, const Path& path, const std::vector<PathAxisLimits>& limits, double factor = 1,
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
Jet sine(const Jet& a) { return chain(a, std::sin(a.v), std::cos(a.v), -std::sin(a.v), -std::cos(a.v)); }
Jet cosine(const Jet& a) { return chain(a, std::cos(a.v), -std::sin(a.v), -std::cos(a.v), std::sin(a.v)); }
Case of_axes(const std::string& name, double length, double feature, const PathLimits& path, const std::vector<PathAxisLimits>& limits,
             FreeCurve::Axes axes) {
    return {name, nullptr, std::make_shared<FreeCurve>(length, feature, path, std::move(axes)), limits, 1};
}
/// Joints of two links that carry the tool to (x, y), elbow to one side.
std::vector<Jet> two_links(const Jet& x, const Jet& y, double upper, double fore) {
    const Jet square = x * x + y * y, bend = (0.5 / (upper * fore)) * (square - Jet{upper * upper + fore * fore});
    const Jet side = root(Jet{1} - bend * bend);
    return {angle(y, x) - angle(fore * side, Jet{upper} + fore * bend), angle(side, bend)};
}

const std::vector<PathAxisLimits> two_axes{{200, 1000, 20'000}, {150, 800, 16'000}};
const PathLimits nothing{1e9, 1e12, 1e12, 1e15};
const PathFeed some_feed{120, 700, 500, 9'000};

std::vector<Case> cases_of_the_project() {
    std::vector<Case> all;
    all.push_back(of_path("P corner 90, curve of 20", corner(20, pi / 2), two_axes));
    all.push_back(of_path("P corner 90, curve of 5", corner(5, pi / 2), two_axes));
    all.push_back(of_path("P corner 90, curve of 2", corner(2, pi / 2), two_axes));
    all.push_back(of_path("P corner 30, curve of 10", corner(10, pi / 6), two_axes));
    all.push_back(of_path("P corner 140, curve of 20", corner(20, 7 * pi / 9), two_axes));
    all.push_back(of_path("P corner with limits of the path", corner(20, pi / 2, 100, 100, some_feed), two_axes));
    all.push_back(of_path("P the same, a tenth", corner(20, pi / 2, 100, 100, some_feed), two_axes, 0.1));
    all.push_back(of_path("P the same, half", corner(20, pi / 2, 100, 100, some_feed), two_axes, 0.5));
    Path quarter, circle, slalom, line, rounded;
    append(quarter, arc(at(0, 0), 50, 0, pi / 2, 1));
    append(circle, arc(at(0, 0), 50, 0, 2 * pi, 1));
    append(slalom, arc(at(0, 0), 50, 0, pi / 2, 1));
    append(slalom, arc(at(50, 50), 50, pi / 2, pi / 2, -1), no_feed, {BlendRule::corner_distance, 15});
    all.push_back(of_path("P quarter of a circle", quarter, two_axes));
    all.push_back(of_path("P circle", circle, two_axes));
    all.push_back(of_path("P S of two arcs", slalom, two_axes));
    const std::vector<PathAxisLimits> joints{{3, 20, 400}, {4, 30, 600}};
    append(line, PathElement::line(at(0, 0), at(-150, 200)));
    append(rounded, PathElement::line(at(0, 0), at(150, 100)));
    append(rounded, PathElement::line(at(150, 100), at(0, 200)), no_feed, {BlendRule::corner_distance, 30});
    all.push_back(of_path("P two links, line", line, joints, 1, PathCurve::Machine::arm));
    all.push_back(of_path("P two links, corner", rounded, joints, 1, PathCurve::Machine::arm));
    return all;
}

std::vector<Case> own_cases() {
    std::vector<Case> all;
    all.push_back(of_path("line of 10", polygon({at(0, 0), at(10, 0)}, 0), two_axes));
    all.push_back(of_path("line of 0.01", polygon({at(0, 0), at(0.008, 0.006)}, 0), two_axes));
    all.push_back(of_path("line of 60 with a feed", polygon({at(0, 0), at(48, 36)}, 0, some_feed), two_axes));
    all.push_back(of_path("corner 60, curve of 1", corner(1, pi / 3), two_axes));
    all.push_back(of_path("corner 120, curve of 8", corner(8, 2 * pi / 3, 40, 70), two_axes));
    all.push_back(of_path("corner 155, curve of 10", corner(10, 155 * pi / 180, 60, 60), two_axes));
    all.push_back(of_path("corner 5, curve of 0.5", corner(0.5, 5 * pi / 180, 50, 50), two_axes));
    all.push_back(of_path("corner 90, all curve, 0.02", corner(0.01, pi / 2, 0.01, 0.01), two_axes));
    all.push_back(of_path("corner 90, all curve, 2", corner(1, pi / 2, 1, 1), two_axes));
    all.push_back(of_path("corner 100, curve in 2 of 300", corner(2, 100 * pi / 180, 300, 3), two_axes));
    all.push_back(of_path("zigzag, curves of 6", polygon({at(0, 0), at(40, 0), at(50, 40), at(90, 30)}, 6), two_axes));
    all.push_back(of_path("stairs, curves of 3", polygon({at(0, 0), at(10, 0), at(10, 10), at(20, 10), at(20, 20)}, 3), two_axes));
    all.push_back(of_path("corner 90, axes 50 to 1", corner(10, pi / 2), {{500, 5000, 100'000}, {10, 100, 2000}}));
    all.push_back(of_path("corner 60, second axis a 20th of jerk", corner(10, pi / 3), {{200, 1000, 20'000}, {200, 1000, 1000}}));
    all.push_back(of_path("corner 90, second axis much jerk", corner(10, pi / 2), {{200, 1000, 3'000}, {200, 1000, 1e6}}));
    Path helix, small_arc, tangent, three_arcs;
    {
        PathVector a = PathVector::Zero(), b = a, drift = a;
        a[0] = b[1] = 20;
        drift[2] = 5;
        append(helix, PathElement::arc(-a, a, b, drift, 4));
        append(small_arc, arc(at(0, 0), 2, 0.3, 2.5, 1));
        append(tangent, PathElement::line(at(0, 0), at(60, 0)));
        append(tangent, arc(at(60, 0), 15, 0, pi, 1), no_feed, {BlendRule::corner_distance, 8});
        append(tangent, PathElement::line(at(60, 30), at(0, 30)), no_feed, {BlendRule::corner_distance, 8});
        append(three_arcs, arc(at(0, 0), 30, 0, 1.2, 1));
        const PathVector one = three_arcs.section_at(three_arcs.length()).at(three_arcs.length()).at;
        append(three_arcs, arc(one, 18, 1.2, 2.0, -1), no_feed, {BlendRule::corner_distance, 6});
        const PathVector two = one + arc(one, 18, 1.2, 2.0, -1).at(36).at - one;
        append(three_arcs, arc(two, 40, -0.8, 1.0, 1), no_feed, {BlendRule::corner_distance, 6});
    }
    all.push_back(of_path("helix", helix, {{200, 1000, 20'000}, {150, 800, 16'000}, {60, 300, 5000}}));
    all.push_back(of_path("arc of radius 2", small_arc, two_axes));
    all.push_back(of_path("line, half a circle, line", tangent, two_axes));
    all.push_back(of_path("three arcs", three_arcs, two_axes));
    all.push_back(of_path("corner 90, feed of much jerk", corner(10, pi / 2, 80, 80, {100, 400, 1500, 1e6}), two_axes));
    // Not by a length.
    all.push_back(of_axes("sine", 100, 3, nothing, two_axes, [](const Jet& s) { return std::vector<Jet>{s, 8.0 * sine(0.12 * s)}; }));
    all.push_back(of_axes("one axis that turns back (q' = 0 of all)", 6, 0.3, {5, 30, 30, 1000}, {{200, 1000, 20'000}},
                          [](const Jet& s) { return std::vector<Jet>{30.0 * cosine(s - Jet{0.5})}; }));
    all.push_back(
        of_axes("an axis with q' = q'' = 0 midway", 2, 0.1, {20, 200, 200, 8000}, {{50, 400, 6000}, {50, 400, 6000}}, [](const Jet& s) {
            const Jet x = s - Jet{1};
            return std::vector<Jet>{20.0 * (x * x * x), 6.0 * s};
        }));
    all.push_back(of_axes("three axes in turn at q' = 0", 6, 0.2, nothing, {{100, 900, 15'000}, {60, 900, 9'000}, {30, 200, 9'000}},
                          [](const Jet& s) {
                              return std::vector<Jet>{20.0 * sine(s), 20.0 * cosine(s), 10.0 * sine(2 * s + Jet{0.3})};
                          }));
    all.push_back(of_axes("two links, line past the shoulder", 600, 12, {400, 1e12, 1e12, 1e15}, {{3, 20, 400}, {4, 30, 600}},
                          [](const Jet& s) { return two_links(s - Jet{300}, Jet{180}, 300, 250); }));
    all.push_back(of_axes("two links, far out", 300, 5, nothing, {{3, 20, 400}, {4, 30, 600}}, [](const Jet& s) {
        return two_links(Jet{530} - 0.00002 * (s - Jet{150}) * (s - Jet{150}), s - Jet{150}, 300, 260);
    }));
    all.push_back(of_axes("SCARA, circle of 40", 2 * pi, 0.15, nothing, {{4, 30, 500}, {5, 40, 800}, {100, 800, 9000}, {8, 80, 900}},
                          [](const Jet& s) {
                              auto q = two_links(Jet{320} + 40.0 * cosine(s), Jet{60} + 40.0 * sine(s), 250, 210);
                              q.push_back(8.0 * sine(2 * s));
                              q.push_back(Jet{0} - q[0] - q[1]);
                              return q;
                          }));
    all.push_back(
        of_axes("SCARA past its column", 300, 4, nothing, {{4, 30, 500}, {5, 40, 800}, {100, 800, 9000}, {8, 80, 900}}, [](const Jet& s) {
            auto q = two_links(s - Jet{150}, Jet{90} + 0.1 * s, 220, 200);
            q.push_back(0.2 * s);
            q.push_back(Jet{0} - q[0] - q[1]);
            return q;
        }));
    all.push_back(of_axes("spiral, unequal axes", 9, 0.2, nothing, {{200, 2000, 60'000}, {40, 200, 2500}}, [](const Jet& s) {
        const Jet r = Jet{12} + 3.0 * s;
        return std::vector<Jet>{r * cosine(s), r * sine(s)};
    }));
    return all;
}

// ------------------------------------------------------------------------------------------------------------------ from rest

bool in_depth() { return property_cases(1) > 1; }
int cells_of_a_search() { return in_depth() ? 240 : 90; }

struct Gaps {
    std::vector<double> all;
    void add(double gap) { all.push_back(gap); }
    void report(const char* what) {
        if (all.empty()) return;
        std::sort(all.begin(), all.end());
        std::printf("%s: %zu, above what was found: median %.2f %%, p90 %.2f %%, most %.2f %%\n", what, all.size(),
                    100 * all[all.size() / 2], 100 * all[all.size() * 9 / 10], 100 * all.back());
    }
};

void from_rest(const Case& c, int drawn, Gaps& gaps) {
    RunPlanner planner;
    RunPlan plan;
    RunTask task;
    task.to = c.curve->end();
    task.velocity_factor = c.factor;
    planner.plan(*c.curve, c.limits, task, plan);
    ASSERT_TRUE(plan.found) << c.name;
    const Uses u = uses_of(plan, *c.curve, c.limits, c.factor);
    EXPECT_LE(u.velocity, 1 + 1e-6) << c.name;
    EXPECT_LE(u.acceleration, 1 + 1e-6) << c.name;
    EXPECT_LE(u.jerk, 1 + 1e-3) << c.name;
    const ConstantJerkSearch::Problem problem{.from = 0, .to = task.to, .velocity_factor = c.factor};
    Found best = faster_than(*c.curve, c.limits, problem, PlanMotion{plan}, plan.duration, cells_of_a_search());
    const Found from_plan = best;
    double least = 1e300, most = 0;
    for (int i = 0; i < drawn; ++i) {
        const double duration = (1.2 + 0.7 * i) * plan.duration;
        const Found f = faster_than(*c.curve, c.limits, problem, drawn_motion(static_cast<std::uint64_t>(i), 0, task.to, duration),
                                    duration, cells_of_a_search());
        if (!f.holds) continue;
        least = std::min(least, f.duration);
        most = std::max(most, f.duration);
        if (f.duration < best.duration || !best.holds) best = f;
    }
    const double gap = plan.duration / best.duration - 1;
    std::printf("%-42s %9.5f s  %+6.2f %% (from the plan %+.2f %s, drawn %+.2f to %+.2f)  uses 1%+.0e 1%+.0e 1%+.0e\n", c.name.c_str(),
                plan.duration, 100 * gap, 100 * (plan.duration / from_plan.duration - 1), from_plan.holds ? "" : "NOT HELD",
                100 * (plan.duration / least - 1), 100 * (plan.duration / most - 1), u.velocity - 1, u.acceleration - 1, u.jerk - 1);
    std::fflush(stdout);
    if (best.holds) gaps.add(std::max(gap, 0.0));
}

/// So many of them, evenly.
std::vector<Case> some_of(std::vector<Case> all, std::size_t count) {
    std::vector<Case> some;
    count = std::min(count, all.size());
    for (std::size_t i = 0; i < count; ++i) some.push_back(std::move(all[i * all.size() / count]));
    return some;
}
/// A plan is at most so much above what a search finds: 0.99 % where one axis has a fifth of the other's jerk, 0.8 % on short lines. Of 68 drawn ones half are below 0.28 %, nine of ten
/// below 1.1 %, the last is at 10.7 % (drawn 33; TheWayBackTakesAsLong says why).
constexpr double promised = 0.012, promised_drawn = 0.12;

// What the limits are looked at with: the derivatives are those of the axes' places, by differences.
TEST(IndependentTime, DerivativesAreThoseOfThePlaces) {
    for (const auto& all : {cases_of_the_project(), own_cases()})
        for (const Case& c : all) {
            if (c.path == nullptr) continue;
            const auto& curve = static_cast<const PathCurve&>(*c.curve);
            for (std::uint32_t part = 0; part < c.path->sections().size(); ++part) {
                const auto& section = c.path->sections()[part];
                const double h = 1e-3 * std::min(section.length, curve.feature(section.begin + section.length / 2, CurveSide::after));
                for (int i = 1; i < 12; ++i) {
                    const double s = section.begin + section.length * i / 12;
                    const PathAxes low = curve.axes_in(part, s - h), middle = curve.axes_in(part, s), high = curve.axes_in(part, s + h);
                    for (std::size_t x = 0; x < c.limits.size(); ++x) {
                        const double first = middle.point.first[x], second = middle.point.second[x], third = middle.point.third[x];
                        const double size = std::fabs(first) + h * std::fabs(second) + 1e-3;
                        EXPECT_NEAR((high.q[x] - low.q[x]) / (2 * h), first + h * h / 6 * third, 1e-6 * size) << c.name << ' ' << s;
                        EXPECT_NEAR((high.point.first[x] - low.point.first[x]) / 2, h * second, 2e-6 * size) << c.name << ' ' << s;
                        EXPECT_NEAR((high.point.second[x] - low.point.second[x]) * h / 2, h * h * third, 2e-6 * size) << c.name << ' ' << s;
                    }
                }
            }
        }
}

// The search itself. Of a line of 10 u with 1000 u/s2 and 20,000 u/s3 the least time is known by hand: A/J + sqrt((A/J)^2 + 4 s/A).
TEST(IndependentTime, TheSearchComesToTheKnownTimeOfALineAndNeverBelow) {
    const Case c = of_path("line of 10", polygon({at(0, 0), at(10, 0)}, 0), two_axes);
    const double best = 0.05 + std::sqrt(0.05 * 0.05 + 0.04);
    const Found f = faster_than(*c.curve, c.limits, {.from = 0, .to = 10}, drawn_motion(0, 0, 10, 0.31), 0.31, 120);
    EXPECT_TRUE(f.holds);
    EXPECT_GE(f.duration, best * (1 - 1e-8));
    EXPECT_LE(f.duration, best * 1.001);
}

TEST(IndependentTime, FromRestNothingMuchFasterIsFound) {
    Gaps gaps;
    const int drawn = in_depth() ? 2 : 1;
    for (const Case& c : some_of(cases_of_the_project(), property_cases(1))) from_rest(c, drawn, gaps);
    for (const Case& c : some_of(own_cases(), property_cases(1))) from_rest(c, drawn, gaps);
    gaps.report("from rest");
    ASSERT_FALSE(gaps.all.empty());
    EXPECT_LE(gaps.all.back(), promised);
}

// ------------------------------------------------------------------------------------------------------------------ from states of motion

/// v of a plan by s.
class VelocityByWay {
public:
    explicit VelocityByWay(const RunPlan& plan) : plan_(plan) {}
    double operator()(double s) const {
        std::size_t low = 0, high = plan_.pieces.size();
        while (high - low > 1) (plan_.pieces[(low + high) / 2].begin <= s ? low : high) = (low + high) / 2;
        const TimePiece& p = plan_.pieces[low];
        const double x = std::clamp(s - p.begin, 0.0, p.length);
        if (p.kind == TimePiece::Kind::from_rest) return std::cbrt(4.5 * p.slope * x * x);
        if (p.kind == TimePiece::Kind::to_rest) return std::cbrt(4.5 * p.slope * (p.length - x) * (p.length - x));
        return std::sqrt(std::max(0.0, p.velocity * p.velocity + x * (2 * p.slope + p.curvature * x)));
    }

private:
    const RunPlan& plan_;
};

struct State {
    double at = 0, left = 0;  ///< s; time of the former plan behind it
    RunTask task;
};
/// The border of a plan that lies about there, in parts of its time.
State state_of(const RunPlan& plan, double part) {
    std::size_t i = 1;
    while (i + 2 < plan.pieces.size() && plan.pieces[i].begin_time < part * plan.duration) ++i;
    const TimePiece& p = plan.pieces[i];
    State s;
    s.at = p.begin_time;
    s.left = plan.duration - p.begin_time;
    s.task.from = p.begin;
    s.task.velocity = p.velocity;
    s.task.acceleration = p.slope;
    return s;
}

struct Moving {
    Gaps same, raised, lowered, grown, to_obey;
    std::size_t not_found = 0, found = 0, not_held = 0;
    Uses uses;
    void report(const char* what) {
        std::printf("-- %s: %zu found, %zu not found, %zu without a search that held; uses 1%+.1e 1%+.1e 1%+.1e\n", what, found, not_found,
                    not_held, uses.velocity - 1, uses.acceleration - 1, uses.jerk - 1);
        same.report("   the same once more");
        raised.report("   a raised velocity factor");
        lowered.report("   a lowered one (no faster than the plan where that is above it)");
        grown.report("   an end that has moved on");
        to_obey.report("   the way until a lowered one is come to, beside the least one");
    }
};

/// Plans on from a state, and compares.
void go_on(const std::string& name, const Case& c, RunTask task, const RunPlan& former, double at, Gaps& gaps, Moving& totals,
           bool lowered = false) {
    RunPlanner planner;
    RunPlan plan;
    planner.plan(*c.curve, c.limits, task, plan, &former.shape);
    if (!plan.found) {
        ++totals.not_found;
        std::printf("   %-40s %-28s from %-9.4g v %-8.4g a %-9.3g: not found\n", c.name.c_str(), name.c_str(), task.from, task.velocity,
                    task.acceleration);
        return;
    }
    ++totals.found;
    ConstantJerkSearch::Problem problem{.from = task.from,
                                        .to = task.to,
                                        .velocity = task.velocity,
                                        .acceleration = task.acceleration,
                                        .velocity_factor = task.velocity_factor};
    double obeys = task.from;
    const VelocityByWay velocity(plan);
    const auto wanted = [&](double s) {
        return std::min(c.curve->at(s, CurveSide::before).path.velocity, c.curve->at(s, CurveSide::after).path.velocity) *
               task.velocity_factor;
    };
    if (lowered && task.velocity > wanted(task.from)) {
        // Until it has come down.
        constexpr int parts = 20'000;
        for (int i = 0; i <= parts; ++i) {
            obeys = task.from + (task.to - task.from) * i / parts;
            if (velocity(obeys) <= wanted(obeys) * (1 + 1e-4)) break;
        }
        problem.cap = [&](double s) { return s <= obeys ? std::max(wanted(s), velocity(s) * (1 + 1e-6)) : wanted(s) * (1 + 1e-6); };
    }
    const Uses u = uses_of(plan, *c.curve, c.limits, task.velocity_factor, 200, problem.cap);
    totals.uses.widen(u);
    // A lowered velocity is no limit that is never crossed (see the tests at the end); the path's own is.
    const double hard = lowered ? uses_of(plan, *c.curve, c.limits, 1, 40).velocity : u.velocity;
    EXPECT_LE(hard, 1 + (task.velocity_factor < 1 ? 1e-3 : 1e-6)) << c.name << ' ' << name << " from " << task.from;
    EXPECT_LE(u.acceleration, 1 + 1e-6) << c.name << ' ' << name << " from " << task.from;
    EXPECT_LE(u.jerk, 1 + 1e-3) << c.name << ' ' << name << " from " << task.from;
    const Found best = faster_than(*c.curve, c.limits, problem, PlanMotion{plan}, plan.duration, cells_of_a_search());
    double least = 1e300;
    if (best.holds) least = best.duration;
    if (std::fabs(former.shape.end - task.to) < 1e-9 * task.to && !problem.cap && task.velocity_factor >= former.shape.velocity_factor) {
        least = std::min(least, former.duration - at);  // what runs is a motion too
        const Found other = faster_than(*c.curve, c.limits, problem, PlanMotion{former, at}, former.duration - at, cells_of_a_search());
        if (other.holds) least = std::min(least, other.duration);
    }
    if (least > 1e299) {
        ++totals.not_held;
        std::printf("   %-40s %-28s from %-9.4g v %-8.4g a %-9.3g: %9.5f s  no search held\n", c.name.c_str(), name.c_str(), task.from,
                    task.velocity, task.acceleration, plan.duration);
        return;
    }
    const double gap = plan.duration / std::min(least, plan.duration) - 1;  // it is a motion as well
    gaps.add(gap);
    std::printf("   %-40s %-28s from %-9.4g v %-8.4g a %-9.3g: %9.5f s %+6.2f %%", c.name.c_str(), name.c_str(), task.from, task.velocity,
                task.acceleration, plan.duration, 100 * gap);
    if (problem.cap && in_depth()) {
        // The least way: halved as long as a search still keeps what is wanted behind it.
        double low = task.from, high = obeys;
        for (int i = 0; i < 6; ++i) {
            const double middle = (low + high) / 2;
            auto sooner = problem;
            sooner.cap = [&, middle](double s) { return s < middle ? 1e9 : wanted(s) * (1 + 1e-6); };
            ConstantJerkSearch search(*c.curve, c.limits, sooner);
            search.begin(PlanMotion{plan}, plan.duration, 60);
            (void)search.solve(60, 1e-5);
            (search.crossed() < 1e-6 && search.look(1).gap < 1e-5 ? high : low) = middle;
        }
        std::printf("  comes down over %.4g, %.2f times the least way", obeys - task.from, (obeys - task.from) / (high - task.from));
        totals.to_obey.add((obeys - task.from) / (high - task.from) - 1);
    }
    std::printf("\n");
    std::fflush(stdout);
}

void from_states(const Case& c, const std::vector<double>& parts, Moving& totals) {
    RunPlanner planner;
    RunPlan full, slow, shorter;
    RunTask task;
    task.to = c.curve->end();
    planner.plan(*c.curve, c.limits, task, full);
    const bool fed = c.curve->at(0, CurveSide::after).path.velocity < 1e8;
    if (fed) {
        task.velocity_factor = 0.3;
        planner.plan(*c.curve, c.limits, task, slow);
    }
    RunTask half;
    half.to = 0.55 * task.to;
    planner.plan(*c.curve, c.limits, half, shorter);
    for (const double part : parts) {
        State s = state_of(full, part);
        s.task.to = task.to;
        go_on("the same", c, s.task, full, s.at, totals.same, totals);
        if (fed)
            for (const double factor : {0.6, 0.15}) {
                s.task.velocity_factor = factor;
                go_on("lowered to " + std::to_string(factor).substr(0, 4), c, s.task, full, s.at, totals.lowered, totals, true);
            }
        if (fed && slow.found) {
            State t = state_of(slow, part);
            t.task.to = task.to;
            go_on("raised from 0.3 to 1", c, t.task, slow, t.at, totals.raised, totals);
        }
        if (shorter.found) {
            State t = state_of(shorter, part);
            t.task.to = task.to;
            go_on("the end moved on", c, t.task, shorter, t.at, totals.grown, totals);
        }
    }
}

std::vector<Case> fed_cases() {
    std::vector<Case> all;
    const PathFeed feed{120, 700, 500, 9'000}, quick{120, 1200, 1200, 40'000};
    all.push_back(of_path("F line of 200", polygon({at(0, 0), at(160, 120)}, 0, feed), two_axes));
    all.push_back(of_path("F corner 90, curve of 20", corner(20, pi / 2, 100, 100, feed), two_axes));
    all.push_back(of_path("F corner 90, curve of 2", corner(2, pi / 2, 100, 100, feed), two_axes));
    all.push_back(of_path("F corner 45, curve of 5", corner(5, pi / 4, 60, 90, quick), two_axes));
    all.push_back(
        of_path("F zigzag, curves of 6", polygon({at(0, 0), at(60, 0), at(70, 50), at(120, 30), at(180, 60)}, 6, quick), two_axes));
    Path slalom, circle;
    append(slalom, arc(at(0, 0), 50, 0, pi / 2, 1), feed);
    append(slalom, arc(at(50, 50), 50, pi / 2, pi / 2, -1), feed, {BlendRule::corner_distance, 15});
    append(circle, arc(at(0, 0), 40, 0, 2 * pi, 1), quick);
    all.push_back(of_path("F S of two arcs", slalom, two_axes));
    all.push_back(of_path("F circle", circle, two_axes));
    Path rounded;
    const PathFeed of_arm{300, 3000, 2000, 50'000};
    append(rounded, PathElement::line(at(0, 0), at(150, 100)), of_arm);
    append(rounded, PathElement::line(at(150, 100), at(0, 200)), of_arm, {BlendRule::corner_distance, 30});
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

TEST(IndependentTime, FromStatesOfMotionNothingMuchFasterIsFound) {
    Moving totals;
    const bool all = in_depth();
    const std::vector<double> parts = all ? std::vector<double>{0.1, 0.3, 0.5, 0.8} : std::vector<double>{0.5};
    for (const Case& c : some_of(fed_cases(), property_cases(1))) from_states(c, parts, totals);
    if (all)
        for (const auto& others : {cases_of_the_project(), own_cases()})
            for (const Case& c : some_of(others, property_cases(1)))
                if (c.factor == 1) from_states(c, {0.12, 0.45, 0.75}, totals);
    totals.report("from states of motion");
    for (const Gaps* g : {&totals.same, &totals.raised, &totals.lowered, &totals.grown})
        if (!g->all.empty()) {
            EXPECT_LE(g->all.back(), promised);
        }
    EXPECT_GT(totals.found, 2u);
}

// ------------------------------------------------------------------------------------------------------------------ drawn

/// A run at random: a program of one to three moves, the same through two links, or axes that are sums of waves.
Case drawn_case(std::uint64_t seed) {
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

TEST(IndependentTime, DrawnFromRestNothingMuchFasterIsFound) {
    Gaps gaps;
    const std::size_t cases = property_cases(1);
    const std::uint64_t first = first_program();
    for (std::uint64_t seed = first; seed < first + cases; ++seed) from_rest(drawn_case(seed), 0, gaps);
    gaps.report("from rest, drawn");
    if (!gaps.all.empty()) {
        EXPECT_LE(gaps.all.back(), promised_drawn);
    }
}
TEST(IndependentTime, DrawnFromStatesOfMotionAreLookedAt) {
    Moving totals;
    const std::size_t cases = in_depth() ? property_cases(1) : 0;
    const std::uint64_t first = first_program();
    for (std::uint64_t seed = first; seed < first + cases; ++seed) {
        RandomProgram random(seed);
        from_states(drawn_case(seed), {random.uniform(0.05, 0.9)}, totals);
    }
    totals.report("drawn");
}
/// Limits alone: from rest, from states, lowered, raised, grown.
TEST(IndependentTime, DrawnPlansKeepEveryLimit) {
    Uses rest, moving;
    std::size_t plans = 0, lost = 0, went_on = 0, not_found = 0, instants = 0, lowered = 0, above_both = 0;
    double furthest_above = 0;
    const std::size_t cases = property_cases(6);
    const std::uint64_t first = first_program();
    RunPlanner planner;
    for (std::uint64_t seed = first; seed < first + cases && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "drawn " << seed);
        const Case c = drawn_case(seed);
        RandomProgram random(seed + 1'000'000);
        RunTask task;
        task.to = c.curve->end();
        task.velocity_factor = random.uniform(0, 1) < 0.5 ? 1 : random.between_decades(0.05, 1);
        RunPlan plan, next;
        planner.plan(*c.curve, c.limits, task, plan);
        ++plans;
        if (!plan.found) {
            ++lost;
            std::printf("drawn %llu: not planned\n", static_cast<unsigned long long>(seed));
            continue;
        }
        const Uses u = uses_of(plan, *c.curve, c.limits, task.velocity_factor);
        instants += plan.pieces.size() * 201;
        rest.widen(u);
        EXPECT_LE(u.velocity, 1 + 1e-6);
        EXPECT_LE(u.acceleration, 1 + 1e-6);
        EXPECT_LE(u.jerk, 1 + 1e-3);
        if (plan.pieces.size() < 4) continue;
        for (int k = 0; k < 3; ++k) {
            State s = state_of(plan, random.uniform(0, 0.95));
            s.task.to = task.to;
            s.task.velocity_factor = k == 0 ? task.velocity_factor : random.between_decades(0.05, 1);
            planner.plan(*c.curve, c.limits, s.task, next, &plan.shape);
            if (!next.found) {
                ++not_found;
                continue;
            }
            ++went_on;
            instants += next.pieces.size() * 201;
            // Above a lowered velocity it may be, not above the path's own.
            const Uses n = uses_of(next, *c.curve, c.limits, s.task.velocity_factor < task.velocity_factor ? 1 : s.task.velocity_factor);
            moving.widen(n);
            if (s.task.velocity_factor < task.velocity_factor) {
                const Uses before = uses_of(next, *c.curve, c.limits, task.velocity_factor);
                above_both += before.velocity > 1 + 1e-6 ? 1 : 0;
                furthest_above = std::max(furthest_above, before.velocity);
                ++lowered;
            }
            // Where a factor scales it, it is kept to at nodes, and within 2.5e-4 between them (drawn 389).
            const bool scaled = s.task.velocity_factor >= task.velocity_factor && s.task.velocity_factor < 1;
            EXPECT_LE(n.velocity, 1 + (scaled ? 1e-3 : 1e-6)) << "from " << s.task.from << " to the factor " << s.task.velocity_factor;
            EXPECT_LE(n.acceleration, 1 + 1e-6) << "from " << s.task.from << " to the factor " << s.task.velocity_factor;
            EXPECT_LE(n.jerk, 1 + 1e-3) << "from " << s.task.from << " to the factor " << s.task.velocity_factor;
        }
    }
    std::printf(
        "%zu plans from rest, %zu not planned: uses 1%+.1e 1%+.1e 1%+.1e; %zu from states, %zu not found: 1%+.1e 1%+.1e 1%+.1e; %zu "
        "instants\n",
        plans, lost, rest.velocity - 1, rest.acceleration - 1, rest.jerk - 1, went_on, not_found, moving.velocity - 1,
        moving.acceleration - 1, moving.jerk - 1, instants);
    std::printf("%zu told to be slower, %zu of them above what the factor before allows as well: %.3f times that at most\n", lowered,
                above_both, furthest_above);
    EXPECT_LE(furthest_above, 1 + 1e-3);
}

// ------------------------------------------------------------------------------------------------------------------ what did not hold, and what does not

/// The highest velocity of a plan.
double top_of(const RunPlan& plan) {
    double top = 0;
    for (const TimePiece& p : plan.pieces)
        for (int i = 0; i <= 20; ++i) top = std::max(top, p.at(p.duration * i / 20).velocity);
    return top;
}
RunTask task_at(const TimePiece& piece, double to, double factor = 1) {
    RunTask task;
    task.from = piece.begin;
    task.to = to;
    task.velocity = piece.velocity;
    task.acceleration = piece.slope;
    task.velocity_factor = factor;
    return task;
}

struct LoweredInARamp {
    int told = 0, above_both = 0, above_though_below = 0;
    double beside_former = 0, beside_new = 0;
};
/// A line of 400 at this factor; told lower ones at every border of its ramp up.
LoweredInARamp lowered_in_a_ramp(double factor) {
    const PathFeed feed{100, 1000, 1000, 10'000};
    const Case c = of_path("line", polygon({at(0, 0), at(400, 0)}, 0, feed), {{1000, 1e5, 1e7}});
    RunPlanner planner;
    RunPlan plan, next;
    RunTask task;
    task.to = 400;
    task.velocity_factor = factor;
    planner.plan(*c.curve, c.limits, task, plan);
    LoweredInARamp found;
    const double former = factor * feed.velocity;
    for (std::size_t i = 1; i < plan.pieces.size() && plan.pieces[i].velocity < 0.999 * former; ++i)
        for (const double part : {0.95, 0.8, 0.5}) {
            const RunTask on = task_at(plan.pieces[i], 400, part * factor);
            planner.plan(*c.curve, c.limits, on, next, &plan.shape);
            if (!next.found) continue;
            ++found.told;
            const double top = top_of(next);
            found.beside_former = std::max(found.beside_former, top / former);
            found.above_both += top > former * (1 + 1e-3) ? 1 : 0;
            // What acceleration there is goes with all of the jerk: on a line that is a motion, and none stays lower.
            const double rising = std::max(on.acceleration, 0.0), least = on.velocity + rising * rising / (2 * feed.jerk);
            if (least > 0.97 * part * former) continue;
            found.beside_new = std::max(found.beside_new, top / (part * former));
            found.above_though_below += top > part * former * (1 + 1e-3) ? 1 : 0;
        }
    std::printf(
        "%d told: %d above the former factor's velocity, %.3f of it at most; %d above the new one's that could stay below, %.3f of it at "
        "most\n",
        found.told, found.above_both, found.beside_former, found.above_though_below, found.beside_new);
    return found;
}
// Who is told to be slower while it speeds up is never faster than it was allowed to be before. It was: its acceleration went as if it had to come back to the velocity of now. Of 60 u/s,
// told 48 at 29 u/s and 738 u/s2: 68 u/s.
TEST(IndependentTime, WhoIsToldToBeSlowerIsNeverFasterThanBefore) { EXPECT_EQ(lowered_in_a_ramp(0.6).above_both, 0); }
TEST(IndependentTime, WhoIsBelowALoweredVelocityAndCanStayThereDoes) { EXPECT_EQ(lowered_in_a_ramp(0.6).above_though_below, 0); }

// Where the end moves on while a run brakes for the former one, it goes on while it can. On a line its deceleration goes with all of the jerk; here more than half of the
// velocity is left then.
TEST(IndependentTime, AnEndThatMovesOnIsGoneOnTo) {
    const Case c = of_path("line of 10", polygon({at(0, 0), at(10, 0)}, 0), two_axes);
    RunPlanner planner;
    RunPlan plan, next;
    RunTask task;
    task.to = 5.5;
    planner.plan(*c.curve, c.limits, task, plan);
    int easy = 0, lost = 0;
    for (std::size_t i = 1; i + 1 < plan.pieces.size(); ++i) {
        const RunTask on = task_at(plan.pieces[i], 10);
        const double falling = std::min(on.acceleration, 0.0);
        if (falling * falling / (2 * two_axes[0].jerk) > 0.5 * on.velocity) continue;
        ++easy;
        planner.plan(*c.curve, c.limits, on, next, &plan.shape);
        if (next.found) continue;
        if (lost++ == 0) std::printf("from %.6g, %.6g u/s, %.6g u/s2: not found\n", on.from, on.velocity, on.acceleration);
    }
    std::printf("%d borders, %d not found\n", easy, lost);
    EXPECT_EQ(lost, 0);
}
// On an arc none was found from states that still speed up, where this search comes to a motion that keeps every limit.
TEST(IndependentTime, AnEndThatMovesOnIsGoneOnToOnAnArc) {
    Path small_arc;
    append(small_arc, arc(at(0, 0), 2, 0.3, 2.5, 1));
    const Case c = of_path("arc of radius 2", small_arc, two_axes);
    RunPlanner planner;
    RunPlan full, plan, next;
    RunTask task;
    task.to = c.curve->end();
    planner.plan(*c.curve, c.limits, task, full);
    task.to *= 0.55;
    planner.plan(*c.curve, c.limits, task, plan);
    for (const double part : {0.25, 0.35, 0.45, 0.55}) {
        const RunTask on = [&] {
            RunTask t = state_of(plan, part).task;
            t.to = c.curve->end();
            return t;
        }();
        planner.plan(*c.curve, c.limits, on, next, &plan.shape);
        if (next.found) continue;
        double low = 0, high = full.duration;
        for (int i = 0; i < 100; ++i) (PlanMotion{full}((low + high) / 2).s < on.from ? low : high) = (low + high) / 2;
        const Found f =
            faster_than(*c.curve, c.limits, {.from = on.from, .to = on.to, .velocity = on.velocity, .acceleration = on.acceleration},
                        PlanMotion{full, low}, full.duration - low, 150);
        EXPECT_FALSE(f.holds) << "from " << on.from << " with " << on.velocity << " u/s and " << on.acceleration
                              << " u/s2 there is a way of " << f.duration << " s, and none is planned";
    }
}

// A run of more than 64 sections is planned coarsely: 1.8 % above what is found for 65, where 59 are 0.25 % above it. (Some minutes.)
TEST(IndependentTime, DISABLED_RunsOfManySectionsComeAsNear) {
    std::mt19937_64 random(5);
    std::vector<PathVector> points{at(0, 0)};
    double heading = 0;
    for (int i = 0; i < 33; ++i) {
        points.push_back(points.back() + at(5 * std::cos(heading), 5 * std::sin(heading)));
        heading += std::uniform_real_distribution<double>(-0.9, 0.9)(random);
    }
    const Case c = of_path("contour of 33", polygon(points, 1), two_axes);
    RunPlanner planner;
    RunPlan plan;
    RunTask task;
    task.to = c.curve->end();
    planner.plan(*c.curve, c.limits, task, plan);
    ConstantJerkSearch search(*c.curve, c.limits, {.from = 0, .to = task.to});
    search.begin(PlanMotion{plan}, plan.duration, 660);
    (void)search.solve(150, 1e-6);
    const Found f = settled(search, true);
    std::printf("%zu sections: planned %.5f s, found %.5f s, jerk %.5f, pieces meet to %.1e\n", c.path->sections().size(), plan.duration,
                f.duration, f.looked.jerk, f.looked.gap);
    EXPECT_LE(plan.duration, f.duration * (1 + promised));
}

// Limits are the same in both directions, so the way back takes as long as the way there. It did not where a run ends on an arc at a place where an axis of little jerk has q' = 0: the
// piece to rest is one of constant jerk, as its moving end allows, and lasted 50 ms there. 0.529 s there, 0.508 s back (4.1 %).
TEST(IndependentTime, TheWayBackTakesAsLong) {
    RunPlanner planner;
    for (const double radius : {0.5, 5.0})
        for (const double weak : {0.1, 0.03})
            for (const double past : {0.0, 0.05}) {
                const std::vector<PathAxisLimits> limits{{200, 1000, 20'000}, {200, 1000 * weak, 20'000 * weak}};
                const double turn = pi / 4 + past;  // it ends heading so far beyond the first axis' direction
                Path there, back;
                const PathElement element = arc(at(0, 0), radius, past - turn, turn, 1);
                append(there, element);
                append(back, arc(element.at(element.length()).at, radius, past + pi, turn, -1));
                std::array<double, 2> durations{};
                for (int i = 0; i < 2; ++i) {
                    const Case c = of_path("arc", i == 0 ? there : back, limits);
                    RunPlan plan;
                    RunTask task;
                    task.to = c.curve->end();
                    planner.plan(*c.curve, c.limits, task, plan);
                    ASSERT_TRUE(plan.found);
                    durations[static_cast<std::size_t>(i)] = plan.duration;
                }
                EXPECT_NEAR(durations[0] / durations[1], 1, promised) << radius << ' ' << weak << ' ' << past;
            }
}
// Drawn 33 was 11 % above what is found, 24 of 344 ms in its last fiftieth; since that piece lasts 12 ms at most some 6 %.
TEST(IndependentTime, DISABLED_AnEndOnAnArcIsComeToSoon) {
    Gaps gaps;
    for (const std::uint64_t seed : {2, 33, 61}) from_rest(drawn_case(seed), 0, gaps);
    gaps.report("ends on arcs");
    EXPECT_LE(gaps.all.back(), promised);
}

// A factor is kept to between nodes as well where a plan goes on from a state of motion with the same factor.
TEST(IndependentTime, DISABLED_TheSameFactorIsKeptToBetweenNodes) {
    const Case c = drawn_case(389);
    RunTask task;
    task.to = c.curve->end();
    task.velocity_factor = 0.0927955667;
    RunPlanner planner;
    RunPlan plan, next;
    planner.plan(*c.curve, c.limits, task, plan);
    double worst = 0;
    for (std::size_t i = 1; i + 1 < plan.pieces.size(); i += 3) {
        planner.plan(*c.curve, c.limits, task_at(plan.pieces[i], task.to, task.velocity_factor), next, &plan.shape);
        if (next.found) worst = std::max(worst, uses_of(next, *c.curve, c.limits, task.velocity_factor, 60).velocity);
    }
    std::printf("velocity 1%+.1e of what the factor leaves\n", worst - 1);
    EXPECT_LE(worst, 1 + 1e-6);
}

}  // namespace
}  // namespace taktwerk::axes
