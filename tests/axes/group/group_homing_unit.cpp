// MC_GroupHome of a group: one member after the other; what ends it.

#include <gtest/gtest.h>

#include <limits>

#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

using enum GroupState;

struct HomingRig : GroupRig {
    explicit HomingRig(std::size_t count) : GroupRig(drives_home(count)) {
        for (auto& drive : drives) drive->homing_speed = 20;
        enable();
    }
    static std::vector<AxisConfig> drives_home(std::size_t count) {
        auto axes = GroupRig::named(count);
        for (auto& axis : axes) axis.homing.kind = HomingKind::drive;
        return axes;
    }
    static GroupCommand home() { return {.kind = GroupCommandKind::home, .target = {10, 20, 30}}; }
};

// G-011: Standby-(GroupHome)->Homing-(done)->Standby; in the order of the identifiers, each alone; the coordinates are those that were given.
TEST(GroupHoming, OneAfterTheOtherInTheirOrder) {
    HomingRig rig(3);
    const auto home = rig.give(HomingRig::home());
    ASSERT_EQ(home.error, ErrorId::none);
    EXPECT_EQ(rig.view().state, GroupHoming);
    EXPECT_EQ(rig.status(home.id), CommandStatus::active);
    std::vector<std::size_t> order;
    ASSERT_TRUE(rig.until(
        [&] {
            std::size_t homing = 0;
            for (std::size_t i = 0; i < 3; ++i)
                if (rig.axis(i).state == AxisState::Homing) {
                    ++homing;
                    if (order.empty() || order.back() != i) order.push_back(i);
                }
            EXPECT_LE(homing, 1u);
            EXPECT_EQ(rig.view().state, rig.status(home.id) == CommandStatus::done ? GroupStandby : GroupHoming);
            return rig.status(home.id) == CommandStatus::done;
        },
        5000));
    EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_EQ(rig.view().state, GroupStandby);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_TRUE(rig.axis(i).homed) << i;
        EXPECT_NEAR(rig.axis(i).set_position, 10 * (static_cast<double>(i) + 1), 1e-9) << i;
    }
    const auto move = rig.give(line({12, 20, 30}, 50));
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 1000)) << "it moves from there";
}

// G-011: from GroupStandby only; nothing else is taken meanwhile but a stop, which waits until the member stands.
TEST(GroupHoming, NothingElseMeanwhileButAStop) {
    HomingRig rig(2);
    auto in_machine = HomingRig::home();
    in_machine.frame = mcMCS;
    EXPECT_EQ(rig.submit(in_machine).error, ErrorId::not_supported);
    auto blended = HomingRig::home();
    blended.buffer_mode = mcBlendingLow;
    EXPECT_EQ(rig.submit(blended).error, ErrorId::buffer_mode_not_supported);
    const auto move = rig.give(line({30, 0}, 50));
    rig.run(50);
    EXPECT_EQ(rig.submit(HomingRig::home()).error, ErrorId::state_forbids) << "in motion";
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 3000));
    rig.run(3);
    const auto home = rig.give(HomingRig::home());
    ASSERT_EQ(home.error, ErrorId::none);
    rig.run(30);
    for (const auto kind : {GroupCommandKind::linear_absolute, GroupCommandKind::wait, GroupCommandKind::halt, GroupCommandKind::interrupt,
                            GroupCommandKind::resume, GroupCommandKind::home})
        EXPECT_EQ(rig.submit(simply(kind)).error, ErrorId::state_forbids) << static_cast<int>(kind);
    EXPECT_EQ(rig.set(WriteSoftwareLimits{}), ErrorId::state_forbids);
    EXPECT_EQ(rig.set(RemoveAllMembers{}), ErrorId::state_forbids);
    const auto stop = rig.submit(simply(GroupCommandKind::stop));
    ASSERT_EQ(stop.error, ErrorId::none);
    EXPECT_EQ(rig.status(home.id), CommandStatus::aborted);
    EXPECT_EQ(rig.view().state, GroupStopping);
    ASSERT_TRUE(rig.until([&] { return rig.status(stop.id) == CommandStatus::done; }, 500));
    EXPECT_EQ(rig.axis(0).state, AxisState::Standstill);
    EXPECT_EQ(rig.view().state, GroupStopping) << "held";
    rig.groups.release_stop(GroupRig::ref, stop.id, Owner::program);
    rig.run(3);
    EXPECT_EQ(rig.view().state, GroupStandby);
    EXPECT_FALSE(rig.axis(0).homed);
    EXPECT_FALSE(rig.axis(1).homed);
}

