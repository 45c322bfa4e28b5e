// What a person holds, whatever its program does meanwhile: a random walk over the commands of both on several arms. Once it rests and he was told so, no
// member moves by a program's will until he lets it go, or ends it; behind that every command comes to an end.

#include <cstdio>

#include "tests/axes/group/drawn_program.hpp"
#include "tests/axes/group/hold_walk.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

class ArmHoldWalk : public HoldWalk {
public:
    ArmHoldWalk(std::uint64_t seed, const JogArm& arm, const Arm& kinematics)
        : HoldWalk(seed, arm.turning.size(), {mcACS}),
          moves_(ProgramDraws(seed, arm, kinematics).program(8)),
          rig_(axes_of(arm), kinematics) {
        for (std::size_t i = 0; i < rig_.axes.size(); ++i)
            EXPECT_EQ(rig_.axes[i].submit({.kind = CommandKind::home, .position = arm.start[i]}, Owner::program).error, ErrorId::none);
        rig_.run(50);
        rig_.enable();
        EXPECT_EQ(rig_.set(WriteJoggingDynamics{jogging_of_arms()}), ErrorId::none);
    }
    std::size_t rests_seen = 0;

private:
    GroupRig& rig() override { return rig_; }
    GroupCommand drawn_move() override {
        auto command = moves_[static_cast<std::size_t>(whole(0, static_cast<int>(moves_.size()) - 1))].command;
        command.dynamics = {.velocity = uniform(40, 200)};
        return command;
    }
    void others_ask() override {
        const double which = uniform(0, 1);
        if (which < 0.3) {
            (void)submit({.kind = GroupCommandKind::home}, "home");
        } else if (which < 0.6) {
            (void)submit({.kind = GroupCommandKind::set_frame, .frame = mcPCS, .execution = chance(0.5) ? mcDelayed : mcQueued}, "frame");
        } else if (which < 0.7) {
            disable();
        } else if (which < 0.73) {
            member_fails();
        }
    }
    void member_fails() {
        const auto i = static_cast<std::size_t>(whole(0, static_cast<int>(rig_.axes.size()) - 1));
        if (chance(0.5)) {
            say("fault of " + std::to_string(i));
            rig_.drives[i]->fault_code = 0x3130;
            faults_ = 30;
        } else {
            say("program: power off " + std::to_string(i));
            rig_.powered[i] = false;
            (void)rig_.axes[i].power(false, false, false, Owner::program);
            faults_ = 60;
        }
    }

    [[nodiscard]] bool rests() const override { return told_; }
    void let_go_told() override { told_ = false; }
    void look_closer() override {
        const auto& now = view();
        if (now.interrupted) {
            EXPECT_TRUE(now.state == GroupState::GroupStandby || now.state == GroupState::GroupStopping ||
                        now.state == GroupState::GroupErrorStop)
                << name(now.state) << cycle_and_story();
        }
        if (!told_ && now.held && now.interrupted && now.powered) {
            told_ = true;
            ++rests_seen;
            for (std::size_t i = 0; i < rig_.axes.size(); ++i) rest_[i] = rig_.axis(i).set_position;
        }
        if (!told_) return;
        for (std::size_t i = 0; i < rig_.axes.size(); ++i) {
            if (!rig_.axis(i).powered) continue;
            EXPECT_NEAR(rig_.axis(i).set_position, rest_[i], 1e-3) << "axis " << i << " " << cycle_and_story();
        }
    }

    std::vector<DrawnMove> moves_;
    GroupRig rig_;
    JointVector rest_{};
    bool told_ = false;
};

TEST(GroupHold, NothingOfAProgramMovesWhatAPersonHolds) {
    const auto arms = arms_of_programs();
    std::vector<Arm> kinematics;
    for (const auto& arm : arms) kinematics.push_back(arm_of(arm.description));
    std::size_t rests = 0, tried = 0, waited = 0;
    const std::uint64_t first = first_program();
    for (std::uint64_t seed = first; seed < first + property_cases(8) && !HasFailure(); ++seed) {
        SCOPED_TRACE(::testing::Message() << "seed " << seed << " on " << arms[seed % arms.size()].name);
        ArmHoldWalk walk(seed, arms[seed % arms.size()], kinematics[seed % arms.size()]);
        walk.walk(6000);
        walk.end();
        rests += walk.rests_seen;
        tried += walk.tried;
        waited += walk.waited;
    }
    EXPECT_GT(rests, 15u);
    EXPECT_GT(waited, 30u);
    std::printf("held %zu times at rest; of %zu commands meanwhile %zu motions waited\n", rests, tried, waited);
}

}  // namespace
}  // namespace taktwerk::axes::test
