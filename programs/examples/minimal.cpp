// The smallest program that moves: one axis is powered and goes to and fro.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

class Minimal final : public Program {
    AxisRef x_;
    MC_Power power_;
    MC_MoveAbsolute there_, back_;

public:
    void declare(Declaration& d) override {
        x_ = d.axis("x");
        d.task<&Minimal::scan>("main");
    }

    void scan(TaskContext& ctx) {
        power_.Axis = x_;
        power_.Enable = true;
        power_(ctx);

        there_.Axis = back_.Axis = x_;
        there_.Position = 100;
        back_.Position = 0;
        there_.Velocity = back_.Velocity = 200;
        there_.Execute = power_.Status && !there_.Done && !back_.Busy;
        there_(ctx);
        back_.Execute = there_.Done || back_.Busy;
        back_(ctx);
    }
};

}  // namespace

TAKTWERK_PROGRAM(Minimal)
