// A careless hand at a belt: it changes its speed, stops and turns round at any moment, while commands on and off it come, are halted, interrupted, slowed
// down and stopped. The rig's oracle holds in each cycle: position, velocity and acceleration of each member continuous and inside its limits, jerk to a
// thousandth, told = shown. Here: on the object nothing slips.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/axes/group/track_rig.hpp"
#include "tests/property_cases.hpp"

namespace taktwerk::axes::test {
namespace {

struct Walk {
    Walk(TrackRig& its_rig, std::uint32_t seed, double most_velocity, const Six& its_origin, double its_turn)
        : rig(its_rig), dice(seed), most(most_velocity), origin(its_origin), turn(its_turn) {}

    double draw(double low, double high) { return std::uniform_real_distribution<double>(low, high)(dice); }
    bool once_in(int n) { return std::uniform_int_distribution<int>(1, n)(dice) == 1; }

    void deed() {
        if (once_in(150) && (rough || rig.axis(rig.last).set_acceleration == 0)) {
            const double v = once_in(4) ? 0 : draw(-most, most);
            rig.step([&] {
                (void)rig.axes[rig.last].submit(
                    v == 0 ? AxisCommand{.kind = CommandKind::halt} : AxisCommand{.kind = CommandKind::move_velocity, .velocity = v},
                    Owner::program);
            });
        } else if (once_in(200)) {
            tracked = rig.track(origin, {draw(-5, 5), draw(-5, 5), 0, 0, 0, 0}).error == ErrorId::none || tracked;
        } else if (once_in(80)) {
            const bool on = tracked && !once_in(4);
            GroupCommand move =
                line({draw(-8, 8), draw(-8, 8), draw(-3, 3), 0, 0, on ? turn : 0}, draw(5, 60), once_in(2) ? mcAborting : mcBuffered);
            move.frame = on ? mcPCS : mcACS;
            if (!on) move = line(home, draw(5, 60));
            if (once_in(3)) move.transition = mcTMCornerDistance, move.transition_parameter = 2;
            (void)rig.give(move);
        } else if (once_in(200)) {
            (void)rig.set(Override{.velocity = once_in(3) ? 0 : draw(0.1, 1)});
        } else if (once_in(300)) {
            (void)rig.give(simply(GroupCommandKind::halt));
        } else if (once_in(200)) {
            (void)rig.give(simply(rig.view().interrupted ? GroupCommandKind::resume : GroupCommandKind::interrupt));
        } else if (once_in(600)) {
            const auto stop = rig.give(simply(GroupCommandKind::stop));
            rig.run(3);
            rig.groups.release_stop(GroupRig::ref, stop.id, Owner::program);
        } else if (rig.view().state == GroupState::GroupErrorStop && once_in(50)) {
            (void)rig.groups.reset(GroupRig::ref, Owner::program);
        } else {
            rig.step();
        }
        look();
    }
    /// In sync and with no motion along the path: what it stands on does not slip from one cycle to the next. A set-point is planned before that of a belt:
    /// jerk * T^3 / 6 (2500: 4.2e-7), and twice of it where the jerk changes its sign.
    void look() {
        const auto& view = rig.view();
        const bool stands = view.track.in_sync && view.path_velocity == 0 && view.active_kind == GroupCommandKind::none;
        const auto& six = rig.groups.equipment(GroupRig::ref)->frames.product[0];
        const std::array<double, 3> off{view.tool_set[0] - six[0], view.tool_set[1] - six[1], view.tool_set[2] - six[2]};
        if (stands && stood)
            for (std::size_t i = 0; i < 3; ++i) {
                EXPECT_NEAR(off[i], at[i], 1e-9) << "in cycle " << rig.path.size();
                ++compared;
            }
        at = off;
        stood = stands;
    }

    TrackRig& rig;
    std::mt19937 dice;
    double most;
    Six origin;
    double turn;
    JointVector home{};
    bool rough = false;  // a belt that is halted against its own acceleration stops with more jerk than its limit
    bool tracked = false, stood = false;
    std::array<double, 3> at{};
    std::size_t compared = 0;
};

std::size_t walks() { return property_cases(6); }

// G-083, G-086, G-088: of straight axes all of it is promised: a belt of 45 u/s and 250 u/s2 with half of their jerk while the group joins
// it is inside the frame's half of each, and there is no error.
TEST(GroupTrackingProperty, ABeltWithItsMoodsAndStraightAxes) {
    std::size_t compared = 0;
    for (std::uint32_t seed = 1; seed <= walks(); ++seed) {
        SCOPED_TRACE(seed);
        TrackRig rig(3, cartesian_arm(), belt_axis({.velocity = 100, .acceleration = 250, .deceleration = 250, .jerk = 1000}));
        Walk walk(rig, seed, 45, {20, -10, 0, 0, 0, 0.7}, -0.7);
        for (int i = 0; i < 6000; ++i) {
            walk.deed();
            ASSERT_NE(rig.view().state, GroupState::GroupErrorStop) << rig.view().error;
            if (testing::Test::HasFailure()) return;
        }
        compared += walk.compared;
    }
    EXPECT_GT(compared, 1000u);
}

// Of an arm that bends what is straight only the limits are: an error is one of the three, and ends at rest.
TEST(GroupTrackingProperty, ABeltWithItsMoodsAndAScara) {
    KinematicsDescription description{.arm = ScaraLengths{.first = 200, .second = 150, .height = 0}};
    description.joints[0].unit = description.joints[1].unit = description.joints[3].unit = std::numbers::pi / 180;
    const auto arm = arm_of(description);
    const AxisLimits turning{.velocity = 360, .acceleration = 3600, .deceleration = 3600, .jerk = 72000};
    const AxisLimits lifting{.velocity = 200, .acceleration = 2000, .deceleration = 2000, .jerk = 40000};
    std::size_t compared = 0;
    int errors = 0;
    for (std::uint32_t seed = 1; seed <= walks(); ++seed) {
        SCOPED_TRACE(seed);
        TrackRig rig({group_axis("a1", turning), group_axis("a2", turning), group_axis("z", lifting), group_axis("a4", turning)}, arm);
        const auto ready = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {-30, 80, 0, 20}});
        ASSERT_TRUE(rig.done(ready.id));
        Walk walk(rig, seed, 80, {250, 60, 0, 0, 0, std::numbers::pi / 2}, 70 * std::numbers::pi / 180 - std::numbers::pi / 2);
        walk.rough = true;
        walk.home = {-30, 80, 0, 20};
        auto last = rig.view().state;
        for (int i = 0; i < 6000; ++i) {
            walk.deed();
            const auto& view = rig.view();
            if (view.state == GroupState::GroupErrorStop && last != view.state) {
                ++errors;
                const auto why = static_cast<ErrorId>(view.error);
                EXPECT_TRUE(why == ErrorId::frame_limit || why == ErrorId::frame_too_fast || why == ErrorId::frame_lost) << view.error;
            }
            last = view.state;
            if (testing::Test::HasFailure()) return;
        }
        compared += walk.compared;
    }
    EXPECT_GT(compared, 1000u);
    EXPECT_GT(errors, 0);
}

}  // namespace
}  // namespace taktwerk::axes::test
