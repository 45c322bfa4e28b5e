// A flying saw: a profile runs without stopping, a carriage runs beside it, and while both are in step the saw goes through and up again. The
// carriage follows a cam of the machine file, over and over: one pass is a piece and the saw's kerf, so lengths are exact at any speed, also while it
// changes. (The flying shear couples with MC_GearInPos anew for each cut: it can cut at marks; this one needs no program between the cuts.)

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

class FlyingSaw final : public Program {
    enum Step : std::int32_t { waiting = 0, sawing = 10, up = 20 };

    AxisRef material_, carriage_;
    CamRef cam_;
    Input<bool> run_;
    Output<bool> saw_down_;
    Parameter length_, kerf_, speed_, cut_time_;

    MC_Power power_material_, power_carriage_;
    MC_Home home_carriage_;
    MC_MoveAbsolute to_start_;
    MC_CamTableSelect select_;
    MC_CamIn follow_;
    MC_MoveVelocity feed_;
    MC_Halt halt_;
    TON cut_;

    std::int32_t step_ = waiting;
    std::int64_t pieces_ = 0;
    bool too_fast_ = false;  ///< the saw was still in the material when the carriage had to brake; until the material stands

    // Of the cam: here the carriage is in step.
    static constexpr double in_step_from = 75, in_step_to = 325;  // mm of the carriage

public:
    void declare(Declaration& d) override {
        material_ = d.axis("material");
        carriage_ = d.axis("carriage");
        cam_ = d.cam("saw");
        run_ = d.input("run");
        saw_down_ = d.output("saw_down");
        length_ =
            d.parameter("length", {.value = 997, .minimum = 900, .maximum = 6000, .unit = "mm", .doc = "of a piece; taken at the start"});
        kerf_ = d.parameter("kerf",
                            {.value = 3, .minimum = 0, .maximum = 10, .unit = "mm", .doc = "what the saw takes away; taken at the start"});
        speed_ = d.parameter("speed", {.value = 300, .minimum = 10, .maximum = 400, .unit = "mm/s", .doc = "of the material"});
        cut_time_ = d.parameter("cut_time", {.value = 0.5, .minimum = 0.05, .maximum = 10, .unit = "s", .doc = "saw down, through and up"});
        d.monitor("step", step_, "", "step of the sequence");
        d.monitor("pieces", pieces_, "", "cuts since start");
        d.monitor("in_step", follow_.InSync, "", "the carriage is on its cam");
        d.block("to_start", to_start_);
        d.block("feed", feed_);
        d.block("halt", halt_);
        d.block("follow", follow_);
        d.alarm(0, Reaction::stop_machine, "The saw was still down at the end of the carriage's way", "锯片在托架行程末端仍未抬起",
                "run the material slower, or shorten the time of the cut; then reset");
        d.task<&FlyingSaw::scan>("main");
    }

    void start() override {
        step_ = waiting;
        pieces_ = 0;
        too_fast_ = false;
        select_ = {};
        to_start_ = {};
        follow_ = {};
    }

    void scan(TaskContext& ctx) {
        const bool ready = prepare(ctx);
        select_cam(ctx, ready);

        to_start_.Axis = carriage_;
        to_start_.Position = 0;
        to_start_.Velocity = 200;
        to_start_.Execute = ready;
        to_start_(ctx);

        // From rest at the cam's beginning, wherever the material is and however fast: a pass begins here.
        follow_.Master = material_;
        follow_.Slave = carriage_;
        follow_.CamTableID = select_.CamTableID;
        follow_.StartMode = mcAbsolute;
        follow_.Execute = ready && select_.Done && to_start_.Done;
        follow_(ctx);

        // The carriage stops and goes on with the material, also in the middle of a cut.
        const bool run = follow_.InSync && ctx.get(run_) && !too_fast_;
        feed_.Axis = halt_.Axis = material_;
        feed_.Velocity = ctx.get(speed_);
        feed_.ContinuousUpdate = true;
        feed_.Execute = run;
        feed_(ctx);
        halt_.Execute = ready && !run && pieces_ + step_ > 0;
        halt_(ctx);

        saw(ctx);
    }

private:
    bool prepare(TaskContext& ctx) {
        power_material_.Axis = material_;
        power_carriage_.Axis = home_carriage_.Axis = carriage_;
        power_material_.Enable = power_carriage_.Enable = true;
        power_material_(ctx);
        power_carriage_(ctx);
        const bool homed = ctx.view(carriage_)->homed;
        home_carriage_.Execute = power_carriage_.Status && !homed;
        home_carriage_(ctx);
        return power_material_.Status && power_carriage_.Status && homed && !home_carriage_.Busy;
    }

    void select_cam(TaskContext& ctx, bool ready) {
        select_.Master = material_;
        select_.Slave = carriage_;
        select_.CamTable = cam_;
        select_.Periodic = true;
        select_.MasterAbsolute = false;  // a pass begins where the material is
        select_.SlaveAbsolute = true;    // at the carriage's own 0
        if (ready && !select_.Execute) ctx.tables->cam(cam_)->points.back().master = ctx.get(length_) + ctx.get(kerf_);
        select_.Execute = ready;
        select_(ctx);
    }

    void saw(TaskContext& ctx) {
        const auto& carriage = *ctx.view(carriage_);
        const bool in_step = follow_.InSync && carriage.set_position >= in_step_from && carriage.set_position <= in_step_to;
        switch (step_) {
            case waiting:
                if (in_step && carriage.set_velocity > 0) step_ = sawing;
                break;
            case sawing:
                if (!in_step) too_fast_ = true;
                if (cut_.Q) {
                    ++pieces_;
                    step_ = up;
                }
                break;
            case up:
                if (carriage.set_position < in_step_from) step_ = waiting;
                break;
            default: step_ = waiting;
        }
        cut_.IN = step_ == sawing;
        cut_.PT = from_seconds(ctx.get(cut_time_));
        cut_(ctx);
        ctx.set(saw_down_, step_ == sawing);
        if (carriage.set_velocity == 0 && !ctx.get(run_)) too_fast_ = false;
        ctx.alarm(0, too_fast_);
    }
};

}  // namespace

TAKTWERK_PROGRAM(FlyingSaw)
