// MC_DigitalCamSwitch (PLCopen Part 1 v2.0, 3.32, figures 37 to 39) along the motion of a real modulo axis; and the axis of a running block.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "fb_library/all_blocks.hpp"
#include "tests/fb_library/motion/cam_switch_example.hpp"
#include "tests/fb_library/motion/coupled_plc.hpp"
#include "tests/fb_library/motion/plc.hpp"

namespace taktwerk::fb {
namespace {

using axes::CamSwitch;
using axes::CamSwitchDirection;
using axes::CamSwitchMode;

constexpr double turn = test::cam_switch_turn;
const auto example = test::cam_switch_example();

struct CamShaft : testing::Test {
    static axes::AxisConfig shaft() {
        auto config = Plc::roomy_axis();
        config.modulo = turn;
        config.limits.acceleration = config.limits.deceleration = 1e6;
        return config;
    }
    CamShaft() {
        run.Axis = cams.Axis = Plc::x;
        run.Velocity = 1000;
        cams.Outputs.point = 0;
        cams.Enable = true;
        cams.Switches = tables.add_cam_switches(example);
        plc.program = [this](const MotionContext& ctx) {
            run(ctx);
            auto with_tables = ctx;
            with_tables.tables = &tables;
            with_tables.outputs = outputs;
            cams(with_tables);
            place = ctx.view(Plc::x)->set_position;
        };
    }
    [[nodiscard]] bool track(int n) const { return ((outputs[0] >> (n - 1)) & 1) != 0; }
    /// Turns until it is at its velocity, then for `turns`, comparing each scan with what `expected` says of the place.
    void expect_track(int n, double turns, const std::function<bool(double)>& expected) {
        run.Execute = true;
        plc.run_until([&] { return run.InVelocity; }, 1s);
        ASSERT_TRUE(run.InVelocity);
        plc.run_for(6s);  // every switch has been passed in this sense
        int on = 0, off = 0;
        for (int i = 0; i < turns * turn / 1; ++i) {
            plc.scan();
            ASSERT_EQ(track(n), expected(place)) << "track " << n << " at " << place;
            ++(track(n) ? on : off);
        }
        EXPECT_GT(on, 0);
        EXPECT_GT(off, 0);
    }

    Plc plc{shaft()};
    axes::MotionTables tables;
    std::array<std::int64_t, 1> outputs{};
    MC_MoveVelocity run;
    MC_DigitalCamSwitch cams;
    double place = 0;
};

// P1-235, P1-238, P1-241, P1-242 (figure 37): three switches on one track; the one for the negative sense is silent.
TEST_F(CamShaft, Figure37InPositiveSense) {
    expect_track(1, 2, [](double x) { return x <= 1000 || (2000 <= x && x <= 3000) || 4000 <= x; });
    expect_track(2, 2, [](double x) { return x >= 3000 && x < 3000 + 1350; });
}

// P1-235, P1-243 (figure 39)
TEST_F(CamShaft, Figure39InNegativeSense) {
    run.Direction = mcNegativeDirection;
    expect_track(1, 2, [](double x) { return x <= 1000 || (2500 <= x && x <= 3000) || 4000 <= x; });
    expect_track(2, 2, [](double x) { return x <= 3000 && x > 3000 - 1350; });
}

// P1-239, P1-244 (figure 38): at 1000 u/s on at 2000 - 125, off at 3000 + 250.
TEST_F(CamShaft, Figure38WithCompensation) {
    cams.Switches = tables.add_cam_switches(std::vector<CamSwitch>{example[0]});
    cams.TrackOptions = tables.add_tracks(std::vector<axes::TrackOptions>{{.on_compensation = -125ms, .off_compensation = 250ms}});
    expect_track(1, 2, [](double x) { return 1875 <= x && x <= 3250; });
}

// P1-236: bit n - 1 enables track n.
TEST_F(CamShaft, TheMaskSilencesATrack) {
    run.Execute = true;
    plc.run_for(10s);
    for (const std::uint32_t mask : {0u, 1u, 2u, 3u}) {
        cams.EnableMask = mask;
        std::int64_t seen = 0;
        for (int i = 0; i < 6000; ++i) plc.scan(), seen |= outputs[0];
        EXPECT_EQ(seen, mask);
        EXPECT_TRUE(cams.InOperation);
    }
}

// P1-237: of the actual value the points shift by what the motor is behind.
TEST_F(CamShaft, TheActualValueSwitchesLater) {
    cams.Switches = tables.add_cam_switches(std::vector<CamSwitch>{example[0]});
    cams.ValueSource = mcActualValue;
    plc.drive.lag = 100'000;  // counts: 100 u
    double began = 0;
    run.Execute = true;
    plc.run_for(6s);
    for (int i = 0; i < 6000 && began == 0; ++i) {
        const bool before = track(1);
        plc.scan();
        if (track(1) && !before) began = place;
    }
    // Dead time and latch add two to three cycles of 1 u.
    EXPECT_GT(began, 2100);
    EXPECT_LT(began, 2104);
    EXPECT_TRUE(cams.InOperation);
}

// P1-240: the motor jitters by 4 u round a switching point, the hysteresis is 5 u: it switches once.
TEST_F(CamShaft, JitterInsideTheHysteresisSwitchesOnce) {
    for (const double hysteresis : {5.0, 0.0}) {
        cams.Switches = tables.add_cam_switches(std::vector<CamSwitch>{{.track = 1, .first = 2000, .last = 3000}});
        cams.TrackOptions = tables.add_tracks(std::vector<axes::TrackOptions>{{.hysteresis = hysteresis}});
        cams.ValueSource = mcActualValue;
        MC_MoveAbsolute move;
        move.Axis = Plc::x;
        move.Position = hysteresis > 0 ? 2002 : 1900;
        move.Velocity = 1000, move.Direction = mcShortestWay;
        auto others = plc.program;
        plc.program = [&](const MotionContext& ctx) { move(ctx), others(ctx); };
        move.Execute = true;
        plc.run_for(4s);
        int switched = 0;
        const auto jitter = [&](int i) { plc.drive.lag = i % 2 == 0 ? 0 : 4000; };
        if (hysteresis == 0) {  // positive control: without one the same jitter is seen
            move.Execute = false;
            plc.scan();
            move.Position = 2002, move.Execute = true;
            plc.run_for(1s);
        }
        for (int i = 0; i < 100; ++i) {
            const bool before = track(1);
            jitter(i);
            plc.run_for(5ms);
            switched += before != track(1);
        }
        if (hysteresis > 0) EXPECT_LE(switched, 1);
        else EXPECT_GT(switched, 50);
        plc.program = others;
        plc.drive.lag = 0;
    }
}

// P1-099, our choice: a command belongs to the axis of its edge, whatever the reference says later.
TEST(AxisOfARunningBlock, StaysThatOfTheEdge) {
    CoupledPlc plc;
    MC_MoveAbsolute move;
    move.Axis = CoupledPlc::master;
    move.Position = 50, move.Velocity = 100, move.Execute = true;
    plc.program = [&](const MotionContext& ctx) { move(ctx); };
    plc.run_for(100ms);
    move.Axis = CoupledPlc::slave;
    plc.run_until([&] { return move.Done; }, 10s);
    EXPECT_TRUE(move.Done);
    EXPECT_EQ(plc.position(CoupledPlc::master), 50);
    EXPECT_EQ(plc.position(CoupledPlc::slave), 0);
}

}  // namespace
}  // namespace taktwerk::fb
