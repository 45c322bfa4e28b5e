// A program as it stands in a machine builder's own repository.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

class Outside final : public Program {
    AxisRef x_;
    Input<bool> start_;
    Output<bool> lamp_;
    Parameter speed_;
    MC_Power power_;
    MC_MoveVelocity move_;
    TON delay_;
    std::int64_t scans_ = 0;

public:
    void declare(Declaration& d) override {
        x_ = d.axis("x");
        start_ = d.input("start_button");
        lamp_ = d.output("lamp");
        speed_ = d.parameter("speed", {.value = 20, .minimum = 1, .maximum = 50, .unit = "mm/s", .doc = "while the button is held"});
        d.monitor("scans", scans_, "", "scans since start");
        d.alarm(0, Reaction::warn, "The axis is not powered", "轴未上电", "look at the axis' own alarm");
        d.task<&Outside::scan>("main");
    }
    void start() override { scans_ = 0; }
    void scan(TaskContext& ctx) {
        ++scans_;
        power_.Axis = move_.Axis = x_;
        power_.Enable = true;
        power_(ctx);
        delay_.IN = ctx.get(start_);
        delay_.PT = from_seconds(0.1);
        delay_(ctx);
        move_.Velocity = ctx.get(speed_);
        move_.Execute = power_.Status && delay_.Q;
        move_(ctx);
        ctx.set(lamp_, move_.InVelocity);
        ctx.alarm(0, !power_.Status);
    }
};

}  // namespace

TAKTWERK_PROGRAM(Outside)
