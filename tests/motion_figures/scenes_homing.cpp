// Steps of PLCopen Part 5. 1 mm is 10000 counts.
#include "fb_library/motion/homing_ends.hpp"
#include "fb_library/motion/homing_passive.hpp"
#include "fb_library/motion/homing_steps.hpp"
#include "fb_library/motion/moves.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

void show_switches(Stage& stage) {
    stage.signal("home switch", [&] { return stage.view().home_switch; });
    stage.signal("limit switch", [&] { return stage.view().positive_limit_switch; });
    stage.signal("homed", [&] { return stage.view().homed; });
}

/// The search begins on the wrong side of the switch.
Figure absolute_switch() {
    Stage stage;
    stage.drive().switches = true;
    stage.drive().home_low = -20 * mm, stage.drive().home_high = -15 * mm;
    stage.drive().positive_end = 25 * mm;
    MC_StepAbsoluteSwitch search;
    MC_FinishHoming finish;
    search.Axis = finish.Axis = Stage::ref();
    search.Direction = MC_HomeDirection::mcPositiveDirection;
    search.Velocity = 40, search.Acceleration = search.Deceleration = 400, search.SetPosition = 100;
    finish.Distance = 12, finish.Velocity = 20, finish.Acceleration = finish.Deceleration = 400, finish.BufferMode = mcBuffered;
    show_switches(stage);
    stage.block("search", search);
    stage.block("finish", finish);
    stage.run(200ms);
    search.Execute = true;
    stage.run(100ms);
    finish.Execute = true;
    stage.run_until([&] { return finish.Done; });
    stage.run(200ms);
    return stage.figure("homing-switch");
}

Figure block() {
    Stage stage;
    stage.drive().negative_stop = -20 * mm;
    stage.drive().stiffness = 0.25 / mm;
    MC_StepBlock search;
    MC_FinishHoming finish;
    search.Axis = finish.Axis = Stage::ref();
    search.Direction = MC_HomeDirection::mcNegativeDirection;
    search.Velocity = 20, search.Acceleration = search.Deceleration = 200;
    search.TorqueLimit = 0.3, search.DetectionVelocityLimit = 1, search.DetectionVelocityTime = 50ms;
    finish.Distance = 10, finish.Velocity = 20, finish.Acceleration = finish.Deceleration = 200, finish.BufferMode = mcBuffered;
    stage.signal("homed", [&] { return stage.view().homed; });
    stage.block("search", search);
    stage.block("finish", finish);
    stage.show("torque", "of rated", 70, {{0, Quantity::actual_torque, Ink::plain}});
    stage.show("position", "mm", 110, {{0, Quantity::actual_position, Ink::actual, "actual"}, {0, Quantity::position, Ink::owner, "set"}});
    stage.run(200ms);
    search.Execute = true;
    stage.run(100ms);
    finish.Execute = true;
    stage.run_until([&] { return finish.Done; });
    stage.run(200ms);
    return stage.figure("homing-block");
}

/// The switch stands at 20 mm of what the axis believes, and is at 30.
Figure flying() {
    Stage stage;
    stage.drive().switches = true;
    stage.drive().home_low = 20 * mm, stage.drive().home_high = 24 * mm;
    MC_MoveAbsolute move;
    MC_StepReferenceFlyingSwitch flying;
    move.Axis = flying.Axis = Stage::ref();
    move.Position = 60, move.Velocity = 40, move.Acceleration = move.Deceleration = 200;
    flying.SetPosition = 30;
    stage.signal("home switch", [&] { return stage.view().home_switch; });
    stage.signal("homed", [&] { return stage.view().homed; });
    stage.block("move", move);
    stage.beside("flying", flying);
    stage.run(200ms);
    flying.Execute = true;
    stage.run(100ms);
    move.Execute = true;
    stage.run_until([&] { return move.Done; });
    stage.run(200ms);
    return stage.figure("homing-flying");
}

}  // namespace

std::vector<Figure> homing() { return {absolute_switch(), block(), flying()}; }

}  // namespace taktwerk::figures
