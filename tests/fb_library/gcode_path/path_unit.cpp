// A program in G-code moves a group: MC_PathSelect, MC_MovePath. Every set-point is compared with the geometry of the program, worked out here by hand.

#include "core/guard/allocation_guard.hpp"
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

// Where a piece under G61 meets one under G64 the stricter one holds, whichever comes first: the corner is stood at. Between two under G64 it is rounded.
TEST(GcodePath, TheStricterRuleHoldsAtAJoint) {
    PathRig rig("G21 G90 G17\nG64 P2 Q0 G1 X20 F3000\nG61 G1 Y20\nG64 P2 Q0 G1 X40\nG1 Y40\nM2\n");
    ASSERT_TRUE(rig.run(20000)) << static_cast<int>(rig.move.ErrorID) << " line " << rig.handshake.FaultLine;
    const auto nearest = [&](const Point& corner) {
        double least = 1e9;
        for (std::size_t n = rig.began; n < rig.plc.rig.path.size(); ++n) least = std::min(least, distance(rig.at_cycle(n), corner));
        return least;
    };
    EXPECT_LT(nearest({20, 0, 0}), 1e-9) << "from G64 to G61";
    EXPECT_LT(nearest({20, 20, 0}), 1e-9) << "from G61 to G64";
    EXPECT_NEAR(nearest({40, 20, 0}), 2, 0.05) << "from G64 to G64";
    EXPECT_LT(nearest({40, 40, 0}), 1e-9);
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
    EXPECT_EQ(rig.lines, (std::vector<std::uint32_t>{2, 3, 4, 5, 6, 7, 8})) << "lines are shown as they are gone; M2 is the end of it";
    EXPECT_EQ(rig.handshake.Line, 0u) << "nothing is carried out any more";
    EXPECT_EQ(rig.handshake.FaultLine, 0u);
    EXPECT_GT(fastest, 45) << "F3000 is 50 mm/s";
    EXPECT_LT(fastest, 100 * std::sqrt(2.0) + 1e-6);
    EXPECT_EQ(rig.plc.rig.view().state, axes::GroupState::GroupStandby);
}

// Behind its end no line is carried out; where something else than its end ended it is told, without a fault of the text.
TEST(GcodePath, AStopTellsTheLineItEndedAt) {
    PathRig rig(contour);
    ASSERT_TRUE(rig.begin());
    ASSERT_TRUE(rig.plc.until([&] { return rig.handshake.Line == 4; }, 20000));
    MC_GroupHalt halt;
    halt.AxesGroup = rig.plc.group;
    halt.Execute = true;
    rig.extra = [&](const MotionContext& ctx) { halt(ctx); };
    ASSERT_TRUE(rig.plc.until([&] { return halt.Done; }, 2000));
    EXPECT_TRUE(rig.move.CommandAborted);
    EXPECT_EQ(rig.handshake.Line, 0u);
    EXPECT_EQ(rig.handshake.FaultLine, 4u);
    EXPECT_EQ(rig.handshake.FaultID, axes::ErrorId::none);
    rig.move.Execute = false;
    rig.plc.run(2);
    rig.extra = {};
    ASSERT_TRUE(rig.run(20000));
    EXPECT_EQ(rig.handshake.FaultLine, 0u) << "gone once more, to its end";
}

