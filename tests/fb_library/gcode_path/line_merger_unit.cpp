// Which short lines become one piece, and that it stays within the tolerance.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fb_library/gcode_path/line_merger.hpp"

namespace taktwerk::gcode {
namespace {

TEST(LineMerger, PointsOfALineBecomeIt) {
    LineMerger m;
    m.begin({0, 0, 0}, {1, 0, 0});
    for (int i = 2; i <= 10; ++i) ASSERT_TRUE(m.extend({1.0 * i, i % 2 * 0.004, 0}, 0.005)) << i;
    EXPECT_EQ(m.arc(), nullptr);
    EXPECT_FALSE(m.extend({11, 0.2, 0}, 0.005)) << "it would leave the points before by more";
    EXPECT_EQ(m.lines(), 10u);
    EXPECT_EQ(m.end()[0], 10);
}

TEST(LineMerger, WhatGoesBackIsAnotherLine) {
    LineMerger m;
    m.begin({0, 0, 0}, {1, 0, 0});
    EXPECT_FALSE(m.extend({0.5, 0, 0}, 1));
    EXPECT_FALSE(m.extend({0, 0, 0}, 1));
}

// Chords of 0.1 on a circle of 20 about (3, 20): its centre and its angle come back.
TEST(LineMerger, ChordsOfACircleBecomeAnArc) {
    for (const int sense : {1, -1}) {
        LineMerger m;
        const auto at = [&](int i) { return Point{3 + 20 * std::sin(0.005 * i), 20 - sense * 20 * std::cos(0.005 * i), 7}; };
        m.begin(at(0), at(1));
        for (int i = 2; i <= 200; ++i) ASSERT_TRUE(m.extend(at(i), 0.005)) << i;
        ASSERT_NE(m.arc(), nullptr);
        EXPECT_EQ(m.arc()->normal, 2);
        EXPECT_NEAR(m.arc()->centre[0], 3, 1e-6);
        EXPECT_NEAR(m.arc()->centre[1], 20, 1e-6);
        EXPECT_EQ(m.arc()->centre[2], 7);
        EXPECT_NEAR(m.arc()->angle, sense * 1.0, 1e-9);
    }
}

// In YZ the normal is X; in no plane of two axes there is no arc.
TEST(LineMerger, ArcsAreOfThePlanesOfTheMachine) {
    LineMerger flat, tilted;
    const auto at = [](int i) { return Point{5, 10 * std::sin(0.02 * i), 10 - 10 * std::cos(0.02 * i)}; };
    const auto up = [](int i) { return Point{0.01 * i, 10 * std::sin(0.02 * i), 10 - 10 * std::cos(0.02 * i)}; };
    flat.begin(at(0), at(1));
    tilted.begin(up(0), up(1));
    bool fits = true;
    for (int i = 2; i <= 40; ++i) {
        ASSERT_TRUE(flat.extend(at(i), 0.005)) << i;
        fits = fits && tilted.extend(up(i), 0.005);
    }
    ASSERT_NE(flat.arc(), nullptr);
    EXPECT_EQ(flat.arc()->normal, 0);
    EXPECT_NEAR(flat.arc()->angle, 0.8, 1e-9);
    EXPECT_FALSE(fits);
    EXPECT_EQ(tilted.arc(), nullptr);
}

// A hexagon is no circle: its sides stray from one by r (1 - cos 30) = 1.3 mm.
TEST(LineMerger, ACoarsePolygonStaysOne) {
    LineMerger m;
    const auto at = [](int i) { return Point{10 * std::cos(i * std::numbers::pi / 3), 10 * std::sin(i * std::numbers::pi / 3), 0}; };
    m.begin(at(0), at(1));
    EXPECT_FALSE(m.extend(at(2), 0.01));
}

}  // namespace
}  // namespace taktwerk::gcode
