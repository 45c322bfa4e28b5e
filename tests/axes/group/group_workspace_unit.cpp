// Where the tool's point of a group may be, and how far from its set-point. The rig asserts limits and continuity of every member in every cycle.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "axes/group/room_check.hpp"
#include "axes/group/workspace.hpp"
#include "tests/axes/group/jog_rig.hpp"
#include "tests/axes/group/track_rig.hpp"

namespace taktwerk::axes::test {
namespace {

using enum GroupState;
using Shape = WorkspaceRoom::Shape;

WorkspaceRoom box(const std::array<double, 3>& middle, const std::array<double, 3>& half, bool kept_free) {
    WorkspaceRoom room{.name = "box", .shape = Shape::box, .kept_free = kept_free, .half = half};
    room.middle.position = middle;
    return room;
}
WorkspaceRoom post(const std::array<double, 3>& middle, double radius, double half_height) {
    WorkspaceRoom room{.name = "post", .shape = Shape::cylinder, .kept_free = true, .half = {radius, radius, half_height}};
    room.middle.position = middle;
    return room;
}

// --- distances, by hand --------------------------------------------------------------------------------------------------------------

TEST(Workspace, ItsClearanceIsTheWayToTheNearestForbiddenPlace) {
    const Workspace cell{{box({0, 0, 0}, {10, 20, 30}, false)}};
    EXPECT_DOUBLE_EQ(cell.clearance({0, 0, 0}), 10);
    EXPECT_DOUBLE_EQ(cell.clearance({7, 0, 0}), 3);
    EXPECT_DOUBLE_EQ(cell.clearance({13, 24, 0}), -5) << "from the edge: 3, 4";
    const Workspace stone{{box({0, 0, 0}, {10, 20, 30}, true)}};
    EXPECT_DOUBLE_EQ(stone.clearance({13, 24, 0}), 5);
    EXPECT_DOUBLE_EQ(stone.clearance({7, 0, 0}), -3);
    const Workspace column{{post({100, 0, 0}, 5, 50)}};
    EXPECT_DOUBLE_EQ(column.clearance({100, 8, 0}), 3);
    EXPECT_DOUBLE_EQ(column.clearance({100, 8, 54}), 5) << "from its upper edge: 3, 4";
    EXPECT_DOUBLE_EQ(column.clearance({100, 0, 49}), -1);
    // Two rooms that overlap are one; what is kept free counts in both.
    const Workspace both{{box({0, 0, 0}, {10, 10, 10}, false), box({15, 0, 0}, {10, 10, 10}, false), post({20, 0, 0}, 2, 1)}};
    EXPECT_DOUBLE_EQ(both.clearance({15, 0, 0}), 3) << "the post";
    EXPECT_DOUBLE_EQ(both.clearance({-12, 0, 0}), -2);
    // A room that is turned by 45 degrees about Z: its corner lies at 10 * sqrt 2 along x.
    auto turned = box({0, 0, 0}, {10, 10, 10}, true);
    turned.middle.orientation = {std::cos(std::numbers::pi / 8), 0, 0, std::sin(std::numbers::pi / 8)};
    EXPECT_NEAR(Workspace{{turned}}.clearance({20, 0, 0}), 20 - 10 * std::numbers::sqrt2, 1e-12);
    EXPECT_TRUE(std::isinf(Workspace{}.clearance({1, 2, 3})));
}

// What lets a path be shown by few looks. A room without an end on some sides is one, too.
TEST(Workspace, ItsClearanceNeverChangesByMoreThanThePointMoves) {
    constexpr double endless = std::numeric_limits<double>::infinity();
    std::mt19937 draw(7);
    std::uniform_real_distribution<double> at(-50, 50), by(-3, 3), size(0.1, 30);
    for (int space_number = 0; space_number < 40; ++space_number) {
        Workspace space;
        for (int i = 0; i < 4; ++i) {
            auto room = i % 2 == 0 ? box({at(draw), at(draw), at(draw)}, {size(draw), size(draw), i == 0 ? endless : size(draw)}, i > 1)
                                   : post({at(draw), at(draw), at(draw)}, size(draw), size(draw));
            const double turn = at(draw);
            room.middle.orientation = {std::cos(turn), std::sin(turn) * 0.6, 0, std::sin(turn) * 0.8};
            space.rooms.push_back(room);
        }
        for (int i = 0; i < 500; ++i) {
            const std::array<double, 3> a{at(draw), at(draw), at(draw)}, d{by(draw), by(draw), by(draw)};
            const double way = std::hypot(d[0], d[1], d[2]);
            const double change = space.clearance({a[0] + d[0], a[1] + d[1], a[2] + d[2]}) - space.clearance(a);
            ASSERT_LE(std::abs(change), way * (1 + 1e-12) + 1e-12) << space_number << " " << i;
        }
    }
}

// A post of 0.2 u on a way of 1000 u: 32 looks would not see it, the clearance does.
TEST(Workspace, AThinPostOnALongWayIsSeen) {
    const Workspace space{{post({431.7, 0, 0}, 0.1, 5)}};
    const auto along = [](double y) { return [y](double s) { return std::array<double, 3>{s, y, 0}; }; };
    const auto at_one = [](double) { return 1.0; };
    EXPECT_NEAR(inside_until(space, 1000, along(0), at_one), 431.6, 1e-6);
    EXPECT_EQ(inside_until(space, 1000, along(0.11), at_one), 1000) << "beside it";
}

// --- paths ---------------------------------------------------------------------------------------------------------------------------

struct PortalRig : GroupRig {
    explicit PortalRig(Workspace its_space) : GroupRig(named(3), cartesian_arm(), its_space.rooms), space(std::move(its_space)) {
        enable();
    }
    /// The lowest clearance of all set-points since `from`.
    [[nodiscard]] double nearest(std::size_t from = 0) const {
        double least = 1e9;
        for (std::size_t n = from; n < path.size(); ++n) least = std::min(least, space.clearance({path[n][0], path[n][1], path[n][2]}));
        return least;
    }
    bool done(CommandId id) {
        return until([&] { return status(id) != CommandStatus::active && status(id) != CommandStatus::queued; }, 20000) &&
               status(id) == CommandStatus::done;
    }
    Workspace space;
};

TEST(GroupWorkspace, APathThroughAForbiddenRoomIsRefusedBeforeAnythingMoves) {
    PortalRig rig({{box({50, 0, 0}, {100, 60, 60}, false), box({50, 0, 0}, {5, 5, 60}, true)}});
    for (const auto frame : {mcACS, mcMCS}) {
        auto through = line({100, 0, 0}, 100);
        through.frame = frame;
        const auto refused = rig.give(through);
        ASSERT_TRUE(rig.until([&] { return rig.status(refused.id) == CommandStatus::error; }, 60)) << frame;
        EXPECT_EQ(rig.error_of(refused.id), ErrorId::outside_workspace);
    }
    auto arc = line({100, 0, 0}, 100);  // half a circle about the room; its lower half leads to y = -50
    arc.kind = GroupCommandKind::circular_absolute;
    arc.frame = mcMCS;
    arc.circle = {.mode = mcBORDER, .aux = {50, -50, 0}};
    auto wide = arc;
    wide.circle.aux = {50, -70, 0};  // beyond y = -60
    const auto out = rig.give(wide);
    ASSERT_TRUE(rig.until([&] { return rig.status(out.id) == CommandStatus::error; }, 60));
    EXPECT_EQ(rig.error_of(out.id), ErrorId::outside_workspace);
    EXPECT_EQ(rig.view().state, GroupStandby) << "a refused command is no error of the group";
    for (const auto& at : rig.path) ASSERT_EQ(at, rig.path.front()) << "nothing has moved";

    const auto round = rig.give(arc);
    EXPECT_TRUE(rig.done(round.id));
    EXPECT_NEAR(rig.point()[0], 100, 1e-9);
    EXPECT_GE(rig.nearest(), -1e-9);
}

// Both lines keep 1 u from the room, and the curve that joins them would cut its corner: the corner is stood at instead.
TEST(GroupWorkspace, ACurveThatWouldCutIntoARoomIsNotGone) {
    for (const bool with_room : {true, false}) {
        Workspace space{{box({0, 0, 0}, {500, 500, 500}, false)}};
        if (with_room) space.rooms.push_back(box({30, 20, 0}, {19, 19, 50}, true));  // 11 to 49, 1 to 39
        PortalRig rig(space);
        rig.run(5);
        const auto first = rig.give(line({50, 0, 0}, 50));
        auto next = line({50, 60, 0}, 50, mcBlendingHigh);
        next.transition = mcTMCornerDistance;
        next.transition_parameter = 20;
        const auto second = rig.give(next);
        ASSERT_EQ(second.error, ErrorId::none);
        double nearest_to_corner = 1e9;
        const bool over = rig.until(
            [&] {
                nearest_to_corner = std::min(nearest_to_corner, std::hypot(rig.point()[0] - 50, rig.point()[1]));
                return rig.status(second.id) == CommandStatus::done;
            },
            9000);
        ASSERT_TRUE(over);
        EXPECT_EQ(rig.status(first.id), CommandStatus::done);
        if (with_room) EXPECT_LT(nearest_to_corner, 1e-6) << "stood at";
        // 7/32 * 20 * sqrt 2 (docs/motion/path.md), and the room's corner is 1 * sqrt 2 from the lines' corner: without it the curve is there.
        else EXPECT_NEAR(nearest_to_corner, 7.0 / 32 * 20 * std::numbers::sqrt2, 0.1);
        EXPECT_GE(rig.nearest(), -1e-9);
    }
}

// The arm's links sweep its tool through a post between two places that are both free of it.
TEST(GroupWorkspace, ADirectMoveOfAnArmIsLookedAtWhereItsToolGoes) {
    constexpr double degree = std::numbers::pi / 180;
    KinematicsDescription scara{.arm = ScaraLengths{.first = 200, .second = 150}};
    for (const std::size_t i : {0u, 1u, 3u}) scara.joints[i].unit = degree;
    std::vector<AxisConfig> configs{group_axis("j1"), group_axis("j2"), group_axis("z"), group_axis("c")};
    // From joint 1 = 0 to 90 degrees with the elbow at 90: the tool, 250 from the column, passes (176.8, 176.8) turned by 36.9 degrees of the
    // elbow, at joint 1 = 45 - 36.87 = 8.13 degrees.
    const double r = std::hypot(200, 150), where = 45 * degree;
    GroupRig rig(configs, arm_of(scara), {post({r * std::cos(where), r * std::sin(where), 0}, 10, 100)});
    rig.enable();
    const auto bent = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {-60, 90, 0, 0}});
    ASSERT_TRUE(rig.until([&] { return rig.status(bent.id) == CommandStatus::done; }, 9000)) << "-60 + 36.9: away from the post";
    rig.run(3);
    const auto stood = rig.point();
    const auto swept = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {60, 90, 0, 0}});
    ASSERT_TRUE(rig.until([&] { return rig.status(swept.id) == CommandStatus::error; }, 60));
    EXPECT_EQ(rig.error_of(swept.id), ErrorId::outside_workspace);
    EXPECT_EQ(rig.point(), stood);
    const auto above = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {-60, 90, 120, 0}});
    ASSERT_TRUE(rig.until([&] { return rig.status(above.id) == CommandStatus::done; }, 9000));
    const auto over = rig.give({.kind = GroupCommandKind::direct_absolute, .target = {60, 90, 120, 0}});
    EXPECT_TRUE(rig.until([&] { return rig.status(over.id) == CommandStatus::done; }, 9000)) << "above the post, which ends at 100";
}

