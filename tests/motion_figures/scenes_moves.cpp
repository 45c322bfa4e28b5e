#include "fb_library/motion/moves.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

Figure move_absolute() {
    Stage stage;
    MC_MoveAbsolute out, back;
    out.Axis = back.Axis = Stage::ref();
    out.Position = 100, back.Position = 0;
    out.Velocity = back.Velocity = 80;
    out.Acceleration = back.Acceleration = 200;
    out.Deceleration = back.Deceleration = 100;
    out.Jerk = back.Jerk = 2000;
    stage.block("out", out);
    stage.block("back", back);
    stage.show("velocity", "mm/s", 90, {{0, Quantity::velocity}});
    stage.show("acceleration", "mm/s²", 70, {{0, Quantity::acceleration}});
    stage.show("position", "mm", 90, {{0, Quantity::position}});
    stage.run(200ms);
    out.Execute = true;
    stage.run_until([&] { return out.Done; });
    stage.run(300ms);
    out.Execute = false;
    back.Execute = true;
    stage.run_until([&] { return back.Done; });
    stage.run(300ms);
    return stage.figure("move-absolute");
}

Figure move_relative() {
    Stage stage;
    MC_MoveRelative first, second;
    first.Axis = second.Axis = Stage::ref();
    first.Distance = 60, second.Distance = 40;
    first.Velocity = 60, second.Velocity = 40;
    first.Acceleration = first.Deceleration = second.Acceleration = second.Deceleration = 150;
    stage.block("first", first);
    stage.block("second", second);
    stage.run(200ms);
    first.Execute = true;
    stage.run(800ms);
    second.Execute = true;
    stage.run_until([&] { return second.Done; });
    stage.run(300ms);
    return stage.figure("move-relative");
}

/// Interrupts a move to 100 mm: the end is 140 mm.
Figure move_additive() {
    Stage stage;
    MC_MoveAbsolute first;
    MC_MoveAdditive second;
    first.Axis = second.Axis = Stage::ref();
    first.Position = 100, second.Distance = 40;
    first.Velocity = 80, second.Velocity = 50;
    first.Acceleration = first.Deceleration = second.Acceleration = second.Deceleration = 150;
    stage.block("first", first);
    stage.block("second", second);
    stage.run(200ms);
    first.Execute = true;
    stage.run(900ms);
    second.Execute = true;
    stage.run_until([&] { return second.Done; });
    stage.run(300ms);
    return stage.figure("move-additive");
}

/// The worked example of section 2.4.6: at 50 of 100 the distance becomes 130 and the velocity 20.
Figure continuous_update() {
    Stage stage;
    MC_MoveRelative move;
    move.Axis = Stage::ref();
    move.ContinuousUpdate = true;
    move.Distance = 100, move.Velocity = 10, move.Acceleration = move.Deceleration = 20;
    stage.block("move", move);
    stage.run(500ms);
    move.Execute = true;
    stage.run_until([&] { return stage.view().set_position >= 50; });
    move.Distance = 130, move.Velocity = 20;
    stage.run_until([&] { return move.Done; });
    move.Distance = 200;
    stage.run(1s);
    return stage.figure("continuous-update");
}

}  // namespace

std::vector<Figure> moves() { return {move_absolute(), move_relative(), move_additive(), continuous_update()}; }

}  // namespace taktwerk::figures
