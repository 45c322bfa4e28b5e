// FK(IK(x)) = x, and IK(FK(q)) has q among its ways: over random stands of every arm, in all branches, on and beside the singularities
// (O-5 of the group's rules). A long run (TAKTWERK_SOAK_FACTOR) prints what it found for each arm.

#include <cstdlib>
#include <iostream>

#include <gtest/gtest.h>

#include "tests/axes/kinematics/pose_difference.hpp"
#include "tests/axes/kinematics/random_stands.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes {
namespace {

/// Issue: 1e-9 m, rad.
constexpr double allowed = 1e-9;

double way_round(double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)); }

struct Found {
    std::size_t poses = 0, ways = 0, none = 0, lost = 0, from_afar = 0;
    double position = 0, angle = 0;
};

std::ostream& operator<<(std::ostream& out, const Found& f) {
    return out << f.poses << " poses, " << f.ways << " ways, worst " << f.position << " m, " << f.angle << " rad; no way to " << f.none
               << ", another way than it came " << f.lost
               << (f.from_afar > 0 ? ", from afar " + std::to_string(f.from_afar) + " of a tenth" : "");
}

/// Do flags and turns stay as they are when the joints move a little?
bool settled(const Kinematics& kinematics, const Joints& axes) {
    for (std::size_t i = 0; i < kinematics.joint_count(); ++i)
        for (const double little : {-1e-7, 1e-7}) {
            Joints beside = axes;
            beside[i] += little;
            if (!(kinematics.configuration(beside) == kinematics.configuration(axes))) return false;
        }
    return true;
}

class RoundTrip : public ::testing::TestWithParam<PublishedArm> {};

TEST_P(RoundTrip, EveryWayLeadsBackToThePose) {
    const PublishedArm& arm = GetParam();
    const Kinematics kinematics = made(arm);
    const auto rotary = kinematics.rotary();
    const bool numeric = !kinematics.closed_form();
    ASSERT_EQ(numeric, !arm.closed_form);  // Newton's method would make good what a closed form does wrong
    const Pose tool = posed(.05, -.02, .11, .3, -.2, .9);
    RandomStands random{17};
    Found found;

    const std::size_t cases = property_cases(numeric ? 1000 : 5000);
    for (std::size_t i = 0; i < cases && !HasFailure(); ++i) {
        Joints q = random.next(arm, rotary);
        if (std::holds_alternative<BeamGantryShape>(arm.description.arm)) q[1] = q[0];  // it is set square
        SCOPED_TRACE(::testing::Message() << "case " << i << " " << ::testing::PrintToString(q));
        const ForwardResult there = kinematics.forward(q, tool);
        if (there.miss.fault == KinematicFault::does_not_close) continue;
        ASSERT_TRUE(there.miss.ok());

        const AllAxisSolutions ways = kinematics.inverse_all(there.pose, tool, q);

        ++found.poses;
        const double nearness = kinematics.singularity(q).measure;
        if (ways.count == 0 && nearness > 1e-6) ++found.none;
        bool came_back = false;
        for (int k = 0; k < ways.count; ++k) {
            const AxisSolution& way = ways.at[static_cast<std::size_t>(k)];
            const ForwardResult back = kinematics.forward(way.axes, tool);
            const PoseDifference d = difference(there.pose, back.pose);
            ASSERT_TRUE(back.miss.ok());
            ASSERT_LE(d.position, allowed);
            ASSERT_LE(d.angle, allowed);
            found.position = std::max(found.position, d.position);
            found.angle = std::max(found.angle, d.angle);
            ++found.ways;
            // Beside a singularity the same pose has stands that differ: how far from q they may be goes with how near it is.
            double furthest = 0;
            for (std::size_t j = 0; j < kinematics.joint_count(); ++j)
                furthest = std::max(furthest, rotary[j] ? way_round(way.axes[j], q[j]) : std::abs(way.axes[j] - q[j]));
            came_back = came_back || furthest < 1e-7 + 1e-14 / (nearness * nearness);
            // Flags and turns are those of the joints, but where their sign is rounding.
            if (!(way.configuration == kinematics.configuration(way.axes))) {
                ASSERT_FALSE(settled(kinematics, way.axes));
            }
        }
        if (!came_back && nearness > 1e-6) ++found.lost;
        if (numeric && i % 10 == 0) found.from_afar += kinematics.inverse_all(there.pose, tool, {}).count == 0 ? 0 : 1;
    }

    if (std::getenv("TAKTWERK_SOAK_FACTOR") != nullptr) std::cout << arm.name << ": " << found << "\n";
    EXPECT_EQ(found.none, 0U);
    EXPECT_EQ(found.lost, 0U);
    RecordProperty("worst_position", std::to_string(found.position));
}

INSTANTIATE_TEST_SUITE_P(Arms, RoundTrip, ::testing::ValuesIn(published_arms()), [](const auto& info) {
    std::string name;
    for (const char c : info.param.name)
        if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
    return name;
});

}  // namespace
}  // namespace taktwerk::axes
