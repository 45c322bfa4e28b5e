// Members of a group: who may be one, who moves it, and what happens when one is lost.

#include <gtest/gtest.h>

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

using enum GroupState;

std::vector<AxisGroupConfig> two_empty_groups() { return {{.name = "g"}, {.name = "h"}}; }

// G-003, G-004, G-005, G-006
TEST(GroupMembers, AreChangedInGroupDisabledOnly) {
    GroupRig rig(GroupRig::named(3), two_empty_groups());
    EXPECT_EQ(rig.set(EnableGroup{}), ErrorId::no_members);
    EXPECT_EQ(rig.set(AddMember{{0}, 0}), ErrorId::invalid_member);
    EXPECT_EQ(rig.set(AddMember{{0}, 17}), ErrorId::invalid_member);
    EXPECT_EQ(rig.set(AddMember{{3}, 1}), ErrorId::invalid_axis);
    EXPECT_EQ(rig.set(AddMember{{0}, 2}), ErrorId::none);
    EXPECT_EQ(rig.set(AddMember{{0}, 3}), ErrorId::invalid_member) << "the same axis twice";
    EXPECT_EQ(rig.set(AddMember{{1}, 2}), ErrorId::invalid_member) << "an identifier twice";
    EXPECT_EQ(rig.groups.set({1}, AddMember{{0}, 1}, Owner::program), ErrorId::invalid_member) << "an axis of another group";
    EXPECT_EQ(rig.set(AddMember{{2}, 16}), ErrorId::none);
    EXPECT_EQ(rig.view().member_count, 2);
    EXPECT_EQ(rig.groups.group_of({2}), GroupRef{0});
    EXPECT_FALSE(rig.groups.group_of({1}).valid());

    EXPECT_EQ(rig.set(RemoveMember{3}), ErrorId::invalid_member);
    rig.enable();
    EXPECT_EQ(rig.set(AddMember{{1}, 1}), ErrorId::state_forbids);
    EXPECT_EQ(rig.set(RemoveMember{2}), ErrorId::state_forbids);
    EXPECT_EQ(rig.view().member_count, 2);
    EXPECT_EQ(rig.set(RemoveAllMembers{}), ErrorId::none);
    EXPECT_EQ(rig.view().state, GroupDisabled);
    EXPECT_EQ(rig.view().member_count, 0);
    EXPECT_EQ(rig.groups.set({1}, AddMember{{0}, 1}, Owner::program), ErrorId::none);
}

TEST(GroupMembers, AModuloAxisAndAnEncoderAreNone) {
    auto turning = group_axis("c");
    turning.modulo = 10;
    GroupRig rig({group_axis("x"), turning}, two_empty_groups());
    EXPECT_EQ(rig.set(AddMember{{1}, 1}), ErrorId::not_supported);
    EXPECT_EQ(rig.set(AddMember{{0}, 1}), ErrorId::none);
}

// G-013, G-022: atomic. One that is not ready refuses the group's motion, and no other has been touched.
TEST(GroupMembers, AMotionTakesAllOrNone) {
    GroupRig rig(3);
    rig.enable();
    ASSERT_EQ(rig.axes[2].submit({.kind = CommandKind::move_absolute, .position = 5, .velocity = 20}, Owner::program).error, ErrorId::none);
    rig.step();
    EXPECT_EQ(rig.submit(line({1, 1, 1}, 10)).error, ErrorId::member_moves);
    EXPECT_EQ(rig.view().state, GroupStandby);
    rig.step();
    EXPECT_EQ(rig.axis(0).state, AxisState::Standstill);
    EXPECT_EQ(rig.axis(2).state, AxisState::DiscreteMotion) << "its own move goes on";
    ASSERT_TRUE(rig.until([&] { return rig.axis(2).state == AxisState::Standstill; }, 1000));
    rig.powered[1] = false;
    rig.step([&] { (void)rig.axes[1].power(false, false, false, Owner::program); });
    rig.run(20);
    EXPECT_EQ(rig.submit(line({1, 1, 1}, 10)).error, ErrorId::not_powered);
    EXPECT_EQ(rig.axis(0).state, AxisState::Standstill);
    rig.axes[0].take_control(Owner::commissioning);
    EXPECT_EQ(rig.submit(line({1, 1, 1}, 10)).error, ErrorId::owned_by_other);
}

