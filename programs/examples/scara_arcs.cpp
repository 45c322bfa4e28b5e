// A SCARA that draws: a group of four axes, its arm in the machine's file. Round a slot of two lines and two half circles, laps without end: the
// corners are passed on curves, and the tool keeps its direction while the arm turns below it.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

class ScaraArcs final : public Program {
    static constexpr std::size_t joints = 4;
    std::array<AxisRef, joints> axes_;
    GroupRef arm_;
    Parameter speed_, corner_;

    MC_GroupPower power_;
    std::array<MC_Home, joints> homes_;
    MC_GroupEnable enable_;
    MC_GroupReset reset_;
    MC_GroupReadStatus status_;
    MC_GroupReadPosition place_;
    MC_MoveDirectAbsolute to_start_;
    MC_MoveLinearAbsolute up_, down_;
    MC_MoveCircularAbsolute far_, near_;

    bool draws_ = true, there_ = false, idle_ = false;
    std::int64_t laps_ = 0, failed_ = 0;
    double x_ = 0, y_ = 0, turn_ = 0;

public:
    void declare(Declaration& d) override {
        const char* names[joints] = {"shoulder", "elbow", "lift", "wrist"};
        for (std::size_t i = 0; i < joints; ++i) axes_[i] = d.axis(names[i]);
        arm_ = d.axis_group("arm");
        speed_ = d.parameter("speed", {.value = 200, .minimum = 1, .maximum = 500, .unit = "mm/s", .doc = "of the tool along its path"});
        corner_ =
            d.parameter("corner", {.value = 6, .minimum = 0, .maximum = 20, .unit = "mm", .doc = "where the curve of a corner begins"});
        d.operator_switch("draws", draws_, {.doc = "one lap after the other; a stop and an error switch it off"});
        d.monitor("laps", laps_, "", "drawn since start");
        d.monitor("failed", failed_, "", "commands that ended with an error");
        d.monitor("x", x_, "mm", "of the tool, set");
        d.monitor("y", y_, "mm", "of the tool, set");
        d.monitor("turn", turn_, "rad", "of the tool, set");
        d.block("up", up_);
        d.block("far", far_);
        d.task<&ScaraArcs::scan>("main");
    }

    void start() override {
        there_ = idle_ = false;
        draws_ = true;
        to_start_.Execute = up_.Execute = far_.Execute = down_.Execute = near_.Execute = enable_.Execute = reset_.Execute = false;
        for (auto& home : homes_) home.Execute = false;
    }

    void scan(TaskContext& ctx) {
        for (auto* group : {&power_.AxesGroup, &enable_.AxesGroup, &reset_.AxesGroup, &status_.AxesGroup, &place_.AxesGroup,
                            &to_start_.AxesGroup, &up_.AxesGroup, &down_.AxesGroup, &far_.AxesGroup, &near_.AxesGroup})
            *group = arm_;
        power_.Enable = status_.Enable = place_.Enable = true;
        power_(ctx);
        bool homed = true;
        for (std::size_t i = 0; i < joints; ++i) {
            homes_[i].Axis = axes_[i];
            homes_[i].Execute = power_.Status && !ctx.view(axes_[i])->homed;
            homes_[i](ctx);
            homed = homed && ctx.view(axes_[i])->homed && !homes_[i].Busy;
        }
        enable_.Execute = power_.Status && homed;
        enable_(ctx);
        status_(ctx);
        reset_.Execute = status_.GroupErrorStop && power_.Status;
        reset_(ctx);
        draw(ctx);
        place_.CoordSystem = mcMCS;
        place_(ctx);
        const auto& tool = place_.Position.C.Tcp;
        if (place_.Valid) x_ = tool.X, y_ = tool.Y, turn_ = tool.RZ;
    }

private:
    static constexpr double left = 220, right = 260, low = -60, high = 60;  // mm: the slot

    void draw(TaskContext& ctx) {
        to_start_.CoordSystem = up_.CoordSystem = far_.CoordSystem = down_.CoordSystem = near_.CoordSystem = mcMCS;
        to_start_.Position.C.Tcp = {.X = right, .Y = low};
        up_.Position.C.Tcp = {.X = right, .Y = high};
        far_.AuxPoint.C.Tcp = {.X = (left + right) / 2, .Y = high};
        far_.EndPoint.C.Tcp = {.X = left, .Y = high};
        down_.Position.C.Tcp = {.X = left, .Y = low};
        near_.AuxPoint.C.Tcp = {.X = (left + right) / 2, .Y = low};
        near_.EndPoint.C.Tcp = {.X = right, .Y = low};
        far_.CircMode = near_.CircMode = mcCENTER;
        far_.PathChoice = near_.PathChoice = mcCounterClockwise;
        up_.Velocity = down_.Velocity = far_.Velocity = near_.Velocity = ctx.get(speed_);
        far_.BufferMode = down_.BufferMode = near_.BufferMode = mcBlendingHigh;
        far_.TransitionMode = down_.TransitionMode = near_.TransitionMode = mcTMCornerDistance;
        far_.TransitionParameter.Parameter[0] = down_.TransitionParameter.Parameter[0] = near_.TransitionParameter.Parameter[0] =
            ctx.get(corner_);

        const bool stands = status_.GroupStandby && power_.Status;
        if (stands && draws_ && idle_) (there_ ? up_.Execute : to_start_.Execute) = true;
        to_start_(ctx);
        if (to_start_.Done) there_ = true;
        // Each follows as soon as the one before it is accepted: all four are one path.
        up_(ctx);
        far_.Execute = up_.Execute && (up_.CommandAccepted || far_.Execute);
        far_(ctx);
        down_.Execute = far_.Execute && (far_.CommandAccepted || down_.Execute);
        down_(ctx);
        near_.Execute = down_.Execute && (down_.CommandAccepted || near_.Execute);
        near_(ctx);
        idle_ = !to_start_.Execute && !up_.Execute;  // the blocks have seen it: the next TRUE is an edge
        const bool broken = up_.CommandAborted || far_.CommandAborted || down_.CommandAborted || near_.CommandAborted || up_.Error ||
                            far_.Error || down_.Error || near_.Error || to_start_.Error || to_start_.CommandAborted;
        if (near_.Done) ++laps_;
        if (to_start_.Error || up_.Error || far_.Error || down_.Error || near_.Error) ++failed_;
        if (to_start_.Done || broken) to_start_.Execute = false;
        if (near_.Done || broken) up_.Execute = far_.Execute = down_.Execute = near_.Execute = false;
        // Somebody has stopped it, or has to look: it does not begin by itself.
        if (broken) there_ = draws_ = false;
    }
};

}  // namespace

TAKTWERK_PROGRAM(ScaraArcs)
