// What a group says of a command that it refuses: which room or whose limit, and where on the path and in the machine. Distances by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "axes/group/workspace.hpp"
#include "tests/axes/group/group_rig.hpp"

namespace taktwerk::axes::test {
namespace {

WorkspaceRoom box(const char* name, const std::array<double, 3>& middle, const std::array<double, 3>& half, bool kept_free) {
    WorkspaceRoom room{.name = name, .shape = WorkspaceRoom::Shape::box, .kept_free = kept_free, .half = half};
    room.middle.position = middle;
    return room;
}

constexpr std::uint8_t cell = 0, post = 2;
const Rooms rooms{box("cell", {50, 0, 0}, {100, 60, 60}, false), box("shelf", {300, 0, 0}, {5, 5, 5}, true),
                  box("post", {50, 0, 0}, {5, 5, 60}, true)};

struct RefusalRig : GroupRig {
    explicit RefusalRig(std::vector<AxisConfig> configs, const Rooms& its_rooms = {})
        : GroupRig(std::move(configs), cartesian_arm(), its_rooms) {
        enable();
    }
    /// What the view says once the command is over.
    PathPlace refused(const GroupCommand& command) {
        const auto given = give(command);
        EXPECT_TRUE(given.error != ErrorId::none || until([&] { return status(given.id) == CommandStatus::error; }, 100)) << "not refused";
        const auto& refusal = view().refusal;
        EXPECT_EQ(refusal.id, given.id);
        EXPECT_EQ(refusal.kind, command.kind);
        EXPECT_EQ(refusal.why.error, given.error == ErrorId::none ? error_of(given.id) : given.error);
        return refusal.why;
    }
};

GroupCommand to(const JointVector& target, MC_CoordSystem frame) {
    auto command = line(target, 100);
    command.frame = frame;
    return command;
}
/// Half a circle from the origin to (100, 0) by (50, `by`).
GroupCommand half_circle(double by) {
    auto arc = to({100, 0, 0}, mcMCS);
    arc.kind = GroupCommandKind::circular_absolute;
    arc.circle = {.mode = mcBORDER, .aux = {50, by, 0}};
    return arc;
}

void expect_point(const PathHindrance& at, const std::array<double, 3>& point, double digits = 1e-6) {
    ASSERT_TRUE(at.in_space);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(at.point[i], point[i], digits) << "XYZ"[i];
}

TEST(GroupRefusal, ARoomIsNamedThatIsEnteredOrLeftAndWhere) {
    RefusalRig rig(RefusalRig::named(3), rooms);
    for (const auto frame : {mcMCS, mcACS}) {
        const auto entered = rig.refused(to({100, 0, 0}, frame));
        EXPECT_EQ(entered.error, ErrorId::outside_workspace);
        EXPECT_EQ(entered.at.room, post) << frame;
        EXPECT_TRUE(entered.at.on_path);
        EXPECT_NEAR(entered.at.part, 0.45, 1e-6) << "at x = 45";
        EXPECT_NEAR(entered.at.length, frame == mcMCS ? 100 : 0, 1e-9) << "a way of axes has no length of the tool's";
        expect_point(entered.at, {45, 0, 0});
    }
    const auto left = rig.refused(to({0, 80, 0}, mcMCS));
    EXPECT_EQ(left.at.room, cell);
    EXPECT_NEAR(left.at.part, 0.75, 1e-6) << "at y = 60";
    expect_point(left.at, {0, 60, 0});
}

// The target is inside, and the arc beside it is not: y = -40 where its angle's sine is 0.8.
TEST(GroupRefusal, AnAxisIsNamedWhoseLimitThePathPasses) {
    auto configs = RefusalRig::named(3);
    configs[1].limits.position_min = -40;
    configs[1].limits.position_max = 200;
    configs[1].homing.kind = HomingKind::set_here;
    RefusalRig rig(configs);
    ASSERT_EQ(rig.axes[1].submit({.kind = CommandKind::home, .position = 0}, Owner::program).error, ErrorId::none);
    ASSERT_TRUE(rig.until([&] { return rig.axis(1).homed && rig.axis(1).state == AxisState::Standstill; }, 200));
    rig.run(5);
    const auto along = rig.refused(half_circle(-50));
    EXPECT_EQ(along.error, ErrorId::beyond_software_limit);
    EXPECT_EQ(along.at.place, 1);
    EXPECT_TRUE(along.at.limit_known);
    EXPECT_EQ(along.at.limit, -40);
    EXPECT_EQ(along.at.position, -40) << "there";
    EXPECT_NEAR(along.at.part, std::asin(0.8) / std::numbers::pi, 1e-6);
    EXPECT_NEAR(along.at.length, 50 * std::numbers::pi, 1e-6);
    expect_point(along.at, {50 - 30, -40, 0}, 1e-5);

    const auto target = rig.refused(to({0, -55, 0}, mcACS));  // known at once
    EXPECT_EQ(target.error, ErrorId::beyond_software_limit);
    EXPECT_EQ(target.at.place, 1);
    EXPECT_EQ(target.at.position, -55);
    EXPECT_EQ(target.at.limit, -40);
    EXPECT_FALSE(target.at.on_path);
}

// Arms of 200 and 150: the tool comes no nearer to the foot than 50. At y = 30 that is x = 40.
TEST(GroupRefusal, WhereAnArmCannotGoIsSaid) {
    KinematicsDescription description{.arm = ScaraLengths{.first = 200, .second = 150, .height = 0}};
    for (const int joint : {0, 1, 3}) description.joints[static_cast<std::size_t>(joint)].unit = std::numbers::pi / 180;
    auto configs = GroupRig::named(4);
    GroupRig rig(configs, arm_of(description));
    rig.enable();
    const auto bent = rig.give(line({0, 90, 0, 0}, 100));
    ASSERT_TRUE(rig.until([&] { return rig.status(bent.id) == CommandStatus::done; }, 5000));
    auto first = to({250, 30, 0}, mcMCS);
    first.kind = GroupCommandKind::direct_absolute;
    const auto there = rig.give(first);
    ASSERT_TRUE(rig.until([&] { return rig.status(there.id) == CommandStatus::done; }, 5000));
    const auto through = rig.give(to({-250, 30, 0}, mcMCS));
    ASSERT_TRUE(rig.until([&] { return rig.status(through.id) == CommandStatus::error; }, 100));
    const auto& why = rig.view().refusal.why;
    EXPECT_EQ(why.error, ErrorId::out_of_reach);
    ASSERT_TRUE(why.at.on_path);
    expect_point(why.at, {40, 30, 0}, 1e-5);
    EXPECT_NEAR(why.at.part, (250.0 - 40) / 500, 1e-7);
    EXPECT_NEAR(why.at.length, 500, 1e-6);

    const auto far = rig.give(to({400, 30, 0}, mcMCS));  // known at once: its target
    EXPECT_EQ(far.error, ErrorId::out_of_reach);
    const auto& target = rig.view().refusal.why.at;
    ASSERT_TRUE(target.in_space);
    EXPECT_EQ(target.point[0], 400);
    EXPECT_FALSE(target.on_path);

    auto on = to({150, 0, 0}, mcMCS);  // from x = 250 at y = 30 beyond the reach of 350: only its planner knows where it begins
    on.kind = GroupCommandKind::linear_relative;
    const auto beyond = rig.give(on);
    ASSERT_TRUE(rig.until([&] { return rig.status(beyond.id) == CommandStatus::error; }, 100));
    const auto& end = rig.view().refusal.why;
    EXPECT_EQ(end.error, ErrorId::out_of_reach);
    ASSERT_TRUE(end.at.on_path);
    EXPECT_LE(end.at.part, 1);
}

TEST(GroupRefusal, ItIsCountedOnceAndForgottenWhenAnotherMotionBegins) {
    RefusalRig rig(RefusalRig::named(3), rooms);
    int block = 0;
    auto through = to({100, 0, 0}, mcMCS);
    through.instance = &block;
    (void)rig.refused(through);
    const auto first = rig.view().refusal.number;
    EXPECT_EQ(rig.view().refusal.block, &block);
    rig.run(50);
    EXPECT_EQ(rig.view().refusal.number, first) << "once per refusal, not per cycle";
    (void)rig.refused(through);
    EXPECT_EQ(rig.view().refusal.number, first + 1);
    (void)rig.give(to({10, 0, 0}, mcMCS));
    EXPECT_EQ(rig.view().refusal.why.error, ErrorId::none);
    EXPECT_EQ(rig.view().refusal.number, first + 1) << "the next one has another number";
}

// Its turn comes while the one before it is gone; what waits behind it goes on from where that one ends.
TEST(GroupRefusal, OneThatWaitedIsRefusedInItsTurn) {
    RefusalRig rig(RefusalRig::named(3), rooms);
    (void)rig.give(to({10, 0, 0}, mcMCS));
    auto through = to({100, 0, 0}, mcMCS), aside = to({10, 20, 0}, mcMCS);
    through.buffer_mode = aside.buffer_mode = mcBuffered;
    const auto second = rig.give(through), third = rig.give(aside);
    ASSERT_TRUE(rig.until([&] { return rig.status(third.id) == CommandStatus::done; }, 5000));
    EXPECT_EQ(rig.view().refusal.id, second.id);
    EXPECT_EQ(rig.view().refusal.why.at.room, post);
    EXPECT_NEAR(rig.view().refusal.why.at.part, 35.0 / 90, 1e-6) << "from x = 10";
}

// Given in one scan, they fall in one cycle: the first one is the cause.
TEST(GroupRefusal, OfThoseThatFallTogetherTheFirstIsTold) {
    RefusalRig rig(RefusalRig::named(3), rooms);
    auto through = to({100, 0, 0}, mcMCS), arc = half_circle(0);
    arc.buffer_mode = mcBuffered;  // from where the first one would have ended: no arc
    Submitted first, second;
    rig.step([&] {
        first = rig.submit(through);
        second = rig.submit(arc);
    });
    ASSERT_TRUE(rig.until([&] { return rig.status(second.id) == CommandStatus::error; }, 100));
    EXPECT_EQ(rig.error_of(second.id), ErrorId::invalid_arc);
    EXPECT_EQ(rig.view().refusal.id, first.id);
    EXPECT_EQ(rig.view().refusal.why.at.room, post);
    EXPECT_EQ(rig.view().refusal.number, 2u);
    rig.run(20);
    (void)rig.refused(to({0, 80, 0}, mcMCS));
    EXPECT_EQ(rig.view().refusal.number, 3u) << "a later one is told by itself";
}

// A person has his answer, and a page that shows programs' refusals has nothing to say.
TEST(GroupRefusal, APersonsCommandIsNone) {
    RefusalRig rig(RefusalRig::named(3), rooms);
    GroupCommand nothing;
    EXPECT_NE(rig.groups.submit(GroupRig::ref, nothing, Owner::operator_panel).error, ErrorId::none);
    EXPECT_EQ(rig.view().refusal.number, 0u);
}

}  // namespace
}  // namespace taktwerk::axes::test
