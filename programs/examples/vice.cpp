// A vice: it closes fast until it is near, then slowly and with a limited torque against whatever is in it, holds that with the same torque, and opens
// again with all that the axis has. The jaw's target is 2 mm inside the part: the torque limit, not the position, says how hard it presses.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

class Vice final : public Program {
    static constexpr double near = 55, inside = 62, open = 10;  // mm

    AxisRef jaw_;
    Input<bool> close_;
    Output<bool> clamped_;
    Parameter torque_;

    MC_Power power_;
    MC_Home home_;
    MC_SetTorqueLimit gentle_, strong_;
    MC_MoveAbsolute approach_, press_, back_;

    bool holds_ = false;

public:
    void declare(Declaration& d) override {
        jaw_ = d.axis("jaw");
        close_ = d.input("close");
        clamped_ = d.output("clamped");
        torque_ =
            d.parameter("torque", {.value = 0.4, .minimum = 0.15, .maximum = 1.5, .unit = "", .doc = "of the rated one, pressed with"});
        d.monitor("holds", holds_, "", "the part is held with the torque asked for");
        d.block("gentle", gentle_);
        d.block("press", press_);
        d.task<&Vice::scan>("main");
    }

    void scan(TaskContext& ctx) {
        for (auto* axis : {&power_.Axis, &home_.Axis, &gentle_.Axis, &strong_.Axis, &approach_.Axis, &press_.Axis, &back_.Axis})
            *axis = jaw_;
        power_.Enable = true;
        power_(ctx);
        home_.Execute = power_.Status && !ctx.view(jaw_)->homed;
        home_(ctx);
        const bool ready = power_.Status && ctx.view(jaw_)->homed;
        const bool close = ready && ctx.get(close_);

        // Near, fast. The limit comes next, so that the last 5 mm are gentle from their beginning.
        approach_.Position = near;
        approach_.Velocity = 200;  // the axis holds it to the 120 mm/s that are allowed downwards
        approach_.Execute = close;
        approach_(ctx);
        gentle_.PositiveLimit = ctx.get(torque_);  // downwards; upwards the axis keeps what is configured
        gentle_.Execute = close && (approach_.Done || gentle_.Execute);
        gentle_(ctx);
        press_.Position = inside;
        press_.Velocity = 10;
        press_.Execute = close && (gentle_.Done || press_.Execute);
        press_(ctx);

        // Open: the move takes over from wherever the pressing has come to; the limit goes back first.
        strong_.Execute = ready && !close;
        strong_(ctx);
        back_.Position = open;
        back_.Velocity = 200;
        back_.Execute = ready && !close && (strong_.Done || back_.Execute);
        back_(ctx);

        // Held: the torque is there, and the jaw stands in front of its target because the part does not let it on.
        constexpr double nearly = 0.98;
        holds_ = press_.Done && ctx.view(jaw_)->actual_torque >= nearly * ctx.get(torque_);
        ctx.set(clamped_, holds_);
    }
};

}  // namespace

TAKTWERK_PROGRAM(Vice)
