// Set-up mode on every kind of arm, whoever moves it: direct moves, lines, blends, jogs of axes and of the tool, with a tool on it. The oracle is not the
// planner's: the forward kinematics of the set-points, from cycle to cycle. A chord is no longer than its arc, so what it shows is at most the speed;
// and where set-points are a millisecond apart it misses of 250 mm/s, bent at a radius of millimetres, less than a thousandth.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/axes/group/jog_arms.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

constexpr double reduced_speed = 250;  // mm/s, ISO 10218-1, 5.6.2
/// Of a tool that stands off: it makes wrists move its point.
constexpr Pose tool_point{.position = {60, 0, 90}};

std::vector<AxisGroupConfig> with_tool(const std::vector<AxisConfig>& axes, const Arm& arm, double setup_velocity) {
    auto groups = GroupRig::all_of(axes, arm);
    groups[0].setup_velocity = setup_velocity;
    return groups;
}

class SetUpWalk {
public:
    SetUpWalk(std::uint64_t seed, const JogArm& arm, double setup_velocity = 0)
        : random_(seed),
          arm_(arm),
          most_(setup_velocity > 0 ? setup_velocity : reduced_speed),
          kinematics_(arm_of(arm.description)),
          rig_(fast(axes_of(arm)), with_tool(axes_of(arm), kinematics_, setup_velocity)) {
        rig_.enable();
        for (auto& axis : rig_.axes)
            EXPECT_EQ(axis.submit({.kind = CommandKind::home, .position = 0}, Owner::program).error, ErrorId::none);
        rig_.run(50);
        EXPECT_EQ(rig_.give({.kind = GroupCommandKind::write_tool, .number = 1, .tool = {.frame = {60, 0, 90, 0, 0, 0}}}).error,
                  ErrorId::none);
        EXPECT_EQ(rig_.set(SelectTool{1}), ErrorId::none);
        auto hand = jogging_of_arms();
        hand.path.velocity = 2000;  // what a program may say
        hand.velocity.fill(400);
        hand.acceleration.fill(0);
        EXPECT_EQ(rig_.set(WriteJoggingDynamics{hand}), ErrorId::none);
        go({.kind = GroupCommandKind::direct_absolute, .target = arm_.start});
    }
    void mode(OperatingMode mode) {
        rig_.groups[0].set_mode(mode);
        watches_ = mode == OperatingMode::setup;
    }

    void walk(int moves) {
        for (int i = 0; i < moves && !::testing::Test::HasFailure(); ++i) {
            switch (whole(0, 3)) {
                case 0: go({.kind = GroupCommandKind::direct_absolute, .target = near_start(40)}); break;
                case 1: lines(); break;
                case 2: jog(mcACS); break;
                default: jog(mcMCS); break;
            }
        }
    }
    [[nodiscard]] double fastest() const { return fastest_; }
    [[nodiscard]] int told() const { return told_; }

private:
    static std::vector<AxisConfig> fast(std::vector<AxisConfig> axes) {
        for (auto& axis : axes) {
            axis.limits.velocity = 400;
            axis.limits.acceleration = axis.limits.deceleration = 4000;
            axis.limits.jerk = 80000;
        }
        return axes;
    }
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
    JointVector near_start(double by) {
        JointVector at = arm_.start;
        for (std::size_t k = 0; k < arm_.turning.size(); ++k) at[k] += uniform(-by, by);
        if (arm_.askew) at[1] = at[0];
        return at;
    }

