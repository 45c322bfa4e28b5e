// A portal on two drives carries a hanging tool to and fro. The two drives are one axis here: that they move alike, and stop together, is the machine
// file's business (`gantry`). At each station the tool goes down, and while it stays there its brake is closed: the drive may rest, and nobody below
// relies on its torque.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

class Portal final : public Program {
    enum class Step : std::uint8_t { travel, lower, close, pause, open, raise };

    AxisRef portal_, tool_;
    Input<bool> run_;
    Parameter first_, second_, depth_, pause_time_;

    MC_Power power_portal_, power_tool_;
    MC_Home home_portal_, home_tool_;
    MC_MoveAbsolute travel_, lift_;
    MC_SetBrake brake_;
    TON pause_;

    Step step_ = Step::travel;
    bool at_second_ = false;
    std::int64_t visits_ = 0;

public:
    void declare(Declaration& d) override {
        portal_ = d.axis("portal");
        tool_ = d.axis("tool");
        run_ = d.input("run");
        first_ = d.parameter("first", {.value = 200, .minimum = 0, .maximum = 1500, .unit = "mm", .doc = "one station"});
        second_ = d.parameter("second", {.value = 900, .minimum = 0, .maximum = 1500, .unit = "mm", .doc = "the other"});
        depth_ = d.parameter("depth", {.value = 100, .minimum = 1, .maximum = 190, .unit = "mm", .doc = "how far the tool goes down"});
        pause_time_ = d.parameter("pause", {.value = 0.5, .minimum = 0, .maximum = 60, .unit = "s", .doc = "down there, on the brake"});
        d.monitor("visits", visits_, "", "of stations since start");
        d.alarm(0, Reaction::stop_machine, "The portal or its tool cannot go on", "龙门或工具无法继续运行", "see the alarms of the axes");
        d.task<&Portal::scan>("main");
    }

    void start() override {
        step_ = Step::travel;
        at_second_ = false;
        visits_ = 0;
    }

    void scan(TaskContext& ctx) {
        const bool ready = power(ctx);
        // A round that has begun is ended: the tool does not stay below.
        const bool go = ready && (ctx.get(run_) || step_ != Step::travel);

        travel_.Axis = portal_;
        travel_.Position = at_second_ ? ctx.get(second_) : ctx.get(first_);
        travel_.Velocity = 400;
        travel_.Execute = go && step_ == Step::travel;
        travel_(ctx);
        lift_.Axis = tool_;
        lift_.Position = step_ == Step::lower ? -ctx.get(depth_) : 0;
        lift_.Velocity = 60;
        lift_.Execute = go && (step_ == Step::lower || step_ == Step::raise);
        lift_(ctx);
        brake_.Axis = tool_;
        brake_.Release = step_ == Step::open;
        brake_.Execute = go && (step_ == Step::close || step_ == Step::open);
        brake_(ctx);
        pause_.IN = step_ == Step::pause;
        pause_.PT = from_seconds(ctx.get(pause_time_));
        pause_(ctx);

        if (go) next();
        ctx.alarm(0, ready && (travel_.Error || lift_.Error || brake_.Error));
    }

private:
    bool power(TaskContext& ctx) {
        power_portal_.Axis = home_portal_.Axis = portal_;
        power_tool_.Axis = home_tool_.Axis = tool_;
        power_portal_.Enable = power_tool_.Enable = true;
        power_portal_(ctx);
        power_tool_(ctx);
        home_portal_.Execute = power_portal_.Status && !ctx.view(portal_)->homed;
        home_portal_(ctx);
        home_tool_.Execute = power_tool_.Status && !ctx.view(tool_)->homed;
        home_tool_(ctx);
        return power_portal_.Status && power_tool_.Status && ctx.view(portal_)->homed && ctx.view(tool_)->homed && !home_portal_.Busy &&
               !home_tool_.Busy && ctx.view(portal_)->state != axes::AxisState::ErrorStop &&
               ctx.view(tool_)->state != axes::AxisState::ErrorStop;
    }

    /// Each step has its block; the next one's Execute rises in the scan after it.
    void next() {
        switch (step_) {
            case Step::travel: step_ = travel_.Done ? Step::lower : step_; break;
            case Step::lower: step_ = lift_.Done ? Step::close : step_; break;
            case Step::close: step_ = brake_.Done ? Step::pause : step_; break;
            case Step::pause: step_ = pause_.Q ? Step::open : step_; break;
            case Step::open: step_ = brake_.Done ? Step::raise : step_; break;
            case Step::raise:
                if (!lift_.Done) break;
                step_ = Step::travel;
                at_second_ = !at_second_;
                ++visits_;
                break;
        }
    }
};

}  // namespace

TAKTWERK_PROGRAM(Portal)
