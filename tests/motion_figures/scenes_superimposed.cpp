#include "fb_library/motion/moves.hpp"
#include "fb_library/motion/superimposed.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

Figure move_superimposed() {
    Stage stage;
    MC_MoveRelative base;
    MC_MoveSuperimposed added;
    base.Axis = added.Axis = Stage::ref();
    base.Distance = 150, base.Velocity = 60, base.Acceleration = base.Deceleration = 200;
    added.Distance = 30, added.VelocityDiff = 40, added.Acceleration = added.Deceleration = 200;
    stage.block("base", base);
    stage.block("added", added);
    stage.run(200ms);
    base.Execute = true;
    stage.run(700ms);
    added.Execute = true;
    stage.run_until([&] { return base.Done; });
    stage.run(300ms);
    return stage.figure("move-superimposed");
}

Figure halt_superimposed() {
    Stage stage;
    MC_MoveRelative base;
    MC_MoveSuperimposed added;
    MC_HaltSuperimposed halt;
    base.Axis = added.Axis = halt.Axis = Stage::ref();
    base.Distance = 150, base.Velocity = 60, base.Acceleration = base.Deceleration = 200;
    added.Distance = 80, added.VelocityDiff = 40, added.Acceleration = added.Deceleration = 200;
    halt.Deceleration = 100;
    stage.block("base", base);
    stage.block("added", added);
    stage.block("halt", halt);
    stage.run(200ms);
    base.Execute = true;
    stage.run(700ms);
    added.Execute = true;
    stage.run(600ms);
    halt.Execute = true;
    stage.run_until([&] { return base.Done; });
    stage.run(300ms);
    return stage.figure("halt-superimposed");
}

}  // namespace

std::vector<Figure> superimposed() { return {move_superimposed(), halt_superimposed()}; }

}  // namespace taktwerk::figures
