// A tool changer: the carriage opens its coupling in front of a tool, closes it around the tool, waits until the tool is there, works with it and
// lays it down where it was. A tool is uncoupled only while nothing of it is powered; the end of the program uncouples nothing.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace std::chrono_literals;
using namespace taktwerk;
using namespace taktwerk::fb;

class ToolChanger final : public Program {
    static constexpr double rack_a = 100, rack_b = 250, work = 600;  // mm
    static constexpr double turns = 5;                               // of the screw
    static constexpr auto coupling_time = 100ms;                     // of the valve, both ways
    static constexpr auto power_gone = 200ms;                        // the drive's stage is off so long after Status has fallen
    static constexpr auto patience = 10s;                            // a tool that is coupled comes up in much less

    enum class Step : std::uint8_t {
        home,
        open,
        take,
        close,
        wait_for_tool,
        to_work,
        grip,
        let_go,
        screw,
        power_off,
        lay_down,
        uncouple,
        stuck
    };

    AxisRef x_, screw_;
    Input<bool> a_present_, b_present_, gripped_;
    Output<bool> release_, grip_;

    MC_Power x_power_, screw_power_;
    MC_Home home_;
    MC_MoveAbsolute go_;
    MC_MoveRelative turn_;
    TON time_, off_;

    Step step_ = Step::home;
    bool second_ = false;  // the screwdriver's turn
    std::uint16_t changes_ = 0, shown_ = 0;
    bool stuck_ = false;

public:
    void declare(Declaration& d) override {
        x_ = d.axis("x");
        screw_ = d.axis("screw");
        a_present_ = d.input("tool_a.present");
        b_present_ = d.input("tool_b.present");
        gripped_ = d.input("gripped");
        release_ = d.output("release");
        grip_ = d.output("grip");
        d.monitor("step", shown_, "", "of the sequence, from 0");
        d.monitor("changes", changes_, "", "tools laid down so far");
        d.alarm(0, Reaction::warn, "A tool was coupled and does not come up", "工具已连接但未就绪",
                "Look at the contacts of the coupling, and at the bus");
        d.block("go", go_);
        d.block("turn", turn_);
        d.block("screw_power", screw_power_);
        d.task<&ToolChanger::scan>("main");
    }

    void start() override {
        next(Step::home);
        stuck_ = false;
    }

    void scan(TaskContext& ctx) {
        power(ctx);
        if (x_power_.Status) sequence(ctx);
        // Whatever the sequence wants: nothing is let go that is powered.
        if (!may_let_go(ctx)) ctx.set(release_, false);
        ctx.alarm(0, stuck_);
        shown_ = static_cast<std::uint16_t>(step_);
    }

private:
    void power(TaskContext& ctx) {
        x_power_.Axis = home_.Axis = go_.Axis = x_;
        screw_power_.Axis = turn_.Axis = screw_;
        x_power_.Enable = true;
        x_power_(ctx);
        screw_power_.Enable = step_ == Step::screw && ctx.get(b_present_);
        screw_power_(ctx);
        off_.IN = !screw_power_.Status && !screw_power_.Enable;
        off_.PT = power_gone;
        off_(ctx);
    }

    [[nodiscard]] bool may_let_go(const TaskContext& ctx) const { return off_.Q && ctx.view(screw_)->state == axes::AxisState::Disabled; }

    void next(Step step) {
        step_ = step;
        home_.Execute = go_.Execute = turn_.Execute = time_.IN = false;
    }
    bool waited(TaskContext& ctx, Duration time) {
        time_.IN = true;
        time_.PT = time;
        time_(ctx);
        return time_.Q;
    }
    bool at(TaskContext& ctx, double position) {
        go_.Position = position;
        go_.Velocity = 400;
        go_.Execute = true;
        go_(ctx);
        return go_.Done;
    }

    void sequence(TaskContext& ctx) {
        const double rack = second_ ? rack_b : rack_a;
        const bool present = ctx.get(second_ ? b_present_ : a_present_);
        // A block sees its falling edge in the cycle in which its step is over.
        if (!go_.Execute) go_(ctx);
        if (!turn_.Execute) turn_(ctx);
        if (!time_.IN) time_(ctx);
        switch (step_) {
            case Step::home:
                home_.Execute = !ctx.view(x_)->homed;
                home_(ctx);
                // A program that begins anew may have a tool in its coupling: it lays that down first.
                if (ctx.view(x_)->homed) {
                    if (ctx.get(a_present_) || ctx.get(b_present_)) second_ = ctx.get(b_present_);
                    next(ctx.get(a_present_) || ctx.get(b_present_) ? Step::lay_down : Step::open);
                }
                break;
            case Step::open:
                ctx.set(release_, true);
                if (waited(ctx, coupling_time)) next(Step::take);
                break;
            case Step::take:
                if (at(ctx, rack)) next(Step::close);
                break;
            case Step::close:
                ctx.set(release_, false);
                if (waited(ctx, coupling_time)) next(Step::wait_for_tool);
                break;
            case Step::wait_for_tool:
                if (present) next(Step::to_work);
                else if (waited(ctx, patience)) next(Step::stuck);
                break;
            case Step::to_work:
                if (at(ctx, work)) next(second_ ? Step::screw : Step::grip);
                break;
            case Step::grip:
                ctx.set(grip_, true);
                if (ctx.good(gripped_) && waited(ctx, 500ms)) next(Step::let_go);
                break;
            case Step::let_go:
                ctx.set(grip_, false);
                if (waited(ctx, 200ms)) next(Step::lay_down);
                break;
            case Step::screw:
                turn_.Distance = turns;
                turn_.Velocity = 10;
                turn_.Execute = screw_power_.Status;
                turn_(ctx);
                if (turn_.Done) next(Step::power_off);
                if (!present) next(Step::stuck);
                break;
            case Step::power_off:
                if (may_let_go(ctx)) next(Step::lay_down);
                break;
            case Step::lay_down:
                if (at(ctx, rack)) next(Step::uncouple);
                break;
            case Step::uncouple:
                ctx.set(release_, true);
                if (!present && waited(ctx, coupling_time)) {
                    ++changes_;
                    second_ = !second_;
                    next(Step::take);
                }
                break;
            case Step::stuck: stuck_ = true; break;
        }
    }
};

}  // namespace

TAKTWERK_PROGRAM(ToolChanger)
