// Traces read back, and what a picture needs of them.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <cmath>

#include "apps/plot/path_picture.hpp"
#include "apps/plot/plot_data.hpp"
#include "apps/plot/plot_script.hpp"
#include "apps/plot/recording_csv.hpp"
#include "apps/plot/trace_file.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string heading =
    "time_s,emergency_stop,alarms,x.state,x.set_position[mm],x.set_velocity[mm/"
    "s],x.set_acceleration,x.set_jerk,x.actual_position,x.actual_velocity,"
    "x.actual_torque,x.following_error,in.start\n";

TEST(TraceFile, TimeIsThatOfTheLogAndUnitsComeFromTheHeading) {
    const auto trace = parse_trace(heading + "100.5,0,0,1,7.25,2,3,4,7,1.5,0.1,0.25,1\n100.501,1,2,7,8,2,3,4,7,1.5,0.1,0.25,1\n", "t.csv");

    ASSERT_TRUE(trace) << trace.error().text();
    EXPECT_THAT(trace->time_s, ElementsAre(100.5, 100.501));
    EXPECT_THAT(trace->emergency_stop, ElementsAre(0, 1));
    ASSERT_EQ(trace->axes.size(), 1u);
    EXPECT_EQ(trace->axes[0].name, "x");
    EXPECT_EQ(trace->axes[0].unit, "mm");
    EXPECT_THAT(trace->axes[0].set_position, ElementsAre(7.25, 8));
    EXPECT_THAT(trace->axes[0].following_error, ElementsAre(0.25, 0.25));
}

// Of an axis that its group leads (state 5) nobody plans a jerk: 0.5 more acceleration in 0.25 s is 2 of jerk. Another axis has what was recorded.
TEST(TraceFile, JerkOfAnAxisThatIsLedIsWhatItsAccelerationsAreApart) {
    const auto trace = parse_trace(heading +
                                       "1,0,0,5,7,2,3,0,7,1,0,0,1\n1.25,0,0,5,7,2,3.5,0,7,1,0,0,1\n1.5,0,0,5,7,2,3.5,0,7,1,0,0,1\n"
                                       "1.75,0,0,3,7,2,9,0,7,1,0,0,1\n",
                                   "t.csv");
    ASSERT_TRUE(trace) << trace.error().text();
    EXPECT_THAT(trace->axes[0].set_jerk, ElementsAre(0, 2, 0, 0));
}

// A recording is drawn as a trace is: each signal a column, with its unit, the time from its first row.
TEST(RecordingCsv, IsTheTraceOfItsCycles) {
    using Coding = runtime::SignalCell::Coding;
    runtime::ScopeHead head;
    head.words = 2;
    head.cycle = std::chrono::milliseconds{1};
    head.first_cycle = 100;
    head.signals = {{"time_s", "s", {}, {}, "", "", "", {0, 0, 64, Coding::integer, 1e9}},
                    {"x.a", "mm", {}, {}, "x", "", "", {1, 0, 64, Coding::real, 1}}};
    const runtime::KeptRows kept{head,
                                 {5'000'000'000, 5'001'000'000, std::bit_cast<std::uint64_t>(0.1), std::bit_cast<std::uint64_t>(-3.0)}};
    EXPECT_EQ(recording_csv(kept), "time_s,x.a[mm]\n0,0.1\n0.001000000000000334,-3\n");
}

TEST(TraceFile, ALineOfAKilledWriterIsLeftOutAndSaid) {
    const auto trace = parse_trace(heading + "1,0,0,1,7.25,2,3,4,7,1.5,0.1,0.25,1\n2,0,0,1,7.", "t.csv");

    ASSERT_TRUE(trace);
    EXPECT_TRUE(trace->cut_off);
    EXPECT_EQ(trace->time_s.size(), 1u);
}

TEST(TraceFile, DamageIsNamedWithItsLine) {
    const auto short_line = parse_trace(heading + "1,0,0,1,7.25,2,3,4,7,1.5,0.1,0.25,1\n2,0,0\n", "t.csv");
    ASSERT_FALSE(short_line);
    EXPECT_EQ(short_line.error().code, "trace.bad_line");
    EXPECT_EQ(short_line.error().subject, "t.csv:3");

    const auto backwards = parse_trace(heading + "2,0,0,1,7,2,3,4,7,1,0,0,1\n1,0,0,1,7,2,3,4,7,1,0,0,1\n", "t.csv");
    ASSERT_FALSE(backwards);
    EXPECT_EQ(backwards.error().subject, "t.csv:3");

    for (const char* text : {"", "a,b,c\n1,2,3\n", "time_s,x.set_position\n1,2\n"}) {
        const auto foreign = parse_trace(text, "t.csv");
        ASSERT_FALSE(foreign) << text;
        EXPECT_EQ(foreign.error().code, "trace.not_a_trace") << text;
    }
    EXPECT_EQ(parse_trace(heading, "t.csv").error().code, "trace.empty");
    EXPECT_EQ(parse_trace(heading + "nan,0,0,1,7,2,3,4,7,1,0,0,1\n", "t.csv").error().code, "trace.bad_line");
    EXPECT_EQ(read_trace("/nowhere/trace.csv").error().code, "trace.open");
}

