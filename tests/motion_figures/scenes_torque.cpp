// The motor is held by friction, then let go: torque, velocity limit, and a move that takes over.
#include "fb_library/motion/moves.hpp"
#include "fb_library/motion/torque_control.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

Figure torque_control() {
    auto config = Stage::linear();
    config.control.rated_acceleration = 2000;
    Stage stage{{config}};
    stage.drive().rated_acceleration = 2000 * config.gearing.counts_per_unit();
    stage.drive().friction = 0.4;
    MC_TorqueControl press;
    MC_MoveAbsolute back;
    press.Axis = back.Axis = Stage::ref();
    press.Torque = 0.3, press.TorqueRamp = 1, press.Velocity = 40, press.Acceleration = 400;
    back.Position = 0, back.Velocity = 60, back.Acceleration = back.Deceleration = 400;
    stage.block("press", press);
    stage.block("back", back);
    stage.show("torque", "of rated", 70, {{0, Quantity::given_torque}});
    stage.show("velocity", "mm/s", 90, {{0, Quantity::velocity}});
    stage.show("position", "mm", 70, {{0, Quantity::position}});
    stage.run(200ms);
    press.Execute = true;
    stage.run_until([&] { return press.InTorque; });
    stage.run(200ms);
    stage.drive().friction = 0.05;
    stage.run(500ms);
    back.Execute = true;
    stage.run_until([&] { return back.Done; });
    stage.run(200ms);
    return stage.figure("torque-control");
}

}  // namespace

std::vector<Figure> torque() { return {torque_control()}; }

}  // namespace taktwerk::figures
