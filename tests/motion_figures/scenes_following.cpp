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

}  // namespace

std::vector<Figure> following() { return {following_window()}; }

}  // namespace taktwerk::figures
