#include "fb_library/motion/brake.hpp"
#include "fb_library/motion/endless_moves.hpp"
#include "fb_library/motion/moves.hpp"
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

/// The same drive warning at the same speed, answered in three ways.
Figure reactions() {
    using axes::ErrorReaction;
    std::vector<axes::AxisConfig> configs;
    for (const auto reaction : {ErrorReaction::ramp_then_off, ErrorReaction::quick_stop, ErrorReaction::power_off}) {
        configs.push_back(Stage::linear(std::string(axes::word_of(reaction).name)));
        configs.back().limits.stop_deceleration = 200;
        configs.back().reactions.choose(axes::AxisAlarm::drive_warning, reaction);
    }
    Stage stage{configs};
    MC_MoveVelocity run[3];
    for (std::uint16_t i = 0; i < 3; ++i) {
        run[i].Axis = Stage::ref(i);
        run[i].Velocity = 80, run[i].Acceleration = 400;
        run[i].Execute = true;
        stage.drive(i).quick_stop_deceleration = 800 * mm;
    }
    double coasts = 0;  // mm/s: friction alone slows the motor without power
    stage.before = [&](const MotionContext& ctx) {
        for (auto& block : run) block(ctx);
        const auto& off = stage.view(2);
        if (off.drive_state == axes::PowerState::enabled) coasts = off.actual_velocity;
        else coasts = std::max(0.0, coasts - 60 * 1e-3);
        stage.drive(2).coasting = coasts * mm * 1e-3;
    };
    for (std::uint16_t i = 0; i < 3; ++i)
        stage.signal("power: " + configs[i].name, [&stage, i] { return stage.view(i).drive_state == axes::PowerState::enabled; });
    stage.show("actual velocity", "mm/s", 140,
               {{0, Quantity::actual_velocity, Ink::owner, "ramp"},
                {1, Quantity::actual_velocity, Ink::master, "quick"},
                {2, Quantity::actual_velocity, Ink::actual, "coasts"}});
    stage.run(400ms);
    for (std::uint16_t i = 0; i < 3; ++i) stage.drive(i).warning = true;
    stage.run(1600ms);
    return stage.figure("reactions");
}

/// A brake that the controller works: MC_Power, a pause with the brake closed, and off again.
Figure brake() {
    auto config = Stage::linear("z");
    config.brake = {.by = axes::BrakeBy::object, .release = 150ms, .engage = 250ms};
    Stage stage{{config}};
    stage.drive().caps.brake = true;
    MC_MoveRelative move, refused;
    MC_SetBrake set;
    move.Axis = refused.Axis = set.Axis = Stage::ref();
    move.Distance = refused.Distance = 20, move.Velocity = refused.Velocity = 80, move.Acceleration = move.Deceleration = 400;
    stage.block("move", move);
    stage.block("brake", set);
    stage.block("another", refused);
    stage.signal("drive enabled", [&] { return stage.drive().power == axes::PowerState::enabled; });
    stage.signal("told to open", [&] { return stage.drive().last.brake == axes::BrakeRequest::open; });
    stage.run(100ms);
    move.Execute = true;
    stage.run_until([&] { return move.Done; });
    stage.run(100ms);
    move.Execute = false;
    set.Execute = true;
    stage.run_until([&] { return set.Done; });
    stage.run(100ms);
    refused.Execute = true;
    stage.run(200ms);
    refused.Execute = set.Execute = false;
    stage.run(50ms);
    set.Release = set.Execute = true;
    stage.run_until([&] { return set.Done; });
    stage.run(50ms);
    move.Execute = true;
    stage.run_until([&] { return move.Done; });
    stage.run(200ms);
    return stage.figure("brake");
}

}  // namespace

std::vector<Figure> stops() { return {halt(), stop(), reactions(), brake()}; }

}  // namespace taktwerk::figures