// Who stands where the tool may not be is led out by a path, and not further in.
TEST(GroupWorkspace, FromAForbiddenPlaceAPathLeadsOutOnly) {
    PortalRig rig({{box({0, 0, 0}, {10, 10, 10}, true)}});  // the members stand in its middle
    for (const JointVector& to : {JointVector{5, 0, 0}, JointVector{20, 0, 0}}) {
        const auto move = rig.give(line(to, 50));
        EXPECT_TRUE(rig.done(move.id)) << to[0] << ": out of the room, or nearer to its wall";
    }
    const auto back = rig.give(line({0, 0, 0}, 50));
    ASSERT_TRUE(rig.until([&] { return rig.status(back.id) == CommandStatus::error; }, 60));
    EXPECT_EQ(rig.error_of(back.id), ErrorId::outside_workspace);
}

TEST(GroupWorkspace, AJogEndsAtItsWall) {
    for (const auto frame : {mcACS, mcMCS}) {
        const auto configs = GroupRig::named(2);
        JogRig rig(configs, plane_arm(), {box({0, 0, 0}, {30, 1000, 1000}, false)});
        rig.frame = frame;
        rig.press({1, 0});
        rig.hold_for(3000);
        EXPECT_NEAR(rig.point()[0], 30, 1e-6) << frame;
        EXPECT_EQ(rig.view().state, GroupStandby) << "it stops, it does not fail (G-091)";
        rig.press({});
        rig.press({0, 1});  // along the wall
        rig.hold_for(500);
        EXPECT_GT(rig.point()[1], 5);
        rig.press({});
        rig.hold_for(300);
        rig.press({-1, 0});
        rig.hold_for(500);
        EXPECT_LT(rig.point()[0], 25) << "away from it";
        for (const auto& at : rig.path) ASSERT_LE(at[0], 30 + 1e-6);
    }
}

