// The motor is held by friction, then let go: torque, velocity limit, and a move that takes over.
#include "fb_library/motion/moves.hpp"
#include "fb_library/motion/torque_control.hpp"
#include "fb_library/motion/torque_limit.hpp"
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

/// A target behind a stop at 20 mm: the motor stands there, the torque rises to the limit, and with another limit to that.
Figure torque_limit() {
    Stage stage;
    stage.drive().caps.torque_limits = stage.drive().caps.torque_limit_per_direction = true;
    stage.drive().obeys_torque_limits = true;
    stage.drive().positive_stop = 20 * mm;
    stage.drive().stiffness = 2.0 / (5.0 * mm);
    MC_SetTorqueLimit gentle, firm;
    MC_MoveAbsolute close, open;
    gentle.Axis = firm.Axis = close.Axis = open.Axis = Stage::ref();
    gentle.PositiveLimit = 0.3, firm.PositiveLimit = 0.8;
    close.Position = 23, close.Velocity = 50;
    open.Position = 0, open.Velocity = 100;
    stage.beside("gentle", gentle);
    stage.block("close", close);
    stage.beside("firm", firm);
    stage.block("open", open);
    stage.show("torque", "of rated", 80, {{0, Quantity::actual_torque}});
    stage.show("position", "mm", 90, {{0, Quantity::actual_position, Ink::actual, "motor"}, {0, Quantity::position}});
    stage.run(100ms);
    gentle.Execute = true;
    stage.run(50ms);
    close.Execute = true;
    stage.run_until([&] { return close.Done; });
    stage.run(300ms);
    firm.Execute = true;
    stage.run(300ms);
    open.Execute = true;
    stage.run_until([&] { return open.Done; });
    stage.run(100ms);
    return stage.figure("torque-limit");
}

}  // namespace

std::vector<Figure> torque() { return {torque_control(), torque_limit()}; }

}  // namespace taktwerk::figures
