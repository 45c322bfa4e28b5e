// Every kind of arm under a careless hand: slots pressed and let go at random, both at once, into limits and singularities, in ACS and MCS, with shares and
// distances. The rig's oracle holds every member to its limits and to one motion; beside it: the tool stays on its straight line, nothing is faster than
// the jogging dynamics say, nothing ends in an error, and everything comes to rest.

#include <gtest/gtest.h>

#include <random>

#include "tests/axes/group/jog_arms.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

class Hand {
public:
    Hand(std::uint64_t seed, const JogArm& arm)
        : random_(seed), arm_(arm), kinematics_(arm_of(arm.description)), rig_(axes_of(arm), kinematics_, jogging_of_arms()) {}

    void walk(int presses) {
        for (auto& axis : rig_.axes) {
            ASSERT_EQ(axis.submit({.kind = CommandKind::home, .position = 0}, Owner::program).error, ErrorId::none);
        }
        rig_.run(50);
        const auto there = rig_.give({.kind = GroupCommandKind::direct_absolute, .target = arm_.start});
        ASSERT_EQ(there.error, ErrorId::none);
        ASSERT_TRUE(rig_.until([&] { return rig_.status(there.id) == CommandStatus::done; }, 5000));
        rig_.run(3);
        for (int i = 0; i < presses && !::testing::Test::HasFailure(); ++i) press();
        release();
        EXPECT_GT(moved_, presses / 4) << "a hand that moves nothing shows nothing";
    }
    [[nodiscard]] int ended_by_themselves() const { return ended_; }

private:
    double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
    int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

    JointVector direction() {
        JointVector d{};
        const int slots = rig_.frame == mcACS ? static_cast<int>(arm_.turning.size()) : 6;
        for (int n = whole(1, 3); n > 0; --n) d[static_cast<std::size_t>(whole(0, slots - 1))] = whole(-1, 1);
        if (rig_.frame == mcACS && arm_.askew) d[1] = d[0];
        return d;
    }

    void press() {
        rig_.frame = uniform(0, 1) < 0.4 ? mcACS : mcMCS;
        rig_.pins = {};
        if (uniform(0, 1) < 0.2) rig_.pins = {.linear = uniform(0.5, 30), .angular = uniform(0.01, 0.3)};
        rig_.held.velocity = uniform(0, 1) < 0.7 ? 1 : uniform(0, 1);
        rig_.held.acceleration = uniform(0, 1) < 0.9 ? 1 : uniform(0.2, 1);
        const CommandId last = rig_.answer.id;
        hold(direction(), whole(20, 1200));
        for (int changes = whole(0, 2); changes > 0; --changes) {
            if (uniform(0, 1) < 0.3) {
                EXPECT_EQ(rig_.set(Override{uniform(0, 1) < 0.2 ? 0 : uniform(0.1, 1), 1, 1}), ErrorId::none);
            }
            hold(direction(), whole(5, 600));
        }
        EXPECT_EQ(rig_.set(Override{1, 1, 1}), ErrorId::none);
        rig_.held.velocity = 1;
        if (rig_.answer.id != last && !rig_.active()) ++ended_;
        release();
    }

    void hold(const JointVector& direction, int cycles) {
        rig_.held.direction = direction;
        for (int i = 0; i < cycles && !::testing::Test::HasFailure(); ++i) {
            rig_.hold_for(1);
            look();
        }
    }
    void release() {
        rig_.held.direction = {};
        for (int i = 0; i < 8000 && rig_.view().state != GroupState::GroupStandby; ++i) {
            rig_.hold_for(1);
            look();
            if (::testing::Test::HasFailure()) return;
        }
        EXPECT_EQ(rig_.view().state, GroupState::GroupStandby);
        for (std::size_t k = 0; k < arm_.turning.size(); ++k) EXPECT_EQ(rig_.axis(k).set_velocity, 0) << k;
        rig_.hold_for(2);
        on_line_ = false;
    }

