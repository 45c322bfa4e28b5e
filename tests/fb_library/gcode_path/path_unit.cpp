// A program in G-code moves a group: MC_PathSelect, MC_MovePath. Every set-point is compared with the geometry of the program, worked out here by hand.

#include "tests/fb_library/gcode_path/path_rig.hpp"

namespace taktwerk::fb {
namespace {

using gcode::Point;

// A line, a quarter circle about (30, 10), a line, a quarter circle of radius 10 the other way about (50, 20), a line, up.
constexpr const char* contour = R"(G21 G90 G17 G61
N10 G0 X10 Y0
N20 G1 X30 F3000
N30 G3 X40 Y10 I0 J10
N40 G1 Y20
N50 G2 X50 Y30 R10
N60 G1 X60
N70 G1 Z5 F600
N80 M2
)";

double off_contour(const Point& p) {
    double off = 1e9;
    const auto arc = [&](double x, double y, bool in_quadrant) {
        if (in_quadrant) off = std::min(off, std::hypot(std::hypot(p[0] - x, p[1] - y) - 10, p[2]));
    };
    for (const auto& [a, b] : std::vector<std::pair<Point, Point>>{{{0, 0, 0}, {10, 0, 0}},
                                                                   {{10, 0, 0}, {30, 0, 0}},
                                                                   {{40, 10, 0}, {40, 20, 0}},
                                                                   {{50, 30, 0}, {60, 30, 0}},
                                                                   {{60, 30, 0}, {60, 30, 5}}})
        off = std::min(off, off_line(p, a, b));
    arc(30, 10, p[0] >= 30 && p[1] <= 10);
    arc(50, 20, p[0] <= 50 && p[1] >= 20);
    return off;
}

// G-094: the set-points lie on the program's lines and arcs, all of it is gone in its order, and nothing is said to be done before.
TEST(GcodePath, ThePortalDrawsTheFile) {
    PathRig rig(contour);
    ASSERT_TRUE(rig.run(20000)) << static_cast<int>(rig.move.ErrorID) << " line " << rig.handshake.FaultLine;
    double worst = 0, fastest = 0;
    // Through (10, 0) the direction stays: it is passed.
    std::vector<Point> corners{{30, 0, 0}, {40, 10, 0}, {40, 20, 0}, {50, 30, 0}, {60, 30, 0}, {60, 30, 5}};
    std::size_t next = 0;
    for (std::size_t n = rig.began; n < rig.plc.rig.path.size(); ++n) {
        const auto p = rig.at_cycle(n);
        worst = std::max(worst, off_contour(p));
        if (n > rig.began) fastest = std::max(fastest, distance(p, rig.at_cycle(n - 1)) / 0.001);
        if (next < corners.size() && distance(p, corners[next]) < 1e-9) ++next;
    }
    EXPECT_LT(worst, 1e-9) << "on the programmed path at every set-point";
    EXPECT_EQ(next, corners.size()) << "each corner is stood at exactly: the direction or the curvature changes there";
    EXPECT_EQ(rig.lines, (std::vector<std::uint32_t>{2, 3, 4, 5, 6, 7, 8, 9})) << "lines are shown as they are gone";
    EXPECT_GT(fastest, 45) << "F3000 is 50 mm/s";
    EXPECT_LT(fastest, 100 * std::sqrt(2.0) + 1e-6);
    EXPECT_EQ(rig.plc.rig.view().state, axes::GroupState::GroupStandby);
}

}  // namespace
}  // namespace taktwerk::fb
