#pragma once
// A group's rig with a hand on it: a direction that is renewed in each cycle, as a block does.

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {

/// 20 u/s, 200 u/s2 up and down, 2000 u/s3 for the tool's point and for each member.
inline JoggingDynamics slow_jogging() {
    JoggingDynamics slow{.path = {20, 200, 200, 2000}};
    slow.velocity.fill(20);
    slow.acceleration.fill(200);
    slow.deceleration.fill(200);
    slow.jerk.fill(2000);
    return slow;
}

/// Members 1 and 2 are X and Y.
inline Arm plane_arm() { return arm_of({.arm = CartesianAxes{.linear = {true, true, false}}}); }

struct JogRig : GroupRig {
    explicit JogRig(std::size_t count, Arm arm = {}, const JoggingDynamics& dynamics = slow_jogging()) : GroupRig(count, arm) {
        ready(dynamics);
    }
    JogRig(std::vector<AxisConfig> configs, Arm arm, const JoggingDynamics& dynamics = slow_jogging()) : GroupRig(std::move(configs), arm) {
        ready(dynamics);
    }
    JogRig(std::vector<AxisConfig> configs, Arm arm, const Rooms& rooms) : GroupRig(std::move(configs), arm, rooms) {
        ready(slow_jogging());
    }

    /// One cycle with this direction held; a jog begins where none is active.
    void press(const JointVector& direction) {
        held.direction = direction;
        hold_for(1);
    }
    void hold_for(int cycles) {
        for (int i = 0; i < cycles; ++i) step([this] { hand(); });
    }
    bool until_held(const std::function<bool()>& condition, int most) {
        for (int i = 0; i < most && !condition(); ++i) hold_for(1);
        return condition();
    }
    [[nodiscard]] bool active() const {
        const auto at = status(held.id);
        return at == CommandStatus::active || at == CommandStatus::queued;
    }

    MC_CoordSystem frame = mcACS;
    JogPins pins;
    HoldJog held;
    Submitted answer;     ///< to the last press
    JointVector spent{};  ///< the direction whose jog has ended by itself

private:
    void ready(const JoggingDynamics& dynamics) {
        enable();
        EXPECT_EQ(set(WriteJoggingDynamics{dynamics}), ErrorId::none);
    }
    void hand() {
        const bool none = held.direction == JointVector{};
        if (none) spent = {};
        if (active()) {
            EXPECT_EQ(set(held), ErrorId::none);
            spent = held.direction;
            return;
        }
        if (none || held.direction == spent) return;
        answer = submit({.kind = GroupCommandKind::jog, .frame = frame, .target = held.direction, .jog = pins});
        held.id = answer.id;
        spent = held.direction;
    }
};

}  // namespace taktwerk::axes::test