// G-022, G-023: while the group moves them members refuse everybody else, and the group does not notice.
TEST(GroupMembers, OthersAreRefusedWhileTheGroupMovesThem) {
    GroupRig rig(2);
    rig.enable();
    const auto move = rig.give(line({60, 80}, 100));
    rig.run(300);
    auto& x = rig.axes[0];
    EXPECT_EQ(x.submit({.kind = CommandKind::move_absolute, .position = 1, .velocity = 1}, Owner::program).error, ErrorId::axis_grouped);
    EXPECT_EQ(x.submit({.kind = CommandKind::halt}, Owner::program).error, ErrorId::axis_grouped);
    EXPECT_EQ(x.submit({.kind = CommandKind::stop}, Owner::program).error, ErrorId::axis_grouped);
    EXPECT_EQ(x.submit({.kind = CommandKind::home}, Owner::program).error, ErrorId::axis_grouped);
    EXPECT_EQ(x.submit({.kind = CommandKind::move_superimposed, .position = 1, .velocity = 1}, Owner::program).error,
              ErrorId::axis_grouped);
    EXPECT_EQ(x.submit({.kind = CommandKind::external}, Owner::program).error, ErrorId::axis_grouped);
    EXPECT_EQ(x.submit({.kind = CommandKind::group_motion}, Owner::program).error, ErrorId::axis_grouped);
    EXPECT_EQ(x.set(SetPosition{.position = 0}, Owner::program), ErrorId::axis_grouped);
    EXPECT_EQ(x.set(SetpointFeed{}, Owner::program), ErrorId::state_forbids);
    EXPECT_EQ(x.submit({.kind = CommandKind::halt}, Owner::operator_panel).error, ErrorId::owned_by_other);
    // What moves nothing stays usable.
    EXPECT_EQ(x.set(Override{0.5, 1, 1}, Owner::program), ErrorId::none);
    rig.step();
    EXPECT_GE(rig.view().path_velocity, 99) << "an axis' override does not act on the path";
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 3000));
    EXPECT_EQ(rig.point()[0], 60);
    rig.run(2);
    EXPECT_EQ(x.submit({.kind = CommandKind::group_motion}, Owner::program).error, ErrorId::not_supported) << "only through a group";
    EXPECT_EQ(x.submit({.kind = CommandKind::move_absolute, .position = 1, .velocity = 1}, Owner::program).error, ErrorId::none);
}

// G-014, G-015, G-016, G-017: a member's fault.
TEST(GroupMembers, AFaultOfOneEndsInGroupErrorStopAndTheOthersStayOnTheWay) {
    GroupRig rig(3);
    rig.enable();
    const auto from = rig.path.size();
    const auto move = rig.give(line({60, 80, 20}, 90));
    const auto waits = rig.give(line({0, 0, 0}, 90, mcBuffered));
    rig.run(400);
    rig.drives[2]->fault_code = 0x2310;
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupErrorStop; }, 20));
    EXPECT_EQ(rig.axis(2).state, AxisState::ErrorStop);
    EXPECT_EQ(rig.view().error, rig.axis(2).error);
    EXPECT_EQ(rig.view().error_place, 2) << "the third member's";
    EXPECT_EQ(rig.status(move.id), CommandStatus::error);
    EXPECT_EQ(rig.error_of(move.id), static_cast<ErrorId>(rig.axis(2).error));
    EXPECT_EQ(rig.error_of(waits.id), ErrorId::aborted_by_axis_error);
    EXPECT_EQ(rig.view().queued_count, 0);
    EXPECT_EQ(rig.submit(line({0, 0, 0}, 10)).error, ErrorId::in_error_stop);
    EXPECT_EQ(rig.set(EnableGroup{}), ErrorId::in_error_stop);
    ASSERT_TRUE(rig.until([&] { return rig.axis(0).state == AxisState::Standstill; }, 500));
    EXPECT_EQ(rig.axis(1).state, AxisState::Standstill);
    EXPECT_GT(rig.point()[0], 1);
    // x and y kept their ratio of 3 : 4 all the way to rest.
    for (std::size_t n = from; n < rig.path.size(); ++n) ASSERT_NEAR(rig.path[n][1] * 3, rig.path[n][0] * 4, 1e-9) << n;

    // While the drive keeps its fault the reset fails, and nothing changes.
    rig.drives[2]->resettable = false;
    EXPECT_EQ(rig.groups.reset(GroupRig::ref, Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return !rig.view().resetting; }, 5000));
    EXPECT_EQ(rig.view().reset_error, ErrorId::reset_failed);
    EXPECT_EQ(rig.view().state, GroupErrorStop);
    EXPECT_NE(rig.view().error, 0);
    // Disabling clears nothing: enabling leads back (G-007).
    ASSERT_EQ(rig.give(simply(GroupCommandKind::disable)).error, ErrorId::none);
    EXPECT_EQ(rig.view().state, GroupDisabled);
    EXPECT_EQ(rig.set(EnableGroup{}), ErrorId::in_error_stop);
    EXPECT_EQ(rig.view().state, GroupErrorStop);

    rig.drives[2]->resettable = true;
    rig.drives[2]->fault_code = 0;
    EXPECT_EQ(rig.groups.reset(GroupRig::ref, Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupStandby; }, 5000));
    EXPECT_EQ(rig.view().error, 0);
    EXPECT_EQ(rig.view().error_place, most_members);
}

