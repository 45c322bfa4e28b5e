#include "fb_library/motion/endless_moves.hpp"
#include "fb_library/motion/stops.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

/// A new command during the ramp takes the axis from MC_Halt.
Figure halt() {
    Stage stage;
    MC_MoveVelocity run;
    MC_Halt halt;
    run.Axis = halt.Axis = Stage::ref();
    run.Velocity = 50, run.Acceleration = 100, halt.Deceleration = 50;
    stage.block("run", run);
    stage.block("halt", halt);
    stage.run(200ms);
    const auto press = [&](auto& block) {
        block.Execute = true;
        stage.run(100ms);
        block.Execute = false;
    };
    press(run);
    stage.run_until([&] { return run.InVelocity; });
    stage.run(200ms);
    press(halt);
    stage.run(400ms);
    press(run);
    stage.run_until([&] { return run.InVelocity; });
    stage.run(200ms);
    halt.Execute = true;
    stage.run_until([&] { return halt.Done; });
    stage.run(200ms);
    halt.Execute = false;
    stage.run(200ms);
    return stage.figure("halt");
}

/// While MC_Stop is held nothing moves the axis.
Figure stop() {
    Stage stage;
    MC_MoveVelocity run;
    MC_Stop stop;
    run.Axis = stop.Axis = Stage::ref();
    run.Velocity = 50, run.Acceleration = 100, stop.Deceleration = 100;
    stage.block("run", run);
    stage.block("stop", stop);
    stage.run(200ms);
    run.Execute = true;
    stage.run_until([&] { return run.InVelocity; });
    stage.run(200ms);
    stop.Execute = true;
    stage.run(200ms);
    run.Execute = false;
    stage.run_until([&] { return stop.Done; });
    stage.run(300ms);
    run.Execute = true;
    stage.run(300ms);
    run.Execute = false;
    stage.run(100ms);
    stop.Execute = false;
    stage.run(100ms);
    run.Execute = true;
    stage.run_until([&] { return run.InVelocity; });
    stage.run(200ms);
    return stage.figure("stop");
}

}  // namespace

std::vector<Figure> stops() { return {halt(), stop()}; }

}  // namespace taktwerk::figures
