// Arcs by hand: circles of radius 10 and 5 with ends on the axes, Pythagoras' 3-4-5, and N-02 of the rules: R of both signs, full circles, planes, tolerance, helices.

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fb_library/gcode/program_summary.hpp"
#include "tests/fb_library/gcode/read_program.hpp"

namespace taktwerk::gcode {
namespace {

using std::numbers::pi;

std::string arc_fault(const std::string& blocks) { return read_blocks("F600\n" + blocks).wrong(); }
Move arc_of(const std::string& blocks) {
    const auto program = read_blocks("F600\n" + blocks);
    EXPECT_EQ(program.wrong(), "") << blocks;
    for (const auto& move : program.moves())
        if (move.kind == Move::Kind::arc) return move;
    ADD_FAILURE() << "no arc in " << blocks;
    return {};
}
void expect_arc(const Move& move, double x, double y, double z, double angle) {
    EXPECT_NEAR(move.centre[0], x, 1e-12);
    EXPECT_NEAR(move.centre[1], y, 1e-12);
    EXPECT_NEAR(move.centre[2], z, 1e-12);
    EXPECT_NEAR(move.angle, angle, 1e-12);
}

TEST(GcodeArcs, AboutACentreBothWays) {
    expect_arc(arc_of("G0 X10\nG3 X0 Y10 I-10 J0"), 0, 0, 0, pi / 2);
    expect_arc(arc_of("G0 X10\nG2 X0 Y10 I-10 J0"), 0, 0, 0, -3 * pi / 2);
    expect_arc(arc_of("G0 X10\nG3 X-10 I-10"), 0, 0, 0, pi);  // an offset without a word is 0
}

TEST(GcodeArcs, WithARadiusOfBothSigns) {
    // Chord from (0,0) to (6,0), radius 5: centres at (3, 4) and (3, -4).
    const double less = 2 * std::asin(0.6);
    expect_arc(arc_of("G3 X6 R5"), 3, 4, 0, less);
    expect_arc(arc_of("G3 X6 R-5"), 3, -4, 0, 2 * pi - less);
    expect_arc(arc_of("G2 X6 R5"), 3, -4, 0, -less);
    expect_arc(arc_of("G2 X6 R-5"), 3, 4, 0, -(2 * pi - less));
    expect_arc(arc_of("G2 X10 R5"), 5, 0, 0, -pi);
}

TEST(GcodeArcs, EveryArcEndsWhereItsWordsSay) {
    for (const char* blocks : {"G3 X6 R5", "G3 X6 R-5", "G2 X6 R5", "G2 X6 R-5", "G2 X1 Y2 I3 J-1 (radii 3.162 and 3.606)",
                               "G18 G2 X6 Z8 R7", "G19 G3 Y1 Z1 J1 K0"}) {
        const auto program = read_blocks("F600\n" + std::string(blocks));
        if (!program.wrong().empty()) {
            EXPECT_EQ(program.wrong(), "2:1 gcode.arc_radii") << blocks;
            continue;
        }
        const auto move = program.moves().front();
        auto nearly = point_of(move, 1 - 1e-12);
        for (std::size_t axis = 0; axis < axis_count; ++axis) EXPECT_NEAR(nearly[axis], move.to[axis], 1e-9) << blocks;
    }
}

// Direction as seen from the positive end of the normal. G18 is ZX: about Y, from Z to X is the positive sense.
TEST(GcodeArcs, PlanesAndTheirSenses) {
    const auto zx = arc_of("G18 G0 Z10\nG3 X10 Z0 I0 K-10");
    EXPECT_EQ(zx.normal, 1);
    expect_arc(zx, 0, 0, 0, pi / 2);
    const auto halfway = point_of(zx, 0.5);
    EXPECT_NEAR(halfway[0], 10 / std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(halfway[2], 10 / std::sqrt(2.0), 1e-12);
    const auto yz = arc_of("G19 G0 Y10\nG3 Y0 Z10 J-10 K0");
    EXPECT_EQ(yz.normal, 0);
    expect_arc(yz, 0, 0, 0, pi / 2);
    EXPECT_EQ(arc_of("G17 G3 X6 R5").normal, 2);
    EXPECT_EQ(arc_fault("G17 G3 X6 K3"), "2:11 gcode.arc_offset_plane");
    EXPECT_EQ(arc_fault("G18 G3 X6 J3"), "2:11 gcode.arc_offset_plane");
    EXPECT_EQ(arc_fault("G19 G3 Y6 I3"), "2:11 gcode.arc_offset_plane");
}

TEST(GcodeArcs, FullCirclesAndTurns) {
    expect_arc(arc_of("G0 X10\nG2 I-10"), 0, 0, 0, -2 * pi);  // no axis words
    expect_arc(arc_of("G0 X10\nG3 X10 Y0 I-10"), 0, 0, 0, 2 * pi);
    expect_arc(arc_of("G0 X10\nG3 X10 I-10 P3"), 0, 0, 0, 6 * pi);
    expect_arc(arc_of("G0 X10\nG2 X0 Y-10 I-10 P2"), 0, 0, 0, -2.5 * pi);
    EXPECT_EQ(arc_fault("G0 X10\nG3 X10 R5"), "3:1 gcode.arc_same_point");
    EXPECT_EQ(arc_fault("G3 X10 R5 P0"), "2:11 gcode.turns");
    EXPECT_EQ(arc_fault("G3 X10 R5 P1.5"), "2:11 gcode.turns");
    // Ten steps of 0.1 are not 1: without a tolerance this were an arc of nothing, or a circle, as the rounding happens to be.
    std::string steps = "G91 G0\n";
    for (int i = 0; i < 10; ++i) steps += "X0.1\n";
    expect_arc(arc_of(steps + "G90 G3 X1 Y0 I-1"), 0, 0, 0, 2 * pi);
}

TEST(GcodeArcs, AHelixRunsEvenlyWithItsAngle) {
    const auto move = arc_of("G0 X10 Z1\nG3 X0 Y10 Z5 I-10");
    expect_arc(move, 0, 0, 1, pi / 2);
    EXPECT_EQ(move.to, (AxisValues{0, 10, 5, 0, 0, 0}));
    EXPECT_NEAR(point_of(move, 0.5)[2], 3, 1e-12);
    EXPECT_NEAR(length_of(move), std::hypot(5 * pi, 4), 1e-12);
    EXPECT_DOUBLE_EQ(move.feed.value, 10) << "along the helix";
}

TEST(GcodeArcs, OffsetsAreRelativeUnlessG90_1) {
    expect_arc(arc_of("G90 G0 X20 Y5\nG3 X10 Y15 I-10"), 10, 5, 0, pi / 2);  // relative under G90
    expect_arc(arc_of("G0 X20 Y5\nG90.1 G3 X10 Y15 I10 J5"), 10, 5, 0, pi / 2);
    EXPECT_EQ(arc_fault("G0 X20 Y5\nG90.1 G3 X10 Y15 I10"), "3:7 gcode.missing_word");
    expect_arc(arc_of("G92 X-100\nG0 X-80 Y5\nG90.1 G3 X-90 Y15 I-90 J5"), 10, 5, 0, pi / 2);  // in the program's coordinates
    expect_arc(arc_of("G20\nF1\nG3 X2 I1"), 25.4, 0, 0, pi);
}

// CAM systems write three decimals: 10 sin 30 = 5, 10 cos 30 = 8.660254 is written as 8.660.
TEST(GcodeArcs, EndsThatAreRoundedAreMetByAMovedCentre) {
    const auto move = arc_of("G0 X10\nG3 X8.660 Y5.000 I-10 J0");
    const double start = std::hypot(10 - move.centre[0], move.centre[1]);
    const double end = std::hypot(8.660 - move.centre[0], 5 - move.centre[1]);
    EXPECT_NEAR(start, end, 1e-12) << "a true circle through both";
    EXPECT_NEAR(start, 10, 5e-4);
    EXPECT_LT(std::hypot(move.centre[0], move.centre[1]), 1e-3);
    EXPECT_NE(move.centre[0], 0) << "the words alone give none";
}

// Exploded arcs: 0.01 mm of a circle of 10 mm, rounded to 3 decimals. The centre moves far, the path does not.
TEST(GcodeArcs, ShortArcsWithRoundedEndsAreTaken) {
    const auto move = arc_of("G0 X10.001\nG3 X10 Y0.010 I-10.001 J0");
    EXPECT_NEAR(length_of(move), 0.01005, 1e-5);
}

TEST(GcodeArcs, EndsThatDoNotFitAreRefused) {
    EXPECT_EQ(arc_fault("G0 X10\nG3 X0 Y10.005 I-10"), "") << "0.005 mm is the limit at radius 5 and below, 0.01 mm here";
    EXPECT_EQ(arc_fault("G0 X1\nG3 X0 Y1.004 I-1"), "");
    EXPECT_EQ(arc_fault("G0 X1\nG3 X0 Y1.006 I-1"), "3:1 gcode.arc_radii");
    EXPECT_EQ(arc_fault("G0 X100\nG3 X0 Y100.09 I-100"), "") << "a thousandth of the radius";
    EXPECT_EQ(arc_fault("G0 X100\nG3 X0 Y100.11 I-100"), "3:1 gcode.arc_radii");
    EXPECT_EQ(arc_fault("G0 X10000\nG3 X0 Y10000.6 I-10000"), "3:1 gcode.arc_radii") << "half a millimetre at most";
    EXPECT_EQ(arc_fault("G0 X10\nG3 X9.999 I-10"), "3:1 gcode.arc_ends") << "nearly a full circle, displaced outwards: no circle near it";
    EXPECT_EQ(arc_fault("G3 X10 I0 J0"), "2:1 gcode.arc_zero_radius");
    EXPECT_EQ(arc_fault("G3 X10 I10"), "2:1 gcode.arc_zero_radius") << "the centre is the end";
    EXPECT_EQ(arc_fault("G3 X10 R0"), "2:1 gcode.arc_zero_radius");
    EXPECT_EQ(arc_fault("G3 X10 R4.9"), "2:1 gcode.arc_too_far");
    EXPECT_EQ(arc_fault("G3 X10.009 R5"), "") << "rounded: half a circle";
    EXPECT_EQ(arc_fault("G3 X10"), "2:1 gcode.arc_nothing");
    EXPECT_EQ(arc_fault("G3"), "2:1 gcode.arc_nothing");
    EXPECT_EQ(arc_fault("G3 X10 R5 I5"), "2:1 gcode.arc_both");
}

TEST(GcodeArcs, AreInheritedAsMotionAndTheirWordsAreNot) {
    const auto program = read_blocks("F600 G0 X10\nG3 X0 Y10 I-10\nX-10 Y0 J-10\nI10");
    ASSERT_EQ(program.wrong(), "");
    ASSERT_EQ(program.moves().size(), 4u);
    EXPECT_NEAR(program.moves()[3].angle, 2 * pi, 1e-12);
    EXPECT_EQ(arc_fault("G0 X10\nG3 X0 Y10 I-10\nX-10 Y0"), "4:1 gcode.arc_nothing");
}

TEST(GcodeArcs, TurnAxesEvenlyAtTheFeedAlongTheArc) {
    InterpreterOptions options;
    options.rotary = InterpreterOptions::Rotary::offered;
    const auto program = read_blocks("F600 G0 X10\nG3 I-10 A90", options);
    ASSERT_EQ(program.wrong(), "");
    const auto move = program.moves().back();
    EXPECT_EQ(move.feed.kind, Feed::Kind::mm_per_s) << "a full circle ends where it began, and is no turning alone";
    EXPECT_DOUBLE_EQ(move.feed.value, 10);
    EXPECT_NEAR(point_of(move, 0.5)[3], 45, 1e-12);
    EXPECT_NEAR(point_of(move, 0.5)[0], -10, 1e-12);
}

TEST(GcodeSummary, AClockwiseArcReachesNoFurtherThanItGoes) {
    ProgramSummary summary;
    for (const auto& item : read_blocks("F600 G0 X10\nG2 X0 Y-10 I-10").items) summary.add(item);
    EXPECT_NEAR(summary.extents()[0].least, 0, 1e-12);
    EXPECT_NEAR(summary.extents()[0].most, 10, 1e-12);
    EXPECT_NEAR(summary.extents()[1].least, -10, 1e-12);
    EXPECT_NEAR(summary.extents()[1].most, 0, 1e-12);
    ProgramSummary three_quarters;
    for (const auto& item : read_blocks("F600 G0 X10\nG2 X0 Y10 I-10").items) three_quarters.add(item);
    EXPECT_NEAR(three_quarters.extents()[0].least, -10, 1e-12);
    EXPECT_NEAR(three_quarters.extents()[1].least, -10, 1e-12);
}

TEST(GcodeSummary, ArcsReachBeyondTheirEnds) {
    ProgramSummary summary;
    for (const auto& item : read_blocks("F600 G0 X10\nG3 X0 Y-10 I-10\nG0 Z5\nG1 X3 Y-6\nG4 P2").items) summary.add(item);
    const auto& x = summary.extents()[0];
    const auto& y = summary.extents()[1];
    EXPECT_NEAR(x.least, -10, 1e-12);
    EXPECT_NEAR(x.most, 10, 1e-12);
    EXPECT_NEAR(y.least, -10, 1e-12);
    EXPECT_NEAR(y.most, 10, 1e-12);
    EXPECT_TRUE(summary.extents()[2].moved);
    EXPECT_FALSE(summary.extents()[3].moved);
    EXPECT_EQ(summary.rapids().count, 2u);
    EXPECT_NEAR(summary.rapids().length_mm, 15, 1e-12);
    EXPECT_NEAR(summary.arcs().length_mm, 15 * pi, 1e-12);
    EXPECT_NEAR(summary.lines().length_mm, 5, 1e-12) << "3-4-5";
    EXPECT_NEAR(summary.least_seconds(), (15 * pi + 5) / 10 + 2, 1e-12);
    EXPECT_EQ(summary.dwells().longest_line, 5u);
    EXPECT_DOUBLE_EQ(summary.feeds().most, 10);
}

}  // namespace
}  // namespace taktwerk::gcode
