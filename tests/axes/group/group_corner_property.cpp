// Programs of direct moves and of lines of the tool, one behind the other at random, with curves between them, overridden and interrupted: each ends where it is to end, and no
// joint is ever beyond a limit or away from one motion (the rig's oracle, every cycle).

#include <gtest/gtest.h>

#include <random>

#include "axes/group/written_pose.hpp"
#include "tests/axes/group/jog_arms.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

class MixedProgram {
public:
    MixedProgram(std::uint64_t seed, const JogArm& arm)
        : random_(seed),
          arm_(arm_of(arm.description)),
          rig_(axes_of(arm), GroupRig::all_of(axes_of(arm), arm_)),
          at_(arm.start),
          start_(arm.start) {
        rig_.enable();
        auto there = line(arm.start, 60);
        there.kind = GroupCommandKind::direct_absolute;
        const auto first = rig_.give(there);
        EXPECT_TRUE(rig_.until([&] { return rig_.status(first.id) == CommandStatus::done; }, 20'000));
    }

    int curves() const { return curves_; }
    void run() {
        constexpr int commands = 12;
        std::vector<CommandId> ids;
        std::size_t finished = 0;
        for (int i = 0; i < 100'000 && !::testing::Test::HasFailure(); ++i) {
            if (static_cast<int>(ids.size()) < commands && uniform(0, 1) < 0.1) {
                const auto answer = rig_.submit(next());
                ASSERT_EQ(answer.error, ErrorId::none);
                ids.push_back(answer.id);
            }
            if (uniform(0, 1) < 0.002) {
                ASSERT_EQ(rig_.set(Override{uniform(0.2, 1), uniform(0.5, 1), uniform(0.5, 1)}), ErrorId::none);
            }
            if (rig_.view().interrupted) {
                ASSERT_EQ(rig_.submit(simply(GroupCommandKind::resume)).error, ErrorId::none);
            } else if (uniform(0, 1) < 0.001) {
                (void)rig_.submit(simply(GroupCommandKind::interrupt));
            }
            const auto before = rig_.view().active;
            rig_.step();
            const auto corner = rig_.view().corner;
            if (rig_.view().active != before && (corner == CornerPassed::as_asked || corner == CornerPassed::smaller)) ++curves_;
            while (finished < ids.size() && rig_.status(ids[finished]) == CommandStatus::done) ++finished;
            if (finished < ids.size()) {
                ASSERT_NE(rig_.status(ids[finished]), CommandStatus::error) << static_cast<int>(rig_.error_of(ids[finished]));
            }
            if (finished == commands && rig_.view().state == GroupState::GroupStandby) break;
        }
        EXPECT_EQ(finished, static_cast<std::size_t>(commands));
        for (std::size_t k = 0; k < arm_->joint_count(); ++k) EXPECT_NEAR(rig_.point()[k], at_[k], 1e-6) << k;
    }

private:
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

    /// Near the beginning, so that straight lines between the places stay in reach and away from singularities.
    GroupCommand next() {
        Joints joints{};
        for (std::size_t k = 0; k < arm_->joint_count(); ++k) joints[k] = at_[k] = start_[k] + uniform(-8, 8);
        GroupCommand command = line(at_, uniform(10, 90), static_cast<MC_BufferMode>(whole(2, 5)));
        if (whole(0, 1) == 0) {
            command.kind = GroupCommandKind::direct_absolute;
        } else {
            const auto pose = arm_->forward(joints, Pose{});
            EXPECT_TRUE(pose.miss.ok());
            const auto six = numbers_of(pose.pose);
            command.frame = mcMCS;
            command.target = {six[0], six[1], six[2], six[3], six[4], six[5]};
        }
        command.transition = static_cast<MC_TransitionMode>(whole(0, 4));
        const bool by_velocity = command.transition == mcTMStartVelocity || command.transition == mcTMConstantVelocity;
        command.transition_parameter = by_velocity ? uniform(0, 1) : uniform(0, 15);
        return command;
    }

    std::mt19937_64 random_;
    Arm arm_;
    GroupRig rig_;
    JointVector at_{}, start_{};
    int curves_ = 0;
};

// G-058, G-060, G-062
TEST(GroupCornerProperty, ProgramsOfAxesAndPosesArrive) {
    int curves = 0;
    for (const auto& arm : every_kind_of_arm()) {
        if (arm.name != "scara" && arm.name != "six_with_wrist" && arm.name != "rotary_delta") continue;
        for (std::size_t i = 0; i < property_cases(1) && !HasFailure(); ++i) {
            SCOPED_TRACE(::testing::Message() << arm.name << " program " << i);
            MixedProgram program(5000 + i, arm);
            program.run();
            curves += program.curves();
        }
    }
    EXPECT_GT(curves, 5);
}

}  // namespace
}  // namespace taktwerk::axes::test
