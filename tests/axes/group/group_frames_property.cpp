// Frames and tools drawn at random: one motion, commanded in a frame and, computed by hand, in the machine, is the same set-points. And a position
// that goes through a frame and back is the same axes.

#include <gtest/gtest.h>

#include <random>

#include "tests/axes/group/by_hand.hpp"
#include "tests/axes/group/group_rig.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

/// ABB, data sheet IRB 140: 352, 70, 360, 380, 65 mm; at 0 the forearm is level. Axes in rad, metres.
Arm six_axes() {
    KinematicsDescription d{.arm = SixJoints{.geometry = WristArmLengths{.a1 = .070, .c1 = .352, .c2 = .360, .c3 = .380, .c4 = .065}}};
    d.joints[2].zero = std::numbers::pi / 2;
    d.joints[0].low = d.joints[3].low = d.joints[5].low = -7;
    d.joints[0].high = d.joints[3].high = d.joints[5].high = 7;
    return arm_of(d);
}
std::vector<AxisConfig> its_axes() {
    std::vector<AxisConfig> axes;
    for (int i = 0; i < 6; ++i)
        axes.push_back(group_axis("j" + std::to_string(i), {.velocity = 4, .acceleration = 20, .deceleration = 20, .jerk = 400}));
    return axes;
}

class FrameDraws {
public:
    explicit FrameDraws(std::uint64_t seed) : random_(seed) {}
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    Six frame(double size) {
        return {uniform(-size, size), uniform(-size, size), uniform(-size, size), uniform(-3, 3), uniform(-1.4, 1.4), uniform(-3, 3)};
    }

private:
    std::mt19937_64 random_;
};

JointVector as_target(const Six& six) { return {six[0], six[1], six[2], six[3], six[4], six[5]}; }
Six pose_at(const Arm& arm, const Joints& q, const Six& tool) {
    const auto at = arm->forward(q, pose_of_numbers(tool));
    return numbers_of(at.pose);
}

// G-029, G-073, G-074, G-080
TEST(GroupFramesProperty, OneMotionInAProductAndInTheMachineIsOne) {
    const Arm arm = six_axes();
    std::size_t gone = 0, to_the_digit = 0;
    for (std::size_t n = 0; n < property_cases(12) && !HasFailure(); ++n) {
        SCOPED_TRACE(::testing::Message() << "case " << n);
        FrameDraws draws(7100 + n);
        const auto world = draws.frame(2), product = draws.frame(2), tool = draws.frame(0.1);
        const auto to_world = hand_frame(world);
        const auto of_product = back(hand_frame(product)) * to_world;  // the machine's numbers -> the product's
        const Joints q0{draws.uniform(-1, 1), draws.uniform(-0.4, 0.4), draws.uniform(-0.4, 0.4),
                        draws.uniform(-1, 1), draws.uniform(0.6, 1.2),  draws.uniform(-1, 1)};
        std::vector<GroupCommand> commands;
        for (int k = 0; k < 3; ++k) {
            Joints q = q0;
            for (double& v : q) v += draws.uniform(-0.12, 0.12);
            const auto target = pose_at(arm, q, tool);
            GroupCommand command = line(as_target(target), 0.3, k == 0 ? mcAborting : mcBlendingHigh);
            command.frame = mcMCS;
            command.transition = mcTMCornerDistance;
            command.transition_parameter = 0.01;
            if (draws.whole(0, 3) == 0) command.kind = GroupCommandKind::direct_absolute;
            if (draws.whole(0, 2) == 0) {
                command.kind = GroupCommandKind::circular_absolute;
                for (double& v : q) v += 0.03;
                const auto aux = pose_at(arm, q, tool);
                command.circle = {.mode = mcBORDER, .aux = {aux[0], aux[1], aux[2]}};
            }
            commands.push_back(command);
        }
        std::array<std::vector<JointVector>, 2> paths;
        std::array<std::vector<int>, 2> ends;
        for (std::size_t side = 0; side < 2; ++side) {
            GroupRig rig(its_axes(), arm);
            rig.enable();
            const auto there = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {q0[0], q0[1], q0[2], q0[3], q0[4], q0[5]}});
            ASSERT_TRUE(rig.until([&] { return rig.status(there.id) == CommandStatus::done; }, 9000));
            rig.run(3);
            GroupCommand written{.kind = GroupCommandKind::write_tool, .number = 2};
            written.tool.frame = tool;
            ASSERT_EQ(rig.submit(written).error, ErrorId::none);
            ASSERT_EQ(rig.set(SelectTool{2}), ErrorId::none);
            if (side == 1) {
                ASSERT_EQ(rig.submit({.kind = GroupCommandKind::set_frame, .frame = mcMCS, .target = as_target(world)}).error,
                          ErrorId::none);
                ASSERT_EQ(rig.submit({.kind = GroupCommandKind::set_frame, .frame = mcPCS_3, .target = as_target(product)}).error,
                          ErrorId::none);
            }
            const auto from = rig.path.size();
            std::vector<CommandId> ids;
            rig.step([&] {
                for (auto command : commands) {
                    if (side == 1) {
                        const auto& t = command.target;
                        command.frame = mcPCS_3;
                        command.target = as_target(hand_six(of_product * hand_frame({t[0], t[1], t[2], t[3], t[4], t[5]})));
                        const auto& aux = command.circle.aux;
                        command.circle.aux = (of_product * hand_frame({aux[0], aux[1], aux[2], 0, 0, 0})).o;
                    }
                    const auto answer = rig.submit(command);
                    EXPECT_EQ(answer.error, ErrorId::none);
                    ids.push_back(answer.id);
                }
            });
            ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupState::GroupStandby; }, 20000));
            for (const auto id : ids) ends[side].push_back(static_cast<int>(rig.error_of(id)));
            paths[side].assign(rig.path.begin() + static_cast<std::ptrdiff_t>(from), rig.path.end());
        }
        EXPECT_EQ(ends[0], ends[1]);
        ASSERT_EQ(paths[0].size(), paths[1].size());
        // The last digits of what is computed by hand may end the search for a time otherwise: by microseconds, never beside the path.
        constexpr double same_time = 5e-6;
        double beside = 0, later = 0, apart_most = 0;
        for (std::size_t i = 1; i + 1 < paths[0].size(); ++i) {
            double along = 0, speed2 = 0, square = 0;
            for (std::size_t k = 0; k < 6; ++k) {
                const double speed = (paths[0][i + 1][k] - paths[0][i - 1][k]) / 0.002, d = paths[1][i][k] - paths[0][i][k];
                along += d * speed;
                speed2 += speed * speed;
                square += d * d;
                apart_most = std::max(apart_most, std::abs(d));
            }
            if (speed2 > 0) later = std::max(later, std::abs(along) / speed2 * (apart_most > 1e-9 ? 1 : 0));
            beside = std::max(beside, std::sqrt(std::max(square - (speed2 > 0 ? along * along / speed2 : 0), 0.0)));
        }
        EXPECT_LE(beside, 1e-9);
        EXPECT_LE(later, same_time);
        to_the_digit += apart_most <= 1e-9 ? 1 : 0;
        gone += paths[0].size() > 200 ? 1 : 0;
    }
    EXPECT_GT(gone, property_cases(12) / 2) << "or nothing was compared";
    EXPECT_GT(to_the_digit, property_cases(12) * 3 / 4) << "in time too";
}

