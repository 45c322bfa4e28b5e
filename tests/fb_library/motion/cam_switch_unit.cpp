// MC_DigitalCamSwitch: PLCopen Part 1 v2.0, 3.32, with its figures 37 to 39. Scans of 1 ms.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "fb_library/motion/digital_cam_switch.hpp"
#include "tests/fb_library/fake_axes.hpp"
#include "tests/fb_library/motion/cam_switch_example.hpp"

namespace taktwerk::fb {
namespace {

using namespace std::chrono_literals;
using axes::CamSwitch;
using axes::CamSwitchDirection;
using axes::CamSwitchMode;
using axes::TrackOptions;

constexpr double turn = test::cam_switch_turn;
const auto example = test::cam_switch_example();

/// Tracks along a motion at constant velocity, one sample per millisecond.
struct Shaft {
    std::vector<CamSwitch> switches;
    std::vector<TrackOptions> options{};
    double modulo = turn;
    double position = 0;
    CamTracks tracks{};
    Instant now{};
    std::uint32_t enabled = 0xFFFF'FFFF;
    std::uint32_t on = 0;

    void at(double where, double velocity) {
        position = where;
        now += 1ms;
        on =
            tracks.step({.position = where, .velocity = velocity, .modulo = modulo, .now = now, .period = 1ms}, switches, options, enabled);
    }
    void advance(double velocity) {
        double next = position + velocity * 1e-3;
        if (modulo > 0) next = next >= modulo ? next - modulo : next < 0 ? next + modulo : next;
        at(next, velocity);
    }
    bool track(int n) const { return ((on >> (n - 1)) & 1u) != 0; }
    /// Runs for `way` and compares each scan with what `expected` says of the place.
    void expect_track(int n, double velocity, double way, const std::function<bool(double)>& expected) {
        for (int i = 0; i < way / std::abs(velocity * 1e-3); ++i) {
            advance(velocity);
            ASSERT_EQ(track(n), expected(position)) << "track " << n << " at " << position << ", velocity " << velocity;
        }
    }
};

// Figure 37, motion in positive sense. The first track has three switches. P1-235, P1-238, P1-241, P1-242
TEST(CamSwitch, Figure37Track1InPositiveSense) {
    Shaft shaft{.switches = example};
    shaft.at(0, 1000);
    EXPECT_TRUE(shaft.track(1)) << "a level: on where the axis stands, once it is known that the switch is for both senses";
    shaft.advance(1000);
    shaft.expect_track(1, 1000, 2 * turn, [](double x) { return x <= 1000 || (2000 <= x && x <= 3000) || 4000 <= x; });
}

// P1-238, P1-242
TEST(CamSwitch, Figure37Track2IsOnForItsTimeWhateverTheVelocity) {
    for (const double velocity : {1000.0, 400.0, 2000.0}) {
        Shaft shaft{.switches = example};
        shaft.at(100, velocity);
        int scans_on = 0;
        double begin = -1;
        for (int i = 0; i < 2.8 * turn / velocity * 1000; ++i) {  // past 3000 three times
            shaft.advance(velocity);
            if (shaft.track(2) && scans_on++ == 0) begin = shaft.position;
            if (!shaft.track(2) && scans_on > 0) break;
        }
        EXPECT_NEAR(begin, 3000, 1e-6) << velocity;
        EXPECT_EQ(scans_on, 1350) << velocity;
    }
}

// Figure 39, motion in negative sense: Switch02 from 3000 down to 2500, Switch01 is silent. P1-235, P1-243
TEST(CamSwitch, Figure39Track1InNegativeSense) {
    Shaft shaft{.switches = example};
    shaft.at(4999, -1000);
    shaft.advance(-1000);
    shaft.expect_track(1, -1000, 2 * turn, [](double x) { return x <= 1000 || (2500 <= x && x <= 3000) || 4000 <= x; });
}

TEST(CamSwitch, Figure39Track2GoesOnAt3000Downwards) {  // P1-243
    Shaft shaft{.switches = example};
    shaft.at(4000, -1000);
    shaft.expect_track(2, -1000, 3000, [](double x) { return x <= 3000 && x > 3000 - 1350; });
}

// Figure 38: OnCompensation -125 ms, OffCompensation +250 ms at 1000 u/s: on at 2000 - 125, off at 3000 + 250. P1-239, P1-244
TEST(CamSwitch, Figure38Compensation) {
    Shaft shaft{.switches = {example[0]}, .options = {{.on_compensation = -125ms, .off_compensation = 250ms}}};
    shaft.at(0, 1000);
    shaft.expect_track(1, 1000, 4900, [](double x) { return 1875 <= x && x <= 3250; });
}

// The points move along the motion: downwards the switch goes on at its other end, earlier there too. P1-239
TEST(CamSwitch, CompensationInNegativeSenseMovesTheOtherWay) {
    Shaft shaft{.switches = {{.track = 1, .first = 2000, .last = 3000}},
                .options = {{.on_compensation = -125ms, .off_compensation = 250ms}}};
    shaft.at(4900, -1000);
    shaft.expect_track(1, -1000, 4800, [](double x) { return 2000 - 250 <= x && x <= 3000 + 125; });
}

TEST(CamSwitch, CompensationThatLeavesNothingIsOff) {
    Shaft shaft{.switches = {{.track = 1, .first = 2000, .last = 2100}}, .options = {{.on_compensation = 200ms}}};
    shaft.at(0, 1000);
    shaft.expect_track(1, 1000, 4900, [](double) { return false; });
}

TEST(CamSwitch, ATimeSwitchIsCompensatedAtBothEnds) {  // P1-239
    Shaft shaft{.switches = {{.track = 1, .first = 3000, .mode = CamSwitchMode::time, .duration = 100ms}},
                .options = {{.on_compensation = -50ms, .off_compensation = 20ms}}};
    shaft.at(2000, 1000);
    // Passed at 3000: on 50 ms before that, off 100 + 20 ms after.
    shaft.expect_track(1, 1000, 2000, [](double x) { return 2950 <= x && x < 3120; });
}

// A point between two scans: passed at 3000, seen at 3000.7; the time runs from the passing. P1-238
TEST(CamSwitch, ATimeSwitchCountsFromThePassing) {
    Shaft shaft{.switches = {{.track = 1, .first = 3000, .mode = CamSwitchMode::time, .duration = 10500us}}};
    shaft.at(2990.7, 1000);
    int scans_on = 0;
    for (int i = 0; i < 40; ++i) {
        shaft.advance(1000);
        scans_on += shaft.track(1);
    }
    EXPECT_EQ(scans_on, 10) << "from 0.7 ms after the passing until before 10.5 ms after it";
}

// Jitter of 4 u round the switching point of 2000 with a hysteresis of 5 u: one switching. P1-240
TEST(CamSwitch, NoRepeatedSwitchingInsideTheHysteresis) {
    Shaft shaft{.switches = {{.track = 1, .first = 2000, .last = 3000}}, .options = {{.hysteresis = 5}}};
    shaft.at(1990, 0);
    int changes = 0;
    const auto go_to = [&](double where) {
        const bool before = shaft.track(1);
        shaft.at(where, 0);
        changes += before != shaft.track(1);
    };
    for (const double x : {1995.0, 2001.0, 1997.0, 2003.0, 1996.0, 2004.0, 1998.0}) go_to(x);
    EXPECT_EQ(changes, 1);
    EXPECT_TRUE(shaft.track(1));
    go_to(1994.9);  // out of the band
    EXPECT_EQ(changes, 2);
    EXPECT_FALSE(shaft.track(1));
    go_to(2000);
    EXPECT_FALSE(shaft.track(1)) << "it has just switched here";
    go_to(2006);
    EXPECT_TRUE(shaft.track(1));
}

TEST(CamSwitch, WithoutHysteresisEachPassingSwitches) {
    Shaft shaft{.switches = {{.track = 1, .first = 2000, .last = 3000}}};
    shaft.at(1990, 0);
    for (const double x : {2001.0, 1997.0, 2003.0, 1996.0}) {
        shaft.at(x, 0);
        EXPECT_EQ(shaft.track(1), x >= 2000);
    }
}

// The sense turns when the axis has come back by more than the hysteresis: jitter does not switch a one-sided cam off. P1-240
TEST(CamSwitch, JitterDoesNotTurnTheSenseOfMotion) {
    Shaft shaft{.switches = {example[0]}, .options = {{.hysteresis = 5}}};
    shaft.at(2400, 1000);
    for (int i = 0; i < 100; ++i) shaft.advance(1000);
    EXPECT_TRUE(shaft.track(1));
    shaft.at(2496, 0);
    EXPECT_TRUE(shaft.track(1));
    shaft.at(2494, 0);
    EXPECT_FALSE(shaft.track(1)) << "6 u back: negative sense";
}

TEST(CamSwitch, EachBitOfTheMaskIsATrack) {  // P1-236
    std::vector<CamSwitch> all;
    for (std::uint16_t n = 1; n <= 32; ++n) all.push_back({.track = n, .first = 0, .last = 100});
    for (int n = 0; n < 32; ++n) {
        Shaft shaft{.switches = all};
        shaft.enabled = 1u << n;
        shaft.at(50, 0);
        EXPECT_EQ(shaft.on, 1u << n);
    }
}

TEST(CamSwitch, ALinearAxisHasNoWrap) {
    Shaft shaft{.switches = {{.track = 1, .first = -100, .last = 100}}, .modulo = 0};
    shaft.at(-200, 1000);
    shaft.expect_track(1, 1000, 400, [](double x) { return -100 <= x && x <= 100; });
    EXPECT_FALSE(CamTracks::usable(std::vector<CamSwitch>{{.track = 1, .first = 100, .last = -100}}, {}, 0));
}

TEST(CamSwitch, AChangeOfCoordinatesIsNoMotion) {
    Shaft shaft{.switches = example};
    shaft.at(2900, 0);
    shaft.now += 1ms;
    const CamTracks::Sample jumped{.position = 3100, .modulo = turn, .longest_step = 10, .now = shaft.now, .period = 1ms};
    EXPECT_EQ(shaft.tracks.step(jumped, shaft.switches, {}, 0xFFFF'FFFF) & 2u, 0u) << "3000 was not passed";
}

TEST(CamSwitch, WhatCannotBeUsed) {
    const auto usable = [](const CamSwitch& s, const TrackOptions& o = {}) {
        return CamTracks::usable(std::vector<CamSwitch>{s}, std::vector<TrackOptions>{o}, turn);
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(usable({.track = 32, .first = 4000, .last = 1}));
    EXPECT_FALSE(usable({.track = 0, .first = 0, .last = 1}));
    EXPECT_FALSE(usable({.track = 33, .first = 0, .last = 1}));
    EXPECT_FALSE(usable({.track = 1, .first = nan, .last = 1}));
    EXPECT_FALSE(usable({.track = 1, .first = 0, .last = nan}));
    EXPECT_FALSE(usable({.track = 1, .first = 0, .mode = CamSwitchMode::time, .duration = -1ms}));
    EXPECT_FALSE(usable({.track = 1, .first = 0, .last = 1}, {.hysteresis = -1}));
    EXPECT_FALSE(CamTracks::usable(std::vector<CamSwitch>(65, {.track = 1, .first = 0, .last = 1}), {}, turn));
}

// --- the block ----------------------------------------------------------------------------------------------------------------

struct SwitchBench {
    SwitchBench() {
        axes.context.tables = &tables;
        axes.context.outputs = outputs;
        axes.axis().modulo = turn;
        block.Axis = {0};
        block.Switches = tables.add_cam_switches(example);
    }
    void at(double position, double velocity = 1000) {
        axes.axis().set_position = position;
        axes.axis().set_velocity = velocity;
        scan();
    }
    void scan() {
        axes.next_scan();
        block(axes.context);
    }
    FakeAxes axes;
    axes::MotionTables tables;
    std::array<std::int64_t, 2> outputs{};
    MC_DigitalCamSwitch block;
};

TEST(DigitalCamSwitch, WritesTheBitsOfItsTracksAndLeavesTheOthers) {  // P1-235, P1-237
    SwitchBench bench;
    bench.outputs[1] = 0xF0;
    bench.block.Outputs.point = 1;
    bench.block.Enable = true;
    bench.at(2400);
    EXPECT_TRUE(bench.block.InOperation);
    bench.at(2401);
    EXPECT_EQ(bench.outputs[1], 0xF1);
    bench.at(2999.5);
    bench.at(3000.5);
    EXPECT_EQ(bench.outputs[1], 0xF2) << "track 2 from 3000 on";
    bench.block.Enable = false;
    bench.scan();
    EXPECT_EQ(bench.outputs[1], 0xF0);
    EXPECT_FALSE(bench.block.InOperation);
    bench.outputs[1] = 0xFF;
    bench.scan();
    EXPECT_EQ(bench.outputs[1], 0xFF) << "and then it is nobody's";
}

TEST(DigitalCamSwitch, ADisabledTrackIsOff) {  // P1-236
    SwitchBench bench;
    bench.block.Outputs.point = 0;
    bench.block.Enable = true;
    bench.block.EnableMask = 2;
    bench.at(500);
    EXPECT_EQ(bench.outputs[0], 0);
    bench.block.EnableMask = 1;
    bench.scan();
    EXPECT_EQ(bench.outputs[0], 1);
    bench.block.EnableMask = 0;
    bench.scan();
    EXPECT_EQ(bench.outputs[0], 0);
    EXPECT_TRUE(bench.block.InOperation);
}

TEST(DigitalCamSwitch, TheSourceSaysWhosePosition) {  // P1-237
    SwitchBench bench;
    bench.block.Enable = true;
    bench.axes.axis().actual_position = 1500;
    bench.at(500);
    EXPECT_EQ(bench.block.on, 1u);
    bench.block.Enable = false;
    bench.scan();
    bench.block.Enable = true;
    bench.block.ValueSource = mcActualValue;
    bench.scan();
    EXPECT_EQ(bench.block.on, 0u);
}

// The free outputs of a drive begin at bit 16 of 60FEh: track 1 there, written when it changes.
TEST(DigitalCamSwitch, OutputsOfADrive) {
    SwitchBench bench;
    bench.block.Outputs.axis = {1};
    bench.block.Enable = true;
    bench.at(1500);
    bench.at(1501);
    bench.at(999, -1000);
    bench.at(998, -1000);
    std::vector<axes::WriteOutput> written;
    for (const auto& call : bench.axes.calls_of("set")) {
        EXPECT_EQ(call.axis.index, 1);
        written.push_back(std::get<axes::WriteOutput>(call.setting));
    }
    const std::vector<axes::WriteOutput> expected{{16, false}, {17, false}, {16, true}};
    EXPECT_EQ(written, expected) << "both known at first, then what changes";
    bench.block.Enable = false;
    bench.scan();
    EXPECT_EQ(std::get<axes::WriteOutput>(bench.axes.calls.back().setting), (axes::WriteOutput{16, false}));
}

TEST(DigitalCamSwitch, SaysWhatIsMissing) {
    SwitchBench bench;
    bench.block.Enable = true;
    bench.block.Switches = {};
    bench.scan();
    EXPECT_EQ(bench.block.ErrorID, ErrorId::invalid_table);
    bench.block.Switches = {0};
    bench.scan();
    EXPECT_TRUE(bench.block.InOperation) << "mended while enabled";
    bench.block.Outputs.point = 2;
    bench.scan();
    EXPECT_EQ(bench.block.ErrorID, ErrorId::invalid_output);
    bench.block.Outputs = {};
    bench.axes.axis().online = false;
    bench.scan();
    EXPECT_EQ(bench.block.ErrorID, ErrorId::drive_not_ready);
    EXPECT_EQ(bench.block.on, 0u);
}

// A point has only the bits of its terminal: a track beyond them would be on in every list and never at the valve. It is refused, and nothing is written.
TEST(DigitalCamSwitch, ATrackThatThePointDoesNotHaveIsRefused) {
    SwitchBench bench;
    const std::array<std::uint8_t, 2> bits{1, 8};
    bench.axes.context.output_bits = bits;
    bench.block.Outputs.point = 1;
    bench.block.Enable = true;
    bench.at(0);
    EXPECT_TRUE(bench.block.InOperation);
    EXPECT_FALSE(bench.block.Error);

    SwitchBench narrow;
    narrow.axes.context.output_bits = bits;
    narrow.block.Outputs.point = 0;
    narrow.block.Enable = true;
    for (double at = 0; at < turn; at += 50) {
        narrow.at(at);
        ASSERT_EQ(narrow.block.ErrorID, ErrorId::invalid_output);
        ASSERT_EQ(narrow.outputs[0], 0);
    }
}

// The delay of a valve is found while it works: options count as they stand in each scan.
TEST(DigitalCamSwitch, TrackOptionsMayBeChangedWhileItWorks) {
    SwitchBench bench;
    const std::vector<CamSwitch> one{{.track = 1, .first = 2000, .last = 3000}};
    bench.block.Switches = bench.tables.add_cam_switches(one);
    bench.block.TrackOptions = bench.tables.add_tracks(std::vector<TrackOptions>(1));
    bench.block.Enable = true;
    const auto first_on = [&] {
        for (double at = 1000; at < 2600; at += 10) {
            bench.at(at);
            if (bench.block.on != 0) return at;
        }
        return 0.0;
    };
    bench.at(3500);
    EXPECT_EQ(first_on(), 2000);
    bench.at(3500);
    bench.tables.track_options(bench.block.TrackOptions)[0].on_compensation = -100ms;  // 1000 u/s: 100 u earlier
    EXPECT_EQ(first_on(), 1900);
}

}  // namespace
}  // namespace taktwerk::fb
