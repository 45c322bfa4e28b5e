// Set-up mode where it hardly holds anything back: jogs of the axes whose tool would, at its fastest place, be faster than it may by a share of a percent.
// There the tool's limit is in force on a few degrees of the way alone, perhaps between two places that are looked at. The same jog once in automatic
// mode says how fast the tool is; then in set-up mode with velocities that bring just that place to its limit.

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "tests/axes/group/jog_arms.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr double reduced = 250;  // mm/s, ISO 10218-1, 5.6.2
constexpr Pose far_tool{.position = {300, -80, 200}};

class EdgeJog {
public:
    explicit EdgeJog(const JogArm& arm) : arm_(arm), kinematics_(arm_of(arm.description)), rig_(fast(axes_of(arm)), kinematics_) {
        rig_.enable();
        for (auto& axis : rig_.axes)
            EXPECT_EQ(axis.submit({.kind = CommandKind::home, .position = 0}, Owner::program).error, ErrorId::none);
        rig_.run(50);
        EXPECT_EQ(rig_.give({.kind = GroupCommandKind::write_tool, .number = 1, .tool = {.frame = {300, -80, 200, 0, 0, 0}}}).error,
                  ErrorId::none);
        EXPECT_EQ(rig_.set(SelectTool{1}), ErrorId::none);
    }

    /// The fastest that the tool was in `cycles` of a jog from the arm's start.
    double fastest(OperatingMode mode, const JointVector& direction, double velocity, int cycles) {
        rig_.groups[0].set_mode(OperatingMode::automatic);
        rig_.run(3);
        const auto there = rig_.give({.kind = GroupCommandKind::direct_absolute, .target = arm_.start});
        EXPECT_TRUE(rig_.until([&] { return rig_.status(there.id) == CommandStatus::done; }, 5000)) << arm_.name;
        rig_.run(5);
        rig_.groups[0].set_mode(mode);
        JoggingDynamics hand{.path = {100, 1000, 1000, 20000}};
        hand.velocity.fill(velocity);
        EXPECT_EQ(rig_.set(WriteJoggingDynamics{hand}), ErrorId::none);
        const auto given = rig_.give({.kind = GroupCommandKind::jog, .frame = mcACS, .target = direction});
        EXPECT_EQ(given.error, ErrorId::none) << arm_.name;
        HoldJog held{.id = given.id, .direction = direction};
        double most = 0;
        std::optional<Pose> last;
        const auto look = [&] {
            Joints joints{};
            for (std::size_t i = 0; i < max_joints; ++i) joints[i] = rig_.view().set_position[i];
            const auto here = kinematics_->forward(joints, far_tool);
            if (!here.miss.ok()) return last.reset();
            double square = 0;
            if (last)
                for (std::size_t k = 0; k < 3; ++k)
                    square += std::pow((here.pose.position[k] - last->position[k]) / to_seconds(GroupRig::cycle), 2);
            last = here.pose;
            most = std::max(most, std::sqrt(square));
        };
        for (int i = 0; i < cycles && rig_.status(given.id) == CommandStatus::active; ++i) {
            rig_.step([&] { (void)rig_.set(held); });
            look();
        }
        held.direction = {};
        rig_.step([&] { (void)rig_.set(held); });
        EXPECT_TRUE(rig_.until([&] { return rig_.view().state == GroupState::GroupStandby; }, 3000)) << arm_.name;
        return most;
    }

private:
    static std::vector<AxisConfig> fast(std::vector<AxisConfig> axes) {
        for (auto& axis : axes) {
            axis.limits.velocity = 400;
            axis.limits.acceleration = axis.limits.deceleration = 4000;
            axis.limits.jerk = 80000;
        }
        return axes;
    }
    const JogArm& arm_;
    Arm kinematics_;
    GroupRig rig_;
};

TEST(GroupSetupEdgeProperty, AToolThatWouldHardlyBeTooFastIsNot) {
    const auto arms = every_kind_of_arm();
    double nearest = 0;
    for (std::size_t i = 0; i < property_cases(arms.size()) && !HasFailure(); ++i) {
        const auto& arm = arms[i % arms.size()];
        if (arm.askew) continue;
        std::mt19937_64 random(31000 + i);
        const auto whole = [&](int from, int to) { return std::uniform_int_distribution<int>(from, to)(random); };
        JointVector direction{};
        for (std::size_t k = 0; k < arm.turning.size(); ++k) direction[k] = whole(0, 2) == 0 ? 0 : whole(0, 1) == 0 ? -1 : 1;
        if (direction == JointVector{}) direction[0] = 1;
        EdgeJog jog(arm);
        constexpr double probing = 30;
        const double there = jog.fastest(OperatingMode::automatic, direction, probing, 2500);
        if (!(there > 1)) continue;
        for (const double beyond : {6e-4, 2e-3, 8e-3}) {
            const double velocity = probing * reduced / there * (1 + beyond);
            if (velocity > 350) continue;
            const double most = jog.fastest(OperatingMode::setup, direction, velocity, static_cast<int>(2500 * probing / velocity));
            EXPECT_LE(most, reduced * (1 + 1e-9)) << arm.name << " case " << i << ", would be faster by " << beyond;
            nearest = std::max(nearest, most);
        }
    }
    EXPECT_GT(nearest, 0.99 * reduced) << "a limit that is never met shows nothing";
}

}  // namespace
}  // namespace taktwerk::axes::test