TEST(TraceFile, AColumnThatStandsTwiceIsNamed) {
    const std::string row = "1,0,0,1,7,2,3,4,7,1,0,0,1", rows = row + ",9\n2" + row.substr(1) + ",9\n";
    for (const char* twice : {"x.set_position", "x.state", "in.start", "time_s"}) {
        const auto trace = parse_trace(heading.substr(0, heading.size() - 1) + "," + twice + "\n" + rows, "t.csv");
        ASSERT_FALSE(trace) << twice;
        EXPECT_EQ(trace.error().code, "trace.not_a_trace");
        EXPECT_THAT(trace.error().what, HasSubstr(std::string("'") + twice + "'"));
    }
    EXPECT_TRUE(parse_trace(heading.substr(0, heading.size() - 1) + ",other\n" + rows, "t.csv")) << "the same with a name of its own";
}

// Numbers that no machine writes: named with their line instead of drawn for ever.
TEST(TraceFile, NumbersThatNoMachineHasAreDamage) {
    for (const char* row : {"2,0,0,8,7,2,3,4,7,1,0,0,1", "2,0,0,-1,7,2,3,4,7,1,0,0,1", "2,0,0,1.5,7,2,3,4,7,1,0,0,1",
                            "2,0,0,1e300,7,2,3,4,7,1,0,0,1", "2,0,0,1,1e16,2,3,4,7,1,0,0,1", "1e300,0,0,1,7,2,3,4,7,1,0,0,1"}) {
        const auto trace = parse_trace(heading + "1,0,0,1,7,2,3,4,7,1,0,0,1\n" + row + "\n", "t.csv");
        ASSERT_FALSE(trace) << row;
        EXPECT_EQ(trace.error().code, "trace.bad_line");
        EXPECT_EQ(trace.error().subject, "t.csv:3");
    }
    EXPECT_TRUE(parse_trace(heading + "1,0,0,1,7,2,3,4,7,1,0,0,1\n2,0,0,7,1e15,2,3,4,7,1,1e300,0,1\n", "t.csv"))
        << "the torque is not drawn";
}

const std::string later_heading =
    "time_s,emergency_stop,alarms,x.state,x.set_position[mm],x.set_velocity[mm/s],x.set_acceleration,x.set_jerk,x.actual_position,"
    "x.actual_velocity,x.following_error,x.target_position[mm],x.active,in.start,out.level,feeder.busy\n";

// x.active is no bit although it is 0 and 1 here: it is the axis' own. out.level is none for it is 7 once.
TEST(TraceFile, WhatIsZeroOrOneAllTheTimeAndOfNoAxisIsABit) {
    const auto trace = parse_trace(later_heading + "1,0,0,3,0,0,0,0,0,0,0,100,0,0,0,1\n2,0,0,3,0,0,0,0,0,0,0,100,1,1,7,1\n", "t.csv");

    ASSERT_TRUE(trace) << trace.error().text();
    ASSERT_EQ(trace->bits.size(), 2u);
    EXPECT_EQ(trace->bits[0].name, "in.start");
    EXPECT_THAT(trace->bits[0].value, ElementsAre(0, 1));
    EXPECT_EQ(trace->bits[1].name, "feeder.busy");
    EXPECT_THAT(trace->axes[0].active, ElementsAre(0, 1));
    EXPECT_THAT(trace->axes[0].target_position, ElementsAre(100, 100));
}