// A belt carries the tool towards the end of the workspace: it stops in front of it, off the path, as at a software limit.
TEST(GroupWorkspace, ABeltDoesNotCarryTheToolOut) {
    TrackRig rig(GroupRig::named(3), cartesian_arm(), belt_axis(), {box({0, 0, 0}, {100, 100, 100}, false)});
    ASSERT_EQ(rig.track({}, {}).error, ErrorId::none);
    const auto on = rig.give(on_product(line({10, 5, 0}, 40)));
    ASSERT_TRUE(rig.done(on.id));
    rig.drive_belt(40);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupErrorStop; }, 6000));
    EXPECT_EQ(rig.view().error, static_cast<std::uint16_t>(ErrorId::frame_limit));
    rig.run(500);
    EXPECT_EQ(rig.axis(0).set_velocity, 0);
    EXPECT_GT(rig.point()[0], 90) << "not long before it either";
    for (const auto& at : rig.path) ASSERT_LE(at[0], 100 + 1e-6);
}

// What stops off the path is looked at all the way. The belt goes along the diagonal of X and Y, 28.3 u/s each; X stops within 1.505 u in 0.106 s, Y, whose
// jerk is less, within 2.38 u in 0.168 s: v sqrt(v / j), 2 sqrt(v / j). So the tool leaves the diagonal when it brakes in front of a wall; some 2.3 u along and
// 0.25 u beside it, between where it begins and the diagonal on which it would rest, stands a post of 0.2 u.
TEST(GroupWorkspace, ABeltsToolDoesNotBrakeThroughWhatStandsBesideItsWay) {
    const std::array<double, 4> eighth{std::cos(std::numbers::pi / 8), 0, 0, std::sin(std::numbers::pi / 8)};
    const auto along = [](double s, double n) {
        return std::array<double, 3>{(s - n) / std::numbers::sqrt2, (s + n) / std::numbers::sqrt2, 0};
    };
    auto wall = box(along(70.71, 0), {0.5, 500, 500}, true), post = box(along(69.76, 0.25), {0.1, 0.1, 500}, true);
    wall.middle.orientation = post.middle.orientation = eighth;
    auto members = GroupRig::named(3);
    members[1].limits.jerk = 4000;
    TrackRig rig(members, cartesian_arm(), belt_axis({.velocity = 100, .acceleration = 100, .deceleration = 100, .jerk = 1000}),
                 {wall, post});
    ASSERT_EQ(rig.track({0, 0, 0, 0, 0, std::numbers::pi / 4}, {}).error, ErrorId::none);
    const auto on = rig.give(on_product(line({0, 0, 1}, 40)));
    ASSERT_TRUE(rig.done(on.id));
    rig.drive_belt(40);
    ASSERT_TRUE(rig.until([&] { return rig.view().state == GroupErrorStop; }, 6000)) << rig.point()[0];
    EXPECT_EQ(rig.view().error, static_cast<std::uint16_t>(ErrorId::frame_limit));
    rig.run(500);
    const Workspace space{{wall, post}};
    for (const auto& at : rig.path) ASSERT_GE(space.clearance({at[0], at[1], at[2]}), -1e-6) << at[0] << ' ' << at[1];
    EXPECT_GT(std::hypot(rig.point()[0], rig.point()[1]), 66) << "not long before it either";
}

