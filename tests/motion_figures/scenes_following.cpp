// How closely the motor follows: a window that grows with the velocity, and what is fed forward for weight and friction.
#include "fb_library/motion/moves.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

/// A position loop of 25 /s without feed-forward: a 25th of a second behind.
Figure following_window() {
    auto config = Stage::linear();
    config.limits.acceleration = config.limits.deceleration = 400;
    config.control = {.mode = axes::ControlMode::velocity, .kv = 25, .feed_forward = 0};
    config.following = {.window = 1.5, .time = 20ms, .per_velocity = 50ms};
    Stage stage{{config}};
    MC_MoveAbsolute fast, slow;
    fast.Axis = slow.Axis = Stage::ref();
    fast.Position = 80, fast.Velocity = 150;
    slow.Position = 60, slow.Velocity = 30;
    stage.block("fast", fast);
    stage.block("slow", slow);
    stage.show("velocity", "mm/s", 80, {{0, Quantity::velocity}});
    stage.show("following error", "mm", 90,
               {{0, Quantity::position, Ink::master, "window", &stage.view().following_window},
                {0, Quantity::position, Ink::plain, "error", &stage.view().following_error}});
    stage.run(100ms);
    fast.Execute = true;
    stage.run_until([&] { return fast.Done; });
    stage.run(300ms);
    slow.Execute = true;
    stage.run_until([&] { return slow.Done; });
    stage.run(200ms);
    return stage.figure("following-window");
}

/// A weight of 0.2 and friction, up and down; the acceleration takes its part.
Figure load_feed_forward() {
    auto config = Stage::linear();
    config.limits.jerk = 10000;
    config.control.torque_feed_forward = 1;
    config.control.rated_acceleration = 5000;
    config.control.load = {.gravity = 0.2, .coulomb_friction = 0.08, .viscous_friction = 0.0006, .friction_velocity = 3};
    Stage stage{{config}};
    MC_MoveAbsolute up, down;
    up.Axis = down.Axis = Stage::ref();
    up.Position = 40, up.Velocity = 120;
    down.Position = 0, down.Velocity = 120;
    stage.block("up", up);
    stage.block("down", down);
    stage.show("velocity", "mm/s", 80, {{0, Quantity::velocity}});
    stage.show("torque offset", "of rated", 110, {{0, Quantity::given_torque}});
    stage.run(100ms);
    up.Execute = true;
    stage.run_until([&] { return up.Done; });
    stage.run(150ms);
    down.Execute = true;
    stage.run_until([&] { return down.Done; });
    stage.run(150ms);
    return stage.figure("load-feed-forward");
}

/// Other limits downwards: the same move to and fro.
Figure direction_limits() {
    auto config = Stage::linear();
    config.limits.negative = {.velocity = 60, .acceleration = 300, .deceleration = 500};
    Stage stage{{config}};
    MC_MoveAbsolute up, down;
    up.Axis = down.Axis = Stage::ref();
    up.Position = 60, up.Velocity = 200;
    down.Position = 0, down.Velocity = 200;
    stage.block("up", up);
    stage.block("down", down);
    stage.show("position", "mm", 80, {{0, Quantity::position}});
    stage.show("velocity", "mm/s", 90, {{0, Quantity::velocity}});
    stage.show("acceleration", "mm/s2", 90, {{0, Quantity::acceleration}});
    stage.run(100ms);
    up.Execute = true;
    stage.run_until([&] { return up.Done; });
    stage.run(100ms);
    down.Execute = true;
    stage.run_until([&] { return down.Done; });
    stage.run(100ms);
    return stage.figure("direction-limits");
}

}  // namespace

std::vector<Figure> following() { return {following_window(), load_feed_forward(), direction_limits()}; }

}  // namespace taktwerk::figures
