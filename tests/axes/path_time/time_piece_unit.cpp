// One piece of s(t): it does what the square of its velocity says, ends where it should, and its derivatives are derivatives.

#include "axes/path_time/time_piece.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace taktwerk::axes {
namespace {

struct Squares {
    double first, middle, last;
};

// Speeding up, slowing down, through a hump, through a dip, nearly and exactly at constant acceleration, over decades.
const std::vector<Squares> squares{{1, 1, 1},   {1, 2, 3},          {1, 1.5, 9},    {9, 2, 0.5},    {1, 7, 1},
                                   {1, 0.2, 1}, {1, 1.5, 2 + 1e-9}, {1e-6, 3, 1e3}, {4e4, 1e4, 1e2}};

TEST(TimePiece, EndsAtItsLengthAndVelocity) {
    for (const Squares& q : squares)
        for (double length : {1e-3, 1.0, 500.0}) {
            const TimePiece p = TimePiece::moving(7, length, q.first, q.middle, q.last);
            const PathMotion end = p.at(p.duration);
            EXPECT_NEAR(end.s - 7, length, 2e-13 * length + 1e-15) << q.first << " " << q.middle << " " << q.last;
            EXPECT_NEAR(end.velocity, std::sqrt(q.last), 1e-12 * std::sqrt(std::max(q.first, q.last)));
            EXPECT_NEAR(end.acceleration, (q.last - q.middle) / length, 1e-12 * std::max({q.first, q.middle, q.last}) / length);
        }
}

TEST(TimePiece, SquareOfVelocityIsTheQuadraticOfTheWay) {
    for (const Squares& q : squares) {
        const double length = 2;
        const TimePiece p = TimePiece::moving(0, length, q.first, q.middle, q.last);
        for (int i = 0; i <= 20; ++i) {
            const PathMotion m = p.at(p.duration * i / 20);
            const double x = m.s / length, y = 1 - x;
            const double square = y * y * q.first + 2 * x * y * q.middle + x * x * q.last;
            EXPECT_NEAR(m.velocity * m.velocity, square, 1e-11 * std::max({q.first, q.middle, q.last}));
            EXPECT_NEAR(m.jerk, (q.first - 2 * q.middle + q.last) / (length * length) * m.velocity, 1e-12 * std::fabs(m.jerk) + 1e-300);
        }
    }
}

TEST(TimePiece, DerivativesByTime) {
    for (const Squares& q : squares) {
        const TimePiece p = TimePiece::moving(0, 2, q.first, q.middle, q.last);
        const double h = 1e-5 * p.duration, size = std::sqrt(std::max({q.first, q.middle, q.last}));
        for (int i = 1; i < 10; ++i) {
            const double t = p.duration * i / 10;
            const PathMotion m = p.at(t), before = p.at(t - h), behind = p.at(t + h);
            EXPECT_NEAR((behind.s - before.s) / (2 * h), m.velocity, 1e-8 * size);
            EXPECT_NEAR((behind.velocity - before.velocity) / (2 * h), m.acceleration, 1e-7 * size / p.duration);
            EXPECT_NEAR((behind.acceleration - before.acceleration) / (2 * h), m.jerk, 1e-7 * size / (p.duration * p.duration));
        }
    }
}

// s = j t^3/6, v = j t^2/2: from rest to 3 u/s over 2 u takes 2 s at 1.5 u/s3; to rest the same backwards.
TEST(TimePiece, RestAtConstantJerk) {
    const TimePiece from = TimePiece::rest(TimePiece::Kind::from_rest, 10, 2, 9), to = TimePiece::rest(TimePiece::Kind::to_rest, 10, 2, 9);

    EXPECT_DOUBLE_EQ(from.duration, 2);
    EXPECT_DOUBLE_EQ(from.at(1).s, 10.25);
    EXPECT_DOUBLE_EQ(from.at(2).velocity, 3);
    EXPECT_DOUBLE_EQ(from.at(2).jerk, 1.5);
    EXPECT_DOUBLE_EQ(to.at(0).s, 10);
    EXPECT_DOUBLE_EQ(to.at(1).s, 11.75);
    EXPECT_DOUBLE_EQ(to.at(1).acceleration, -1.5);
    EXPECT_EQ(to.at(2).s, 12);
    EXPECT_EQ(to.at(2).velocity, 0);
    EXPECT_EQ(to.at(2).acceleration, 0);
}

}  // namespace
}  // namespace taktwerk::axes
