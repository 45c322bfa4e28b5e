// What people are told of a group is where its axes are: the SCARA's tool in `state` against its two links by hand, its speed against the way that it
// goes, the axis that holds it back against that axis' limits. And the same in the memory of the scope, to the last bit.

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <nlohmann/json.hpp>

#include "hmi_bridge/runtime_link.hpp"
#include "hmi_bridge/socket/json_state.hpp"
#include "runtime/recording/signal_ring.hpp"
#include "tests/programs/examples/example_machine.hpp"

namespace taktwerk::group_seen {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;
using runtime::OperatorAction;
using testing::ExampleMachine;

constexpr double degree = std::numbers::pi / 180;
const std::vector<std::string> joints{"shoulder", "elbow", "lift", "wrist"};
/// config/machines/scara.yaml: deg/s, deg/s2, deg/s3; of the lift mm.
const std::map<std::string, std::array<double, 3>> limits{
    {"shoulder", {300, 2000, 40000}}, {"elbow", {300, 2000, 40000}}, {"lift", {300, 2000, 40000}}, {"wrist", {600, 5000, 100000}}};

struct Tool {
    double x, y, z, rz;
};
/// Two links of 200 and 150 mm; the wrist turns below them.
Tool forward(double shoulder, double elbow, double lift, double wrist) {
    const double a = shoulder * degree, b = a + elbow * degree;
    return {200 * std::cos(a) + 150 * std::cos(b), 200 * std::sin(a) + 150 * std::sin(b), lift, shoulder + elbow + wrist};
}

struct Scara {
    Scara() { EXPECT_TRUE(m.up()); }
    Json state() { return Json::parse(hmi::state_json(m.snapshot(), link)); }
    Json group() { return state()["groups"][0]; }
    const runtime::SeenGroup& seen() { return m.snapshot().groups[0]; }
    bool until_it_draws() {
        return m.until([&] { return m.variable("laps") > 0 && seen().along.velocity > 150; }, 20s);
    }
    runtime::CommandAnswer order(OperatorAction action, double value = 0) {
        runtime::OperatorCommand command;
        command.action = action;
        command.index = 0;
        command.value = value;
        return m.command(command);
    }
    double setpoint(const std::string& axis) { return m.axis(axis).set_position; }

