// Which way is chosen: flags, turns, limits, nearness; and what is said where there is none.

#include <gtest/gtest.h>

#include "core/guard/allocation_guard.hpp"
#include "tests/axes/kinematics/pose_difference.hpp"
#include "tests/axes/kinematics/published_arms.hpp"

namespace taktwerk::axes {
namespace {

void expect_axes(const Joints& axes, const Joints& expected, double tolerance = 1e-9) {
    for (std::size_t i = 0; i < max_joints; ++i) EXPECT_NEAR(axes[i], expected[i], tolerance) << "axis " << i + 1;
}

// Each of the eight combinations of flags names one way, and it is the one that has them.
TEST(KinematicChoice, EachCombinationOfFlagsIsOneWay) {
    const Joints there = degrees({20, 30, -10, 40, 50, 60});
    for (const PublishedArm& arm : {irb_120(), ur5e()}) {
        SCOPED_TRACE(arm.name);
        const Kinematics kinematics = made(arm);
        const Pose pose = kinematics.forward(there, {}).pose;
        std::vector<Joints> ways;
        for (const Shoulder shoulder : {Shoulder::front, Shoulder::back})
            for (const Elbow elbow : {Elbow::up, Elbow::down})
                for (const Wrist wrist : {Wrist::no_flip, Wrist::flip}) {
                    Configuration wanted;
                    wanted.branch = {shoulder, elbow, wrist};
                    const AxisSolution way = kinematics.inverse(pose, {}, wanted, {});
                    if (!way.ok()) {
                        EXPECT_EQ(way.miss.fault, KinematicFault::other_branch);
                        continue;
                    }
                    EXPECT_EQ(way.configuration.branch, wanted.branch);
                    EXPECT_EQ(kinematics.configuration(way.axes).branch, wanted.branch);
                    EXPECT_LT(difference(kinematics.forward(way.axes, {}).pose, pose).position, 1e-12);
                    for (const Joints& other : ways) EXPECT_FALSE(std::equal(other.begin(), other.end(), way.axes.begin()));
                    ways.push_back(way.axes);
                }
        EXPECT_GE(ways.size(), 4U);
        EXPECT_LE(ways.size(), 8U);
    }
}

// The flags, read off the drawings: the ABB reaches to the front with its elbow up; joint 5 decides the wrist; leaning backwards over axis 1
// it reaches behind itself.
TEST(KinematicChoice, FlagsOfStandsThatCanBeSeen) {
    const Kinematics abb = made(irb_140());
    EXPECT_EQ(abb.configuration(degrees({0, 0, 0, 0, 30, 0})).branch, (Branch{Shoulder::front, Elbow::up, Wrist::no_flip}));
    EXPECT_EQ(abb.configuration(degrees({0, 0, 0, 0, -30, 0})).branch, (Branch{Shoulder::front, Elbow::up, Wrist::flip}));
    EXPECT_EQ(abb.configuration(degrees({0, 90, -120, 0, 30, 0})).branch, (Branch{Shoulder::front, Elbow::down, Wrist::no_flip}));
    EXPECT_EQ(abb.configuration(degrees({0, -90, -60, 0, 30, 0})).branch, (Branch{Shoulder::back, Elbow::up, Wrist::no_flip}));
    EXPECT_EQ(made(epson_g10()).configuration(degrees({0, 40, 0, 0, 0, 0})).branch.elbow, Elbow::up);
    EXPECT_EQ(made(epson_g10()).configuration(degrees({0, -40, 0, 0, 0, 0})).branch.elbow, Elbow::down);
}

// Flags change sign exactly in the singularity: a SCARA's elbow at 0.
TEST(KinematicChoice, FlagsFlipInTheSingularity) {
    const Kinematics scara = made(epson_g10());
    EXPECT_EQ(scara.configuration({1, 1e-15, 0, 0, 0, 0}).branch.elbow, Elbow::up);
    EXPECT_EQ(scara.configuration({1, 0, 0, 0, 0, 0}).branch.elbow, Elbow::up);
    EXPECT_EQ(scara.configuration({1, -1e-15, 0, 0, 0, 0}).branch.elbow, Elbow::down);
}

// Turns: those wanted, else the nearest; (-180, 180] is turn 0.
TEST(KinematicChoice, TurnsAreAPartOfThePose) {
    const Kinematics abb = made(irb_120());
    const Joints there = degrees({10, 20, 30, 40, 50, 400});
    const Configuration c = abb.configuration(there);
    EXPECT_EQ(c.turns, (std::array<std::int8_t, 6>{0, 0, 0, 0, 0, 1}));
    const Pose pose = abb.forward(there, {}).pose;

    expect_axes(abb.inverse(pose, {}, c, {}).axes, there);
    Configuration other = c;
    other.turns[5] = -2;
    expect_axes(abb.inverse(pose, {}, other, {}).axes, degrees({10, 20, 30, 40, 50, 40 - 720}));
    Configuration any = c;
    any.turns.fill(any_turn);
    expect_axes(abb.inverse(pose, {}, any, degrees({10, 20, 30, 40, 50, 700})).axes, degrees({10, 20, 30, 40, 50, 760}));
    EXPECT_EQ(abb.configuration(degrees({180, -180, 180.0001, -180.0001, 540, 541})).turns,
              (std::array<std::int8_t, 6>{0, -1, 1, -1, 1, 2}));
}

// Without flags the nearest way is taken (G-042); limits exclude ways, and turns are sought within them.
TEST(KinematicChoice, NearestWithinTheLimits) {
    PublishedArm arm = irb_120();
    // ABB: +-165, +-110, -110..70, +-160, +-120, +-400 degrees.
    const Joints low = degrees({-165, -110, -110, -160, -120, -400}), high = degrees({165, 110, 70, 160, 120, 400});
    for (std::size_t i = 0; i < 6; ++i) arm.description.joints[i].low = low[i], arm.description.joints[i].high = high[i];
    const Kinematics abb = made(arm);
    const Joints there = degrees({20, 30, -10, 100, 50, 350});
    const Pose pose = abb.forward(there, {}).pose;

    expect_axes(abb.inverse(pose, {}, {}, degrees({22, 28, -12, 95, 55, 360})).axes, there);
    // Near the flipped wrist instead: axis 4 half a turn on.
    expect_axes(abb.inverse(pose, {}, {}, degrees({20, 30, -10, -80, -50, 170})).axes, degrees({20, 30, -10, -80, -50, 170}));
    // The nearest turn of axis 6 would be 710 degrees, beyond its limit: the one before it is taken.
    expect_axes(abb.inverse(pose, {}, abb.configuration(there), degrees({20, 30, -10, 100, 50, 800})).axes, there);
    Configuration any_of_6 = abb.configuration(there);
    any_of_6.turns.fill(any_turn);
    expect_axes(abb.inverse(pose, {}, any_of_6, degrees({20, 30, -10, 100, 50, 800})).axes, there);
    EXPECT_TRUE(abb.limits_of(there).ok());
}

TEST(KinematicChoice, BeyondALimitSaysWhichAndByHowMuch) {
    PublishedArm arm = irb_120();
    arm.description.joints[2].high = 70 * degree;
    const Kinematics abb = made(arm);
    const Joints there = degrees({20, 10, 75, 40, 50, 60});
    const AxisSolution way = abb.inverse(abb.forward(there, {}).pose, {}, abb.configuration(there), there);
    EXPECT_EQ(way.miss.fault, KinematicFault::joint_limit);
    EXPECT_EQ(way.miss.joint, 2);
    EXPECT_NEAR(way.miss.amount, 5 * degree, 1e-12);
    expect_axes(way.axes, there);
    const Miss miss = abb.limits_of(there);
    EXPECT_EQ(miss.fault, KinematicFault::joint_limit);
    EXPECT_EQ(miss.joint, 2);
    EXPECT_NEAR(miss.amount, 5 * degree, 1e-12);
}

// The reach of the SCARA is 650 mm and not less than 150: 50 mm too far, 50 mm too near.
TEST(KinematicChoice, OutOfReachSaysByHowMuch) {
    const Kinematics scara = made(epson_g10());
    const Miss far = scara.inverse(posed(.7, 0, 0, 0, 0, 0), {}, {}, {}).miss;
    EXPECT_EQ(far.fault, KinematicFault::out_of_reach);
    EXPECT_NEAR(far.amount, .05, 1e-12);
    const Miss near = scara.inverse(posed(0, .1, 0, 0, 0, 0), {}, {}, {}).miss;
    EXPECT_EQ(near.fault, KinematicFault::out_of_reach);
    EXPECT_NEAR(near.amount, .05, 1e-12);
    EXPECT_TRUE(scara.inverse(posed(.65, 0, 0, 0, 0, 0), {}, {}, {}).ok());

    // Axis 2 of the ABB is 290 mm up; from there 270 + hypot(302, 70) to the wrist, and 72 more straight on: pull at its flange sideways.
    const double reach = .270 + std::hypot(.302, .070);
    const Miss pulled = made(irb_120()).inverse(posed(reach + .072 + .01, 0, .290, 0, right, 0), {}, {}, {}).miss;
    EXPECT_EQ(pulled.fault, KinematicFault::out_of_reach);
    EXPECT_NEAR(pulled.amount, .01, 1e-12);
    // The TX40 does not get nearer to its first axis than 35 mm: here its wrist would be 10 mm from it.
    const Miss inside = made(tx40()).inverse(posed(0, .010, .5, 0, 0, 0), {}, {}, {}).miss;
    EXPECT_EQ(inside.fault, KinematicFault::out_of_reach);
    EXPECT_NEAR(inside.amount, .025, 1e-12);
    // Delta: 1.5 m below the middle; the rods reach 354.5 mm down and sqrt(0.8^2 - 0.148^2) further.
    const Miss below = made(flexpicker()).inverse(posed(0, 0, -1.5, 0, 0, 0), {}, {}, {}).miss;
    EXPECT_EQ(below.fault, KinematicFault::out_of_reach);
    EXPECT_NEAR(below.amount, std::hypot(1.5, .148) - .3545 - .8, 1e-3);  // of one arm: nearly in line
    const Miss side = made(linear_delta()).inverse(posed(.3, 0, 0, 0, 0, 0), {}, {}, {}).miss;
    EXPECT_EQ(side.fault, KinematicFault::out_of_reach);
    EXPECT_NEAR(side.amount, std::hypot(.3 + .1285 * std::cos(30 * degree), .1285 / 2) - .269, 1e-12);  // the tower on the other side
}

// Arms that turn about the vertical only do not tilt, and say by how much they were asked to.
TEST(KinematicChoice, OrientationThatAnArmCannotTake) {
    for (const PublishedArm& arm : {epson_g10(), irb_460(), flexpicker(), cartesian(), beam_gantry()}) {
        SCOPED_TRACE(arm.name);
        const Miss miss = made(arm).inverse(posed(.3, .2, -.7, .4, .1, 0), {}, {}, {}).miss;
        EXPECT_EQ(miss.fault, KinematicFault::orientation);
        EXPECT_NEAR(miss.amount, .1, 1e-12);
    }
    // Without a turning joint the turn is what cannot be taken.
    EXPECT_EQ(made(linear_delta()).inverse(posed(0, 0, 0, .2, 0, 0), {}, {}, {}).miss.fault, KinematicFault::orientation);
    EXPECT_EQ(made(core_xy()).inverse(posed(0, 0, 0, .2, 0, 0), {}, {}, {}).miss.fault, KinematicFault::orientation);
    // A missing linear axis: two axes do not leave their plane.
    const Kinematics table = Kinematics::make({.arm = CartesianAxes{.linear = {true, true, false}}}).value();
    const Miss lifted = table.inverse(posed(.1, .2, .3, 0, 0, 0), {}, {}, {}).miss;
    EXPECT_EQ(lifted.fault, KinematicFault::out_of_reach);
    EXPECT_NEAR(lifted.amount, .3, 1e-15);
    EXPECT_TRUE(table.inverse(posed(.1, .2, 0, 0, 0, 0), {}, {}, {}).ok());
}

TEST(KinematicChoice, WhatIsNoPoseIsRefused) {
    const Kinematics abb = made(irb_120());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(abb.inverse({{nan, 0, 0}, {1, 0, 0, 0}}, {}, {}, {}).miss.fault, KinematicFault::not_finite);
    EXPECT_EQ(abb.inverse({{.3, 0, .5}, {1, 1, 0, 0}}, {}, {}, {}).miss.fault, KinematicFault::not_finite);
    EXPECT_EQ(abb.inverse_all({{.3, 0, .5}, {0, 0, 0, 0}}, {}, {}).miss.fault, KinematicFault::not_finite);
    EXPECT_EQ(abb.inverse(posed(.3, 0, .5, 0, 0, 0), {}, {}, {nan}).miss.fault, KinematicFault::not_finite);
    EXPECT_EQ(abb.forward({nan}, {}).miss.fault, KinematicFault::not_finite);
    // A carriage a metre below the others: rods of 269 mm do not meet.
    EXPECT_EQ(made(linear_delta()).forward({0, 1, 1}, {}).miss.fault, KinematicFault::does_not_close);
}

// Whatever comes in: nothing that is told as reached is far from what was asked, and nothing that is no number is told.
TEST(KinematicChoice, HostileNumbers) {
    const double numbers[] = {0, 1e-320, .3, -1, 1e11, -1e160, std::numeric_limits<double>::max()};
    for (const PublishedArm& arm : published_arms()) {
        SCOPED_TRACE(arm.name);
        const Kinematics kinematics = made(arm);
        for (const double x : numbers)
            for (const double z : numbers)
                for (const double near : numbers) {
                    const Pose pose{{x, -x, z}, {1, 0, 0, 0}};
                    const AxisSolution way = kinematics.inverse(pose, {}, {}, {near, near, near, near, near, near});
                    if (way.ok()) {
                        EXPECT_LT(difference(kinematics.forward(way.axes, {}).pose, pose).position,
                                  1e-9 * (1 + std::abs(near) + std::abs(x) + std::abs(z)));
                    }
                    (void)kinematics.configuration({x, z, near, x, z, near});
                    (void)kinematics.singularity({x, z, near, x, z, near});
                    (void)kinematics.limits_of({x, z, near, x, z, near});
                }
        const double nan = std::numeric_limits<double>::quiet_NaN();
        (void)kinematics.configuration({nan, nan, nan, nan, nan, nan});
    }
}

// K-03: a line through the wrist's singularity, at every distance from it: axis 4 stays where it is when the distance is 0, and the pose is
// kept to 1e-9 whatever the axes do.
TEST(KinematicChoice, WristPassesItsSingularity) {
    const Kinematics abb = made(irb_120());
    for (const double beside : {0.0, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2}) {
        SCOPED_TRACE(beside);
        Joints q = degrees({5, 20, 10, 30, 0, -20});
        for (int step = -50; step <= 50; ++step) {
            // Axis 5 through 0, the tool's direction passing `beside` it.
            const Joints there = {q[0], 20 * degree, 10 * degree, 30 * degree, step * .002, -20 * degree};
            const Pose pose = composed(abb.forward({5 * degree, there[1], there[2], there[3], there[4], there[5]}, {}).pose,
                                       posed(0, 0, 0, 0, 0, beside));
            const AxisSolution way = abb.inverse(pose, {}, {}, q);
            ASSERT_TRUE(way.ok());
            const PoseDifference d = difference(abb.forward(way.axes, {}).pose, pose);
            ASSERT_LT(d.position, 1e-9);
            ASSERT_LT(d.angle, 1e-9);
            if (beside == 0 && step == 0) {
                EXPECT_NEAR(way.axes[3], q[3], 1e-12);
            }
            q = way.axes;
            q[0] = 5 * degree;
        }
        if (beside == 0) {
            EXPECT_NEAR(q[3], 30 * degree, 1e-9);
        }
    }
}

// On axis 1 joint 1 is free, and stays.
TEST(KinematicChoice, ShoulderIsHeldOnItsAxis) {
    const Kinematics abb = made(irb_120());
    const double height = .290 + .270 + .2;
    const AxisSolution way = abb.inverse(posed(0, 0, height + .072, 0, 0, 0), {}, {}, {.7, 0, 0, 0, 0, 0});
    ASSERT_TRUE(way.ok());
    EXPECT_NEAR(way.axes[0], .7, 1e-12);
    EXPECT_EQ(abb.singularity(way.axes).kind, SingularityKind::shoulder);
    const AxisSolution column = made(irb_460()).inverse(posed(0, 0, 1, .3, 0, 0), {}, {}, {-.4, 0, 0, 0, 0, 0});
    if (column.ok()) {
        EXPECT_NEAR(column.axes[0], -.4, 1e-12);
    }
}

// Axis 5 follows axis 4 by a fiftieth, axis 6 both: told so, each motor moves by what its own joint and those before it need.
TEST(KinematicChoice, CoupledWristAxes) {
    PublishedArm arm = irb_120();
    arm.description.coupling[4][3] = .02;
    arm.description.coupling[5][3] = .01;
    arm.description.coupling[5][4] = -.05;
    const Kinematics coupled = made(arm), plain = made(irb_120());
    const Joints joints = degrees({10, 20, 30, 40, 50, 60});
    const Joints motors = degrees({10, 20, 30, 40, 50 + .02 * 40, 60 + .01 * 40 - .05 * 50});
    EXPECT_LT(difference(coupled.forward(motors, {}).pose, plain.forward(joints, {}).pose).position, 1e-14);
    expect_axes(coupled.inverse(plain.forward(joints, {}).pose, {}, {}, motors).axes, motors, 1e-12);
}

TEST(KinematicChoice, DegreesAndMakersZeros) {
    PublishedArm arm = kr6_r900();
    for (JointSettings& j : arm.description.joints) j.unit = degree;
    const Kinematics kuka = made(arm);
    const Joints home{0, -90, 90, 0, 30, 0};
    expect_axes(kuka.inverse(kuka.forward(home, {}).pose, {}, kuka.configuration(home), {}).axes, home, 1e-9);
    EXPECT_LT((position_of(kuka.forward({0, -90, 90, 0, 0, 0}, {}).pose) - Eigen::Vector3d(.525, 0, .890)).norm(), 1e-12);
}

// Rounding in a quaternion is scaled away, and does not reach the axes.
TEST(KinematicChoice, NearlyUnitQuaternions) {
    const Kinematics abb = made(irb_120());
    const Joints there = degrees({20, 30, -10, 40, 50, 60});
    Pose pose = abb.forward(there, {}).pose;
    for (double& v : pose.orientation) v *= 1 + 1e-8;
    expect_axes(abb.inverse(pose, {}, abb.configuration(there), there).axes, there, 1e-12);
}

// The cycle allocates nothing, whatever the arm, the pose or the outcome.
TEST(KinematicChoice, NothingAllocates) {
    for (const PublishedArm& arm : published_arms()) {
        SCOPED_TRACE(arm.name);
        const Kinematics kinematics = made(arm);
        const Joints q = arm.name.find("gantry") == std::string::npos ? Joints{.2, .2, .2, .2, .2, .2} : Joints{};
        HeapUse used;
        double sum = 0;
        {
            const NoAllocationScope scope;
            const Pose pose = kinematics.forward(q, {}).pose;
            sum += kinematics.inverse(pose, {}, {}, q).axes[0] + kinematics.inverse_all(pose, {}, q).count;
            sum += kinematics.inverse(posed(100, 0, 0, 0, 0, 0), {}, {}, q).miss.amount;
            sum += kinematics.jacobian(q, {})(0, 0) + kinematics.derivatives(q, {}, {}).of[0][0] + kinematics.singularity(q).measure;
            const Kinematics copy = kinematics;
            sum += copy.forward(q, {}).pose.position[0];
            used = scope.used();
        }
        EXPECT_EQ(used.total(), 0U) << used.text() << sum;
    }
}

}  // namespace
}  // namespace taktwerk::axes