// G-070, G-071: whatever the override, and however often it changes, the set-points lie on the same path.
TEST(GcodePath, OverrideBendsNothing) {
    for (const double factor : {0.03, 0.37, 1.0}) {
        PathRig rig(contour);
        ASSERT_EQ(rig.plc.rig.set(axes::Override{.velocity = factor}), axes::ErrorId::none);
        ASSERT_TRUE(rig.run(200000)) << factor;
        double worst = 0, fastest = 0;
        for (std::size_t n = rig.began + 1; n < rig.plc.rig.path.size(); ++n) {
            worst = std::max(worst, off_contour(rig.at_cycle(n)));
            fastest = std::max(fastest, distance(rig.at_cycle(n), rig.at_cycle(n - 1)) / 0.001);
        }
        EXPECT_LT(worst, 1e-9) << factor;
        EXPECT_LE(fastest, factor * 100 * (1 + 1e-6)) << "X alone moves with G0, by 100 mm/s at most";
    }
    PathRig rig(contour);
    std::size_t changes = 0;
    rig.extra = [&](const MotionContext& ctx) {
        if (ctx.cycle % 37 != 0) return;
        constexpr std::array factors{1.0, 0.05, 0.4, 0.0, 0.8};
        (void)rig.plc.rig.groups.set(rig.plc.group, axes::Override{.velocity = factors[changes++ % factors.size()]}, ctx.owner);
    };
    ASSERT_TRUE(rig.run(100000));
    EXPECT_GT(changes, 50u);
    for (std::size_t n = rig.began; n < rig.plc.rig.path.size(); ++n) EXPECT_LT(off_contour(rig.at_cycle(n)), 1e-9);
    EXPECT_LT(distance(rig.at(), {60, 30, 5}), 1e-9);
}

// G-070: what is lowered while an M word waits holds from the answer on. Whoever gives the answer may stand in the machine.
TEST(GcodePath, AnOverrideOfNothingWhileAnMWordWaitsHoldsWhatComesBehindIt) {
    PathRig rig("G21 G90 G61\nG0 X5\nM100 P1 Q1\nG0 X60\nM2\n");
    rig.acknowledges = false;
    ASSERT_TRUE(rig.begin());
    ASSERT_TRUE(rig.plc.until([&] { return rig.handshake.Waits; }, 5000));
    rig.plc.run(100);
    ASSERT_EQ(rig.plc.rig.set(axes::Override{.velocity = 0}), axes::ErrorId::none);
    rig.plc.run(50);
    const auto stood = rig.at();
    rig.acknowledges = true;
    for (int i = 0; i < 1500; ++i) {
        rig.plc.scan();
        ASSERT_EQ(rig.at(), stood) << i << " cycles behind the answer";
    }
    EXPECT_FALSE(rig.handshake.Waits);
    ASSERT_EQ(rig.plc.rig.set(axes::Override{.velocity = 0.2}), axes::ErrorId::none);
    double fastest = 0;
    ASSERT_TRUE(rig.plc.until(
        [&] {
            fastest = std::max(fastest, std::abs(rig.plc.rig.axis(0).set_velocity));
            return rig.move.Done;
        },
        10000));
    EXPECT_NEAR(fastest, 20, 0.1) << "of the 100 mm/s of a rapid";
}

// G-065: a halt in the middle of an arc ends on the arc; the path is over then.
TEST(GcodePath, AHaltInAnArcStandsOnTheArc) {
    PathRig rig(contour);
    ASSERT_TRUE(rig.begin());
    ASSERT_TRUE(rig.plc.until([&] { return rig.handshake.Line == 4 && rig.at()[1] > 2; }, 20000));
    const auto halt = rig.plc.rig.submit(axes::test::simply(axes::GroupCommandKind::halt));
    ASSERT_EQ(halt.error, axes::ErrorId::none);
    ASSERT_TRUE(rig.plc.until([&] { return rig.plc.rig.view().state == axes::GroupState::GroupStandby; }, 3000));
    EXPECT_TRUE(rig.move.CommandAborted);
    EXPECT_NEAR(std::hypot(rig.at()[0] - 30, rig.at()[1] - 10), 10, 1e-9);
    EXPECT_GT(rig.at()[0], 30);
    EXPECT_LT(rig.at()[1], 10);
    for (std::size_t n = rig.began; n < rig.plc.rig.path.size(); ++n) EXPECT_LT(off_contour(rig.at_cycle(n)), 1e-9);
}

