#include "fb_library/motion/endless_moves.hpp"
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

}  // namespace

std::vector<Figure> endless_moves() { return {move_velocity()}; }

}  // namespace taktwerk::figures