// G-014: also without motion.
TEST(GroupMembers, AFaultInStandbyIsAnErrorOfTheGroup) {
    GroupRig rig(2);
    rig.drives[0]->fault_code = 0x2310;
    rig.run(20);
    EXPECT_EQ(rig.view().state, GroupDisabled) << "a disabled group has no errors";
    rig.drives[0]->fault_code = 0;
    ASSERT_EQ(rig.axes[0].reset(Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis(0).state == AxisState::Standstill; }, 5000));
    rig.enable();
    rig.step();
    rig.drives[0]->fault_code = 0x2310;
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupErrorStop; }, 20));
}

// G-008, and a party that takes an axis: it has left the group, whoever asked.
TEST(GroupMembers, OneThatIsTakenAwayHasLeft) {
    for (const int way : {0, 1, 2}) {
        GroupRig rig(2);
        rig.enable();
        const auto move = rig.give(line({60, 80}, 100));
        rig.run(300);
        if (way == 0) {
            rig.powered[0] = false;
            rig.step([&] { (void)rig.axes[0].power(false, false, false, Owner::program); });
        } else if (way == 1) {
            rig.axes[0].take_control(Owner::commissioning);
        } else {
            rig.axes[0].shut_down();
            rig.powered[0] = false;
        }
        rig.run(2);
        EXPECT_EQ(rig.view().state, GroupErrorStop) << way;
        EXPECT_EQ(rig.view().error, static_cast<std::uint16_t>(ErrorId::member_left)) << way;
        EXPECT_EQ(rig.error_of(move.id), ErrorId::member_left) << way;
        ASSERT_TRUE(rig.until([&] { return rig.axis(1).state == AxisState::Standstill; }, 500)) << way;
    }
}

// An emergency stop asks no group.
TEST(GroupMembers, AnEmergencyStopStopsEachByItself) {
    GroupRig rig(2);
    rig.enable();
    ASSERT_EQ(rig.give(line({60, 80}, 100)).error, ErrorId::none);
    rig.run(300);
    for (auto& axis : rig.axes) axis.demand_emergency_stop(EmergencyStop::stop);
    rig.step();
    EXPECT_EQ(rig.axis(0).state, AxisState::ErrorStop);
    EXPECT_EQ(rig.view().state, GroupErrorStop);
    rig.run(300);
    EXPECT_EQ(rig.axis(0).set_velocity, 0);
    for (auto& axis : rig.axes) axis.demand_emergency_stop(EmergencyStop::none);
    EXPECT_EQ(rig.groups.reset(GroupRig::ref, Owner::program), ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupStandby; }, 5000));
    const auto again = rig.give(line({0, 0}, 100));
    ASSERT_TRUE(rig.until([&] { return rig.status(again.id) == CommandStatus::done; }, 3000));
    EXPECT_EQ(rig.point()[0], 0);
}