// G-066, G-067: interrupted in an arc and gone on with, all of the path is gone; the command stays Busy.
TEST(GcodePath, AnInterruptionInAnArcGoesOnAtItsPlace) {
    PathRig rig(contour);
    ASSERT_TRUE(rig.begin());
    ASSERT_TRUE(rig.plc.until([&] { return rig.handshake.Line == 4 && rig.at()[1] > 2; }, 20000));
    ASSERT_EQ(rig.plc.rig.submit(axes::test::simply(axes::GroupCommandKind::interrupt)).error, axes::ErrorId::none);
    ASSERT_TRUE(rig.plc.until([&] { return rig.plc.rig.view().interrupted; }, 3000));
    EXPECT_TRUE(rig.move.Busy);
    EXPECT_FALSE(rig.move.Active);
    const auto stood = rig.at();
    rig.plc.run(500);
    EXPECT_EQ(rig.at(), stood);
    ASSERT_EQ(rig.plc.rig.submit(axes::test::simply(axes::GroupCommandKind::resume)).error, axes::ErrorId::none);
    ASSERT_TRUE(rig.plc.until([&] { return rig.move.Done; }, 20000));
    for (std::size_t n = rig.began; n < rig.plc.rig.path.size(); ++n) EXPECT_LT(off_contour(rig.at_cycle(n)), 1e-9);
    EXPECT_LT(distance(rig.at(), {60, 30, 5}), 1e-9);
}

constexpr const char* with_words = R"(G21 G90 T2
M6
M3 S1000
G1 X10 F3000
M100 P1.5 Q2
G1 X20
G4 P0.5
G1 X30
M5
M30
)";

// N-11: what is asked for is asked for at its place, in the program's order, and nothing behind it is gone before the answer.
TEST(GcodePath, WordsAreAskedForAtTheirPlace) {
    PathRig rig(with_words);
    rig.acknowledges = false;
    ASSERT_TRUE(rig.begin());
    const auto answer = [&] {
        EXPECT_TRUE(rig.plc.until([&] { return rig.handshake.Waits; }, 5000));
        const auto stood = rig.at();
        const auto asked = rig.handshake.RequestID;
        rig.plc.run(300);
        EXPECT_EQ(rig.at(), stood) << "it waits";
        EXPECT_EQ(rig.handshake.RequestID, asked);
        EXPECT_EQ(rig.plc.rig.view().state, axes::GroupState::GroupMoving);
        rig.handshake.Acknowledge = true;
        rig.plc.scan();
        rig.handshake.Acknowledge = false;
        rig.plc.scan();
    };
    for (int i = 0; i < 3; ++i) answer();
    const auto before = rig.plc.rig.path.size();
    answer();
    EXPECT_EQ(rig.handshake.Request, mcPathSpindleOff);
    ASSERT_TRUE(rig.plc.until([&] { return rig.move.Done; }, 100)) << "the end waits for nobody";
    ASSERT_EQ(rig.requests.size(), 5u);
    const auto is = [&](std::size_t i, MC_PATH_REQUEST kind, std::uint32_t number, double value, double x) {
        EXPECT_EQ(rig.requests[i].kind, kind) << i;
        EXPECT_EQ(rig.requests[i].number, number) << i;
        EXPECT_EQ(rig.requests[i].value, value) << i;
        EXPECT_NEAR(rig.requests[i].place[0], x, 1e-9) << i;
    };
    is(0, mcPathToolPrepare, 2, 0, 0);
    is(1, mcPathToolChange, 2, 0, 0);
    is(2, mcPathSpindleClockwise, 0, 1000, 0);
    is(3, mcPathUser, 100, 1.5, 10);
    is(4, mcPathSpindleOff, 0, 0, 30);
    // G4: at X20 for half a second.
    int stands = 0;
    for (std::size_t n = before; n < rig.plc.rig.path.size(); ++n) stands += std::abs(rig.at_cycle(n)[0] - 20) < 1e-9 ? 1 : 0;
    EXPECT_GE(stands, 500);
    EXPECT_LE(stands, 520);
}