    void step(const std::function<void()>& program = {}) {
        rig_.step(program);
        look();
    }
    /// Until it is over; a command may end in an error (out of reach, singular): nothing moved then.
    void go(const GroupCommand& command) {
        Submitted given;
        step([&] { given = rig_.submit(command); });
        rest(given.id);
    }
    void rest(CommandId id) {
        for (int i = 0; i < 12'000 && !::testing::Test::HasFailure(); ++i) {
            if (rig_.view().state != GroupState::GroupMoving) break;
            step();
        }
        EXPECT_EQ(rig_.view().state, GroupState::GroupStandby) << arm_.name << " command " << id;
        step();
    }
    /// Three lines in the machine, blended.
    void lines() {
        const auto here = rig_.view().tool_set;
        CommandId last = 0;
        for (int i = 0; i < 3; ++i) {
            GroupCommand line{.kind = GroupCommandKind::linear_absolute,
                              .frame = mcMCS,
                              .buffer_mode = i == 0 ? mcAborting : mcBlendingHigh,
                              .transition = i == 0 ? mcTMNone : mcTMCornerDistance,
                              .transition_parameter = i == 0 ? 0.0 : 15.0,
                              .dynamics = {.velocity = uniform(100, 1500)}};
            for (std::size_t k = 0; k < 6; ++k) line.target[k] = here[k];
            for (std::size_t k = 0; k < 3; ++k)
                if (kinematics_->commands()[k]) line.target[k] += uniform(-60, 60);
            const auto given = rig_.submit(line);
            if (given.error == ErrorId::none) last = given.id;
            step();
        }
        rest(last);
    }
    void jog(MC_CoordSystem frame) {
        GroupCommand press{.kind = GroupCommandKind::jog, .frame = frame};
        const int slots = frame == mcACS ? static_cast<int>(arm_.turning.size()) : 3;
        for (int n = whole(1, 3); n > 0; --n) press.target[static_cast<std::size_t>(whole(0, slots - 1))] = whole(0, 1) == 0 ? -1 : 1;
        if (frame == mcACS && arm_.askew) press.target[1] = press.target[0];
        if (press.target == JointVector{}) return;
        Submitted given;
        step([&] { given = rig_.submit(press); });
        HoldJog held{.id = given.id, .direction = press.target};
        for (int i = whole(200, 700); i > 0 && rig_.status(given.id) == CommandStatus::active && !::testing::Test::HasFailure(); --i)
            step([&] { (void)rig_.set(held); });
        held.direction = {};
        step([&] { (void)rig_.set(held); });
        rest(given.id);
    }

    void look() {
        const auto& view = rig_.view();
        const auto here = kinematics_->forward(first_of(view.set_position), tool_point);
        if (!here.miss.ok()) return;
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k)
            square += std::pow((here.pose.position[k] - last_.position[k]) / to_seconds(GroupRig::cycle), 2);
        last_ = here.pose;
        if (!known_) {
            known_ = true;
            return;
        }
        const double speed = std::sqrt(square);
        if (!watches_) {
            fastest_ = std::max(fastest_, speed);
            return;
        }
        ASSERT_LE(speed, most_ * (1 + 1e-9)) << arm_.name << " in cycle " << rig_.path.size() << ", doing "
                                             << static_cast<int>(view.active_kind);
        fastest_ = std::max(fastest_, speed);
        EXPECT_EQ(view.tool_limit, most_);
        if (view.limiter != PathLimiter::setup_velocity) return;
        ++told_;
        EXPECT_GE(speed, 0.95 * most_) << "told is so";
    }
    static Joints first_of(const JointVector& values) {
        Joints joints{};
        for (std::size_t i = 0; i < max_joints; ++i) joints[i] = values[i];
        return joints;
    }

    std::mt19937_64 random_;
    JogArm arm_;
    double most_;
    Arm kinematics_;
    GroupRig rig_;
    Pose last_{};
    bool known_ = false, watches_ = false;
    double fastest_ = 0;
    int told_ = 0;
};

TEST(GroupSetupVelocityProperty, TheToolsPointKeepsReducedSpeedOnEveryKindOfArm) {
    const auto arms = every_kind_of_arm();
    for (std::size_t i = 0; i < property_cases(arms.size()) && !HasFailure(); ++i) {
        const auto& arm = arms[i % arms.size()];
        SCOPED_TRACE(::testing::Message() << "walk " << i << " of " << arm.name);
        SetUpWalk walk(9100 + i, arm);
        walk.mode(OperatingMode::setup);
        walk.walk(8);
        EXPECT_GT(walk.fastest(), 0.97 * reduced_speed) << "a limit that is never met shows nothing";
        EXPECT_GT(walk.told(), 20);
    }
}

// The same hands without set-up mode: they would have been faster, so it is the mode that holds them.
TEST(GroupSetupVelocityProperty, InAnotherModeTheSameMovesAreFaster) {
    const auto arms = every_kind_of_arm();
    for (std::size_t i = 0; i < arms.size() && !HasFailure(); i += 3) {
        SetUpWalk walk(9100 + i, arms[i]);
        walk.walk(8);
        EXPECT_GT(walk.fastest(), 1.2 * reduced_speed) << arms[i].name;
        EXPECT_EQ(walk.told(), 0);
    }
}

TEST(GroupSetupVelocityProperty, ALowerVelocityHolds) {
    const auto arms = every_kind_of_arm();
    SetUpWalk walk(9200, arms[3], 40);
    walk.mode(OperatingMode::setup);
    walk.walk(5);
    EXPECT_GT(walk.fastest(), 0.97 * 40);
}

}  // namespace
}  // namespace taktwerk::axes::test
