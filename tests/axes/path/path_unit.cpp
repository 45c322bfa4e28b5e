// How moves become a path: joints, refusals, what is frozen. G-033, G-036, G-045, G-047, G-055, G-056.

#include "axes/path/path.hpp"

#include <gtest/gtest.h>

#include "tests/axes/path/points.hpp"

namespace taktwerk::axes {
namespace {

PathMove line(const PathVector& from, const PathVector& to) {
    PathMove move;
    move.element = PathElement::line(from, to);
    return move;
}

TEST(Path, CornerWithoutACurveIsAStop) {
    Path path;
    EXPECT_EQ(*path.append(line(at(0, 0), at(100, 0)), {}), PathJoint::first);
    EXPECT_EQ(*path.append(line(at(100, 0), at(100, 50)), {}), PathJoint::stop);

    ASSERT_EQ(path.sections().size(), 2u);
    EXPECT_TRUE(path.sections()[1].stop_before);
    EXPECT_EQ(path.length(), 150);
}

TEST(Path, BlendTakesItsPartOfBothMoves) {
    Path path;
    ASSERT_TRUE(path.append(line(at(0, 0), at(100, 0)), {}).ok());
    EXPECT_EQ(*path.append(line(at(100, 0), at(100, 50)), {BlendRule::corner_distance, 10}), PathJoint::blend);

    ASSERT_EQ(path.sections().size(), 3u);
    EXPECT_EQ(path.sections()[0].length, 90);
    EXPECT_TRUE(path.sections()[1].blend);
    EXPECT_EQ(path.sections()[2].from, 10);
    EXPECT_EQ(path.sections()[2].length, 40);
    EXPECT_EQ(path.index_at(90), 1u);
    EXPECT_EQ(path.index_at(89.9), 0u);
    EXPECT_EQ(path.index_at(path.length()), 2u);
}

// A chain of short moves: each curve takes at most half of either.
TEST(Path, HalfOfAMoveIsLeftToTheNextBlend) {
    Path path;
    ASSERT_TRUE(path.append(line(at(0, 0), at(10, 0)), {}).ok());
    EXPECT_EQ(*path.append(line(at(10, 0), at(10, 10)), {BlendRule::corner_distance, 8}), PathJoint::cut);
    EXPECT_EQ(*path.append(line(at(10, 10), at(20, 10)), {BlendRule::corner_distance, 8}), PathJoint::cut);

    for (const PathSection& s : path.sections()) EXPECT_GE(s.length, 0);
    EXPECT_NEAR(path.sections()[0].length, 5, 1e-12);
    EXPECT_NEAR((path.section_at(path.length()).at(path.length()).at - at(20, 10)).norm(), 0, 1e-12);
}

// Also of a short move behind a long one.
TEST(Path, ACurveTakesHalfOfTheNextMoveAtMost) {
    Path path;
    ASSERT_TRUE(path.append(line(at(0, 0), at(100, 0)), {}).ok());
    EXPECT_EQ(*path.append(line(at(100, 0), at(100, 10)), {BlendRule::corner_distance, 8}), PathJoint::cut);

    EXPECT_NEAR(path.sections()[0].length, 95, 1e-12);
    EXPECT_NEAR(path.sections()[2].from, 5, 1e-12);
}

// Whichever of the two moves is the slower one, in each of its numbers.
TEST(Path, ACornerIsPassedAsTheSlowerOfBothWouldBe) {
    PathMove one = line(at(0, 0), at(100, 0)), other = line(at(100, 0), at(100, 50));
    one.feed = {100, 1000, 800, 9000};
    other.feed = {50, 2000, 700, 10'000};
    Path path;
    ASSERT_TRUE(path.append(one, {}).ok());
    ASSERT_EQ(*path.append(other, {BlendRule::corner_distance, 10}), PathJoint::blend);

    const PathFeed& corner = path.sections()[1].feed;
    EXPECT_EQ(corner.velocity, 50);
    EXPECT_EQ(corner.acceleration, 1000);
    EXPECT_EQ(corner.deceleration, 700);
    EXPECT_EQ(corner.jerk, 9000);
}

TEST(Path, WhatIsFrozenIsNotBent) {
    Path path;
    ASSERT_TRUE(path.append(line(at(0, 0), at(100, 0)), {}).ok());

    EXPECT_EQ(*path.append(line(at(100, 0), at(100, 50)), {BlendRule::corner_distance, 10}, 96), PathJoint::cut);

    EXPECT_NEAR(path.sections()[0].length, 96, 1e-12);

    Path late;
    ASSERT_TRUE(late.append(line(at(0, 0), at(100, 0)), {}).ok());
    EXPECT_EQ(*late.append(line(at(100, 0), at(100, 50)), {BlendRule::corner_distance, 10}, 100), PathJoint::stop);
}

TEST(Path, GapAndEmptyMoveAreRefusedAndChangeNothing) {
    Path path;
    ASSERT_TRUE(path.append(line(at(0, 0), at(100, 0)), {}).ok());

    EXPECT_EQ(path.append(line(at(100, 0.01), at(100, 50)), {}).error().code, "path.gap");
    EXPECT_EQ(path.append(line(at(100, 0), at(100, 0)), {}).error().code, "path.empty_move");

    EXPECT_EQ(path.sections().size(), 1u);
}

}  // namespace
}  // namespace taktwerk::axes
