// MC_SyncGroupToAxis: an axis drives the length of a stored path. A portal, and a fourth axis beside it; places, ways and times by hand. The rig asserts the limits and the
// continuity of every member in every cycle.

#include <numbers>

#include "core/guard/allocation_guard.hpp"
#include "tests/fb_library/gcode_path/driven_rig.hpp"

namespace taktwerk::fb {
namespace {

using axes::CommandStatus;
using axes::GroupState;
using gcode::Point;
using std::numbers::pi;

/// Set-points of a master whose acceleration changes are foreseen a cycle ahead: off by jerk T^3 / 6 = 4.2e-7 of it.
constexpr double foreseen = 5e-7;

// G-093: 2 u of the master for 1 u of path. At a standing master the group is in sync at once, where the path begins. 40 u on is 20 u of path, 30 u back 15 less; with the
// master it stops, and reverses.
TEST(DrivenPath, GoesStopsAndReversesWithItsMaster) {
    DrivenRig rig(straight);
    rig.sync.TuCNumerator = 2;
    rig.begin();
    EXPECT_TRUE(rig.sync.InSync);
    EXPECT_EQ(rig.state(), GroupState::GroupMoving);
    const double from = rig.at_master();
    for (const double to : {40.0, 10.0, 25.0}) {
        rig.master_to(from + to, 30);
        ASSERT_TRUE(rig.plc.until(
            [&] {
                EXPECT_NEAR(rig.tool()[0], (rig.at_master() - from) / 2, foreseen);
                EXPECT_NEAR(rig.plc.rig.view().path_velocity, rig.plc.rig.axis(3).set_velocity / 2, 2e-3);
                EXPECT_TRUE(rig.sync.InSync);
                return rig.master_stands();
            },
            5000));
        rig.plc.run(2);
        EXPECT_NEAR(rig.tool()[0], to / 2, 1e-9);
        EXPECT_EQ(rig.speed(), 0);
    }
    EXPECT_EQ(rig.tool()[1], 0);
    EXPECT_EQ(rig.state(), GroupState::GroupMoving) << "it ends when another command comes";
    EXPECT_TRUE(rig.sync.Active);
}

// G-093: joined at 20 u/s it comes up to that inside half of what X can do, 500 u/s2 and 5000 u/s3: 500 is not reached, so it takes 2 sqrt(20/5000) = 0.1265 s, in which the
// master goes 2.530 u and the tool half of that. The 1.265 u that are lost stay lost; from then on it is locked by place.
TEST(DrivenPath, ComesUpToAMasterThatMovesAndIsLockedFromThenOn) {
    DrivenRig rig(straight);
    rig.master_at(20);
    rig.plc.run(500);
    rig.sync.Execute = true;
    ASSERT_TRUE(rig.plc.until([&] { return rig.plc.rig.view().path_velocity > 0; }, 50));
    const double from = rig.at_master() - 0.02;  // a cycle ago it stood
    EXPECT_FALSE(rig.sync.InSync);
    int cycles = 0;
    ASSERT_TRUE(rig.plc.until([&] { return ++cycles > 0 && rig.sync.InSync; }, 400));
    EXPECT_NEAR(cycles, 127, 4);
    const double lost = rig.at_master() - from - rig.tool()[0];
    EXPECT_NEAR(lost, 1.265, 0.03);
    for (int i = 0; i < 300; ++i) {
        rig.plc.scan();
        ASSERT_NEAR(rig.at_master() - from - rig.tool()[0], lost, 1e-9);
        ASSERT_NEAR(rig.speed(), 20, 1e-9);
    }
}

// G-093, not periodic: at the path's end it stands, exactly, while the master goes on; when that comes back it takes the tool along again, to the places where it was
// before. In front of the path's beginning likewise.
TEST(DrivenPath, StandsAtItsEndsAndComesBackToTheSamePlaces) {
    DrivenRig rig(straight);
    rig.begin();
    const double from = rig.at_master();
    rig.master_to(from + 90, 40);
    bool stood = false;
    ASSERT_TRUE(rig.plc.until(
        [&] {
            EXPECT_LE(rig.tool()[0], 60);
            if (rig.sync.InSync && !stood) {
                EXPECT_NEAR(rig.tool()[0], rig.at_master() - from, foreseen);
            }
            stood = stood || rig.tool()[0] == 60;
            return rig.master_stands() && stood;
        },
        6000));
    EXPECT_EQ(rig.tool()[0], 60);
    EXPECT_EQ(rig.speed(), 0);
    EXPECT_FALSE(rig.sync.InSync);
    EXPECT_TRUE(rig.sync.Active);
    EXPECT_EQ(rig.state(), GroupState::GroupMoving);
    rig.master_to(from + 30, 40);
    ASSERT_TRUE(rig.plc.until([&] { return rig.sync.InSync; }, 6000));
    ASSERT_TRUE(rig.plc.until([&] { return rig.master_stands(); }, 6000));
    rig.plc.run(2);
    EXPECT_NEAR(rig.tool()[0], 30, 1e-9);
    rig.master_to(from - 20, 40);
    ASSERT_TRUE(rig.plc.until(
        [&] {
            EXPECT_GE(rig.tool()[0], 0);
            return rig.master_stands();
        },
        6000));
    ASSERT_TRUE(rig.comes_to_rest());
    EXPECT_EQ(rig.tool()[0], 0);
    rig.master_to(from + 5, 40);
    ASSERT_TRUE(rig.plc.until([&] { return rig.master_stands() && rig.sync.InSync; }, 6000));
    rig.plc.run(2);
    EXPECT_NEAR(rig.tool()[0], 5, 1e-9);
}

// G-093, periodic: after 2 pi 20 u it is where it began, and goes on. Clockwise about (20, 0) from the leftmost point: the place is at pi - s/20.
TEST(DrivenPath, GoesRoundAsOftenAsItsMaster) {
    DrivenRig rig(circle);
    rig.sync.Mode = mcPeriodic;
    rig.begin();
    EXPECT_TRUE(rig.sync.InSync);
    const double from = rig.at_master();
    const auto on_circle = [&] {
        const double s = rig.at_master() - from;
        EXPECT_NEAR(rig.tool()[0], 20 + 20 * std::cos(pi - s / 20), 1e-6) << s;
        EXPECT_NEAR(rig.tool()[1], 20 * std::sin(pi - s / 20), 1e-6) << s;
        EXPECT_NEAR(std::hypot(rig.tool()[0] - 20, rig.tool()[1]), 20, 1e-9) << "on the circle at every set-point";
        EXPECT_TRUE(rig.sync.InSync);
        return rig.master_stands();
    };
    rig.master_to(from + 2.5 * 2 * pi * 20, 40);  // 314 u
    ASSERT_TRUE(rig.plc.until(on_circle, 20000));
    rig.plc.run(2);
    EXPECT_NEAR(rig.tool()[0], 40, 1e-9);
    EXPECT_NEAR(rig.tool()[1], 0, 1e-9);
    rig.master_to(from - 10 * pi, 40);  // back through the seam, a quarter of a lap in front of the beginning
    ASSERT_TRUE(rig.plc.until(on_circle, 20000));
    rig.plc.run(2);
    EXPECT_NEAR(rig.tool()[0], 20, 1e-9);
    EXPECT_NEAR(rig.tool()[1], -20, 1e-9);
}

// G-093: a master at 80 u/s in front of a corner of 0.5 u, which X and Y cannot take like that: an error with a name, and the group comes to rest in front of it,
// on the path: where the curve begins at the latest, 0.25 from the corner's lines.
TEST(DrivenPath, AMasterTooFastForABendIsAnErrorAndARampOnThePath) {
    DrivenRig rig(corner);
    rig.begin();
    rig.master_at(80);
    ASSERT_TRUE(rig.plc.until([&] { return rig.state() == GroupState::GroupErrorStop; }, 3000));
    EXPECT_EQ(rig.plc.rig.view().error, static_cast<std::uint16_t>(ErrorId::path_limit));
    EXPECT_GT(rig.speed(), 40) << "it brakes, and does not jump";
    ASSERT_TRUE(rig.plc.until(
        [&] {
            EXPECT_LE(off_line(rig.tool(), {0, 0, 0}, {40, 0, 0}), 0.02);
            EXPECT_TRUE(rig.plc.rig.groups[0].leads()) << "on the path";
            return rig.speed() == 0;
        },
        2000));
    EXPECT_GT(rig.tool()[0], 20);
    EXPECT_LT(rig.tool()[0], 39.5);
    EXPECT_TRUE(rig.sync.Error);
    EXPECT_EQ(rig.sync.ErrorID, ErrorId::path_limit);
    EXPECT_FALSE(rig.sync.InSync);
}

// The same corner at 5 u/s: it is rounded as the program says, no further than 0.5 from it (half of that is for merging).
TEST(DrivenPath, ABendIsGoneWhereTheMembersCan) {
    DrivenRig rig(corner);
    rig.begin();
    const double from = rig.at_master();
    rig.master_to(from + 65, 5);
    double nearest = 1e9;
    ASSERT_TRUE(rig.plc.until(
        [&] {
            const auto p = rig.tool();
            nearest = std::min(nearest, distance(p, {40, 0, 0}));
            EXPECT_TRUE(p[1] == 0 || std::abs(p[0] - 40) < 1e-9 || distance(p, {40, 0, 0}) < 2) << p[0] << ' ' << p[1];
            return rig.master_stands();
        },
        20'000));
    EXPECT_NEAR(nearest, 0.25, 5e-3);
    EXPECT_EQ(rig.state(), GroupState::GroupMoving);
    EXPECT_TRUE(rig.sync.InSync);
}

// 1 u of the master for 2 u of path: a master at 60 u/s asks 120 of X, which has 100. It speeds up by 250 u/s2, the tool by 500; to take that away with 5000 u/s3 costs 500^2 / (2 * 5000) =
// 25 u/s more: at 75 u/s it has to end.
TEST(DrivenPath, AMemberTooSlowForTheMasterIsAnErrorAndARampOnThePath) {
    DrivenRig rig("G21 G90 G61\nG1 X300 F3000\nM2\n");
    rig.sync.TuCDenominator = 2;
    rig.begin();
    rig.master_at(60);
    ASSERT_TRUE(rig.plc.until([&] { return rig.state() == GroupState::GroupErrorStop; }, 3000));
    EXPECT_EQ(rig.plc.rig.view().error, static_cast<std::uint16_t>(ErrorId::path_limit));
    EXPECT_NEAR(rig.speed(), 75, 1.5);
    ASSERT_TRUE(rig.comes_to_rest());
    EXPECT_LT(rig.tool()[0], 300);
}

// An error of the master is one of the group, which comes to rest on the path.
TEST(DrivenPath, AMasterThatFailsIsAnErrorAndARampOnThePath) {
    DrivenRig rig(straight);
    rig.begin();
    rig.master_at(30);
    ASSERT_TRUE(rig.plc.until([&] { return rig.tool()[0] > 20; }, 3000));
    rig.plc.rig.drives[3]->fault_code = 0x5441;
    ASSERT_TRUE(rig.plc.until([&] { return rig.state() == GroupState::GroupErrorStop; }, 50));
    EXPECT_EQ(rig.plc.rig.view().error, static_cast<std::uint16_t>(ErrorId::master_lost));
    EXPECT_NEAR(rig.speed(), 30, 2);
    ASSERT_TRUE(rig.comes_to_rest());
    // From 30 u/s with 500 u/s2 and 5000 u/s3: 30 sqrt(30/5000) = 2.3 u.
    EXPECT_LT(rig.tool()[0], 26);
}

// MC_GroupHalt, another motion, MC_GroupStop, MC_GroupDisable, the end of the program: on the path, and the block was aborted.
TEST(DrivenPath, WhateverEndsItComesToRestOnThePath) {
    enum class End { halt, move, stop, disable, program };
    for (const auto end : {End::halt, End::move, End::stop, End::disable, End::program}) {
        DrivenRig rig(straight);
        rig.begin();
        rig.master_at(30);
        ASSERT_TRUE(rig.plc.until([&] { return rig.tool()[0] > 20; }, 3000));
        axes::CommandId id = 0;
        rig.plc.rig.step([&] {
            using axes::GroupCommandKind;
            if (end == End::halt) id = rig.plc.rig.submit({.kind = GroupCommandKind::halt}).id;
            if (end == End::move) id = rig.plc.rig.submit(axes::test::line({10, 10, 0}, 50)).id;
            if (end == End::stop) id = rig.plc.rig.submit({.kind = GroupCommandKind::stop}).id;
            if (end == End::disable) id = rig.plc.rig.submit({.kind = GroupCommandKind::disable}).id;
            if (end == End::program) rig.plc.rig.groups[0].let_go();
        });
        rig.plc.run(2);
        EXPECT_TRUE(rig.sync.CommandAborted) << static_cast<int>(end);
        EXPECT_FALSE(rig.sync.InSync);
        const double begins = rig.tool()[0];
        ASSERT_TRUE(rig.plc.until(
            [&] {
                EXPECT_EQ(rig.tool()[1], 0);
                return rig.speed() == 0;
            },
            2000))
            << static_cast<int>(end);
        EXPECT_LT(rig.tool()[0] - begins, 2.4) << "30 sqrt(30/5000)";
        rig.plc.run(5);
        if (end == End::halt || end == End::program) {
            EXPECT_EQ(rig.state(), GroupState::GroupStandby) << static_cast<int>(end);
        }
        if (end == End::stop) {
            EXPECT_EQ(rig.state(), GroupState::GroupStopping);
        }
        if (end == End::disable) {
            EXPECT_EQ(rig.state(), GroupState::GroupDisabled);
        }
        if (end == End::move) {
            ASSERT_TRUE(rig.plc.until([&] { return rig.plc.rig.status(id) == CommandStatus::done; }, 5000));
            EXPECT_EQ(rig.tool()[0], 10);
        }
    }
}

// An interruption stops it on the path while the master goes on; MC_GroupContinue brings it up to the master again, and what was lost stays lost.
TEST(DrivenPath, AnInterruptionIsGoneOnWith) {
    DrivenRig rig(straight);
    rig.begin();
    rig.master_at(10);
    ASSERT_TRUE(rig.plc.until([&] { return rig.tool()[0] > 10; }, 3000));
    rig.plc.rig.step([&] { EXPECT_NE(rig.plc.rig.submit({.kind = axes::GroupCommandKind::interrupt}).id, 0u); });
    ASSERT_TRUE(rig.plc.until([&] { return rig.state() == GroupState::GroupStandby; }, 1000));
    rig.plc.run(2);
    EXPECT_TRUE(rig.sync.Busy);
    EXPECT_FALSE(rig.sync.Active);
    EXPECT_FALSE(rig.sync.CommandAborted);
    const double stood = rig.tool()[0];
    rig.plc.run(300);
    EXPECT_EQ(rig.tool()[0], stood);
    rig.plc.rig.step([&] { EXPECT_EQ(rig.plc.rig.submit({.kind = axes::GroupCommandKind::resume}).error, ErrorId::none); });
    ASSERT_TRUE(rig.plc.until([&] { return rig.sync.InSync; }, 1000));
    EXPECT_GT(rig.tool()[0], stood);
    EXPECT_LT(rig.tool()[0], stood + 1) << "10 u/s in 0.09 s: half of 0.9 u";
    const double apart = rig.at_master() - rig.tool()[0];
    rig.plc.run(200);
    EXPECT_NEAR(rig.at_master() - rig.tool()[0], apart, 1e-9);
}

// G-072: the override is none of it.
TEST(DrivenPath, OverrideIsNoneOfIt) {
    DrivenRig rig(straight);
    rig.begin();
    ASSERT_EQ(rig.plc.rig.set(axes::Override{.velocity = 0.1}), ErrorId::none);
    const double from = rig.at_master();
    rig.master_to(from + 20, 30);
    ASSERT_TRUE(rig.plc.until(
        [&] {
            EXPECT_TRUE(rig.sync.InSync);
            return rig.master_stands();
        },
        3000));
    rig.plc.run(2);
    EXPECT_NEAR(rig.tool()[0], 20, 1e-9);
}

// What stands somewhere is no path to be driven; the line is named, nothing moves, and the group is as it was.
TEST(DrivenPath, WhatCannotBeDrivenIsRefusedBeforeItMoves) {
    struct Bad {
        const char* text;
        ErrorId error;
        std::uint32_t line;
        MC_PATH_SYNC_MODE mode = mcNonPeriodic;
    };
    for (const Bad& bad : {Bad{"G21 G90 G61\nG1 X10 F3000\nG1 Y10\nM2\n", ErrorId::path_stands, 3},
                           Bad{"G21 G90\nG1 X10 F3000\nG4 P1\nG1 X20\nM2\n", ErrorId::path_stands, 3},
                           Bad{"G21 G90\nG1 X10 F3000\nM8\nG1 X20\nM2\n", ErrorId::path_stands, 3},
                           Bad{"G21 G90 G17 G61\nG1 X10 F3000\nG3 X20 Y10 J10\nM2\n", ErrorId::path_stands, 3},  // its curvature jumps
                           Bad{straight, ErrorId::path_not_closed, 3, mcPeriodic},
                           Bad{"G21 G90 G64 P1\nG1 X40 F3000\nG1 Y40\nG1 X0\nG1 Y0\nM2\n", ErrorId::path_not_closed, 6, mcPeriodic}}) {
        DrivenRig rig(bad.text);
        rig.sync.Mode = bad.mode;
        EXPECT_EQ(rig.refused(), bad.error) << bad.text;
        EXPECT_EQ(rig.plc.rig.view().path.place.line, bad.line) << bad.text;
        rig.plc.run(5);
        EXPECT_EQ(rig.state(), GroupState::GroupStandby);
        EXPECT_EQ(rig.tool(), (Point{0, 0, 0}));
        const auto next = rig.plc.rig.give(axes::test::line({5, 0, 0}, 50));
        EXPECT_TRUE(rig.plc.until([&] { return rig.plc.rig.status(next.id) == CommandStatus::done; }, 2000)) << "the group goes on";
    }
}

TEST(DrivenPath, PinsThatMeanNothingAreRefused) {
    DrivenRig rig(straight);
    const auto outcome = [&](auto change) {
        rig.sync.Execute = false;
        rig.plc.scan();
        const auto before = rig.sync;
        change(rig.sync);
        rig.sync.Execute = true;
        rig.plc.scan();
        const auto error = rig.sync.ErrorID;
        rig.sync = before;
        rig.plc.scan();
        return error;
    };
    EXPECT_EQ(outcome([](auto& b) { b.Master = AxisRef{1}; }), ErrorId::invalid_master) << "a member goes with the path";
    EXPECT_EQ(outcome([](auto& b) { b.Master = AxisRef{}; }), ErrorId::invalid_master);
    EXPECT_EQ(outcome([](auto& b) { b.TuCNumerator = 0; }), ErrorId::invalid_ratio);
    EXPECT_EQ(outcome([](auto& b) { b.TuCDenominator = 0; }), ErrorId::invalid_ratio);
    EXPECT_EQ(outcome([](auto& b) { b.CoordSystem = mcACS; }), ErrorId::not_supported);
    EXPECT_EQ(outcome([](auto& b) { b.BufferMode = mcBlendingLow; }), ErrorId::buffer_mode_not_supported);
    EXPECT_EQ(outcome([](auto& b) { b.Mode = static_cast<MC_PATH_SYNC_MODE>(2); }), ErrorId::invalid_parameter);
    EXPECT_EQ(outcome([](auto& b) { b.Acceleration = NAN; }), ErrorId::invalid_dynamics);
    rig.begin();
    rig.master_at(10);
    rig.plc.run(100);
    EXPECT_EQ(rig.plc.rig.give(axes::test::line({5, 0, 0}, 50, axes::mcBuffered)).error, ErrorId::state_forbids)
        << "it has no end that something could wait for";
    EXPECT_EQ(rig.plc.rig.set(axes::FollowPath{.slave = DrivenRig::master}), ErrorId::coupling_loop);
    EXPECT_EQ(rig.plc.rig.groups.select(rig.plc.group, {0}, {}).error, ErrorId::path_in_use);
}

// A master that would follow a member follows itself, over the path. Not while it drives it alone: also while it waits for its turn, and over an axis between.
TEST(DrivenPath, AMasterThatBeginsToFollowAMemberIsRefused) {
    auto members = PathRig::axes_of(0);
    DrivenRig rig(straight, axes::test::belt_axis(), PathRig::group(), members);
    auto& master = rig.plc.rig.axes[3];
    const auto onto = [&](std::uint16_t axis) {
        axes::AxisCommand gear{.kind = axes::CommandKind::gear_in};
        gear.details = axes::GearDetails{AxisRef{axis}, {1, 1}};
        ErrorId error{};
        rig.plc.rig.step([&] { error = master.submit(gear, axes::Owner::program).error; });
        return error;
    };
    ASSERT_EQ(onto(0), ErrorId::none) << "nothing drives the path yet";
    rig.plc.run(5);
    EXPECT_EQ(rig.refused(), ErrorId::coupling_loop) << "the other way round";
    rig.halt_master();
    rig.plc.run(200);
    rig.sync.Execute = false;
    rig.plc.scan();
    rig.begin();
    for (std::uint16_t member = 0; member < 3; ++member) EXPECT_EQ(onto(member), ErrorId::coupling_loop) << member;
    EXPECT_EQ(rig.state(), GroupState::GroupMoving) << "it goes on";
    rig.master_at(10);
    rig.plc.run(300);
    EXPECT_TRUE(rig.sync.InSync);
    (void)rig.plc.rig.give({.kind = axes::GroupCommandKind::halt});
    ASSERT_TRUE(rig.plc.until([&] { return rig.state() == GroupState::GroupStandby; }, 3000));
    rig.halt_master();
    rig.plc.run(300);
    EXPECT_EQ(onto(0), ErrorId::none) << "it drives nothing any more";
}

// An encoder turned by hand: what is measured trembles, and is followed within what its filter leaves.
TEST(DrivenPath, AnEncoderDrivesItToo) {
    auto wheel = axes::test::belt_axis();
    wheel.encoder = true;
    wheel.limits = {.velocity = 100};
    DrivenRig rig(straight, wheel);
    rig.plc.rig.drives[3]->coasting = 20;  // counts a cycle: 20 u/s
    rig.plc.run(300);
    rig.begin();
    ASSERT_TRUE(rig.plc.until([&] { return rig.sync.InSync && rig.tool()[0] > 5; }, 3000))
        << rig.plc.rig.view().error << " at " << rig.tool()[0] << " with " << rig.speed();
    const double apart = rig.plc.rig.axis(3).actual_position - rig.tool()[0];
    for (int i = 0; i < 500; ++i) {
        rig.plc.scan();
        ASSERT_TRUE(rig.sync.InSync);
        ASSERT_NEAR(rig.plc.rig.axis(3).actual_position - rig.tool()[0], apart, 2e-3);
        ASSERT_NEAR(rig.speed(), 20, 1);
    }
}

// A path of three sides with rounded corners, and a master that wanders over it: it starts, stops, turns round, at speeds that the corners allow. Whatever it does, the tool is where the master says, on the path; stopped at a random moment it stays on it.
TEST(DrivenPath, AMoodyMasterIsFollowedOnThePath) {
    DrivenRig rig("G21 G90 G64 P4\nG1 X30 F3000\nG1 Y30\nG1 X60\nM2\n");
    rig.begin();
    const double from = rig.at_master();
    std::uint32_t random = 12345;
    const auto draw = [&](double low, double high) {
        random = random * 1664525u + 1013904223u;
        return low + (high - low) * (random >> 8) / 16777216.0;
    };
    const auto off_path = [&] {
        const auto p = rig.tool();
        const double off =
            std::min({off_line(p, {0, 0, 0}, {30, 0, 0}), off_line(p, {30, 0, 0}, {30, 30, 0}), off_line(p, {30, 30, 0}, {60, 30, 0})});
        EXPECT_LE(off, 2 + 1e-9) << "no further than 4, half of that for merging";
        const bool at_corner = std::min(distance(p, {30, 0, 0}), distance(p, {30, 30, 0})) < 13;
        if (!at_corner) {
            EXPECT_LE(off, 1e-9);
        }
    };
    int synced = 0;
    for (int move = 0; move < 25; ++move) {
        rig.master_to(from + draw(-10, 95), draw(3, 14));
        const int cycles = static_cast<int>(draw(50, 2500));
        for (int i = 0; i < cycles; ++i) {
            rig.plc.scan();
            off_path();
            synced += rig.sync.InSync ? 1 : 0;
            ASSERT_EQ(rig.state(), GroupState::GroupMoving) << rig.plc.rig.view().error << " in move " << move << " at " << rig.tool()[0];
        }
    }
    EXPECT_GT(synced, 10'000);
    rig.plc.rig.step([&] { (void)rig.plc.rig.submit({.kind = axes::GroupCommandKind::halt}); });
    ASSERT_TRUE(rig.plc.until(
        [&] {
            off_path();
            return rig.state() == GroupState::GroupStandby;
        },
        3000));
}

// G-092 on such a path: an axis that follows its length goes back with it.
TEST(DrivenPath, AnAxisThatFollowsTheLengthGoesBackWithIt) {
    auto all = DrivenRig::with(axes::test::belt_axis());
    all.push_back(axes::test::belt_axis());
    GroupPlc plc(all, {PathRig::group()}, PathRig::makers(straight, {}));
    MC_GroupEnable enable;
    plc.carry_out(enable);
    MC_PathSelect select;
    select.PathDescription.Path = {0};
    ASSERT_EQ(plc.carry_out(select, 2000), ErrorId::none);
    MC_SyncGroupToAxis sync;
    MC_SyncAxisToGroup pump;
    sync.AxesGroup = pump.AxesGroup = plc.group;
    sync.Master = AxisRef{3};
    sync.PathData = select.PathData;
    pump.SlaveAxis = AxisRef{4};
    sync.Execute = pump.Execute = true;
    plc.program = [&](const MotionContext& ctx) {
        pump(ctx);
        sync(ctx);
    };
    plc.run(20);
    ASSERT_TRUE(sync.InSync);
    ASSERT_TRUE(pump.InSync);
    const double began = plc.rig.axis(4).set_position, from = plc.rig.axis(3).set_position;
    for (const double to : {30.0, 12.0}) {
        plc.rig.step([&] {
            (void)plc.rig.axes[3].submit({.kind = axes::CommandKind::move_absolute, .position = from + to, .velocity = 20},
                                         axes::Owner::program);
        });
        ASSERT_TRUE(plc.until(
            [&] {
                EXPECT_NEAR(plc.rig.axis(4).set_position - began, plc.rig.axis(0).set_position, 1e-9);
                return plc.rig.axis(3).set_velocity == 0;
            },
            5000));
        plc.run(3);
        EXPECT_NEAR(plc.rig.axis(4).set_position - began, to, 1e-9);
    }
}

// The cycle's part of it allocates nothing.
TEST(DrivenPath, AllocatesNothingInTheCycle) {
    DrivenRig rig(circle);
    rig.sync.Mode = mcPeriodic;
    rig.begin();
    rig.master_at(30);
    rig.plc.run(400);
    ASSERT_TRUE(rig.sync.InSync);
    for (int i = 0; i < 300; ++i) {
        rig.plc.rig.now += axes::test::GroupRig::cycle;
        NoAllocationScope none;
        rig.plc.rig.groups.plan(rig.plc.rig.now, axes::test::GroupRig::cycle);
        ASSERT_EQ(none.used().total(), 0u);
    }
}

}  // namespace
}  // namespace taktwerk::fb
