// Motion that an operator or a program gives moment by moment.
#include <cmath>
#include <numbers>

#include "fb_library/motion/external_setpoints.hpp"
#include "fb_library/motion/jog.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

/// Each mode pressed once; the last two for longer than the way takes.
Figure jog_modes() {
    auto config = Stage::linear();
    config.manual.slow = 20, config.manual.fast = 60;
    Stage stage{{config}};
    MC_Jog jog;
    jog.Axis = Stage::ref();
    jog.Position = 10, jog.Velocity = 40, jog.Acceleration = jog.Deceleration = 400;
    stage.block("jog", jog);
    bool slow = false, fast = false, continuous = false, inching = false, modulo = false;
    const auto press = [&](bool& shown, MC_JogMode mode, bool& input, Duration time) {
        jog.Mode = mode;
        shown = input = true;
        stage.run(time);
        input = false;
        stage.run(300ms);
        shown = false;
    };
    stage.signal("slow", [&] { return slow; });
    stage.signal("fast", [&] { return fast; });
    stage.signal("continuous", [&] { return continuous; });
    stage.signal("inching", [&] { return inching; });
    stage.signal("inching modulo", [&] { return modulo; });
    stage.run(200ms);
    press(slow, mcJogStandardSlow, jog.JogForward, 500ms);
    press(fast, mcJogStandardFast, jog.JogForward, 500ms);
    press(continuous, mcJogContinuous, jog.JogBackwards, 500ms);
    press(inching, mcJogInching, jog.JogForward, 600ms);
    press(modulo, mcJogInchingModulo, jog.JogForward, 600ms);
    return stage.figure("jog");
}

/// x = 20 mm (1 - cos), ended at full speed.
Figure external() {
    Stage stage;
    MC_ExtSetPointGenEnable enable;
    MC_ExtSetPointGenFeed feed;
    MC_ExtSetPointGenDisable disable;
    enable.Axis = feed.Axis = disable.Axis = Stage::ref();
    disable.Deceleration = 400;
    constexpr double w = 2 * std::numbers::pi / 1.2, half = 20;  // 1/s, mm
    double t = 0;
    stage.before = [&](const MotionContext&) {
        // Before the blocks of the picture: the feed asks what the enabling block showed in the scan before.
        feed.Enable = enable.Busy;
        if (enable.Busy) t += to_seconds(Stage::period);
        feed.Position = half * (1 - std::cos(w * t)), feed.Velocity = half * w * std::sin(w * t);
        feed.Acceleration = half * w * w * std::cos(w * t);
    };
    stage.block("enable", enable);
    stage.beside("feed", feed);
    stage.block("disable", disable);
    stage.show("velocity", "mm/s", 100, {{0, {}, Ink::actual, "fed", &feed.Velocity}, {0, Quantity::velocity, Ink::owner, "set"}});
    stage.show("position", "mm", 100, {{0, {}, Ink::actual, "fed", &feed.Position}, {0, Quantity::position, Ink::owner, "set"}});
    stage.run(200ms);
    enable.Execute = true;
    stage.run(1500ms);
    disable.Execute = true;
    stage.run_until([&] { return disable.Done; });
    stage.run(200ms);
    return stage.figure("external-setpoints");
}

}  // namespace

std::vector<Figure> by_hand() { return {jog_modes(), external()}; }

}  // namespace taktwerk::figures