// G-028: a search has no motion behind which a setting could have its turn. One that waited would never be done, and everything behind it neither.
TEST(GroupHoming, ASettingDoesNotWaitForItsEnd) {
    HomingRig rig(2);
    const auto home = rig.give(HomingRig::home());
    ASSERT_EQ(home.error, ErrorId::none);
    GroupCommand setting{.kind = GroupCommandKind::set_frame, .frame = mcPCS, .target = {1, 2, 3}, .execution = mcQueued};
    EXPECT_EQ(rig.submit(setting).error, ErrorId::state_forbids);
    setting.execution = mcDelayed;
    EXPECT_EQ(rig.submit(setting).error, ErrorId::state_forbids);
    setting.execution = mcImmediately;
    EXPECT_EQ(rig.submit(setting).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.status(home.id) == CommandStatus::done; }, 5000));
    rig.run(3);
    EXPECT_EQ(rig.view().queued_count, 0);
    const auto move = rig.give(line({12, 20}, 50, mcBuffered));
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 1000)) << "nothing is in front of it";
}

// G-007: Done of MC_GroupDisable comes at rest, also where a search is under way.
TEST(GroupHoming, DisabledOnlyWhenTheMemberStands) {
    HomingRig rig(2);
    const auto home = rig.give(HomingRig::home());
    rig.run(30);
    ASSERT_EQ(rig.axis(0).state, AxisState::Homing);
    const auto disable = rig.submit(simply(GroupCommandKind::disable));
    ASSERT_EQ(disable.error, ErrorId::none);
    EXPECT_EQ(rig.status(home.id), CommandStatus::aborted);
    EXPECT_EQ(rig.submit(simply(GroupCommandKind::disable)).error, ErrorId::state_forbids);
    ASSERT_TRUE(rig.until(
        [&] {
            const bool over = rig.status(disable.id) == CommandStatus::done;
            EXPECT_EQ(rig.view().state == GroupDisabled, over);
            if (over) {
                EXPECT_EQ(rig.axis(0).state, AxisState::Standstill);
            }
            return over;
        },
        500));
    EXPECT_FALSE(rig.axis(0).homed);
    rig.enable();
    rig.run(3);
    EXPECT_EQ(rig.view().state, GroupStandby);
}

// A member that finds no reference, or refuses: the command ends with its reason; those behind it have not moved.
TEST(GroupHoming, AMemberThatFailsEndsIt) {
    HomingRig rig(3);
    rig.drives[1]->homing_fails = true;
    const auto home = rig.give(HomingRig::home());
    ASSERT_TRUE(rig.until([&] { return rig.status(home.id) == CommandStatus::error; }, 5000));
    EXPECT_TRUE(rig.axis(0).homed);
    EXPECT_FALSE(rig.axis(1).homed);
    EXPECT_FALSE(rig.axis(2).homed);
    EXPECT_NE(rig.error_of(home.id), ErrorId::none);
    rig.run(5);
    EXPECT_EQ(rig.view().state, rig.axis(1).state == AxisState::ErrorStop ? GroupErrorStop : GroupStandby);

    GroupRig plain(2);  // members without a homing
    plain.enable();
    const auto refused = plain.give(HomingRig::home());
    ASSERT_TRUE(plain.until([&] { return plain.status(refused.id) == CommandStatus::error; }, 10));
    EXPECT_EQ(plain.error_of(refused.id), ErrorId::not_supported);
    EXPECT_EQ(plain.view().state, GroupStandby);
}

// G-014: another member's fault meanwhile stops the one that is homed.
TEST(GroupHoming, AFaultElsewhereStopsIt) {
    HomingRig rig(2);
    const auto home = rig.give(HomingRig::home());
    rig.run(30);
    ASSERT_EQ(rig.axis(0).state, AxisState::Homing);
    rig.drives[1]->fault_code = 0x2310;
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupErrorStop; }, 20));
    EXPECT_EQ(rig.status(home.id), CommandStatus::error);
    ASSERT_TRUE(rig.until([&] { return rig.axis(0).state == AxisState::Standstill; }, 500));
    EXPECT_FALSE(rig.axis(0).homed);
}

