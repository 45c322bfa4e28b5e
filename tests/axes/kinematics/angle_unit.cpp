// The angle of a sine and a cosine, against the C library's in twice its precision.

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "axes/kinematics/angle_of.hpp"

namespace taktwerk::axes {
namespace {

constexpr double half_turn = std::numbers::pi;

/// In parts of the last bit of the true angle; where that is below 1e-300, of 1e-300.
double bits_off(double sine, double cosine) {
    const long double truth = std::atan2(static_cast<long double>(sine), static_cast<long double>(cosine));
    const long double off = std::abs(static_cast<long double>(angle_of(sine, cosine)) - truth);
    return static_cast<double>(off / std::max(std::abs(truth), 1e-300L)) / std::numeric_limits<double>::epsilon();
}

TEST(AngleOf, IsRightToTwoBitsAllAround) {
    std::mt19937_64 random{5};
    std::uniform_real_distribution<double> part{-1, 1}, exponent{-290, 290};
    double worst = 0;
    for (int i = 0; i < 300'000; ++i) {
        const double size = i % 2 == 0 ? 1 : std::pow(10, exponent(random)), other = i % 3 == 0 ? std::pow(10, exponent(random)) : size;
        worst = std::max(worst, bits_off(size * part(random), other * part(random)));
    }
    EXPECT_LT(worst, 2);
}

TEST(AngleOf, IsRightOnBothSidesOfEveryBorder) {
    for (int eighth = -8; eighth <= 8; ++eighth)
        for (const double beside : {0.0, 1e-17, 1e-16, 1e-15, 1e-9, 1e-3})
            for (const double side : {-1.0, 1.0})
                for (const double more : {0.0, half_turn / 8}) {
                    const double angle = eighth * half_turn / 4 + more + side * beside;
                    const double sine = std::sin(angle), cosine = std::cos(angle);
                    EXPECT_LT(bits_off(sine, cosine), 2) << angle;
                }
}

TEST(AngleOf, OnTheAxesItIsExact) {
    for (const double size : {1e-290, 1.0, 3.7e299}) {
        EXPECT_EQ(angle_of(0, size), 0);
        EXPECT_EQ(angle_of(size, 0), half_turn / 2);
        EXPECT_EQ(angle_of(-size, 0), -half_turn / 2);
        EXPECT_EQ(angle_of(0, -size), half_turn);
        EXPECT_EQ(angle_of(-0.0, -size), -half_turn);
        EXPECT_EQ(angle_of(size, size), half_turn / 4);
    }
    EXPECT_EQ(angle_of(0, 0), 0);
    EXPECT_EQ(angle_of(0, -0.0), 0);  // std::atan2 says pi here
    EXPECT_TRUE(std::signbit(angle_of(-0.0, 1)));
}

TEST(AngleOf, WhatIsNoNumberStaysNone) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(angle_of(none, 1)));
    EXPECT_TRUE(std::isnan(angle_of(1, none)));
    EXPECT_TRUE(std::isnan(angle_of(none, none)));
}

}  // namespace
}  // namespace taktwerk::axes
