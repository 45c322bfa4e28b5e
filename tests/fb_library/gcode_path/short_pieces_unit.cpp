// Ten thousand pieces of 10 um: the planner keeps up, and a slow one costs speed alone.

#include <fmt/format.h>

#include <numbers>

#include "tests/fb_library/gcode_path/path_rig.hpp"

namespace taktwerk::fb {
namespace {

constexpr int pieces = 10'000;
constexpr double radius = pieces * 0.01 / (2 * std::numbers::pi);  // mm: chords of 10 um

/// A full circle about (0, radius) from the origin, as CAM systems write it.
std::string circle_of_chords(const std::string& mode) {
    std::string text = "G21 G90 " + mode + " F3000\nG1\n";
    for (int i = 1; i <= pieces; ++i) {
        const double angle = 2 * std::numbers::pi * i / pieces;
        text += fmt::format("X{:.6f} Y{:.6f}\n", radius * std::sin(angle), radius * (1 - std::cos(angle)));
    }
    return text + "M2\n";
}
double off_circle(const gcode::Point& p) { return std::abs(std::hypot(p[0], p[1] - radius) - radius); }

struct Outcome {
    double seconds = 0, worst = 0, at_feed = 0, limited = 0;
};
Outcome draw(const std::string& text, std::size_t served_every) {
    PathRig rig(text);
    Outcome out;
    EXPECT_TRUE(rig.prepare());
    rig.plc.rig.served_every = served_every;
    int cycles = 0, fast = 0, limited = 0;
    rig.extra = [&](const MotionContext&) {
        if (!rig.move.Active) return;
        ++cycles;
        const auto& view = rig.plc.rig.view();
        fast += view.path_velocity > 0.99 * 50 ? 1 : 0;
        limited += view.path_velocity > 0.95 * 50 || view.limiter == axes::PathLimiter::axis ? 1 : 0;
    };
    EXPECT_TRUE(rig.run(100000));
    for (std::size_t n = rig.began; n < rig.plc.rig.path.size(); ++n) out.worst = std::max(out.worst, off_circle(rig.at_cycle(n)));
    EXPECT_LT(distance(rig.at(), {0, 0, 0}), 1e-6);
    out.seconds = cycles * 0.001;
    out.at_feed = 1.0 * fast / cycles;
    out.limited = 1.0 * limited / cycles;
    return out;
}

// T-05, T-06, T-07. By hand: 100 mm at F3000 are 2 s; 50 mm/s are reached with 10000 mm/s3 in 2 sqrt(50/10000) = 0.1414 s over half the way of the feed, as braking is: 2.1414 s,
// and (2.1414 - 2 * 0.1414) / 2.1414 = 86.8 % of it at the feed: 90 % cannot be. Above 99 % of it, as is counted here, are sqrt(2 * 0.5/10000) = 0.01 s more at each end: at most 87.7 %. The circle itself allows sqrt(1000 * 15.9) = 126 mm/s.
TEST(GcodePath, TenThousandPiecesKeepTheirFeed) {
    const auto out = draw(circle_of_chords("G64 P0.01"), 1);
    EXPECT_GE(out.seconds, 2.1413);
    EXPECT_LE(out.seconds, 2.1414 * 1.01);
    EXPECT_LE(out.worst, 0.01) << "never further from the program than P";
    RecordProperty("at_feed", fmt::format("{:.3f}", out.at_feed));
    RecordProperty("limited", fmt::format("{:.3f}", out.limited));
    fmt::print("{:.3f} s, at the feed {:.1f} %, off {:.6f} mm\n", out.seconds, 100 * out.at_feed, out.worst);
    EXPECT_GT(out.at_feed, 0.87);
    EXPECT_LT(out.at_feed, 0.8774);
}

// The planner comes every 40 cycles only: the same corners, later.
TEST(GcodePath, ASlowPlannerCostsSpeedAlone) {
    const auto out = draw(circle_of_chords("G64 P0.01"), 40);
    EXPECT_LE(out.worst, 0.01);
    EXPECT_GE(out.seconds, 2.0);
    fmt::print("{:.3f} s, at the feed {:.1f} %, off {:.6f} mm\n", out.seconds, 100 * out.at_feed, out.worst);
}

}  // namespace
}  // namespace taktwerk::fb
