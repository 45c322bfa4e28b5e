// A centre winder: the roll grows, so the winder must turn slower and slower for the web to come in as fast as the line gives it. While
// the line runs the winder is geared to it, and the ratio follows the radius; while the line stands the winder holds the web's
// tension by its torque, so that the web neither sags nor tears.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;
using namespace std::chrono_literals;

constexpr double gear = 10;            // motor turns per turn of the roll
constexpr double rated_torque = 1.27;  // Nm of the motor
constexpr double slow = 0.1;           // rad/s: nobody winds slower; the torque alone must not either, a torn web would

class Winder final : public Program {
    enum Step : std::int32_t { idle = 0, holding = 10, coupling = 20, winding = 30, stopping = 40 };

    AxisRef line_, winder_;
    Input<bool> run_, new_core_;
    Output<bool> winding_, full_;
    Parameter speed_, thickness_, core_, largest_, tension_;

    MC_Power power_line_, power_winder_;
    MC_GearIn gear_;
    MC_TorqueControl hold_;
    MC_MoveVelocity feed_;
    MC_Halt halt_;
    R_TRIG core_changed_;
    TON settled_;

    std::int32_t step_ = idle;
    double first_turn_ = 0;    ///< rad of the winder at which the core was empty
    double radius_ = 0;        ///< mm
    std::uint16_t error_ = 0;  ///< ErrorID of the winder's blocks
    double torque_ = 0;        ///< of the motor, rated = 1

public:
    void declare(Declaration& d) override {
        line_ = d.axis("line");
        winder_ = d.axis("winder");
        run_ = d.input("run");
        new_core_ = d.input("new_core");
        winding_ = d.output("winding");
        full_ = d.output("full");
        speed_ = d.parameter("speed", {.value = 500, .minimum = 10, .maximum = 500, .unit = "mm/s", .doc = "of the web"});
        thickness_ = d.parameter("thickness", {.value = 1, .minimum = 0.01, .maximum = 5, .unit = "mm", .doc = "of the web"});
        core_ = d.parameter("core", {.value = 50, .minimum = 20, .maximum = 200, .unit = "mm", .doc = "radius of the empty core"});
        largest_ =
            d.parameter("largest", {.value = 75, .minimum = 30, .maximum = 400, .unit = "mm", .doc = "radius at which the roll is full"});
        tension_ =
            d.parameter("tension", {.value = 20, .minimum = 0, .maximum = 100, .unit = "N", .doc = "of the web while the line stands"});
        d.monitor("step", step_, "", "step of the sequence");
        d.monitor("radius", radius_, "mm", "of the roll");
        d.monitor("torque", torque_, "1", "that holds the tension, of the motor's rated torque");
        d.monitor("error", error_, "", "ErrorID of the winder's blocks, 0 = none");
        d.block("gear", gear_);
        d.block("hold", hold_);
        d.block("feed", feed_);
        d.block("halt", halt_);
        d.alarm(0, Reaction::warn, "The roll is full", "料卷已满", "put in an empty core and press new_core");
        d.alarm(1, Reaction::stop_machine, "The web is torn or slack: the winder turns while the line stands",
                "断料或松料:生产线停止时收卷轴转动", "thread the web; check `tension`");
        d.alarm(2, Reaction::stop_machine, "The winder cannot follow the line", "收卷轴无法跟随生产线", "check core, thickness and speed");
        d.task<&Winder::scan>("main");
    }

    void start() override { step_ = idle; }

    void scan(TaskContext& ctx) {
        const bool ready = power(ctx);
        const auto &line = *ctx.view(line_), &winder = *ctx.view(winder_);

        // Each turn is one layer more: a spiral.
        core_changed_.CLK = ctx.get(new_core_);
        core_changed_(ctx);
        if (core_changed_.Q || ctx.first_scan) first_turn_ = winder.set_position;
        const double turns = std::max(0.0, winder.set_position - first_turn_) / (2 * std::numbers::pi);
        radius_ = ctx.get(core_) + ctx.get(thickness_) * turns;
        const bool full = radius_ >= ctx.get(largest_);

        settled_.IN = ready;
        settled_.PT = 300ms;
        settled_(ctx);

        const bool run = ready && ctx.get(run_) && !full;
        const bool stands = line.set_velocity == 0;
        switch (step_) {
            case idle:  // the drive's own position loop first finds the torque that holds the web
                if (settled_.Q) step_ = holding;
                break;
            case holding:  // the torque holds the web
                if (run && hold_.InTorque) step_ = coupling;
                break;
            case coupling:  // geared, but the line stands
                if (gear_.InGear) step_ = winding;
                break;
            case winding:
                if (!run) step_ = stopping;
                break;
            case stopping:
                if (run) step_ = winding;
                else if (stands && winder.set_velocity == 0) step_ = holding;
                break;
            default: step_ = idle;
        }
        if (!ready) step_ = idle;

        couple(ctx);
        hold_tension(ctx);

        feed_.Axis = halt_.Axis = line_;
        feed_.Velocity = ctx.get(speed_);
        feed_.ContinuousUpdate = true;
        feed_.Execute = step_ == winding;
        feed_(ctx);
        halt_.Execute = step_ == stopping;
        halt_(ctx);

        error_ = static_cast<std::uint16_t>(gear_.Error ? gear_.ErrorID : hold_.ErrorID);
        ctx.alarm(0, full);
        ctx.alarm(1, step_ == holding && std::abs(winder.actual_velocity) > slow);
        ctx.alarm(2, ready && (gear_.Error || hold_.Error));
        ctx.set(winding_, step_ == winding);
        ctx.set(full_, full);
    }

private:
    bool power(TaskContext& ctx) {
        power_line_.Axis = line_;
        power_winder_.Axis = winder_;
        power_line_.Enable = power_winder_.Enable = true;
        power_line_(ctx);
        power_winder_(ctx);
        return power_line_.Status && power_winder_.Status && ctx.view(winder_)->state != axes::AxisState::ErrorStop;
    }

    /// Winder rad per mm of line: 1 / radius. In hundredths of a millimetre, so the ratio is a new one every few cycles only.
    void couple(TaskContext& ctx) {
        gear_.Master = line_;
        gear_.Slave = winder_;
        gear_.RatioNumerator = 100;
        gear_.RatioDenominator = static_cast<std::uint32_t>(std::lround(100 * radius_));
        gear_.ContinuousUpdate = true;
        gear_.Execute = step_ == coupling || step_ == winding || step_ == stopping;
        gear_(ctx);
    }

    /// From the torque that the motor has, over a ramp, to the one that pulls with the tension.
    void hold_tension(TaskContext& ctx) {
        torque_ = ctx.get(tension_) * radius_ / 1000 / gear / rated_torque;
        hold_.Axis = winder_;
        hold_.Torque = torque_;
        hold_.TorqueRamp = 0.5;
        hold_.Velocity = 2 * slow;  // all it may do when the web gives way
        hold_.ContinuousUpdate = true;
        hold_.Execute = step_ == holding;
        hold_(ctx);
    }
};

}  // namespace

TAKTWERK_PROGRAM(Winder)