// What a program divided by zero is no damage of the file: the curve has a gap there, and the rest is drawn.
TEST(TraceFile, ValuesThatAreNoNumbersAreReadAndLeaveAGapInThePicture) {
    const auto trace = parse_trace(later_heading +
                                       "1,0,0,3,5,0,0,0,nan,0,0,100,0,0,2.5,1\n2,0,0,3,6,0,0,0,7,0,0,100,1,1,inf,1\n"
                                       "3,0,0,3,6,0,0,0,-inf,0,0,100,1,1,4.5,1\n",
                                   "t.csv");
    ASSERT_TRUE(trace) << trace.error().text();
    ASSERT_EQ(trace->values.size(), 1u);
    EXPECT_EQ(trace->values[0].name, "out.level");
    EXPECT_TRUE(std::isinf(trace->values[0].value[1]));

    const auto script = plot_script(*trace, {"t", "t.svg", {}, 0, 0, false, {}, {"out.level"}});
    ASSERT_TRUE(script) << script.error().text();
    EXPECT_THAT(*script, HasSubstr("1.000000 2.5\n\n3.000000 4.5\n"));  // two runs, nothing between
    EXPECT_THAT(*script, HasSubstr("2.000000 7\n"));                    // the one actual position that is a number
    EXPECT_THAT(*script, Not(HasSubstr("inf")));

    EXPECT_EQ(plot_script(*trace, {"t", "t.svg", {}, 0, 0, false, {}, {"out.levle"}}).error().remedy, "Did you mean 'out.level'?");
    // A state that is no number is damage.
    EXPECT_EQ(parse_trace(later_heading + "1,0,0,nan,5,0,0,0,0,0,0,100,0,0,2.5,1\n", "t.csv").error().code, "trace.bad_line");
}

TEST(PlotScript, APanelWithoutOneNumberIsEmptyAndHasARange) {
    const auto trace = parse_trace(later_heading + "1,0,0,3,5,0,0,0,0,0,0,100,0,0,nan,1\n2,0,0,3,6,0,0,0,7,0,0,100,1,1,nan,1\n", "t.csv");
    ASSERT_TRUE(trace) << trace.error().text();

    const auto script = plot_script(*trace, {"t", "t.svg", {}, 0, 0, false, {}, {"out.level"}});

    ASSERT_TRUE(script);
    EXPECT_THAT(*script, HasSubstr("1.000000 NaN\nEOD"));
    EXPECT_THAT(*script, Not(HasSubstr("inf")));
    EXPECT_THAT(*script, Not(HasSubstr("[nan")));
}

TEST(PlotData, NoPeakIsLostHoweverNarrow) {
    std::vector<double> time, values;
    for (int i = 0; i < 100000; ++i) {
        time.push_back(i * 1e-3);
        values.push_back(i == 54321 ? 5 : i == 54323 ? -7 : 0);
    }

    const auto points = decimate(time, values, {0, time.size()}, 100);

    EXPECT_LE(points.size(), 400u);
    const auto at = [](double t, double value) {
        return ::testing::AllOf(::testing::Field(&Point::t, t), ::testing::Field(&Point::value, value));
    };
    EXPECT_THAT(points, ::testing::Contains(at(54321e-3, 5)));
    EXPECT_THAT(points, ::testing::Contains(at(54323e-3, -7)));
    for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LE(points[i - 1].t, points[i].t);
}

TEST(PlotData, FewRowsComeThroughAsTheyAre) {
    const auto points = decimate({0, 1, 2, 3}, {4, 5, 6, 7}, {1, 3}, 10);
    ASSERT_EQ(points.size(), 2u);
    EXPECT_EQ(points[0].value, 5);
    EXPECT_EQ(points[1].value, 6);
}

TEST(PlotData, TheMoreImportantStateOfACellIsShown) {
    // 1000 rows of state 1, one row of state 7: an error of one cycle must be visible.
    std::vector<double> time, state;
    for (int i = 0; i <= 1000; ++i) {
        time.push_back(i);
        state.push_back(i == 505 ? 7 : 1);
    }

    const auto found = spans(time, state, {0, time.size()}, 10, [](int value) { return value; });

    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[1].value, 7);
    EXPECT_DOUBLE_EQ(found[1].from, 500);
    EXPECT_DOUBLE_EQ(found[1].to, 600);
    EXPECT_DOUBLE_EQ(found[0].from, 0);
    EXPECT_DOUBLE_EQ(found[2].to, 1000);
}

TEST(PlotData, AValueHoldsOverCellsWithoutRows) {
    const auto found = spans({0, 100}, {3, 4}, {0, 2}, 10, [](int value) { return value; });
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].value, 3);
    EXPECT_DOUBLE_EQ(found[0].to, 90);
}