// X is held for an hour, if nobody lets go: it has no limit. 20 u beside the way a wall goes along, and somewhere a peg stands out of it, across the way.
TEST(GroupWorkspace, AJogBesideAWallSeesAPegHoweverFarItIs) {
    const auto arm = plane_arm();
    for (const double peg : {30.0, 777.0, 5000.0, 12345.0}) {
        const Workspace space{{box({0, 120, 0}, {1e6, 100, 100}, true), box({peg, 0, 0}, {1, 20, 100}, true)}};
        MoveSpace around;
        around.arm = arm.get();
        around.members = 2;
        around.workspace = &space;
        const double seconds = inside_until(3600, {}, {20, 0}, {}, around);
        EXPECT_NEAR(20 * seconds, peg - 1, 2e-9 * peg);
    }
}

// --- how far from the path -----------------------------------------------------------------------------------------------------------

// One member stays 1.5 u behind, another 2.0: together the tool is 2.5 from where it should be. Each alone is inside its own window.
TEST(GroupFollowing, TheToolTooFarFromItsPathIsAnErrorOfTheGroup) {
    for (const double window : {2.4, 2.6, 0.0}) {
        auto configs = GroupRig::named(3);
        for (auto& config : configs) config.following.window = 100;
        auto groups = GroupRig::all_of(configs, cartesian_arm());
        groups[0].following = {window, 20ms};
        GroupRig rig(configs, groups);
        rig.enable();
        const auto move = rig.give(line({100, 30, 0}, 50));
        rig.run(300);
        ASSERT_EQ(rig.status(move.id), CommandStatus::active);
        EXPECT_LT(rig.view().path_deviation, 1e-3);
        rig.drives[0]->lag = 1500;
        rig.drives[1]->lag = 2000;
        rig.run(10);
        EXPECT_NEAR(rig.view().path_deviation, 2.5, 2e-3) << "counts of 0.001";
        EXPECT_EQ(rig.view().state, GroupMoving) << "not for less than its time";
        rig.run(20);
        if (window != 2.4) {
            EXPECT_EQ(rig.view().state, GroupMoving) << window;
            continue;
        }
        EXPECT_EQ(rig.view().state, GroupErrorStop);
        EXPECT_EQ(rig.view().error, static_cast<std::uint16_t>(ErrorId::path_following_error));
        EXPECT_EQ(rig.status(move.id), CommandStatus::error);
        EXPECT_EQ(rig.error_of(move.id), ErrorId::path_following_error);
        EXPECT_GT(std::abs(rig.axis(0).set_velocity), 1) << "it brakes, it does not stop dead";
        ASSERT_TRUE(rig.until([&] { return rig.axis(0).set_velocity == 0; }, 1000));
        EXPECT_LT(rig.deviation({0, 0, 0}, {100, 30, 0}), 1e-9) << "on its path";
        rig.drives[0]->lag = rig.drives[1]->lag = 0;
        rig.run(20);
        EXPECT_EQ(rig.view().path_deviation, 0) << "nobody moves it";
    }
}

