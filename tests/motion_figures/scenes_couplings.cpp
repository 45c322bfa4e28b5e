// The slave is the first axis (its curve has the colour of the block that couples it), the master the second, in grey.
#include <cmath>
#include <numbers>

#include "fb_library/motion/camming.hpp"
#include "fb_library/motion/combine_axes.hpp"
#include "fb_library/motion/endless_moves.hpp"
#include "fb_library/motion/gearing.hpp"
#include "fb_library/motion/moves.hpp"
#include "fb_library/motion/phasing.hpp"
#include "tests/motion_figures/scenes.hpp"
#include "tests/motion_figures/stage.hpp"

namespace taktwerk::figures {
namespace {

using namespace fb;

constexpr axes::AxisRef slave = Stage::ref(0), master = Stage::ref(1);

void show_both(Stage& stage) {
    stage.show("velocity", "mm/s", 100, {{1, Quantity::velocity, Ink::master, "master"}, {0, Quantity::velocity, Ink::owner, "slave"}});
    stage.show("position", "mm", 100, {{1, Quantity::position, Ink::master, "master"}, {0, Quantity::position, Ink::owner, "slave"}});
}

/// The master at constant velocity before the picture begins.
struct Line {
    Line(Stage& stage, double velocity) {
        run.Axis = master;
        run.Velocity = velocity, run.Acceleration = run.Deceleration = 200, run.Execute = true;
        stage.before = [this](const MotionContext& ctx) { run(ctx); };
    }
    MC_MoveVelocity run;
};

/// Figure 43 of the standard: two gears take over from each other.
Figure gear_in() {
    Stage stage{{Stage::linear("slave"), Stage::linear("master")}};
    Line line{stage, 40};
    MC_GearIn one, two;
    MC_GearOut out;
    one.Master = two.Master = master;
    one.Slave = two.Slave = out.Slave = slave;
    two.RatioNumerator = 2;
    one.Acceleration = one.Deceleration = two.Acceleration = two.Deceleration = 100;
    stage.block("one", one);
    stage.block("two", two);
    stage.block("out", out);
    show_both(stage);
    stage.run(300ms);
    one.Execute = true;
    stage.run_until([&] { return one.InGear; });
    stage.run(300ms);
    two.Execute = true;
    stage.run_until([&] { return two.InGear; });
    stage.run(200ms);
    line.run.Execute = false;
    line.run.Velocity = 20;
    stage.scan();
    line.run.Execute = true;
    stage.run(500ms);
    out.Execute = true;
    stage.run(100ms);
    line.run.Execute = false;
    line.run.Velocity = 50;
    stage.scan();
    line.run.Execute = true;
    stage.run(400ms);
    return stage.figure("gear-in");
}

/// Figure 44 of the standard.
Figure gear_in_pos() {
    Stage stage{{Stage::linear("slave"), Stage::linear("master")}};
    Line line{stage, 50};
    MC_GearInPos gear;
    gear.Master = master, gear.Slave = slave;
    gear.MasterSyncPosition = 70, gear.SlaveSyncPosition = 20, gear.MasterStartDistance = 40;
    stage.block("gear", gear);
    show_both(stage);
    stage.run(300ms);
    gear.Execute = true;
    stage.run_until([&] { return gear.InSync; });
    stage.run(800ms);
    return stage.figure("gear-in-pos");
}

axes::CamRef sine_cam(Stage& stage) {
    std::vector<axes::CamPoint> points;
    constexpr int steps = 16;
    constexpr double length = 60, lift = 20;
    for (int i = 0; i <= steps; ++i) {
        const double angle = 2 * std::numbers::pi * i / steps;
        points.push_back({length * i / steps, lift * (1 - std::cos(angle)) / 2, lift * std::numbers::pi / length * std::sin(angle),
                          2 * lift * std::numbers::pi * std::numbers::pi / (length * length) * std::cos(angle)});
    }
    return stage.cam(points);
}

/// The slave is on a cam once `select` and `in` are told to.
struct Cam {
    Cam(Stage& stage, Line& line, axes::CamRef table) {
        select.Master = in.Master = master;
        select.Slave = in.Slave = slave;
        select.CamTable = table;
        select.Periodic = true, select.SlaveAbsolute = true, select.MasterAbsolute = false;
        in.StartMode = mcAbsolute;
        stage.before = [this, &line](const MotionContext& ctx) {
            line.run(ctx);
            select(ctx);
            in.CamTableID = select.CamTableID;
        };
        stage.block("cam", in);
    }
    MC_CamTableSelect select;
    MC_CamIn in;
};

Figure cam_in() {
    Stage stage{{Stage::linear("slave"), Stage::linear("master")}};
    Line line{stage, 50};
    Cam cam{stage, line, sine_cam(stage)};
    MC_CamOut out;
    out.Slave = slave;
    stage.block("out", out);
    show_both(stage);
    cam.select.Execute = true;
    stage.run(500ms);
    cam.in.Execute = true;
    stage.run(2900ms);
    out.Execute = true;
    stage.run(300ms);
    return stage.figure("cam-in");
}

/// A saw that runs beside its material for 30 mm of each 100 mm: the cam of programs/examples/flying_saw.cpp, a tenth as long.
Figure flying_saw() {
    Stage stage{{Stage::linear("saw"), Stage::linear("material")}};
    Line line{stage, 50};
    using axes::CamSegment;
    Cam cam{stage, line,
            stage.cam({{.master = 0, .slave = 0, .segment = CamSegment::inclined_sine},
                       {.master = 15, .slave = 7.5, .velocity = 1, .segment = CamSegment::linear},
                       {.master = 45, .slave = 37.5, .velocity = 1, .segment = CamSegment::inclined_sine},
                       {.master = 60, .slave = 45, .segment = CamSegment::modified_sine},
                       {.master = 100, .slave = 0}})};
    stage.signal("in step", [&] { return stage.view(0).set_velocity > 0 && stage.view(0).set_velocity == stage.view(1).set_velocity; });
    show_both(stage);
    cam.select.Execute = true;
    stage.run(300ms);
    cam.in.Execute = true;
    stage.run(4500ms);
    return stage.figure("flying-saw");
}

/// A gear, and on it a shift of phase.
struct Phased {
    Phased(Stage& stage, double shift) {
        gear.Master = phase.Master = master;
        gear.Slave = phase.Slave = slave;
        gear.Acceleration = gear.Deceleration = 200;
        phase.PhaseShift = shift, phase.Velocity = 20, phase.Acceleration = phase.Deceleration = 100;
        stage.block("gear", gear);
        stage.block("phase", phase);
    }
    void begin(Stage& stage) {
        stage.run(200ms);
        gear.Execute = true;
        stage.run_until([&] { return gear.InGear; });
        stage.run(400ms);
        phase.Execute = true;
    }
    MC_GearIn gear;
    MC_PhasingRelative phase;
};

Figure phasing() {
    Stage stage{{Stage::linear("slave"), Stage::linear("master")}};
    Line line{stage, 40};
    Phased phased{stage, 15};
    show_both(stage);
    phased.begin(stage);
    stage.run_until([&] { return phased.phase.Done; });
    stage.run(400ms);
    return stage.figure("phasing");
}

Figure halt_phasing() {
    Stage stage{{Stage::linear("slave"), Stage::linear("master")}};
    Line line{stage, 40};
    Phased phased{stage, 60};
    MC_HaltPhasing halt;
    halt.Slave = slave;
    halt.Deceleration = 50;
    stage.block("halt", halt);
    show_both(stage);
    phased.begin(stage);
    stage.run(700ms);
    halt.Execute = true;
    stage.run_until([&] { return halt.Done; });
    stage.run(400ms);
    return stage.figure("halt-phasing");
}

Figure combine_axes() {
    Stage stage{{Stage::linear("slave"), Stage::linear("master"), Stage::linear("second")}};
    Line line{stage, 30};
    MC_CombineAxes combine;
    MC_MoveRelative correct;
    combine.Slave = slave, combine.Master1 = master, combine.Master2 = correct.Axis = Stage::ref(2);
    correct.Distance = 20, correct.Velocity = 40, correct.Acceleration = correct.Deceleration = 200;
    stage.block("combine", combine);
    stage.block("second", correct);
    stage.show("velocity", "mm/s", 100,
               {{1, Quantity::velocity, Ink::master, "first"},
                {2, Quantity::velocity, Ink::actual, "second"},
                {0, Quantity::velocity, Ink::owner, "slave"}});
    stage.show("position", "mm", 100,
               {{1, Quantity::position, Ink::master, "first"},
                {2, Quantity::position, Ink::actual, "second"},
                {0, Quantity::position, Ink::owner, "slave"}});
    stage.run(300ms);
    combine.Execute = true;
    stage.run_until([&] { return combine.InSync; });
    stage.run(500ms);
    correct.Execute = true;
    stage.run_until([&] { return correct.Done; });
    stage.run(400ms);
    return stage.figure("combine-axes");
}

}  // namespace

std::vector<Figure> couplings() { return {gear_in(), gear_in_pos(), cam_in(), flying_saw(), phasing(), halt_phasing(), combine_axes()}; }

}  // namespace taktwerk::figures
