// A portal that engraves a plate from G-code. The path comes from the machine's file (`paths`), what it asks for beside motion is answered here: spindle, air, tools.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

class Engraver final : public Program {
    static constexpr std::size_t count = 3;
    std::array<AxisRef, count> axes_;
    GroupRef portal_;
    axes::PathRef plate_;
    Input<bool> spindle_turns_;
    Output<bool> spindle_, air_;

    struct {
        MC_GroupPower power;
        std::array<MC_Home, count> homes;
        MC_GroupEnable enable;
        MC_GroupReset reset;
    } up_;  // what leads to GroupStandby
    MC_GroupReadStatus status_;
    MC_GroupSetOverride override_;
    MC_GroupInterrupt hold_;
    MC_GroupContinue continue_;
    MC_PathSelect select_;
    MC_MovePath move_;
    Path_Handshake asked_;
    TON changing_;

    bool engraves_ = true, holds_ = false, go_on_ = false, one_by_one_ = false;
    double feed_ = 100;  // percent
    std::int64_t plates_ = 0, failed_ = 0;

public:
    void declare(Declaration& d) override {
        const char* names[count] = {"x", "y", "z"};
        for (std::size_t i = 0; i < count; ++i) axes_[i] = d.axis(names[i]);
        portal_ = d.axis_group("portal");
        plate_ = d.path("plate");
        spindle_turns_ = d.input("spindle_turns");
        spindle_ = d.output("spindle");
        air_ = d.output("air");
        d.operator_switch("engraves", engraves_, {.doc = "one plate after the other; a stop and an error switch it off"});
        d.operator_switch("holds", holds_, {.doc = "stands on the path"});
        d.operator_switch("one_by_one", one_by_one_, {.doc = "a block at a time, from the next plate on"});
        d.operator_button("go_on", go_on_, {.doc = "after M0, M1, a tool, a block"});
        d.operator_value("feed", feed_, {.minimum = 0, .maximum = 100, .unit = "%", .doc = "override of the path"});
        d.monitor("plates", plates_, "", "engraved since start");
        d.monitor("failed", failed_, "", "paths that ended with an error");
        d.monitor("line", asked_.Line, "", "of the program, that is carried out");
        d.monitor("waits", asked_.Waits, "", "for an answer to what the path asks for");
        d.monitor("fault_line", asked_.FaultLine, "", "of the program: what ended it");
        d.monitor("fault_column", asked_.FaultColumn, "", "likewise");
        d.block("move", move_);
        d.task<&Engraver::scan>("main");
    }

    void start() override {
        up_.enable.Execute = up_.reset.Execute = select_.Execute = move_.Execute = hold_.Execute = continue_.Execute = false;
        for (auto& home : up_.homes) home.Execute = false;
        on_ = {};
        idle_ = false;
        engraves_ = true;
    }

    void scan(TaskContext& ctx) {
        for (auto* group : {&up_.power.AxesGroup, &up_.enable.AxesGroup, &up_.reset.AxesGroup, &status_.AxesGroup, &override_.AxesGroup,
                            &hold_.AxesGroup, &continue_.AxesGroup, &select_.AxesGroup, &move_.AxesGroup, &asked_.AxesGroup})
            *group = portal_;
        up_.power.Enable = status_.Enable = override_.Enable = asked_.Enable = true;
        up_.power(ctx);
        bool homed = true;
        for (std::size_t i = 0; i < count; ++i) {
            up_.homes[i].Axis = axes_[i];
            up_.homes[i].Execute = up_.power.Status && !ctx.view(axes_[i])->homed;
            up_.homes[i](ctx);
            homed = homed && ctx.view(axes_[i])->homed && !up_.homes[i].Busy;
        }
        up_.enable.Execute = up_.power.Status && homed;
        up_.enable(ctx);
        status_(ctx);
        up_.reset.Execute = status_.GroupErrorStop && up_.power.Status;
        up_.reset(ctx);
        override_.VelFactor = feed_ / 100;
        override_(ctx);
        engrave(ctx);
        hold_.Execute = holds_ && move_.Busy;
        hold_(ctx);
        // While a person keeps it interrupted it is refused (held_by_person), and asks again.
        continue_.Execute = !holds_ && move_.Busy && hold_was_ && !continue_.Error;
        continue_(ctx);
        if (hold_.Done) hold_was_ = true;
        if (continue_.Done || !move_.Busy) hold_was_ = false;
        answer(ctx);
        ctx.set(spindle_, on_.spindle && status_.Valid && !status_.GroupErrorStop);
        ctx.set(air_, on_.air);
    }

private:
    struct {
        bool spindle = false, air = false;
    } on_;
    bool hold_was_ = false;
    bool idle_ = false;  ///< path blocks have seen Execute FALSE

    void engrave(TaskContext& ctx) {
        const bool stands = status_.GroupStandby && up_.power.Status;
        select_.PathDescription = {plate_, {.single_block = one_by_one_}};
        if (stands && engraves_ && idle_) select_.Execute = true;
        select_(ctx);
        move_.PathData = select_.PathData;
        if (select_.Done) move_.Execute = true;
        move_(ctx);
        idle_ = !select_.Execute && !move_.Execute;  // the blocks have seen it: the next TRUE is an edge
        if (move_.Done) ++plates_;
        const bool over = move_.Done || move_.Error || move_.CommandAborted || select_.Error;
        if (move_.Error || select_.Error) ++failed_;
        // Somebody has to look, or has stopped it: it does not begin by itself.
        if (!idle_ && over && !move_.Done) engraves_ = false;
        if (over) select_.Execute = move_.Execute = false;
        if (!move_.Busy) on_ = {};  // also M30's business
    }

    /// What the path asks for is done here; it stands until that has happened.
    void answer(TaskContext& ctx) {
        bool done = false;
        switch (move_.Busy ? asked_.Request : mcPathNothing) {  // of a path that was stopped nobody wants anything any more
            case mcPathSpindleClockwise:
            case mcPathSpindleCounter: on_.spindle = true, done = ctx.get(spindle_turns_); break;
            case mcPathSpindleOff: on_.spindle = false, done = true; break;
            case mcPathMist:
            case mcPathFlood: on_.air = done = true; break;
            case mcPathCoolantOff: on_.air = false, done = true; break;
            case mcPathToolChange: done = changing_.Q; break;  // by hand, here: half a second
            default: done = go_on_; break;
        }
        using namespace std::chrono_literals;
        changing_.PT = 500ms;
        changing_.IN = asked_.Waits && asked_.Request == mcPathToolChange;
        changing_(ctx);
        asked_.Acknowledge = asked_.Waits && done && !asked_.Acknowledge;
        asked_(ctx);
    }
};

}  // namespace

TAKTWERK_PROGRAM(Engraver)
