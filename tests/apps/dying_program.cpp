// A program that moves x for a while and then takes the controller down with it: by a crash of one kind or another, or by never coming
// back. As a slower task it never comes back either.

#include <cstdlib>

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
        how_ = d.parameter("how", {.value = 0,
                                   .minimum = 0,
                                   .maximum = 5,
                                   .unit = "",
                                   .doc = "0 lives, 1 wild pointer, 2 endless loop, 3 division by zero, 4 recursion, 5 abort"});
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
        if (ctx.get(how_) == 3) quotient_ = 1000 / zero_;                 // NOLINT: nor is this one an accident
        if (ctx.get(how_) == 4) quotient_ = deeper(1);
        if (ctx.get(how_) == 5) std::abort();
        volatile bool forever = ctx.get(how_) == 2;
        while (forever) {}
    }

private:
    volatile int zero_ = 0, quotient_ = 0;
    int deeper(int depth) {  // NOLINT: this is the point
        volatile char used[4096] = {};
        used[depth % 4096] = 1;
        return depth < 0 ? depth : deeper(depth + 1) + used[0];
    }
};

}  // namespace

TAKTWERK_PROGRAM(Dying)
