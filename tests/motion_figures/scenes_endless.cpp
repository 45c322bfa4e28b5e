#include "fb_library/motion/endless_moves.hpp"
#include "fb_library/motion/override.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

/// Figures 10 and 11 of the standard: one instance, three edges.
Figure move_velocity() {
    Stage stage;
    MC_MoveVelocity run;
    run.Axis = Stage::ref();
    run.Acceleration = run.Deceleration = 100;
    stage.block("run", run);
    stage.run(200ms);
    for (const double velocity : {40.0, 80.0, 0.0}) {
        run.Velocity = velocity;
        run.Execute = true;
        stage.run(300ms);
        run.Execute = false;
        stage.run_until([&] { return run.InVelocity; });
        stage.run(300ms);
    }
    return stage.figure("move-velocity");
}

Figure move_continuous(const std::string& name, double end_velocity) {
    Stage stage;
    MC_MoveContinuousAbsolute cut;
    cut.Axis = Stage::ref();
    cut.Position = 80, cut.EndVelocity = end_velocity, cut.Velocity = 100, cut.Acceleration = cut.Deceleration = 250;
    stage.block("cut", cut);
    stage.run(200ms);
    cut.Execute = true;
    stage.run_until([&] { return cut.InEndVelocity; });
    stage.run(700ms);
    return stage.figure(name);
}

/// Figure 36 of the standard, in short.
Figure set_override() {
    Stage stage;
    MC_MoveVelocity run;
    MC_SetOverride factors;
    run.Axis = factors.Axis = Stage::ref();
    run.Velocity = 80, run.Acceleration = run.Deceleration = 200;
    stage.block("run", run);
    stage.block("override", factors);
    stage.run(200ms);
    run.Execute = true;
    stage.run_until([&] { return run.InVelocity; });
    stage.run(300ms);
    factors.VelFactor = 0.5;
    factors.Enable = true;
    stage.run(600ms);
    factors.VelFactor = 0;
    stage.run(600ms);
    factors.VelFactor = 1;
    stage.run(200ms);
    factors.Enable = false;
    stage.run(600ms);
    return stage.figure("set-override");
}

}  // namespace

std::vector<Figure> endless_moves() {
    return {move_velocity(), set_override(), move_continuous("move-continuous", 30), move_continuous("move-continuous-back", -50)};
}

}  // namespace taktwerk::figures