// G-076: also across turns, in every frame, with a tool.
TEST(GroupFramesProperty, AxesThroughAFrameAndBackAreTheSameAxes) {
    const Arm arm = six_axes();
    GroupRig rig(its_axes(), arm);
    FrameDraws draws(7400);
    std::size_t across = 0, compared = 0;
    for (std::size_t n = 0; n < property_cases(4000) && !HasFailure(); ++n) {
        const auto world = draws.frame(2), product = draws.frame(2), tool = draws.frame(0.2);
        ASSERT_EQ(rig.submit({.kind = GroupCommandKind::set_frame, .frame = mcMCS, .target = as_target(world)}).error, ErrorId::none);
        ASSERT_EQ(rig.submit({.kind = GroupCommandKind::set_frame, .frame = mcPCS_8, .target = as_target(product)}).error, ErrorId::none);
        GroupCommand written{.kind = GroupCommandKind::write_tool, .number = 31};
        written.tool.frame = tool;
        ASSERT_EQ(rig.submit(written).error, ErrorId::none);
        ASSERT_EQ(rig.set(SelectTool{31}), ErrorId::none);
        PlaceQuestion question{.from = mcACS, .to = mcPCS_8, .place = {}};
        // Beyond a turn where the axis may go there; away from singularities, where the way back is no function.
        const double ranges[] = {6.5, 2, 2, 6.5, 2, 6.5};
        Joints q{};
        for (std::size_t k = 0; k < 6; ++k) question.place.axes[k] = q[k] = draws.uniform(-ranges[k], ranges[k]);
        if (arm->singularity(q).measure < 0.05) continue;
        for (const auto frame : {mcMCS, mcWCS, mcPCS_8, mcTCS}) {
            question.to = frame;
            const auto there = rig.groups.transformed(GroupRig::ref, question);
            ASSERT_EQ(there.error, ErrorId::none);
            EXPECT_FALSE(there.singular);
            PlaceQuestion home{.from = frame, .to = mcACS, .place = there.place};
            home.place.axes = {};
            const auto again = rig.groups.transformed(GroupRig::ref, home);
            ASSERT_EQ(again.error, ErrorId::none);
            for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(again.place.axes[k], q[k], 1e-9) << k;
            // What it says is so: by hand, of the machine's numbers.
            if (frame == mcPCS_8) {
                const auto machine = hand_frame(pose_at(arm, q, tool));
                EXPECT_LE(apart(hand_frame(there.place.six), back(hand_frame(product)) * hand_frame(world) * machine), 1e-12 * 10);
            }
        }
        ++compared;
        for (const std::size_t k : {0, 3, 5}) across += std::abs(q[k]) > std::numbers::pi ? 1 : 0;
    }
    EXPECT_GT(compared, property_cases(4000) / 2);
    EXPECT_GT(across, compared) << "turns were left";
}

}  // namespace
}  // namespace taktwerk::axes::test
