// MC_SyncGroupToAxis where it is tight: at the ends of the path, in front of bends, with masters that others move, and where there is nothing to go. The rig asserts the limits and the
// continuity of every member in every cycle.

#include "core/guard/allocation_guard.hpp"
#include "tests/fb_library/gcode_path/driven_rig.hpp"

namespace taktwerk::fb {
namespace {

using axes::CommandStatus;
using axes::GroupState;

/// A portal whose X can do a tenth of what Y can: ramps along a path that needs it anywhere are as soft as X wants, also where Y goes alone.
std::vector<axes::AxisConfig> weak_x() {
    auto axes = PathRig::axes_of(0);
    axes[0].limits = {.velocity = 100, .acceleration = 100, .deceleration = 100, .jerk = 1000};
    return axes;
}

// A master that turns round at the path's beginning, harder than a ramp on the path may be: the tool stands there, exactly, and neither jumps nor goes beyond, wherever it turns.
TEST(DrivenEnds, AMasterThatTurnsRoundAtAnEndIsNoJump) {
    int turned = 0;
    for (const double beyond : {0.02, 0.1, 0.3, 0.6, 1.0, 3.0}) {
        DrivenRig rig("G21 G90 G64 P1\nG1 Y40 F3000\nG1 X20\nM2\n", axes::test::belt_axis(), PathRig::group(), weak_x());
        rig.begin();
        const double from = rig.at_master();
        rig.master_to(from + beyond, 40);
        ASSERT_TRUE(rig.plc.until([&] { return rig.at_master() - from > beyond * 0.6; }, 1000));
        rig.master_at(-60);
        for (int i = 0; i < 1500; ++i) {
            rig.plc.scan();
            ASSERT_GE(rig.tool()[1], 0);
            const bool named =
                rig.plc.rig.view().error == static_cast<std::uint16_t>(ErrorId::path_limit);  // faster than X might brake it in the bend
            ASSERT_TRUE(rig.state() == GroupState::GroupMoving || named) << rig.plc.rig.view().error;
            ASSERT_LT(rig.state() == GroupState::GroupMoving && rig.tool()[1] == 0 ? rig.speed() : 0, 1e-3);
        }
        EXPECT_EQ(rig.speed(), 0);
        EXPECT_FALSE(rig.sync.InSync);
        turned += rig.state() == GroupState::GroupMoving && rig.tool()[1] == 0 ? 1 : 0;
    }
    EXPECT_GE(turned, 3);
}
// A halt that is softer than the bend in front of it allows gets as hard as it has to: to rest on the path, and no error.
TEST(DrivenEnds, ASoftHaltInFrontOfABendStaysOnThePath) {
    for (const double soft : {2.0, 10.0, 30.0, 100.0}) {
        DrivenRig rig(corner);
        rig.begin();
        rig.master_at(25);
        ASSERT_TRUE(rig.plc.until([&] { return rig.tool()[0] > 20; }, 3000));
        axes::CommandId id = 0;
        rig.plc.rig.step([&] { id = rig.plc.rig.submit({.kind = axes::GroupCommandKind::halt, .dynamics = {.deceleration = soft}}).id; });
        ASSERT_TRUE(rig.plc.until([&] { return rig.plc.rig.status(id) != CommandStatus::active; }, 20'000));
        EXPECT_EQ(rig.plc.rig.status(id), CommandStatus::done) << soft << " error " << rig.plc.rig.view().error;
        EXPECT_EQ(rig.state(), GroupState::GroupStandby) << soft;
        EXPECT_LE(std::min(off_line(rig.tool(), {0, 0, 0}, {40, 0, 0}), off_line(rig.tool(), {40, 0, 0}, {40, 30, 0})), 0.25) << soft;
        EXPECT_LT(rig.tool()[0], 40);
    }
}

// A master somewhat too fast for a bend, however sharp that is: jerk costs way, too, so the error comes early enough for a ramp that ends on the path.
TEST(DrivenEnds, AMasterTooFastForASharpBendEndsOnThePathInFrontOfIt) {
    int errors = 0;
    for (const char* tolerance : {"0.5", "0.05", "0.005"})
        for (const double speed : {2.0, 4.0, 6.0, 10.0, 16.0, 40.0}) {
            SCOPED_TRACE(testing::Message() << "P" << tolerance << " at " << speed);
            DrivenRig rig(std::string("G21 G90 G64 P") + tolerance + "\nG1 X20 F3000\nG1 Y10\nM2\n");
            rig.begin();
            rig.master_at(speed);
            for (int i = 0; i < 20'000 && rig.state() == GroupState::GroupMoving && rig.tool()[1] < 9.9; ++i) rig.plc.scan();
            if (rig.state() == GroupState::GroupMoving) continue;
            ++errors;
            EXPECT_EQ(rig.plc.rig.view().error, static_cast<std::uint16_t>(ErrorId::path_limit));
            while (rig.speed() > 0) {
                ASSERT_TRUE(rig.plc.rig.groups[0].leads()) << "it left the path with " << rig.speed();
                rig.plc.scan();
            }
            const auto p = rig.tool();
            EXPECT_LE(std::min(off_line(p, {0, 0, 0}, {20, 0, 0}), off_line(p, {20, 0, 0}, {20, 10, 0})), std::stod(tolerance) / 2 + 1e-9);
            EXPECT_LT(p[1], 5);
        }
    EXPECT_GT(errors, 10);
}

// A path that has no length has no place that an axis could lead along: that is said, and the group is as it was.
TEST(DrivenEnds, APathOfNoLengthIsSaid) {
    DrivenRig rig("G21 G90 G61\nG1 X0 F3000\nM2\n");
    EXPECT_EQ(rig.refused(), ErrorId::path_stands);
    EXPECT_FALSE(rig.sync.Busy);
    EXPECT_EQ(rig.state(), GroupState::GroupStandby);
}

// It has no end that something could wait for: no motion, no frame, no tool, also not in front of its turn; and nothing gets in behind those.
TEST(DrivenEnds, NothingWaitsBehindIt) {
    for (const bool begun : {true, false}) {
        DrivenRig rig(straight);
        if (!begun) (void)rig.plc.rig.give(axes::test::line({30, 0, 0}, 20));
        rig.sync.BufferMode = mcBuffered;
        rig.sync.Execute = true;
        rig.plc.run(8);
        ASSERT_EQ(rig.sync.Active, begun);
        ASSERT_TRUE(rig.sync.Busy);
        for (const auto mode : {axes::mcQueued, axes::mcDelayed}) {
            if (!begun && mode == axes::mcDelayed) continue;  // that is in front of it
            const auto frame = rig.plc.rig.give({.kind = axes::GroupCommandKind::set_frame, .frame = axes::mcPCS, .execution = mode});
            EXPECT_EQ(frame.error, ErrorId::state_forbids) << begun << mode;
        }
        EXPECT_EQ(rig.plc.rig.give(axes::test::line({5, 0, 0}, 50, axes::mcBuffered)).error, ErrorId::state_forbids) << begun;
        const auto at_once = rig.plc.rig.give({.kind = axes::GroupCommandKind::set_frame, .frame = axes::mcPCS});
        EXPECT_EQ(at_once.error, ErrorId::none);
    }
}

// G-072: an override is none of it, and is not what people are told holds it back.
TEST(DrivenEnds, NoOverrideHoldsItBack) {
    DrivenRig rig(straight);
    rig.begin();
    ASSERT_EQ(rig.plc.rig.set(axes::Override{.velocity = 0.1}), ErrorId::none);
    rig.master_at(10);
    rig.plc.run(500);
    EXPECT_EQ(rig.plc.rig.view().limiter, axes::PathLimiter::command);
}

// Set-up mode: the tool's point goes no faster than the group's set-up velocity, whoever moves it. Who drives it faster is told, and it brakes.
TEST(DrivenEnds, SetUpVelocityHoldsForWhoeverDrives) {
    auto group = PathRig::group();
    group.setup_velocity = 30;
    DrivenRig rig("G21 G90 G61\nG1 X100 F3000\nM2\n", axes::test::belt_axis(), group);
    rig.plc.rig.groups[0].set_mode(axes::OperatingMode::setup);
    rig.begin();
    rig.master_at(60);
    ASSERT_TRUE(rig.plc.until(
        [&] {
            EXPECT_LE(rig.speed(), 30 * (1 + 1e-6));
            return rig.state() == GroupState::GroupErrorStop;
        },
        3000));
    EXPECT_EQ(rig.plc.rig.view().error, static_cast<std::uint16_t>(ErrorId::path_limit));
    ASSERT_TRUE(rig.comes_to_rest());
}

// A master that bends harder than the group foresees of it, which is planned in front of it: set-points that are no one motion are not given, and that has a name.
TEST(DrivenEnds, AMasterThatBendsTooHardIsNamed) {
    auto hard = axes::test::group_axis("wheel", {.velocity = 100, .acceleration = 900, .deceleration = 900, .jerk = 9000});
    DrivenRig rig(straight, hard);
    rig.begin();
    rig.master_at(40);
    ASSERT_TRUE(rig.plc.until([&] { return rig.state() == GroupState::GroupErrorStop; }, 100));
    EXPECT_EQ(rig.plc.rig.view().error, static_cast<std::uint16_t>(ErrorId::path_limit));
    ASSERT_TRUE(rig.comes_to_rest());
}

// A thousand pieces, two thirds of a turn about (0, 30) as chords of 0.126 with rounded corners: gone on, to a stop and back as one circle is, no further than half of P from the chords, and
// nothing allocates while braking has to be looked for over many sections.
TEST(DrivenEnds, AThousandPiecesAreOnePath) {
    std::string text = "G21 G90 G64 P0.02\n";
    for (int i = 1; i <= 1000; ++i) {
        char line[64];
        std::snprintf(line, sizeof line, "G1 X%.6f Y%.6f F3000\n", 30 * std::sin(i * 0.0042), 30 - 30 * std::cos(i * 0.0042));
        text += line;
    }
    DrivenRig rig(text + "M2\n");
    rig.sync.Execute = true;
    ASSERT_TRUE(rig.plc.until([&] { return rig.sync.InSync; }, 100)) << static_cast<int>(rig.sync.ErrorID);
    const double from = rig.at_master();
    const auto off_circle = [&] { return std::abs(std::hypot(rig.tool()[0], rig.tool()[1] - 30) - 30); };
    for (const double to : {90.0, 20.0, 60.0}) {
        rig.master_to(from + to, 12);
        ASSERT_TRUE(rig.plc.until(
            [&] {
                EXPECT_LE(off_circle(), 0.0101);
                EXPECT_TRUE(rig.sync.InSync) << rig.plc.rig.view().error;
                return rig.master_stands() || !rig.sync.InSync;
            },
            20'000));
        rig.plc.run(2);
        EXPECT_NEAR(std::atan2(rig.tool()[0], 30 - rig.tool()[1]), to / 30, 2e-3);
    }
    rig.master_at(12);
    rig.plc.run(300);
    for (int i = 0; i < 100; ++i) {
        rig.plc.rig.now += axes::test::GroupRig::cycle;
        NoAllocationScope none;
        rig.plc.rig.groups.plan(rig.plc.rig.now, axes::test::GroupRig::cycle);
        ASSERT_EQ(none.used().total(), 0u);
    }
}

// A master without power is pushed by whoever pushes it: it is followed, or that has a name.
TEST(DrivenEnds, AMasterThatLosesItsPowerIsFollowedOrNamed) {
    DrivenRig rig(straight);
    rig.begin();
    rig.master_at(20);
    ASSERT_TRUE(rig.plc.until([&] { return rig.tool()[0] > 10; }, 3000));
    rig.plc.rig.trembles = true;
    rig.plc.rig.drives[3]->coasting = 20;
    rig.plc.rig.powered[3] = false;
    for (int i = 0; i < 1500; ++i) {
        rig.plc.rig.step([&] { (void)rig.plc.rig.axes[3].power(false, true, true, axes::Owner::program); });
        const auto error = static_cast<ErrorId>(rig.plc.rig.view().error);
        ASSERT_TRUE(rig.state() == GroupState::GroupMoving || error == ErrorId::path_limit || error == ErrorId::master_lost);
    }
    EXPECT_EQ(rig.tool()[1], 0);
}

// Homing the master and giving it new numbers moves nothing; then it leads on.
TEST(DrivenEnds, NewNumbersForTheMasterMoveNothing) {
    auto wheel = axes::test::belt_axis();
    wheel.homing.kind = axes::HomingKind::set_here;
    DrivenRig rig(straight, wheel);
    rig.begin();
    rig.master_to(rig.at_master() + 20, 30);
    ASSERT_TRUE(rig.plc.until([&] { return rig.master_stands(); }, 4000));
    rig.plc.run(3);
    const double at = rig.tool()[0];
    rig.plc.rig.step([&] { EXPECT_EQ(rig.plc.rig.axes[3].set(axes::SetPosition{.position = 500}, axes::Owner::program), ErrorId::none); });
    rig.plc.run(20);
    EXPECT_EQ(rig.tool()[0], at);
    rig.plc.rig.step([&] { EXPECT_EQ(rig.plc.rig.axes[3].submit(axes::test::home(-300), axes::Owner::program).error, ErrorId::none); });
    rig.plc.run(50);
    EXPECT_EQ(rig.tool()[0], at);
    EXPECT_EQ(rig.state(), GroupState::GroupMoving) << rig.plc.rig.view().error;
    EXPECT_TRUE(rig.sync.InSync);
    rig.master_to(rig.at_master() + 10, 30);
    rig.plc.run(1500);
    EXPECT_NEAR(rig.tool()[0], at + 10, 1e-9);
}

}  // namespace
}  // namespace taktwerk::fb