// What is asked for before anything is gone has its line, too.
TEST(GcodePath, ARequestSaysWhichLineAsksForIt) {
    PathRig rig("G21 G90\n\nT3\nM6\nG1 X10 F3000\nM2\n");
    std::vector<std::pair<MC_PATH_REQUEST, std::uint32_t>> asked;
    rig.extra = [&](const MotionContext& ctx) {
        const auto& request = ctx.groups->view(rig.plc.group)->path.request;
        if (request.kind != mcPathNothing && (asked.empty() || asked.back().first != request.kind))
            asked.emplace_back(request.kind, request.line);
    };
    ASSERT_TRUE(rig.run(5000));
    EXPECT_EQ(asked, (std::vector<std::pair<MC_PATH_REQUEST, std::uint32_t>>{{mcPathToolPrepare, 3}, {mcPathToolChange, 4}}));
}

// A wrong program is refused as a whole, with line and column: nothing moves.
TEST(GcodePath, AFaultyTextIsRefusedBeforeAnythingMoves) {
    PathRig rig("G21 G90\nG1 X10 F3000\nG1 X20 Y1,5\nM2\n");
    EXPECT_FALSE(rig.prepare());
    EXPECT_EQ(rig.select.ErrorID, ErrorId::path_program);
    rig.plc.scan();
    EXPECT_EQ(rig.handshake.FaultLine, 3u);
    EXPECT_EQ(rig.handshake.FaultColumn, 8u) << "the word with the comma";
    EXPECT_EQ(rig.handshake.FaultID, ErrorId::path_program);
    rig.move.Execute = true;
    rig.plc.run(100);
    EXPECT_EQ(rig.move.ErrorID, ErrorId::path_not_selected);
    EXPECT_EQ(rig.at(), (Point{0, 0, 0}));
}

// A place that only the machine knows to be out of the question: all before it is gone, the group stands there, and says which line.
TEST(GcodePath, APlaceBeyondALimitEndsThePathBehindTheBlockBefore) {
    PathRig rig("G21 G90\nG1 X10 F3000\nG1 Y20\nG1 Y70\nG1 X0\nM2\n", {}, 50);
    for (auto& axis : rig.plc.rig.axes)
        ASSERT_EQ(axis.submit({.kind = axes::CommandKind::home}, axes::Owner::program).error, ErrorId::none);
    ASSERT_TRUE(rig.plc.until(
        [&] { return rig.plc.rig.axis(2).homed && rig.plc.rig.axis(1).homed && rig.plc.rig.axis(1).state == axes::AxisState::Standstill; },
        100));
    EXPECT_FALSE(rig.run(20000));
    EXPECT_EQ(rig.move.ErrorID, ErrorId::beyond_software_limit);
    EXPECT_EQ(rig.handshake.FaultLine, 4u);
    EXPECT_LT(distance(rig.at(), {10, 20, 0}), 1e-9);
    const auto& refusal = rig.plc.rig.view().refusal;  // of the piece from Y 20 to Y 70 the part up to 50
    EXPECT_EQ(refusal.kind, axes::GroupCommandKind::path);
    EXPECT_EQ(refusal.why.line, 4u);
    EXPECT_EQ(refusal.why.at.place, 1);
    EXPECT_EQ(refusal.why.at.limit, 50);
    EXPECT_NEAR(refusal.why.at.part, 0.6, 1e-6);
    EXPECT_NEAR(refusal.why.at.length, 50, 1e-9);
    EXPECT_NEAR(refusal.why.at.point[1], 50, 1e-6);
    rig.plc.run(5);
    EXPECT_EQ(rig.plc.rig.view().state, axes::GroupState::GroupStandby) << "no error of the group: a command ended with one";
}