// Of a SCARA whose last joint's screw lifts its shaft, the tool 40 mm beside the flange: motors that stay behind by degrees, and what that is at the tool by hand.
// Beyond the window for longer than its time it is an error, and else it is none, however often it is beyond for less.
TEST(GroupFollowing, OfAnArmItIsTheToolsWay) {
    constexpr double degree = std::numbers::pi / 180, screw = -20.0 / 360;  // mm a degree
    KinematicsDescription scara{.arm = ScaraLengths{.first = 200, .second = 150}};
    for (const std::size_t i : {0u, 1u, 3u}) scara.joints[i].unit = degree;
    scara.coupling[2][3] = screw / degree;
    const auto place = [&](const std::array<double, 4>& motor) {
        const double a = motor[0] * degree, b = a + motor[1] * degree, c = b + motor[3] * degree;
        return std::array<double, 3>{200 * std::cos(a) + 150 * std::cos(b) + 40 * std::cos(c),
                                     200 * std::sin(a) + 150 * std::sin(b) + 40 * std::sin(c), motor[2] - screw * motor[3]};
    };
    std::mt19937 draw(11);
    std::uniform_real_distribution<double> by(-1.2, 1.2);
    int tripped = 0, stayed = 0;
    for (int run = 0; run < 24; ++run) {
        auto configs = GroupRig::named(4);
        for (auto& config : configs) config.following.window = 100;
        auto groups = GroupRig::all_of(configs, arm_of(scara));
        groups[0].following = {3, 20ms};
        GroupRig rig(configs, groups);
        rig.enable();
        GroupCommand write{.kind = GroupCommandKind::write_tool, .execution = mcImmediately, .number = 1};
        write.tool.frame = {40, 0, 0, 0, 0, 0};
        ASSERT_EQ(rig.give(write).error, ErrorId::none);
        ASSERT_EQ(rig.set(SelectTool{1}), ErrorId::none);
        (void)rig.give({.kind = GroupCommandKind::direct_absolute, .target = {60, 80, 20, 50}, .dynamics = {.velocity = 20}});
        rig.run(200);
        for (int piece = 0; piece < 8 && rig.view().state == GroupMoving; ++piece) {
            std::array<double, 4> lag{};
            for (std::size_t i = 0; i < 4; ++i) {
                lag[i] = by(draw);
                rig.drives[i]->lag = std::llround(1000 * lag[i]);
            }
            rig.run(3);  // until it is seen
            const int length = draw() % 2 == 0 ? 12 : 40;
            double least = 1e9, most = 0;
            for (int i = 0; i < length && rig.view().state == GroupMoving; ++i) {
                rig.step();
                std::array<double, 4> is{}, told{};
                for (std::size_t k = 0; k < 4; ++k) {
                    is[k] = rig.view().actual_position[k];
                    told[k] = is[k] + lag[k];
                }
                const auto a = place(is), b = place(told);
                const double off = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
                ASSERT_NEAR(rig.view().path_deviation, off, 0.02) << "counts of 0.001 degrees, 390 mm away";
                least = std::min(least, off);
                most = std::max(most, off);
            }
            const bool error = rig.view().state == GroupErrorStop;
            if (length == 40 && least > 3.05) {
                EXPECT_TRUE(error) << run << " " << piece << " " << least;
                ++tripped;
            }
            if (length == 12 || most < 2.95) {
                EXPECT_FALSE(error) << run << " " << piece << " " << most;
                ++stayed;
            }
            for (auto& drive : rig.drives) drive->lag = 0;
            if (rig.view().state == GroupMoving) rig.run(6);
        }
        for (auto& drive : rig.drives) drive->lag = 0;
        rig.run(400);
    }
    EXPECT_GT(tripped, 5);
    EXPECT_GT(stayed, 20);
}

}  // namespace
}  // namespace taktwerk::axes::test