// G-007
TEST(GroupMembers, DisablingInMotionStopsOnTheWayFirst) {
    GroupRig rig(2);
    rig.enable();
    const auto from = rig.path.size();
    const auto move = rig.give(line({60, 80}, 100));
    rig.run(300);
    const auto off = rig.give(simply(GroupCommandKind::disable));
    EXPECT_EQ(rig.status(move.id), CommandStatus::aborted);
    EXPECT_EQ(rig.view().state, GroupMoving);
    EXPECT_EQ(rig.submit(line({0, 0}, 1)).error, ErrorId::state_forbids);
    ASSERT_TRUE(rig.until([&] { return rig.status(off.id) == CommandStatus::done; }, 500));
    EXPECT_EQ(rig.view().state, GroupDisabled);
    EXPECT_EQ(rig.view().path_velocity, 0);
    EXPECT_LE(rig.deviation({0, 0}, {60, 80}, from), 1e-9 * 100);
    EXPECT_EQ(rig.submit(line({0, 0}, 1)).error, ErrorId::group_disabled);
    EXPECT_EQ(rig.submit(simply(GroupCommandKind::disable)).error, ErrorId::none);
}

// The machine's hand: on the way, then without power.
TEST(GroupMembers, ShuttingDownStopsOnTheWay) {
    GroupRig rig(2);
    rig.enable();
    const auto from = rig.path.size();
    ASSERT_EQ(rig.give(line({60, 80}, 100)).error, ErrorId::none);
    rig.run(300);
    rig.powered = {false, false};
    rig.groups[0].shut_down({0});
    rig.groups[0].shut_down({1});
    ASSERT_TRUE(rig.until([&] { return rig.axis(0).state == AxisState::Disabled && rig.axis(1).state == AxisState::Disabled; }, 500));
    EXPECT_LE(rig.deviation({0, 0}, {60, 80}, from), 1e-9 * 100);
    EXPECT_EQ(rig.view().state, GroupStandby);
}

// What stops several at once is none of theirs: nobody is accused.
TEST(GroupMembers, AnErrorOfSeveralNamesNone) {
    GroupRig rig(3);
    rig.enable();
    (void)rig.give(line({60, 80, 20}, 90));
    rig.run(400);
    for (const std::size_t i : {0u, 2u}) rig.drives[i]->fault_code = 0x2310;
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupErrorStop; }, 20));
    EXPECT_NE(rig.view().error, 0);
    EXPECT_EQ(rig.view().error_place, most_members);
}

// What a configuration may say, each with its code.
TEST(GroupConfig, SaysEveryProblem) {
    const std::vector<std::string> axes{"x", "y", "z", "u"};
    const auto codes = [&](const std::vector<AxisGroupConfig>& groups) {
        std::string all;
        for (const auto& error : check(groups, axes)) all += error.code + " ";
        return all;
    };
    EXPECT_EQ(codes({{.name = "g", .members = {"x", "y"}}, {.name = "h", .members = {"z"}}}), "");
    EXPECT_EQ(codes({{.name = "", .members = {"x"}}}), "group.no_name ");
    EXPECT_EQ(codes({{.name = "g"}, {.name = "g"}}), "group.name_twice ");
    EXPECT_EQ(codes({{.name = "z", .members = {"x"}}}), "group.name_twice ")
        << "an axis is called so, and people command both by their names";
    EXPECT_EQ(codes({{.name = "g", .members = {"w"}}}), "group.unknown_axis ");
    EXPECT_EQ(codes({{.name = "g", .members = {"x"}}, {.name = "h", .members = {"x"}}}), "group.axis_twice ");
    EXPECT_EQ(codes({{.name = "g", .members = axes, .kinematics = cartesian_arm()}}), "group.kinematics ");
    EXPECT_EQ(codes({{.name = "g", .members = {}, .kinematics = {}, .default_dynamics = {.velocity = -1}}}), "group.dynamics ");
}

}  // namespace
}  // namespace taktwerk::axes::test
