// Positions into signals, and signals into positions. 1 mm is 10000 counts.
#include "fb_library/motion/digital_cam_switch.hpp"
#include "fb_library/motion/moves.hpp"
#include "fb_library/motion/probes.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

/// Over the mark and back: it rises at 20 mm on the way out and at 26 mm on the way back.
Figure touch_probe() {
    Stage stage;
    auto& drive = stage.drive();
    drive.caps.probes = 2;
    drive.probe_signal = {{{20 * mm, 26 * mm}, {20 * mm, 26 * mm}}};
    MC_MoveAbsolute there, back;
    MC_TouchProbe any, window;
    there.Axis = back.Axis = any.Axis = window.Axis = Stage::ref();
    for (auto* move : {&there, &back}) move->Velocity = 50, move->Acceleration = move->Deceleration = 250;
    there.Position = 40;
    back.BufferMode = mcBuffered;
    window.TriggerInput.source = axes::TriggerSource::probe2;
    window.WindowOnly = true, window.FirstPosition = 24, window.LastPosition = 35;
    stage.signal("mark", [&] { return drive.position >= 20 * mm && drive.position <= 26 * mm; });
    stage.block("there", there);
    stage.block("back", back);
    stage.beside("any", any);
    stage.beside("window", window);
    stage.show("position", "mm", 110, {{0, Quantity::position}});
    stage.show("recorded", "mm", 70,
               {{0, {}, Ink::master, "any", &any.RecordedPosition}, {0, {}, Ink::plain, "window", &window.RecordedPosition}});
    stage.run(100ms);
    any.Execute = window.Execute = true;
    stage.run(100ms);
    there.Execute = back.Execute = true;
    stage.run_until([&] { return back.Done; });
    stage.run(100ms);
    return stage.figure("touch-probe");
}

/// The same three tracks, slowly there and twice as fast back.
Figure digital_cam_switch() {
    Stage stage;
    MC_MoveAbsolute there, back;
    MC_DigitalCamSwitch cams;
    there.Axis = back.Axis = cams.Axis = Stage::ref();
    there.Position = 60, there.Velocity = 40, back.Velocity = 80;
    for (auto* move : {&there, &back}) move->Acceleration = move->Deceleration = 800;
    back.BufferMode = mcBuffered;
    cams.Switches = stage.cam_switches({{.track = 1, .first = 20, .last = 40},
                                        {.track = 2, .first = 20, .last = 40},
                                        {.track = 3, .first = 20, .mode = axes::CamSwitchMode::time, .duration = 200ms}});
    cams.TrackOptions = stage.tracks({{}, {.on_compensation = -100ms, .off_compensation = -100ms}});
    stage.block("there", there);
    stage.block("back", back);
    stage.beside("cams", cams);
    stage.signal("1: 20 to 40 mm", [&] { return (cams.on & 1u) != 0; });
    stage.signal("2: 100 ms earlier", [&] { return (cams.on & 2u) != 0; });
    stage.signal("3: 200 ms from 20", [&] { return (cams.on & 4u) != 0; });
    stage.show("position", "mm", 130, {{0, Quantity::position}});
    stage.run(100ms);
    cams.Enable = true;
    stage.run(100ms);
    there.Execute = back.Execute = true;
    stage.run_until([&] { return back.Done; });
    stage.run(100ms);
    return stage.figure("digital-cam-switch");
}

}  // namespace

std::vector<Figure> probes_and_cams() { return {touch_probe(), digital_cam_switch()}; }

}  // namespace taktwerk::figures