    ExampleMachine m{"scara"};
    hmi::RuntimeLink link{m.machine()};
};

TEST(GroupSeen, TheToolIsWhereItsJointsAre) {
    Scara s;
    ASSERT_TRUE(s.until_it_draws());
    Tool before{};
    int looked = 0;
    double fastest = 0;
    s.m.each_cycle = [&] {
        const auto& axes = s.m.snapshot();
        std::map<std::string, double> set, actual;
        for (const auto& name : joints) {
            set[name] = s.m.axis(name).set_position;
            actual[name] = s.m.axis(name).actual_position;
        }
        const auto at = forward(set["shoulder"], set["elbow"], set["lift"], set["wrist"]);
        const auto is = forward(actual["shoulder"], actual["elbow"], actual["lift"], actual["wrist"]);
        const auto& tool = axes.groups[0].tool;
        ASSERT_TRUE(tool.known);
        EXPECT_NEAR(tool.set[0], at.x, 1e-9);
        EXPECT_NEAR(tool.set[1], at.y, 1e-9);
        EXPECT_NEAR(tool.set[2], at.z, 1e-9);
        EXPECT_NEAR(std::remainder(tool.set[5] - at.rz, 360), 0, 1e-9);
        EXPECT_NEAR(tool.actual[0], is.x, 1e-9);
        EXPECT_NEAR(tool.actual[1], is.y, 1e-9);
        // Told with shown: the speed is the way of a millisecond, but for what the acceleration (2000 mm/s2, and the curve's) makes of that time.
        if (looked > 0) {
            EXPECT_NEAR(tool.speed, std::hypot(at.x - before.x, at.y - before.y, at.z - before.z) / 1e-3, 0.5e-3 * 6000);
        }
        EXPECT_NEAR(tool.speed, axes.groups[0].along.velocity, 1e-6 * 200) << "the path is the tool's";
        fastest = std::max(fastest, tool.speed);
        before = at;
        ++looked;
    };
    s.m.run(2s);
    EXPECT_GE(looked, 1900);
    EXPECT_NEAR(fastest, 200, 0.2) << "mm/s: the parameter `speed`";

    const auto group = s.group();
    EXPECT_EQ(group["name"], "arm");
    EXPECT_EQ(group["state"], "GroupMoving");
    EXPECT_EQ(group["tool_known"], true);
    const auto at = forward(s.setpoint("shoulder"), s.setpoint("elbow"), s.setpoint("lift"), s.setpoint("wrist"));
    EXPECT_NEAR(group["tool_set"][0].get<double>(), at.x, 1e-9);
    EXPECT_NEAR(group["tool_set"][1].get<double>(), at.y, 1e-9);
    ASSERT_EQ(group["members"].size(), 4u);
    for (std::size_t i = 0; i < joints.size(); ++i) {
        EXPECT_EQ(group["members"][i]["axis"], joints[i]);
        EXPECT_EQ(group["members"][i]["ident"], i + 1);
        EXPECT_EQ(group["members"][i]["set_position"].get<double>(), s.setpoint(joints[i]));
    }
    EXPECT_TRUE(group["command"] == "MC_MoveLinearAbsolute" || group["command"] == "MC_MoveCircularAbsolute") << group["command"];
    EXPECT_GT(group["progress"].get<double>(), 0);
    EXPECT_LT(group["progress"].get<double>(), 1);
}

// The delta's tray (config/machines/delta-picker.yaml: pcs_2 at -75, 110, -900 mm, turned by 3 deg) stands; its part (pcs) goes along X with the belt, at
// 90 mm/s, and so does what is told of it.
TEST(GroupSeen, TheToolIsToldFromEachFrameThatSomebodySet) {
    ExampleMachine m{"delta-picker"};
    hmi::RuntimeLink link{m.machine()};
    ASSERT_TRUE(m.up());
    m.run(10ms);
    const auto group = [&] { return Json::parse(hmi::state_json(m.snapshot(), link))["groups"][0]; };
    ASSERT_EQ(group()["frames"].size(), 1u) << "no part is on the belt yet: only the tray is there";
    const auto frame = [&](const Json& of, const char* name) {
        for (const auto& one : of["frames"])
            if (one["frame"] == name) return one;
        return Json{};
    };
    int in_step = 0, behind = 0, compared = 0, cycle = 0;
    double before = 0;
    bool was_in_step = false;
    // To read the whole state's text takes ten times what the cycle does: two cycles in succession are looked at, of each eight.
    m.each_cycle = [&] {
        const int place = cycle++ % 8;
        if (place > 1) return;
        was_in_step = was_in_step && place == 1;
        const auto now = group();
        ASSERT_EQ(now["tool_known"], true);
        for (const char* of : {"tool_set", "tool_actual"}) {
            const auto tray = frame(now, "pcs_2");
            EXPECT_EQ(tray["axis"], "");
            const double x = now[of][0].get<double>() + 75, y = now[of][1].get<double>() - 110, c = std::cos(3 * degree),
                         s = std::sin(3 * degree);
            EXPECT_NEAR(tray[of][0].get<double>(), c * x + s * y, 1e-9);
            EXPECT_NEAR(tray[of][1].get<double>(), c * y - s * x, 1e-9);
            EXPECT_NEAR(tray[of][2].get<double>(), now[of][2].get<double>() + 900, 1e-9);
            EXPECT_NEAR(tray[of][5].get<double>(), now[of][5].get<double>() - 3, 1e-9) << "deg";
        }
        const auto part = frame(now, "pcs");
        if (now["track"] == "none") {
            EXPECT_EQ(now["track_axis"], "");
            EXPECT_EQ(now["track_in_sync"], false);
            was_in_step = false;
            return;
        }
        EXPECT_EQ(now["track"], "belt");
        EXPECT_EQ(now["track_axis"], "belt");
        ASSERT_FALSE(part.is_null());
        EXPECT_EQ(part["axis"], "belt");
        const double moved = now["tool_set"][0].get<double>() - part["tool_set"][0].get<double>();
        const bool in_sync = now["track_in_sync"].get<bool>();
        if (in_sync && was_in_step) {
            EXPECT_NEAR(moved - before, 0.09, 0.002) << "mm in a cycle, but for what the belt's encoder rounds";
            EXPECT_NEAR(now["track_lag"].get<double>(), 0, 1e-9);
            ++compared;
        }
        (in_sync ? in_step : behind) += 1;
        was_in_step = in_sync;
        before = moved;
    };
    m.run(12s);
    EXPECT_GT(in_step, 200);
    EXPECT_GT(behind, 50);
    EXPECT_GT(compared, 200);
}

// 1 = at the limit, of velocity, acceleration and jerk of each axis; who is named as holding the path back is at its limit.
TEST(GroupSeen, WhoHoldsThePathBackIsAtItsLimit) {
    Scara s;
    s.m.set_parameter("speed", 500);  // more than the axes give
    ASSERT_TRUE(s.until_it_draws());
    std::map<std::string, double> before;
    std::map<std::string, int> named;
    int by_command = 0;
    s.m.each_cycle = [&] {
        const auto& group = s.seen();
        for (std::size_t i = 0; i < joints.size(); ++i) {
            const auto& axis = s.m.axis(joints[i]);
            const auto& most = limits.at(joints[i]);
            EXPECT_NEAR(group.use[i].velocity, std::abs(axis.set_velocity) / most[0], 1e-6);
            EXPECT_NEAR(group.use[i].acceleration, std::abs(axis.set_acceleration) / most[1], 1e-6);
            if (before.contains(joints[i])) {
                EXPECT_NEAR(group.use[i].jerk, std::abs(axis.set_acceleration - before[joints[i]]) / 1e-3 / most[2], 1e-4);
            }
            EXPECT_LE(group.use[i].velocity, 1 + 1e-6);
            EXPECT_LE(group.use[i].acceleration, 1 + 1e-6);
            EXPECT_LE(group.use[i].jerk, 1 + 1e-3);
            before[joints[i]] = axis.set_acceleration;
        }
        const auto& along = group.along;
        if (along.limiter == axes::PathLimiter::axis) {
            const auto& use = group.use[along.limiting_place];
            EXPECT_GE(std::max({use.velocity, use.acceleration, use.jerk}), 0.98F - 1e-4F);
            ++named[joints[along.limiting_place]];
        }
        by_command += along.limiter == axes::PathLimiter::command ? 1 : 0;
    };
    s.m.run(3s);
    int held = 0;
    for (const auto& [axis, times] : named) held += times;
    EXPECT_GT(held, 50) << "no axis was at its limit: this has shown nothing";
    EXPECT_GT(by_command, 50);
    // In words, with the name.
    s.m.each_cycle = {};
    ASSERT_TRUE(s.m.until([&] { return s.seen().along.limiter == axes::PathLimiter::axis; }, 5s));
    const auto group = s.group();
    EXPECT_EQ(group["limiter"], "axis_limit");
    EXPECT_EQ(group["limiting_axis"], joints[s.seen().along.limiting_place]);
}

/// By what is behind "group.arm.": what the snapshot of the same cycle has.
double of_the_snapshot(const runtime::SeenGroup& g, const std::string& name) {
    const auto& tool = g.tool;
    const auto& along = g.along;
    const std::map<std::string, double> plain{{"state", static_cast<double>(g.state)},
                                              {"tool_x", tool.set[0]},
                                              {"tool_y", tool.set[1]},
                                              {"tool_z", tool.set[2]},
                                              {"tool_rx", tool.set[3]},
                                              {"tool_ry", tool.set[4]},
                                              {"tool_rz", tool.set[5]},
                                              {"tool_actual_x", tool.actual[0]},
                                              {"tool_actual_y", tool.actual[1]},
                                              {"tool_actual_z", tool.actual[2]},
                                              {"tool_actual_rx", tool.actual[3]},
                                              {"tool_actual_ry", tool.actual[4]},
                                              {"tool_actual_rz", tool.actual[5]},
                                              {"tool_speed", tool.speed},
                                              {"tool_actual_speed", tool.actual_speed},
                                              {"path_velocity", along.velocity},
                                              {"path_acceleration", along.acceleration},
                                              {"distance_to_go", along.to_go},
                                              {"progress", 100 * along.progress},
                                              {"limiter", static_cast<double>(along.limiter)},
                                              {"command", static_cast<double>(g.active_kind)},
                                              {"active", static_cast<double>(g.active)},
                                              {"error", static_cast<double>(g.error)},
                                              {"queued", static_cast<double>(g.queued)},
                                              {"interrupted", g.interrupted ? 1.0 : 0.0},
                                              {"path_deviation", g.path_deviation},
                                              {"track", static_cast<double>(g.track.kind)},
                                              {"track_in_sync", g.track.in_sync ? 1.0 : 0.0},
                                              {"track_lag", g.track.lag}};
    if (const auto found = plain.find(name); found != plain.end()) return found->second;
    if (name == "limiting_axis") return along.limiter == axes::PathLimiter::axis ? g.members[along.limiting_place].index + 1.0 : 0.0;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const auto percent = [](float part) { return std::floor(static_cast<double>(part * 10'000.0F + 0.5F)) / 100; };
        if (name == joints[i] + "_velocity_use") return percent(g.use[i].velocity);
        if (name == joints[i] + "_acceleration_use") return percent(g.use[i].acceleration);
        if (name == joints[i] + "_jerk_use") return percent(g.use[i].jerk);
    }
    ADD_FAILURE() << "nobody knows " << name;
    return 0;
}

TEST(GroupSeen, TheScopeHasWhatTheStateShows) {
    Scara s;
    const auto& ring = s.m.machine().signals();
    std::vector<std::uint64_t> row(ring.words());
    std::map<std::string, double> first;
    std::set<std::string> moved;
    int looked = 0;
    s.m.each_cycle = [&] {
        const auto& snapshot = s.m.snapshot();
        if (snapshot.cycle % 8 != 0) return;  // the words of this test are slow
        ASSERT_TRUE(ring.read_row(snapshot.cycle, row));
        for (const auto& signal : ring.signals()) {
            if (signal.group != runtime::SignalGroup::group) continue;
            EXPECT_EQ(signal.of, "arm");
            const double shown = signal.cell.value_of(row[signal.cell.word]);
            const double wanted = of_the_snapshot(snapshot.groups[0], signal.name.substr(std::string("group.arm.").size()));
            if (snapshot.groups[0].tool.known || signal.name.find(".tool_") == std::string::npos) {
                ASSERT_EQ(std::bit_cast<std::uint64_t>(shown), std::bit_cast<std::uint64_t>(wanted)) << signal.name << ' ' << shown;
                if (!first.contains(signal.name)) first[signal.name] = shown;
                else if (first[signal.name] != shown) moved.insert(signal.name);
            }
            ++looked;
        }
    };
    s.m.run(6s);
    EXPECT_GT(looked, 700 * 30);
    for (const auto* name : {"tool_x", "tool_y", "tool_actual_x", "tool_speed", "path_velocity", "progress", "state", "command", "active",
                             "limiter", "shoulder_velocity_use", "elbow_acceleration_use", "wrist_jerk_use"})
        EXPECT_TRUE(moved.contains(std::string("group.arm.") + name)) << name << " never changed: this has shown nothing of it";
}

// A person holds it on the path and lets it go on; the program's commands stay, and the path is the same.
TEST(GroupSeen, APersonInterruptsAndTheToolStaysOnItsPath) {
    Scara s;
    ASSERT_TRUE(s.until_it_draws());
    EXPECT_EQ(s.order(OperatorAction::group_continue).answer, runtime::Answer::refused_by_axis) << "nobody has interrupted it";
    double off = 0;
    s.m.each_cycle = [&] {
        const auto& tool = s.seen().tool.set;
        const double past = std::abs(tool[1]) > 60 ? std::hypot(tool[0] - 240, std::abs(tool[1]) - 60) : std::abs(tool[0] - 240);
        off = std::max(off, std::abs(past - 20));
    };
    const auto laps = s.m.variable("laps");

    ASSERT_EQ(s.order(OperatorAction::group_interrupt).answer, runtime::Answer::accepted);
    ASSERT_TRUE(s.m.until([&] { return s.seen().interrupted; }, 1s));
    EXPECT_TRUE(s.seen().held);
    EXPECT_EQ(s.group()["held"], true);
    EXPECT_EQ(s.order(OperatorAction::group_interrupt).error, axes::ErrorId::state_forbids) << "it is interrupted already";
    const auto at = s.seen().tool.set;
    s.m.run(500ms);
    EXPECT_EQ(s.seen().tool.set, at);
    EXPECT_EQ(s.seen().tool.speed, 0);

    ASSERT_EQ(s.order(OperatorAction::group_continue).answer, runtime::Answer::accepted);
    ASSERT_TRUE(s.m.until([&] { return s.m.variable("laps") >= laps + 2; }, 20s));
    EXPECT_FALSE(s.seen().interrupted);
    EXPECT_FALSE(s.seen().held);
    EXPECT_LE(off, 0.5) << "mm: no more than at the corners";
    EXPECT_EQ(s.m.variable("failed"), 0);
    EXPECT_EQ(s.m.alarms(), "");
}

// The operator's override: of the group, and of one of its axes, slow the tool down, and the smaller one acts. 0 holds it.
TEST(GroupSeen, AnOverrideSlowsTheToolAndBendsNothing) {
    Scara s;
    ASSERT_TRUE(s.until_it_draws());
    const auto fastest_of = [&](Duration time) {
        double fastest = 0;
        s.m.run(500ms);
        s.m.each_cycle = [&] { fastest = std::max(fastest, s.seen().tool.speed); };
        s.m.run(time);
        s.m.each_cycle = {};
        return fastest;
    };
    ASSERT_EQ(s.order(OperatorAction::group_override, 0.5).answer, runtime::Answer::accepted);
    EXPECT_NEAR(fastest_of(4s), 100, 0.1);
    EXPECT_EQ(s.group()["operators_override"], 0.5);
    EXPECT_EQ(s.group()["limiter"], "override_factor");

    runtime::OperatorCommand of_an_axis;
    of_an_axis.action = OperatorAction::override_velocity;
    of_an_axis.axis = 1;
    of_an_axis.value = 0.25;
    ASSERT_EQ(s.m.command(of_an_axis).answer, runtime::Answer::accepted);
    EXPECT_NEAR(fastest_of(4s), 50, 0.1);
    of_an_axis.value = 0;
    ASSERT_EQ(s.m.command(of_an_axis).answer, runtime::Answer::accepted);
    EXPECT_EQ(fastest_of(1s), 0);
    EXPECT_EQ(s.group()["state"], "GroupMoving");
    of_an_axis.value = 1;
    ASSERT_EQ(s.m.command(of_an_axis).answer, runtime::Answer::accepted);
    ASSERT_EQ(s.order(OperatorAction::group_override, 1).answer, runtime::Answer::accepted);
    EXPECT_NEAR(fastest_of(4s), 200, 0.1);

    EXPECT_EQ(s.order(OperatorAction::group_override, 1.5).answer, runtime::Answer::bad_value);
    EXPECT_EQ(s.order(OperatorAction::group_override, std::nan("")).answer, runtime::Answer::bad_value);
    EXPECT_EQ(s.m.alarms(), "");
}

// Whose the axes are decides who enables and disables; a stop is everybody's, and makes a `continue` stale that was given before it.
TEST(GroupSeen, OfAProgramsGroupAPersonMayOnlyHoldItBack) {
    Scara s;
    ASSERT_TRUE(s.until_it_draws());
    for (const auto action : {OperatorAction::group_enable, OperatorAction::group_disable}) {
        const auto answer = s.order(action);
        EXPECT_EQ(answer.answer, runtime::Answer::no_control);
        EXPECT_EQ(answer.owner, axes::Owner::program);
    }
    runtime::OperatorCommand none;
    none.action = OperatorAction::group_interrupt;
    none.index = 1;
    EXPECT_EQ(s.m.command(none).answer, runtime::Answer::unknown_name);

    ASSERT_EQ(s.order(OperatorAction::group_interrupt).answer, runtime::Answer::accepted);
    ASSERT_TRUE(s.m.until([&] { return s.seen().interrupted; }, 1s));
    const auto raised = s.m.machine().levels_raised();
    (void)s.m.machine().request_stop(2);
    s.m.run(5ms);
    runtime::OperatorCommand late;
    late.action = OperatorAction::group_continue;
    late.index = 0;
    late.after = raised;
    EXPECT_EQ(s.m.command(late).answer, runtime::Answer::stale);
    EXPECT_FALSE(s.seen().interrupted) << "a stop ends what is interrupted: a program could go on with it";
}

// Its program brings it to the slot by MC_MoveDirectAbsolute: joints in deg turn together, and their norm is no length. Along a line it is the tool's.
TEST(GroupSeen, AWayOfJointsIsNoLength) {
    Scara s;
    ASSERT_TRUE(
        s.m.until([&] { return s.seen().active_kind == axes::GroupCommandKind::direct_absolute && s.seen().along.velocity > 0; }, 20s));
    EXPECT_EQ(s.group()["path_unit"], "u");
    ASSERT_TRUE(s.until_it_draws());
    EXPECT_EQ(s.group()["path_unit"], "mm");
}

// A member's drive fails in the middle: the group says why in words.
TEST(GroupSeen, AnErrorIsSaidInWords) {
    Scara s;
    ASSERT_TRUE(s.until_it_draws());
    EXPECT_EQ(s.group()["error"], 0);
    EXPECT_FALSE(s.group().contains("error_name"));
    s.m.world().drive("elbow")->raise(0x2310);
    ASSERT_TRUE(s.m.until([&] { return s.seen().state == axes::GroupState::GroupErrorStop; }, 500ms));
    const auto group = s.group();
    EXPECT_EQ(group["state"], "GroupErrorStop");
    EXPECT_EQ(group["error"], s.m.axis("elbow").error);
    EXPECT_EQ(group["error_name"], "drive_fault");
    EXPECT_EQ(group["error_text"], "drive_fault of axis elbow");
    EXPECT_NE(group["error_remedy"], "");
}

}  // namespace
}  // namespace taktwerk::group_seen
