// A flying shear: material runs without stopping, a carriage runs beside it, and while both are in step the knife cuts. Each cut is
// MC_GearInPos at the next place of the material, so lengths are equal whatever the speed, and none is lost when the speed changes.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

class FlyingShear final : public Program {
    enum Step : std::int32_t { waiting = 0, armed = 10, cutting = 20, returning = 30 };

    AxisRef material_, carriage_;
    Input<bool> run_;
    Output<bool> knife_;
    Parameter length_, speed_, cut_time_;

    MC_Power power_material_, power_carriage_;
    MC_Home home_carriage_;
    MC_MoveVelocity feed_;
    MC_Halt halt_;
    MC_GearInPos synchronise_;
    MC_MoveAbsolute return_;
    TON cut_;

    std::int32_t step_ = waiting;
    std::int64_t pieces_ = 0;
    bool late_ = false;
    double next_cut_ = 0;  ///< mm of material at which the carriage is in step at `in_step_at`

    static constexpr double in_step_at = 120;      // mm of the carriage: from here on it runs with the material
    static constexpr double start_distance = 240;  // mm of material: twice the carriage's way, as it starts from rest
    static constexpr double home = 0;              // mm

public:
    void declare(Declaration& d) override {
        material_ = d.axis("material");
        carriage_ = d.axis("carriage");
        run_ = d.input("run");
        knife_ = d.output("knife");
        length_ = d.parameter("length", {.value = 500, .minimum = 300, .maximum = 5000, .unit = "mm", .doc = "of a piece"});
        speed_ = d.parameter("speed", {.value = 300, .minimum = 10, .maximum = 400, .unit = "mm/s", .doc = "of the material"});
        cut_time_ = d.parameter("cut_time", {.value = 0.15, .minimum = 0.02, .maximum = 1, .unit = "s", .doc = "knife down"});
        d.monitor("step", step_, "", "step of the sequence");
        d.monitor("pieces", pieces_, "", "cuts since start");
        d.monitor("next_cut", next_cut_, "mm", "place of the next cut on the material");
        d.monitor("in_step", synchronise_.InSync, "", "carriage and material run together");
        d.block("feed", feed_);
        d.block("halt", halt_);
        d.block("synchronise", synchronise_);
        d.block("return", return_);
        d.alarm(0, Reaction::warn, "The carriage came back too late: one piece is longer", "托架返回太晚:有一件过长",
                "run the material slower, cut longer pieces, or shorten the knife's time");
        d.task<&FlyingShear::scan>("main");
    }

    void scan(TaskContext& ctx) {
        const bool ready = prepare(ctx);
        if (!ready) step_ = waiting;

        feed_.Axis = halt_.Axis = material_;
        feed_.Velocity = ctx.get(speed_);
        feed_.ContinuousUpdate = true;  // a change of speed reaches the material at once; the carriage follows it
        feed_.Execute = ready && ctx.get(run_);
        feed_(ctx);
        halt_.Execute = ready && !ctx.get(run_);
        halt_(ctx);

        switch (step_) {
            case waiting:
                // The first cut is far enough ahead for the carriage to start.
                if (ready && feed_.InVelocity) {
                    next_cut_ = ctx.view(material_)->set_position + start_distance + 50;
                    step_ = armed;
                }
                break;
            case armed:
                if (synchronise_.InSync) step_ = cutting;
                break;
            case cutting:
                if (cut_.Q) {
                    ++pieces_;
                    next_cut_ += ctx.get(length_);
                    step_ = returning;
                }
                break;
            case returning:
                if (return_.Done) step_ = armed;
                // Back too late for the next place: that piece comes out longer, and somebody has to know.
                late_ = return_.Done && ctx.view(material_)->set_position > next_cut_ - start_distance;
                while (late_ && ctx.view(material_)->set_position > next_cut_ - start_distance) next_cut_ += ctx.get(length_);
                break;
            default: step_ = waiting;
        }

        ctx.alarm(0, late_);

        synchronise_.Master = material_;
        synchronise_.Slave = carriage_;
        synchronise_.MasterSyncPosition = next_cut_;
        synchronise_.SlaveSyncPosition = in_step_at;
        synchronise_.MasterStartDistance = start_distance;
        synchronise_.Execute = step_ == armed || step_ == cutting;
        synchronise_(ctx);

        cut_.IN = step_ == cutting;
        cut_.PT = from_seconds(ctx.get(cut_time_));
        cut_(ctx);
        ctx.set(knife_, step_ == cutting);

        return_.Axis = carriage_;
        return_.Position = home;
        return_.Velocity = 1000;
        return_.Execute = step_ == returning;
        return_(ctx);
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
};

}  // namespace

TAKTWERK_PROGRAM(FlyingShear)
