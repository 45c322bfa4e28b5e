// How near plans through arms come to the least time there is, with every limit of jerk: against the oracle of tests/axes/path_time. O-2.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "axes/group/move_shape.hpp"
#include "axes/group/run_curve.hpp"
#include "axes/group/written_pose.hpp"
#include "axes/pose_math.hpp"
#include "tests/axes/group/jog_arms.hpp"
#include "tests/axes/path_time/least_time.hpp"

namespace taktwerk::axes::test {
namespace {

/// A line of the tool from where the members stand: as a group's planner sees it.
std::unique_ptr<RunCurve> line_of_tool(const JogArm& arm, const Kinematics& kinematics, const Eigen::Vector3d& by,
                                       const Eigen::Quaterniond& turned, const PathFeed& feed) {
    std::array<MemberLimits, max_path_axes> limits{};
    for (std::size_t i = 0; i < arm.turning.size(); ++i) {
        limits[i].velocity = arm.turning[i] ? 90 : 200;
        limits[i].acceleration = arm.turning[i] ? 900 : 2000;
        limits[i].jerk = arm.turning[i] ? 18'000 : 40'000;
        limits[i].low = -150;
        limits[i].high = 150;
    }
    MoveSpace space{&kinematics, arm.turning.size(), limits};
    MoveEnd from;
    for (std::size_t i = 0; i < arm.turning.size(); ++i) from.members[i] = arm.start[i];
    from.configuration.branch = kinematics.configuration(joints_of(from.members)).branch;
    GroupOrder order;
    order.command.kind = GroupCommandKind::linear_relative;
    order.command.frame = mcMCS;
    const auto six = numbers_of(pose_of(by, turned));
    for (std::size_t k = 0; k < six.size(); ++k) order.command.target[k] = six[k];
    const MoveShape shape = shape_of(order, from, space);
    EXPECT_EQ(shape.error, ErrorId::none) << arm.name;
    auto curve = std::make_unique<RunCurve>(&kinematics, arm.turning.size(), limits);
    PathMove move;
    move.element = shape.element;
    move.chart = shape.chart;
    move.feed = feed;
    EXPECT_TRUE(curve->path.append(move, {}).ok());
    RunCurve::Seen seen;
    seen.run.through_arm = true;
    seen.run.configuration = from.configuration;
    seen.members = shape.members;
    curve->seen.push_back(seen);
    return curve;
}

void expect_near(const std::string& name, const std::string& kind, const JointVector& start, const Eigen::Vector3d& by,
                 const Eigen::Quaterniond& turned = Eigen::Quaterniond::Identity(), const PathFeed& feed = {0, 0, 0, 0}) {
    SCOPED_TRACE(name);
    auto arms = every_kind_of_arm();
    const auto arm = std::find_if(arms.begin(), arms.end(), [&](const JogArm& a) { return a.name == kind; });
    ASSERT_NE(arm, arms.end());
    arm->start = start;
    const Arm kinematics = arm_of(arm->description);
    const auto curve = line_of_tool(*arm, *kinematics, by, turned, feed);
    if (::testing::Test::HasFailure()) return;
    expect_near_least_time(name, *curve, {curve->axis_limits().begin(), curve->axis_limits().end()});
}

TEST(LeastTimeOfArms, LinesOfTheToolComeNear) {
    expect_near("line of a SCARA", "scara", {-30, 80, 0, 0}, {-60, 150, 0});
    expect_near("line of a SCARA past its column", "scara", {-40, 100, 0, 0}, {40, -140, 0});
    expect_near("line of a delta", "rotary_delta", {20, 20, 20}, {60, 40, -20});
    expect_near("line of six joints", "six_with_wrist", {10, 15, 10, 20, 40, 10}, {80, -120, 60});
    // Joint 5 comes down to some degrees: joints 4 and 6 turn fast there.
    expect_near("line near the wrist's singularity", "six_with_wrist", {0, 10, -10, 15, 12, 0}, {0, 120, 20});
    expect_near("turn of six joints on a line", "six_with_wrist", {10, 15, 10, 20, 40, 10}, {60, 60, 0},
                Eigen::Quaterniond(Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 1, 0).normalized())));
    expect_near("line of six joints with a feed", "six_without_wrist", {20, -80, 80, -60, -70, 10}, {100, 100, -50},
                Eigen::Quaterniond::Identity(), {80, 400, 300, 6000});
}

}  // namespace
}  // namespace taktwerk::axes::test