    void look() {
        const auto& view = rig_.view();
        const auto dynamics = jogging_of_arms();
        ASSERT_EQ(view.error, 0) << arm_.name;
        ErrorId error = ErrorId::none;
        if (rig_.answer.id != 0 && view.status(rig_.answer.id, &error) == CommandStatus::error) {
            ASSERT_EQ(error, ErrorId::singular_path) << arm_.name << ": pressed in a singularity, and nothing else";
        }
        bool moves = false;
        for (std::size_t k = 0; k < arm_.turning.size(); ++k) {
            const auto& axis = rig_.axis(k);
            ASSERT_LE(std::abs(axis.set_velocity), dynamics.velocity[k] * (1 + 1e-6)) << arm_.name << ' ' << k;
            ASSERT_LE(std::abs(axis.set_acceleration), std::max(dynamics.acceleration[k], dynamics.deceleration[k]) * (1 + 1e-6))
                << arm_.name << ' ' << k;
            ASSERT_LE(std::abs(axis.set_position), 150 * (1 + 1e-12)) << arm_.name << ' ' << k;
            moves = moves || axis.set_velocity != 0;
        }
        if (moves && !moving_) ++moved_;
        if (!moves) on_line_ = false;
        moving_ = moves;
        if (rig_.frame != mcMCS || !moves) return;
        const auto here = kinematics_->forward(first_of(view.set_position), {});
        ASSERT_TRUE(here.miss.ok()) << arm_.name;
        for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(view.tool_set[k], here.pose.position[k], 1e-9 * 100);
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k) square += view.tool_velocity[k] * view.tool_velocity[k];
        ASSERT_LE(std::sqrt(square), dynamics.path.velocity * (1 + 1e-6)) << arm_.name;
        // The straight line: through where it left rest, in the direction of its velocity there and from then on.
        std::array<double, 6> v{};
        double size = 0;
        for (std::size_t k = 0; k < 6; ++k) size += view.tool_velocity[k] * view.tool_velocity[k];
        size = std::sqrt(size);
        if (size < 1e-3) return;
        for (std::size_t k = 0; k < 6; ++k) v[k] = view.tool_velocity[k] / size;
        if (!on_line_) {
            on_line_ = true;
            begin_ = here.pose.position;
            way_ = v;
            return;
        }
        double along = 0, linear = 0, off = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            along += (here.pose.position[k] - begin_[k]) * way_[k];
            linear += way_[k] * way_[k];
        }
        for (std::size_t k = 0; k < 3; ++k)
            off += std::pow(here.pose.position[k] - begin_[k] - (linear > 1e-12 ? along / linear : 0) * way_[k], 2);
        ASSERT_LE(std::sqrt(off), 1e-9 * 1000) << arm_.name << ": the tool left its line";
        for (std::size_t k = 0; k < 6; ++k) ASSERT_NEAR(v[k], way_[k], 1e-6) << arm_.name << ' ' << k;
    }
    static Joints first_of(const JointVector& values) {
        Joints joints{};
        for (std::size_t i = 0; i < max_joints; ++i) joints[i] = values[i];
        return joints;
    }

    std::mt19937_64 random_;
    const JogArm& arm_;
    Arm kinematics_;
    JogRig rig_;
    bool moving_ = false, on_line_ = false;
    int moved_ = 0, ended_ = 0;
    std::array<double, 3> begin_{};
    std::array<double, 6> way_{};
};

// G-089, G-090, G-091
TEST(GroupJogProperty, ACarelessHandOnEveryKindOfArm) {
    const auto arms = every_kind_of_arm();
    int ended = 0;
    for (std::size_t i = 0; i < property_cases(arms.size()) && !HasFailure(); ++i) {
        SCOPED_TRACE(::testing::Message() << "walk " << i << " of " << arms[i % arms.size()].name);
        Hand hand(7000 + i, arms[i % arms.size()]);
        hand.walk(6);
        ended += hand.ended_by_themselves();
    }
    EXPECT_GT(ended, 4) << "limits, singularities and distances are met";
}

}  // namespace
}  // namespace taktwerk::axes::test