TEST(GcodePath, BlocksAreGoneOneByOne) {
    PathRig rig("G21 G90\nG1 X10 F3000\nG1 X20\nM2\n");
    rig.select.PathDescription.Options.single_block = true;
    rig.acknowledges = false;
    ASSERT_TRUE(rig.begin());
    for (const double x : {10.0, 20.0}) {
        ASSERT_TRUE(rig.plc.until([&] { return rig.handshake.Waits && std::abs(rig.at()[0] - x) < 1e-9; }, 3000) ||
                    (rig.handshake.Waits && rig.at()[0] == 0));
        if (rig.at()[0] == 0) {  // behind the block of settings
            rig.handshake.Acknowledge = true;
            rig.plc.scan();
            rig.handshake.Acknowledge = false;
            ASSERT_TRUE(rig.plc.until([&] { return rig.handshake.Waits && std::abs(rig.at()[0] - x) < 1e-9; }, 3000));
        }
        EXPECT_EQ(rig.handshake.Request, mcPathBlockStop);
        rig.handshake.Acknowledge = true;
        rig.plc.scan();
        rig.handshake.Acknowledge = false;
    }
    EXPECT_TRUE(rig.plc.until([&] { return rig.move.Done; }, 3000));
}

// The state in front of the line is asked for, then a straight line leads to where the program is.
TEST(GcodePath, ItBeginsAtALine) {
    PathRig rig("G21 G90 T3 M6\nM3 S900\nG1 X10 Y10 F3000\nG1 X20\nG1 X20 Y30\nM2\n");
    rig.select.PathDescription.Options.start_line = 5;
    ASSERT_TRUE(rig.run(20000));
    ASSERT_EQ(rig.requests.size(), 4u);
    EXPECT_EQ(rig.requests[0].kind, mcPathResume);
    EXPECT_EQ(rig.requests[1].kind, mcPathToolChange);
    EXPECT_EQ(rig.requests[1].number, 3u);
    EXPECT_EQ(rig.requests[2].kind, mcPathSpindleClockwise);
    EXPECT_EQ(rig.requests[2].value, 900);
    EXPECT_EQ(rig.requests[3].kind, mcPathSpindleOff) << "M2 switches it off";
    for (std::size_t n = rig.began; n < rig.plc.rig.path.size(); ++n) {
        const auto p = rig.at_cycle(n);
        EXPECT_LT(std::min(off_line(p, {0, 0, 0}, {20, 10, 0}), off_line(p, {20, 10, 0}, {20, 30, 0})), 1e-9);
    }
    EXPECT_LT(distance(rig.at(), {20, 30, 0}), 1e-9);
}

// The cycle's side takes no memory: pieces, requests, dwells, the end.
TEST(GcodePath, NothingInTheCycleTakesMemory) {
    PathRig rig(with_words);
    ASSERT_TRUE(rig.prepare());
    auto& plc = rig.plc.rig;
    axes::GroupCommand path{.kind = axes::GroupCommandKind::path, .frame = mcMCS};
    path.path = rig.select.PathData.path;
    path.ticket = rig.select.PathData.ticket;
    std::size_t taken = 0;
    int asked = 0;
    const auto guarded = [&](const axes::GroupCommand* command) {
        plc.now += axes::test::GroupRig::cycle;
        for (auto& one : plc.axes) one.update(plc.now);
        NoAllocationScope none;
        plc.groups.update(plc.now);
        if (command != nullptr) {
            EXPECT_EQ(plc.submit(*command).error, ErrorId::none);
        }
        if (plc.view().path.waits) {
            ++asked;
            EXPECT_EQ(plc.groups.acknowledge(rig.plc.group, plc.view().path.request_id, axes::Owner::program), ErrorId::none);
        }
        plc.groups.plan(plc.now, axes::test::GroupRig::cycle);
        taken += none.used().total();
        axes::plan_axes(plc.axes, plc.now, axes::test::GroupRig::cycle);
        for (auto& one : plc.axes) one.encode(plc.now);
    };
    guarded(&path);
    for (int i = 0; i < 5000 && plc.view().state != axes::GroupState::GroupStandby; ++i) {
        plc.groups.service();
        guarded(nullptr);
    }
    EXPECT_EQ(plc.view().state, axes::GroupState::GroupStandby);
    EXPECT_NEAR(plc.axis(0).set_position, 30, 1e-9);
    EXPECT_GE(asked, 4);
    EXPECT_EQ(taken, 0u);
}

}  // namespace
}  // namespace taktwerk::fb
