// The monitor's screen from a state as the runtime gives it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/machine/monitor_screen.hpp"
#include "apps/terminal/terminal_text.hpp"

namespace taktwerk::apps {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StrEq;
using Json = nlohmann::ordered_json;

Json axis(const std::string& name) {
    return Json{{"name", name},
                {"unit", "mm"},
                {"state", "Standstill"},
                {"owner", "program"},
                {"command", "MC_MoveAbsolute"},
                {"block", name == "a0" ? "cell.pick" : ""},
                {"disabled", false},
                {"simulated", true},
                {"online", true},
                {"powered", true},
                {"homed", true},
                {"drive_error", 0},
                {"actual_position", 12.3456},
                {"actual_velocity", -0.5},
                {"set_position", 12.5},
                {"following_error", 0.001},
                {"drive_state", "operation_enabled"},
                {"negative_limit_switch", false},
                {"positive_limit_switch", false},
                {"home_switch", false}};
}

Json alarm(const std::string& source) {
    return Json{{"source", source},
                {"english", "The drive reports fault 3130h"},
                {"chinese", "驱动器报告故障 0x3130"},
                {"cause", "A phase is missing"},
                {"remedy", "Check the mains"},
                {"reset", "reset"},
                {"standing", true},
                {"acknowledged", false},
                {"count", 1}};
}

Json state(std::size_t axes, std::size_t alarms) {
    Json out{{"machine", "cell"},   {"cycle", 12345},          {"phase", "running"},
             {"mode", "automatic"}, {"emergency_stop", false}, {"simulated", true}};
    out["statistics"] =
        Json{{"lateness_ns", 12000}, {"lateness_max_ns", 87000}, {"compute_ns", 45000}, {"compute_max_ns", 120000}, {"missed_ticks", 3}};
    out["bus"] = Json{{"phase", "operational"}, {"frames_lost", 1}, {"frames_late", 2}, {"working_counter_errors", 0}};
    out["slaves"] = Json::array({Json{{"fresh", true}}, Json{{"fresh", false}}});
    out["axes"] = Json::array();
    for (std::size_t i = 0; i < axes; ++i) out["axes"].push_back(axis("a" + std::to_string(i)));
    out["alarms"] = Json::array();
    for (std::size_t i = 0; i < alarms; ++i) out["alarms"].push_back(alarm("axis a" + std::to_string(i)));
    out["programs"] = Json::array({Json{{"name", "cell"}, {"state", "running"}}});
    out["variables"] = Json::array({Json{{"program", "cell"}, {"name", "step"}, {"unit", ""}, {"value", 30}}});
    out["parameters"] = Json::array({Json{{"program", "cell"}, {"name", "speed"}, {"unit", "mm/s"}, {"value", 400}}});
    out["inputs"] = Json{{"estop_ok", 1}, {"start_button", 0}};
    out["outputs"] = Json{{"lamp", 1}};
    return out;
}

const Json layout{{"cycle_ns", 1000000}};

TEST(TerminalText, ChineseTakesTwoColumns) {
    EXPECT_EQ(columns("abc"), 3u);
    EXPECT_EQ(columns("急停:x"), 6u);
    EXPECT_EQ(columns("急停：x"), 7u);  // fullwidth colon
    EXPECT_EQ(cut("急停急停", 5), "急停…");
    EXPECT_EQ(cut("急停急停", 4), "急…");
    EXPECT_EQ(columns(left("急停", 7)), 7u);
    EXPECT_EQ(right("ab", 4), "  ab");
}

TEST(MonitorScreen, ThreeAxesWithAlarmsFitAPlainTerminal) {
    const auto lines = monitor_screen(state(3, 2), layout, {80, 24, false});

    EXPECT_LE(lines.size(), 24u);
    for (const auto& line : lines) EXPECT_LE(columns(line), 80u) << line;
    EXPECT_THAT(lines, Contains(HasSubstr("SIMULATED")));
    EXPECT_THAT(lines, Contains(HasSubstr("missed 3")));
    EXPECT_THAT(lines, Contains(HasSubstr("axis a1: The drive reports fault 3130h")));
    EXPECT_THAT(lines, Contains(HasSubstr("驱动器报告故障 0x3130")));
    EXPECT_THAT(lines, Contains(HasSubstr("why: A phase is missing")));
    EXPECT_THAT(lines, Contains(HasSubstr("-> Check the mains (reset)")));
    EXPECT_THAT(lines, Contains(HasSubstr("step=30")));
    EXPECT_THAT(lines, Contains(HasSubstr("speed=400 mm/s")));
    EXPECT_THAT(lines, Contains(HasSubstr("estop_ok=1")));
    EXPECT_THAT(lines, Contains(HasSubstr("owner program (MC_MoveAbsolute cell.pick)")));
    EXPECT_THAT(lines, Contains(HasSubstr("owner program (MC_MoveAbsolute)"))) << "a block without a name";
}

// What a program has divided by zero is shown as what it is; the screen stays.
TEST(MonitorScreen, ValuesThatAreNoNumbersAreShown) {
    auto broken = state(1, 0);
    broken["variables"][0]["value"] = "NaN";
    broken["parameters"][0]["value"] = "-Infinity";
    broken["axes"][0]["actual_velocity"] = "Infinity";
    broken["axes"][0]["following_error"] = nullptr;

    const auto lines = monitor_screen(broken, layout, {100, 24, false});

    EXPECT_THAT(lines, Contains(HasSubstr("step=nan")));
    EXPECT_THAT(lines, Contains(HasSubstr("speed=-inf mm/s")));
    EXPECT_THAT(lines, Contains(HasSubstr("        inf        nan")));
}

TEST(MonitorScreen, WhatDoesNotFitGivesWayToAxesAndAlarms) {
    const auto lines = monitor_screen(state(12, 9), layout, {80, 24, false});

    EXPECT_EQ(lines.size(), 24u);
    for (int i = 0; i < 12; ++i) EXPECT_THAT(lines, Contains(HasSubstr(" a" + std::to_string(i) + " ")));
    EXPECT_THAT(lines, Contains(HasSubstr("axis a8")));  // the newest alarm
    EXPECT_THAT(lines, Not(Contains(HasSubstr("owner program"))));
    EXPECT_THAT(lines, Contains(HasSubstr("alarms more")));
}

TEST(MonitorScreen, OfARingItSaysWhetherItIsClosed) {
    auto ring = state(1, 0);
    ring["bus"]["ring"] = "closed";
    EXPECT_THAT(monitor_screen(ring, layout, {100, 24, false}), Contains(HasSubstr("bus operational, ring closed ")));
    ring["bus"]["ring"] = "open";
    ring["bus"]["ring_before_break"] = 4;
    ring["bus"]["ring_behind_break"] = 2;
    EXPECT_THAT(monitor_screen(ring, layout, {100, 24, false}), Contains(HasSubstr("ring broken (4 + 2)")));
    ring["bus"]["ring"] = "none";
    EXPECT_THAT(monitor_screen(ring, layout, {100, 24, false}), Contains(HasSubstr("bus operational  ")));
}

Json group() {
    const auto member = [](const char* axis, double velocity, double acceleration) {
        return Json{{"axis", axis}, {"velocity_use", velocity}, {"acceleration_use", acceleration}, {"jerk_use", 0}};
    };
    return Json{{"name", "arm"},
                {"unit", "mm"},
                {"state", "GroupMoving"},
                {"interrupted", false},
                {"held", false},
                {"powered", true},
                {"error", 0},
                {"members", Json::array({member("a0", 0.995, 0.2), member("a1", 0.1, 0.45)})},
                {"tool_known", true},
                {"tool_set", {250.5, -120.25, 10, 0, 0, 45}},
                {"tool_actual", {250.4, -120.2, 10, 0, 0, 45}},
                {"tool_speed", 200},
                {"tool_actual_speed", 199.5},
                {"path_velocity", 200},
                {"limiter", "axis_limit"},
                {"limiting_axis", "a0"},
                {"command", "MC_MoveLinearAbsolute"},
                {"block", "cell.up"},
                {"progress", 0.42},
                {"distance_to_go", 70.5},
                {"remaining_s", 0.6},
                {"queued", 3},
                {"override", 1},
                {"operators_override", 0.5}};
}

// Where its tool is, how fast, who holds it back, what it does and how far it is.
TEST(MonitorScreen, AGroupSaysWhatItDoesAndWhoHoldsItBack) {
    auto with_group = state(2, 0);
    with_group["groups"] = Json::array({group()});
    const auto lines = monitor_screen(with_group, layout, {110, 40, false});
    EXPECT_THAT(lines, Contains(AllOf(HasSubstr(" arm "), HasSubstr("GroupMoving"), HasSubstr("200.0 mm/s, held back by axis a0"))));
    EXPECT_THAT(lines, Contains(HasSubstr("set    X 250.500  Y -120.250  Z 10.000 mm  RX 0.000  RY 0.000  RZ 45.000 deg   200.0 mm/s")));
    EXPECT_THAT(lines, Contains(HasSubstr("actual X 250.400")));
    EXPECT_THAT(lines, Contains(HasSubstr("MC_MoveLinearAbsolute cell.up  42 %, 70.5 mm to go, 0.6 s, 3 wait   override 50 %")));
    EXPECT_THAT(lines, Contains(HasSubstr("limits a0 100 % v  a1 45 % a")));
    for (const auto& line : lines) EXPECT_LE(columns(line), 110u) << line;

    auto stands = with_group;
    stands["groups"][0]["path_velocity"] = 0;
    stands["groups"][0]["limiter"] = "none";
    EXPECT_THAT(monitor_screen(stands, layout, {110, 40, false}), Contains(AllOf(HasSubstr("0.0 mm/s"), Not(HasSubstr("held by")))));
    stands["groups"][0]["operators_override"] = 0;
    EXPECT_THAT(monitor_screen(stands, layout, {110, 40, false}), Contains(HasSubstr("0.0 mm/s, held by the override")));

    with_group["groups"][0]["interrupted"] = with_group["groups"][0]["held"] = true;
    with_group["groups"][0]["state"] = "GroupStandby";
    EXPECT_THAT(monitor_screen(with_group, layout, {110, 40, false}), Contains(HasSubstr("INTERRUPTED by a person")));
}

// The measure of a way of several axes is the norm of their numbers: no millimetres, and only its share says how far it is.
TEST(MonitorScreen, AWayOfAxesHasNoLength) {
    auto direct = state(2, 0);
    direct["groups"] = Json::array({group()});
    direct["groups"][0]["path_unit"] = "u";
    direct["groups"][0]["command"] = "MC_MoveDirectAbsolute";
    const auto lines = monitor_screen(direct, layout, {110, 40, false});
    EXPECT_THAT(lines, Contains(HasSubstr("200.0 u/s of its axes together, held back by axis a0")));
    EXPECT_THAT(lines, Contains(HasSubstr("MC_MoveDirectAbsolute cell.up  42 %, 0.6 s, 3 wait")));
    EXPECT_THAT(lines, Not(Contains(HasSubstr("to go"))));
}

// In step with its belt, and where the tool is on it; an older runtime says nothing of that.
TEST(MonitorScreen, AGroupThatGoesWithABeltSaysSo) {
    auto on_belt = state(2, 0);
    on_belt["groups"] = Json::array({group()});
    auto& arm = on_belt["groups"][0];
    arm["frames"] = Json::array(
        {{{"frame", "wcs"}, {"axis", ""}, {"tool_set", {1, 2, 3, 0, 0, 0}}, {"tool_actual", {1, 2, 3, 0, 0, 0}}},
         {{"frame", "pcs_2"}, {"axis", "conveyor"}, {"tool_set", {9, 9, 9, 0, 0, 0}}, {"tool_actual", {12.5, -3, 40, 0, 0, 90}}}});
    arm["track"] = "belt";
    arm["track_axis"] = "conveyor";
    arm["track_in_sync"] = false;
    arm["track_lag"] = 4.26;
    auto lines = monitor_screen(on_belt, layout, {120, 40, false});
    EXPECT_THAT(lines, Contains(HasSubstr("pcs_2  X 12.500  Y -3.000  Z 40.000 mm  RX 0.000  RY 0.000  RZ 90.000 deg   with conveyor")));
    EXPECT_THAT(lines, Contains(AllOf(HasSubstr("wcs    X 1.000"), Not(HasSubstr("with ")))));
    EXPECT_THAT(lines, Contains(HasSubstr("with belt conveyor, 4.3 mm behind")));
    arm["track_in_sync"] = true;
    EXPECT_THAT(monitor_screen(on_belt, layout, {120, 40, false}), Contains(HasSubstr("with belt conveyor, in step")));
    arm["track"] = "none";
    EXPECT_THAT(monitor_screen(on_belt, layout, {120, 40, false}), Not(Contains(HasSubstr("with belt"))));
}

// The place behind the room is not lost on a narrow screen.
TEST(MonitorScreen, AGroupSaysWhatItHasRefusedAndWhere) {
    auto refused = state(2, 0);
    refused["groups"] = Json::array({group()});
    refused["groups"][0]["path_unit"] = "deg";
    refused["groups"][0]["refusal"] = {
        {"number", 3},
        {"error", "outside_workspace"},
        {"text", "The path leaves the workspace of the tool"},
        {"remedy", "Lead the path around the room"},
        {"command", "MC_MoveLinearAbsolute"},
        {"block", "cell.up"},
        {"where", "it enters the kept-free room 'post'; at X 45.000 Y 0.000 Z 12.500 mm (MCS); after 45.0 % of its way"}};
    for (const std::size_t columns_there : {80u, 160u}) {
        const auto lines = monitor_screen(refused, layout, {columns_there, 60, false});
        EXPECT_THAT(lines, Contains(HasSubstr("refused MC_MoveLinearAbsolute cell.up: The path leaves")));
        EXPECT_THAT(lines, Contains(HasSubstr("where: it enters the kept-free room 'post'")));
        EXPECT_THAT(lines, Contains(HasSubstr("at X 45.000 Y 0.000 Z 12.500 mm (MCS)")));
        EXPECT_THAT(lines, Contains(HasSubstr("after 45.0 % of its way")));
        EXPECT_THAT(lines, Contains(HasSubstr("-> Lead the path around the room")));
        for (const auto& line : lines) EXPECT_LE(columns(line), columns_there) << line;
    }
    EXPECT_THAT(monitor_screen(refused, layout, {110, 40, false}), Contains(HasSubstr("70.5 deg to go"))) << "of axes that turn";
    refused["time_ns"] = 0;
    refused["events"] =
        Json::array({{{"axis", ""}, {"group", "arm"}, {"time_ns", 0}, {"times", 1}, {"english", "it was refused"}, {"remedy", "x"}}});
    EXPECT_THAT(monitor_screen(refused, layout, {110, 60, false}), Contains(HasSubstr("group arm: it was refused")));
}

TEST(MonitorScreen, AGroupInErrorSaysWhyAlsoWhereThereIsNoRoom) {
    auto broken = state(12, 0);
    broken["groups"] = Json::array({group()});
    auto& arm = broken["groups"][0];
    arm["state"] = "GroupErrorStop";
    arm["error"] = 77;
    arm["error_name"] = "out_of_reach";
    arm["error_text"] = "The tool cannot be there";
    arm["error_cause"] = "It is too far";
    arm["error_remedy"] = "Come nearer";
    auto of_axis = broken;
    of_axis["groups"][0]["error_name"] = "drive_fault";
    of_axis["groups"][0]["error_text"] = "drive_fault of axis elbow";
    for (const std::size_t rows : {24u, 60u}) {
        const auto lines = monitor_screen(broken, layout, {80, rows, false});
        EXPECT_THAT(lines, Contains(HasSubstr("out_of_reach: The tool cannot be there"))) << rows;
        EXPECT_THAT(monitor_screen(of_axis, layout, {80, rows, false}), Contains(StrEq("   drive_fault of axis elbow"))) << rows;
        EXPECT_THAT(lines, Contains(HasSubstr("-> Come nearer"))) << rows;
    }
}

TEST(MonitorScreen, EmergencyStopIsInTheFirstLine) {
    auto stopped = state(1, 0);
    stopped["emergency_stop"] = true;
    EXPECT_THAT(monitor_screen(stopped, layout, {80, 24, true}).front(), HasSubstr("EMERGENCY STOP"));
}

}  // namespace
}  // namespace taktwerk::apps
