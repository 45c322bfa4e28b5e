// A program that moves x for a while and then takes the controller down with it: by a wild pointer or by never coming back.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

class Dying final : public Program {
    AxisRef x_;
    Parameter how_;
    MC_Power power_;
    MC_Home home_;
    MC_MoveVelocity move_;
    TON life_;

public:
    void declare(Declaration& d) override {
        x_ = d.axis("x");
        how_ = d.parameter("how", {.value = 0, .minimum = 0, .maximum = 2, .unit = "", .doc = "0 lives, 1 wild pointer, 2 endless loop"});
        d.task<&Dying::scan>("main");
    }
    void scan(TaskContext& ctx) {
        power_.Axis = home_.Axis = move_.Axis = x_;
        power_.Enable = true;
        power_(ctx);
        move_.Velocity = 10;
        move_.Execute = power_.Status;
        move_(ctx);
        life_.IN = move_.InVelocity;
        life_.PT = std::chrono::milliseconds{500};
        life_(ctx);
        if (!life_.Q) return;
        if (ctx.get(how_) == 1) *reinterpret_cast<volatile int*>(8) = 1;  // NOLINT: this is the point
        volatile bool forever = ctx.get(how_) == 2;
        while (forever) {}
    }
};

}  // namespace

TAKTWERK_PROGRAM(Dying)