TEST(PlotData, TicksAreRoundNumbersInsideTheValues) {
    EXPECT_THAT(ticks(-350, 350, 5).at, ElementsAre(-200, 0, 200));
    EXPECT_THAT(ticks(0, 20, 6).at, ElementsAre(0, 5, 10, 15, 20));
    EXPECT_THAT(ticks(0, 20, 5).at, ElementsAre(0, 5, 10, 15, 20));
    const auto constant = ticks(0, 0, 5);
    EXPECT_LT(constant.low, 0);
    EXPECT_GT(constant.high, 0);
    EXPECT_FALSE(constant.at.empty());
    for (double size = 1e-9; size < 1e9; size *= 7) {
        const auto t = ticks(0.3 * size, 1.7 * size, 5);
        EXPECT_GE(t.at.size(), 2u) << size;
        EXPECT_LE(t.at.size(), 6u) << size;
    }
}

TEST(PlotData, TicksEndAlsoWhereTheNumbersHardlyDiffer) {
    for (const double at : {1e15, -1e15, 1.0, 1e-300})
        for (const double away : {std::nextafter(at, HUGE_VAL), at * (1 + 1e-11), -at}) {
            const auto t = ticks(std::min(at, away), std::max(at, away), 5);
            EXPECT_GE(t.at.size(), 1u) << at;
            EXPECT_LE(t.at.size(), 7u) << at;
        }
}

TEST(PlotData, TickTextsAreShortAndExact) {
    EXPECT_EQ(tick_text(0, 5), "0");
    EXPECT_EQ(tick_text(-200, 200), "-200");
    EXPECT_EQ(tick_text(0.25, 0.05), "0.25");
    EXPECT_EQ(tick_text(20000, 10000), "20k");
    EXPECT_EQ(tick_text(15000, 5000), "15k");
    EXPECT_EQ(tick_text(1500000, 500000), "1.5M");
}

TEST(PlotScript, AskedForWhatTheTraceDoesNotHave) {
    const auto trace = parse_trace(heading + "1,0,0,1,7,2,3,4,7,1,0,0,1\n2,0,0,1,7,2,3,4,7,1,0,0,1\n", "t.csv");
    ASSERT_TRUE(trace);

    PlotRequest request{"t", "t.svg", {"xx"}, 0, 0, false};
    EXPECT_EQ(plot_script(*trace, request).error().code, "plot.unknown_axis");
    request.axes = {"x"};
    EXPECT_TRUE(plot_script(*trace, request));
    request.from_s = 5;
    EXPECT_EQ(plot_script(*trace, request).error().code, "plot.empty_window");
}

// Two commands one after the other, the second takes the axis from the first at 4 s; the program's bit does not change.
TEST(PlotScript, DrawsTargetsHandOversAndTheBitsThatChange) {
    const auto trace = parse_trace(later_heading +
                                       "1,0,0,1,0,0,0,0,0,0,0,0,0,0,0,1\n2,0,0,3,0,0,0,0,0,0,0,100,5,1,7,1\n"
                                       "4,0,0,3,0,0,0,0,0,0,0,200,6,0,7,1\n6,0,0,1,0,0,0,0,0,0,0,200,0,0,7,1\n",
                                   "t.csv");
    ASSERT_TRUE(trace);

    const auto script = plot_script(*trace, {"t", "t.svg", {}, 0, 0, false});

    ASSERT_TRUE(script);
    EXPECT_THAT(*script, HasSubstr("title 'commanded'"));
    EXPECT_THAT(*script, HasSubstr("set arrow from first 4.000000"));
    EXPECT_THAT(*script, ::testing::Not(HasSubstr("set arrow from first 2.000000"))) << "nothing was taken from anybody there";
    EXPECT_THAT(*script, HasSubstr("set label 'in.start'"));
    EXPECT_THAT(*script, ::testing::Not(HasSubstr("feeder.busy")));

    PlotRequest named{"t", "t.svg", {}, 0, 0, false, {"feeder.busy"}};
    const auto asked = plot_script(*trace, named);
    ASSERT_TRUE(asked);
    EXPECT_THAT(*asked, HasSubstr("feeder.busy"));
    named.bits = {"in.stat"};
    EXPECT_EQ(plot_script(*trace, named).error().code, "plot.unknown_bit");
}

const std::string way_heading =
    "time_s,emergency_stop,alarms,x.state,x.set_position[mm],x.set_velocity[mm/"
    "s],x.set_acceleration,x.set_jerk,x.actual_position,x.actual_velocity,"
    "x.actual_torque,x.following_error,group.arm.tool_x[mm],group.arm.tool_y[mm],group.arm.tool_z[mm],group.arm.tool_actual_x[mm],"
    "group.arm.tool_actual_y[mm],group.arm.tool_actual_z[mm],group.arm.tool_speed[mm/s],group.arm.path_velocity[mm/"
    "s],group.arm.x_velocity_use[%],"
    "group.arm.x_acceleration_use[%],group.arm.x_jerk_use[%],group.flat.path_velocity[mm/s]\n";

