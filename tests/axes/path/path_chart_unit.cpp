// Orientation along a path: great circles, derivatives of the turn, blends between two turns. G-043, G-057.

#include "axes/path/path_chart.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "axes/path/path.hpp"

namespace taktwerk::axes {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double lever = 50;

PathChart chart_of(const Quaterniond& q) { return {{q.w(), q.x(), q.y(), q.z()}, lever}; }

PathVector numbers(const Vector3d& position, const Vector3d& rotation) {
    PathVector v = PathVector::Zero();
    v.head<3>() = position;
    v.segment<3>(3) = lever * rotation;
    return v;
}

PathMove turning_line(const Vector3d& from, const Vector3d& to, const Quaterniond& start, const Quaterniond& end) {
    PathMove move;
    move.chart = chart_of(start);
    move.element = PathElement::line(numbers(from, Vector3d::Zero()), numbers(to, rotation_between(start, end)));
    return move;
}

double between(const Quaterniond& a, const Quaterniond& b) { return rotation_between(a, b).norm(); }

TEST(PathChart, GreatCircleAtConstantRate) {
    const Quaterniond start(AngleAxisd(0.4, Vector3d(1, 2, -1).normalized())),
        end = start * Quaterniond(AngleAxisd(2.5, Vector3d::UnitY()));
    const PathMove move = turning_line({0, 0, 0}, {100, 0, 0}, start, end);

    const double length = move.element.length();
    EXPECT_NEAR(length, std::hypot(100, lever * 2.5), 1e-12);
    for (double share : {0.0, 0.25, 0.5, 1.0}) {
        const PosePoint p = pose_point(move.element.at(share * length), move.chart);
        EXPECT_LT(between(p.orientation, start.slerp(share, end)), 1e-14);
        EXPECT_LT((p.angular[0] - start * Vector3d::UnitY() * 2.5 / length).norm(), 1e-14);
        EXPECT_LT(p.angular[1].norm(), 1e-15);
    }
}

TEST(PathChart, AngularDerivativesThroughABlend) {
    const Quaterniond a(AngleAxisd(0.3, Vector3d::UnitX())), b = a * Quaterniond(AngleAxisd(1.5, Vector3d::UnitZ()));
    const Quaterniond c = b * Quaterniond(AngleAxisd(2.0, Vector3d(1, 1, 0).normalized()));
    Path path;
    ASSERT_TRUE(path.append(turning_line({0, 0, 0}, {100, 0, 0}, a, b), {}).ok());
    ASSERT_TRUE(path.append(turning_line({100, 0, 0}, {100, 80, 0}, b, c), {BlendRule::corner_distance, 60}).ok());
    ASSERT_EQ(path.sections().size(), 3u);

    const double h = 1e-4;
    const PathSection& blend = path.sections()[1];
    const auto pose = [&](double s) { return pose_point(path.section_at(s).at(s), path.section_at(s).chart); };
    for (int i = 1; i < 40; ++i) {
        const double s = blend.begin + blend.length * i / 40;
        const PosePoint p = pose(s), before = pose(s - h), behind = pose(s + h);
        // The turn between two neighbours, seen from the path's frame.
        const Quaterniond step = behind.orientation * before.orientation.conjugate();
        EXPECT_LT((2 * step.vec() / (2 * h) - p.angular[0]).norm(), 1e-9);
        EXPECT_LT(((behind.angular[0] - before.angular[0]) / (2 * h) - p.angular[1]).norm(), 1e-9);
        EXPECT_LT(((behind.angular[1] - before.angular[1]) / (2 * h) - p.angular[2]).norm(), 1e-9);
    }
    for (double joint : {blend.begin, blend.end()}) {
        const PathSection &first = joint == blend.begin ? path.sections()[0] : blend,
                          &second = joint == blend.begin ? blend : path.sections()[2];
        const PosePoint p = pose_point(first.at(joint), first.chart), q = pose_point(second.at(joint), second.chart);
        EXPECT_LT((p.position - q.position).norm(), 1e-11);
        EXPECT_LT(between(p.orientation, q.orientation), 1e-12);
        for (std::size_t k : {0u, 1u}) {
            EXPECT_LT((p.linear[k] - q.linear[k]).norm(), 1e-12);
            EXPECT_LT((p.angular[k] - q.angular[k]).norm(), 1e-12);
        }
    }
}

// A move that begins at the same place, but as the tool does not stand there, would make it leap.
TEST(PathChart, AMoveThatBeginsTurnedOtherwiseIsAGap) {
    const Quaterniond a(AngleAxisd(0.3, Vector3d::UnitX())), b = a * Quaterniond(AngleAxisd(1.5, Vector3d::UnitZ()));
    const Quaterniond elsewhere = b * Quaterniond(AngleAxisd(1e-3, Vector3d::UnitX()));
    Path path;
    ASSERT_TRUE(path.append(turning_line({0, 0, 0}, {100, 0, 0}, a, b), {}).ok());

    EXPECT_EQ(path.append(turning_line({100, 0, 0}, {100, 80, 0}, elsewhere, a), {}).error().code, "path.gap");
    EXPECT_TRUE(path.append(turning_line({100, 0, 0}, {100, 80, 0}, b, a), {}).ok());
}

TEST(PathChart, RotationBetweenTakesTheShortWay) {
    const Quaterniond a(AngleAxisd(0.5, Vector3d::UnitX()));
    const Quaterniond b = a * Quaterniond(AngleAxisd(1.5 * std::numbers::pi, Vector3d::UnitZ()));

    EXPECT_LT((rotation_between(a, b) - Vector3d(0, 0, -0.5 * std::numbers::pi)).norm(), 1e-14);
    EXPECT_LT((rotation_between(a, Quaterniond(-b.w(), -b.x(), -b.y(), -b.z())) - Vector3d(0, 0, -0.5 * std::numbers::pi)).norm(), 1e-14);
}

}  // namespace
}  // namespace taktwerk::axes
