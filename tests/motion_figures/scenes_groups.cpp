#include <array>
#include <numbers>

#include "tests/motion_figures/group_stage.hpp"
#include "tests/motion_figures/scenes.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;
using namespace std::chrono_literals;

const GroupStage::Shown path_speed{[](const axes::GroupView& g) { return g.path_velocity; }, "", Ink::owner};

std::vector<GroupStage::Shown> speeds_of_axes(std::vector<std::string> names) {
    std::vector<GroupStage::Shown> out;
    for (std::size_t i = 0; i < names.size(); ++i)
        out.push_back({[i](const axes::GroupView& g) { return g.set_velocity[i]; }, names[i], i == 0 ? Ink::plain : Ink::master});
    return out;
}

MC_MoveLinearAbsolute line_to(double x, double y, double velocity) {
    MC_MoveLinearAbsolute move;
    move.CoordSystem = mcMCS;
    move.Position.C.Tcp = {.X = x, .Y = y};
    move.Velocity = velocity;
    move.Acceleration = move.Deceleration = 800;
    move.Jerk = 8000;
    return move;
}

/// Three sides of a square and a half circle back, commanded at once.
struct Round {
    MC_MoveLinearAbsolute first = line_to(80, 0, 100), second = line_to(80, 60, 100), third = line_to(0, 60, 100);
    MC_MoveCircularAbsolute back;

    explicit Round(MC_BufferMode mode, MC_TransitionMode transition = mcTMNone, double parameter = 0) {
        back.CoordSystem = mcMCS;
        back.CircMode = mcBORDER;
        back.AuxPoint.C.Tcp = {.X = -30, .Y = 30};
        back.Velocity = 100, back.Acceleration = back.Deceleration = 800, back.Jerk = 8000;
        const auto follow = [&](auto& move) {
            move.BufferMode = mode;
            move.TransitionMode = transition;
            move.TransitionParameter.Parameter[0] = parameter;
        };
        follow(second), follow(third), follow(back);
    }
    void command(GroupStage& stage) {
        for (auto* move : {&first, &second, &third}) {
            move->Execute = true;
            stage.scan();
        }
        back.Execute = true;
        stage.scan();
    }
};

Figure round_trip(const std::string& name, Round round) {
    GroupStage stage;
    stage.block("right", round.first), stage.block("up", round.second), stage.block("left", round.third), stage.block("arc", round.back);
    stage.show_way(170);
    stage.show("speed of tool", "mm/s", 80, {path_speed});
    stage.show("velocity", "mm/s", 90, speeds_of_axes({"x", "y"}));
    stage.run(100ms);
    round.command(stage);
    stage.run_until([&] { return round.back.Done; });
    stage.run(150ms);
    return stage.figure(name);
}

/// 100 %, 30 %, 0 and back, while it goes round a corner.
Figure override_on_the_path() {
    GroupStage stage;
    Round round(mcBlendingHigh, mcTMCornerDistance, 15);
    MC_GroupSetOverride factor;
    factor.Enable = true;
    stage.block("right", round.first), stage.block("up", round.second), stage.block("left", round.third), stage.block("arc", round.back);
    stage.block("override", factor);
    stage.show_way(170);
    stage.show("factor", "1", 40, {{[&](const axes::GroupView& g) { return g.override_factors.velocity; }, "", Ink::plain}});
    stage.show("speed of tool", "mm/s", 80, {path_speed});
    stage.show("velocity", "mm/s", 90, speeds_of_axes({"x", "y"}));
    stage.run(100ms);
    round.command(stage);
    stage.run(500ms);
    factor.VelFactor = 0.3;
    stage.run(900ms);
    factor.VelFactor = 0;
    stage.run(600ms);
    factor.VelFactor = 1;
    stage.run_until([&] { return round.back.Done; });
    stage.run(150ms);
    return stage.figure("group-override");
}