// 40 wide, 160 high, 0 deep: one scale for all three directions, the point where it began, a gap where nobody knew where the tool was.
TEST(PathScript, DrawsTheWayToOneScale) {
    const std::string axis = ",0,0,1,0,0,0,0,0,0,0,0,";
    const auto trace =
        parse_trace(way_heading + "1" + axis + "nan,nan,nan,nan,nan,nan,nan,0,0,0,0,0\n" + "2" + axis +
                        "220,-80,5,221,-79,5,100,100,40,90.25,10,0\n" + "3" + axis + "260,80,5,259,79,5,200,200,100,20,30,0\n",
                    "t.csv");
    ASSERT_TRUE(trace) << trace.error().text();

    const auto script = path_script(*trace, {"t", "t.svg", "arm", 0, 0});

    ASSERT_TRUE(script) << script.error().text();
    EXPECT_THAT(*script, HasSubstr("$set << EOD\n220 -80 5\n260 80 5\nEOD"));
    EXPECT_THAT(*script, HasSubstr("$actual << EOD\n221 -79 5\n259 79 5\nEOD"));
    EXPECT_THAT(*script, HasSubstr("$start << EOD\n220 -80 5\nEOD"));
    // 160 / 470 pixels and 8 % more is what a pixel is worth; the pictures are 511 x 470 pixels around (240, 0) and (240, 5).
    const double half_high = 1.08 * 160 / 2, half_wide = 1.08 * 160 / 470 * 511 / 2;
    EXPECT_THAT(*script, HasSubstr(fmt::format("set xrange [{:.9g}:{:.9g}]; set yrange [{:.9g}:{:.9g}]", 240 - half_wide, 240 + half_wide,
                                               -half_high, half_high)));
    EXPECT_THAT(*script, HasSubstr(fmt::format("set yrange [{:.9g}:{:.9g}]", 5 - half_high, 5 + half_high)));
    EXPECT_THAT(*script, HasSubstr("'X [mm]'"));
    EXPECT_THAT(*script, HasSubstr("2.000000 90.25\n3.000000 100\n")) << "of velocity, acceleration and jerk the most";
}

TEST(PathScript, SaysWhatItCannotDraw) {
    const std::string axis = ",0,0,1,0,0,0,0,0,0,0,0,";
    const auto trace = parse_trace(
        way_heading + "1" + axis + "nan,nan,nan,nan,nan,nan,nan,0,0,0,0,0\n" + "2" + axis + "nan,nan,nan,nan,nan,nan,nan,0,0,0,0,0\n",
        "t.csv");
    ASSERT_TRUE(trace) << trace.error().text();
    EXPECT_EQ(path_script(*trace, {"t", "t.svg", "arn", 0, 0}).error().code, "plot.unknown_group");
    EXPECT_THAT(path_script(*trace, {"t", "t.svg", "arn", 0, 0}).error().remedy, HasSubstr("'arm'"));
    EXPECT_EQ(path_script(*trace, {"t", "t.svg", "flat", 0, 0}).error().code, "plot.no_tool") << "no arm";
    EXPECT_EQ(path_script(*trace, {"t", "t.svg", "arm", 0, 0}).error().code, "plot.no_tool") << "known nowhere";
    EXPECT_EQ(path_script(*trace, {"t", "t.svg", "arm", 5, 6}).error().code, "plot.empty_window");
    EXPECT_TRUE(plot_script(*trace, {"t", "t.svg", {}, 0, 0, false})) << "its axes all the same";
}

TEST(PlotScript, TextsOfTheOutsideCannotLeaveTheirQuotes) {
    const auto trace = parse_trace(heading + "1,0,0,1,7,2,3,4,7,1,0,0,1\n2,0,0,1,7,2,3,4,7,1,0,0,1\n", "t.csv");
    ASSERT_TRUE(trace);

    const auto script = plot_script(*trace, {"a'; system('rm') #\\ `id` \n\"", "|t.svg", {}, 0, 0, false});

    ASSERT_TRUE(script);
    EXPECT_THAT(*script, HasSubstr(R"('a''; system(''rm'') #\ `id`  "')"));
    EXPECT_THAT(*script, HasSubstr("set output './|t.svg'")) << "a file, no command";
}

}  // namespace
}  // namespace taktwerk::apps