// G-024: limits of all members or of none; the next path is looked at with them.
TEST(GroupHoming, SoftwareLimitsAreWrittenTogether) {
    HomingRig rig(2);
    const auto home = rig.give({.kind = GroupCommandKind::home, .target = {0, 0}});
    ASSERT_TRUE(rig.until([&] { return rig.status(home.id) == CommandStatus::done; }, 5000));
    rig.run(3);
    constexpr double as_it_is = std::numeric_limits<double>::infinity();
    const auto limits_of = [&](std::size_t i) {
        return std::pair{rig.axes[i].config().limits.position_min, rig.axes[i].config().limits.position_max};
    };
    WriteSoftwareLimits limits{{10, 20}, {-10, -20}};
    ASSERT_EQ(rig.set(limits), ErrorId::none);
    EXPECT_EQ(limits_of(0), (std::pair<double, double>{-10, 10}));
    EXPECT_EQ(limits_of(1), (std::pair<double, double>{-20, 20}));
    EXPECT_EQ(rig.submit(line({11, 0}, 10)).error, ErrorId::beyond_software_limit);
    for (const WriteSoftwareLimits& bad : {WriteSoftwareLimits{{30, 5}, {-30, 5}}, WriteSoftwareLimits{{30, 5}, {-30, 6}},
                                           WriteSoftwareLimits{{30, std::nan("")}, {-30, -1}}}) {
        EXPECT_EQ(rig.set(bad), ErrorId::invalid_parameter);
        EXPECT_EQ(limits_of(0), (std::pair<double, double>{-10, 10})) << "none of them";
    }
    EXPECT_EQ(rig.set(WriteSoftwareLimits{{30, 30}, {-30, 5}}), ErrorId::beyond_software_limit) << "the second one stands at 0";
    EXPECT_EQ(limits_of(0), (std::pair<double, double>{-10, 10}));
    EXPECT_EQ(rig.set(WriteSoftwareLimits{{as_it_is, 25}, {-5, -as_it_is}}), ErrorId::none);
    EXPECT_EQ(limits_of(0), (std::pair<double, double>{-5, 10}));
    EXPECT_EQ(limits_of(1), (std::pair<double, double>{-20, 25}));
    const auto move = rig.give(line({9, 9}, 50));
    rig.run(100);
    EXPECT_EQ(rig.set(limits), ErrorId::state_forbids) << "its way was looked at with those before";
    ASSERT_TRUE(rig.until([&] { return rig.status(move.id) == CommandStatus::done; }, 3000));
    rig.run(3);
    // Both limits beyond the others: at no time is the lower one above the upper one.
    ASSERT_EQ(rig.set(WriteSoftwareLimits{{100, 100}, {8, 8}}), ErrorId::none);
    EXPECT_EQ(limits_of(0), (std::pair<double, double>{8, 100}));
}

// G-030: mcPercentage. 50 % of 40 u/s is 20 u/s; above 100, and without a reference, it is refused.
TEST(GroupHoming, PercentsAreOfTheReferenceDynamics) {
    GroupRig rig(1);
    rig.enable();
    ASSERT_EQ(rig.set(SetDynamicsMode{true}), ErrorId::none);
    EXPECT_EQ(rig.submit(line({50}, 50)).error, ErrorId::invalid_velocity) << "of what";
    ASSERT_EQ(rig.set(WriteDynamics{WriteDynamics::Which::reference_dynamics, {40, 0, 0, 0}}), ErrorId::none);
    EXPECT_EQ(rig.submit(line({50}, 101)).error, ErrorId::invalid_velocity);
    auto with_jerk = line({50}, 50);
    with_jerk.dynamics.jerk = 10;
    EXPECT_EQ(rig.submit(with_jerk).error, ErrorId::invalid_dynamics);
    const auto move = rig.give(line({50}, 50));
    double fastest = 0;
    ASSERT_TRUE(rig.until(
        [&] {
            fastest = std::max(fastest, rig.axis(0).set_velocity);
            return rig.status(move.id) == CommandStatus::done;
        },
        5000));
    EXPECT_NEAR(fastest, 20, 0.02);
}

}  // namespace
}  // namespace taktwerk::axes::test