Figure interrupt_and_continue() {
    GroupStage stage;
    Round round(mcBlendingHigh, mcTMCornerDistance, 15);
    MC_GroupInterrupt hold;
    MC_GroupContinue go_on;
    hold.Deceleration = 800, hold.Jerk = 8000;
    stage.block("right", round.first), stage.block("up", round.second), stage.block("left", round.third), stage.block("arc", round.back);
    stage.block("interrupt", hold), stage.block("continue", go_on);
    stage.show_way(170);
    stage.show("speed of tool", "mm/s", 80, {path_speed});
    stage.show("velocity", "mm/s", 90, speeds_of_axes({"x", "y"}));
    stage.run(100ms);
    round.command(stage);
    stage.run_until([&] { return stage.view().tool_set[0] > 60; });
    hold.Execute = true;
    stage.run_until([&] { return hold.Done; });
    stage.run(300ms);
    go_on.Execute = true;
    stage.run_until([&] { return round.back.Done; });
    stage.run(150ms);
    return stage.figure("group-interrupt");
}

Figure halt_and_stop() {
    GroupStage stage;
    auto way = line_to(120, 60, 150), again = line_to(0, 0, 150);
    MC_GroupHalt halt;
    MC_GroupStop stop;
    halt.Deceleration = 800, halt.Jerk = 8000;
    stop.Deceleration = 1000, stop.Jerk = 10000;
    stage.block("way", way), stage.block("halt", halt), stage.block("again", again), stage.block("stop", stop);
    stage.show("speed of tool", "mm/s", 80, {path_speed});
    stage.show("velocity", "mm/s", 90, speeds_of_axes({"x", "y"}));
    stage.run(100ms);
    way.Execute = true;
    stage.run(500ms);
    halt.Execute = true;
    stage.run_until([&] { return halt.Done; });
    stage.run(150ms);
    again.Execute = true;
    stage.run(400ms);
    stop.Execute = true;
    stage.run_until([&] { return stop.Done; });
    stage.run(200ms);
    stop.Execute = false;
    stage.run(150ms);
    return stage.figure("group-halt-stop");
}

constexpr std::array joint_speed{180.0, 180.0, 100.0, 360.0};  ///< deg/s, deg/s, mm/s, deg/s
constexpr double joint_acceleration = 1500;

/// A SCARA of 200 and 150 mm draws a line past its own foot: the share that each joint takes of what it may.
Figure who_holds_back() {
    std::vector<axes::AxisConfig> configs;
    for (std::size_t i = 0; i < joint_speed.size(); ++i) {
        auto config = GroupStage::linear("j" + std::to_string(i + 1));
        config.limits = {.velocity = joint_speed[i], .acceleration = joint_acceleration, .deceleration = joint_acceleration, .jerk = 20000};
        configs.push_back(config);
    }
    axes::KinematicsDescription scara{.arm = axes::ScaraLengths{.first = 200, .second = 150}};
    for (const std::size_t turning : {0, 1, 3}) scara.joints[turning].unit = std::numbers::pi / 180;
    GroupStage stage(configs, axes::test::arm_of(scara));
    MC_MoveDirectAbsolute ready;
    ready.Position.A.Axes = {-106.87, 83.88, 0, 0};  // the tool at 80, -250
    ready.Velocity = 100;
    stage.beforehand(ready);
    auto across = line_to(80, 250, 600);
    across.Acceleration = across.Deceleration = 3000, across.Jerk = 40000;
    stage.block("across", across);
    stage.show("speed of tool", "mm/s", 80, {path_speed});
    std::vector<GroupStage::Shown> velocities, accelerations;
    for (std::size_t i = 0; i < 2; ++i) {
        const auto name = "j" + std::to_string(i + 1);
        const auto ink = i == 0 ? Ink::plain : Ink::master;
        velocities.push_back({[i](const axes::GroupView& g) { return 100 * g.set_velocity[i] / joint_speed[i]; }, name, ink});
        accelerations.push_back({[i](const axes::GroupView& g) { return 100 * g.set_acceleration[i] / joint_acceleration; }, name, ink});
    }
    stage.show("of its velocity", "%", 90, velocities);
    stage.show("of its acceleration", "%", 90, accelerations);
    stage.run(100ms);
    across.Execute = true;
    stage.run_until([&] { return across.Done; });
    stage.run(100ms);
    return stage.figure("group-who-holds-back");
}

}  // namespace

std::vector<Figure> groups() {
    return {round_trip("group-buffered", Round(mcBuffered)),
            round_trip("group-corner-distance", Round(mcBlendingHigh, mcTMCornerDistance, 15)),
            round_trip("group-corner-deviation", Round(mcBlendingHigh, mcTMMaxCornerDeviation, 1)),
            override_on_the_path(),
            interrupt_and_continue(),
            halt_and_stop(),
            who_holds_back()};
}

}  // namespace taktwerk::figures
