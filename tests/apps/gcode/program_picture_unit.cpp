// What a picture keeps of a path.

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/gcode/program_picture.hpp"

namespace taktwerk::apps {
namespace {

using gcode::Feed;
using gcode::Move;

Move line_to(const Move& before, double x, double y, Feed::Kind feed = Feed::Kind::mm_per_s) {
    Move move;
    move.from = before.to, move.to = {x, y, 0, 0, 0, 0}, move.feed = {feed, 1};
    return move;
}

TEST(ProgramPath, KeepsRunsOfRapidsAndOfCutsApart) {
    ProgramPath path(100);
    auto move = line_to({}, 10, 0, Feed::Kind::rapid);
    path.add(move), path.add(move = line_to(move, 10, 10)), path.add(move = line_to(move, 0, 10)),
        path.add(line_to(move, 0, 0, Feed::Kind::rapid));
    ASSERT_EQ(path.runs().size(), 3u);
    EXPECT_TRUE(path.runs()[0].rapid);
    EXPECT_EQ(path.runs()[1].points, (std::vector<PathPoint>{{10, 0, 0}, {10, 10, 0}, {0, 10, 0}}));
    EXPECT_TRUE(path.runs()[2].rapid);
}

// A pixel shows a thousandth of the picture; lines of a millionth are not kept one by one, and no end of a run is lost.
TEST(ProgramPath, ThinsShortLinesAndKeepsWhereTheyEnd) {
    ProgramPath path(1000);
    Move move;
    for (int i = 1; i <= 100'000; ++i) path.add(move = line_to(move, 0.01 * i, 0));
    path.add(line_to(move, 0, 0, Feed::Kind::rapid));
    ASSERT_EQ(path.runs().size(), 2u);
    const auto& points = path.runs()[0].points;
    EXPECT_LT(points.size(), 3'100u);
    EXPECT_GT(points.size(), 2'000u);
    EXPECT_NEAR(points.back()[0], 1000, 1e-9);
}

TEST(ProgramPath, DrawsCirclesThatLookRound) {
    ProgramPath path(40);
    Move circle;
    circle.kind = Move::Kind::arc, circle.from = circle.to = {20, 0, 0, 0, 0, 0}, circle.angle = 2 * std::numbers::pi,
    circle.feed = {Feed::Kind::mm_per_s, 1};
    path.add(circle);
    const auto& points = path.runs().front().points;
    EXPECT_GT(points.size(), 90u);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        EXPECT_NEAR(std::hypot(points[i][0], points[i][1]), 20, 1e-9);
        const double x = (points[i][0] + points[i + 1][0]) / 2, y = (points[i][1] + points[i + 1][1]) / 2;
        EXPECT_GT(std::hypot(x, y), 20 - 0.005) << "a chord strays by less than a tenth of a pixel";
    }
}

TEST(ProgramPath, IsBoundedWhateverAProgramDraws) {
    ProgramPath path(1e-3);
    Move turns;
    turns.kind = Move::Kind::arc, turns.from = turns.to = {20, 0, 0, 0, 0, 0}, turns.angle = 2 * std::numbers::pi * 10'000,
    turns.feed = {Feed::Kind::mm_per_s, 1};
    for (int i = 0; i < 1000 && !path.cut_off(); ++i) path.add(turns);
    EXPECT_TRUE(path.cut_off());
    std::size_t points = 0;
    for (const auto& run : path.runs()) points += run.points.size();
    EXPECT_LE(points, 2'000'001u);
}

TEST(ProgramPicture, OfNothingIsAnError) {
    const auto script = program_picture({}, ProgramPath(1), {"t", "t.svg"});
    ASSERT_FALSE(script);
    EXPECT_EQ(script.error().code, "gcode.nothing_to_draw");
}

}  // namespace
}  // namespace taktwerk::apps
