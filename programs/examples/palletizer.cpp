// A SCARA takes boxes from a chute and stacks them on a pallet, layer by layer, each layer turned against the one below, so that the stack holds together.
// The pattern is written in the pallet's own frame; where the pallet stands is told once (MC_SetCoordinateTransform), by whoever has measured it.
//
//     even layers        odd layers           boxes of 60 x 40 mm, 120 x 120 mm in all
//     +-----+-----+      +---+---+---+
//     |     |     |      |   |   |   |        Between the places the arm moves as its joints like it best (MC_MoveDirectAbsolute:
//     +-----+-----+      |   |   |   |        no straight way is wanted there). Close to boxes the tool goes straight, and comes in
//     |     |     |      +---+---+---+        aslant from the free side, so that no box rubs against its neighbours; that corner is
//     +-----+-----+      |   |   |   |        passed on a curve.
//     |     |     |      |   |   |   |
//     +-----+-----+      +---+---+---+

#include <algorithm>
#include <array>
#include <numbers>

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace std::chrono_literals;
using namespace taktwerk;
using namespace taktwerk::fb;

constexpr double degree = std::numbers::pi / 180;

// mm. The tool's point is the middle of the box's top. Of the machine (mcMCS):
constexpr double chute_x = 250, chute_y = -320, chute_top = 130;  // of a box that lies there along X
constexpr double pallet_height = 50;
// Of a box, and of the ways close to it.
constexpr double length = 60, width = 40, height = 30;
constexpr double high = 100;    // above the place: from here on straight
constexpr double aslant = 10;   // to the free side ...
constexpr double near_by = 25;  // ... and above it, where the way turns down
constexpr std::int64_t layers = 3, boxes_of_layer = 6;

/// Where a box lies on the pallet: the middle of its top, in the pallet's frame (mcPCS).
MC_CART_REF place_of(std::int64_t box) {
    const std::int64_t layer = box / boxes_of_layer, in_layer = box % boxes_of_layer;
    const double z = height * static_cast<double>(layer + 1);
    if (layer % 2 == 0)  // two columns of three, along X
        return {.X = length * (static_cast<double>(in_layer % 2) + 0.5), .Y = width * (static_cast<double>(in_layer / 2) + 0.5), .Z = z};
    return {.X = width * (static_cast<double>(in_layer % 3) + 0.5),  // three columns of two, across
            .Y = length * (static_cast<double>(in_layer / 3) + 0.5),
            .Z = z,
            .RZ = 90 * degree};
}

class Palletizer final : public Program {
    static constexpr std::size_t joints = 4;
    enum class Step : std::uint8_t { raise, prepare, wait, take, stack, change_pallet };

    std::array<AxisRef, joints> axes_;
    GroupRef arm_;
    Input<bool> box_there_, pallet_there_, go_on_;
    Output<bool> grip_, pallet_full_;
    Parameter pallet_x_, pallet_y_, pallet_turned_, speed_;

    struct {  // power and reference
        MC_GroupPower power;
        std::array<MC_Home, joints> homes;
        MC_GroupEnable enable;
        MC_GroupReadStatus status;
        MC_GroupReadPosition place;
    } up_;
    struct {  // a round, in its order
        MC_MoveDirectRelative raise;
        MC_GroupSelectTool tool;
        MC_SetCoordinateTransform pallet;
        MC_MoveDirectAbsolute over_chute;
        MC_MoveLinearAbsolute onto_box, off_chute;
        MC_GroupWaitTime gripping;
        MC_MoveDirectAbsolute over_pallet;
        MC_MoveLinearAbsolute beside, down, off_pallet;
        MC_GroupWaitTime letting_go;
    } go_;
    TON exchange_;
    R_TRIG pressed_;

    Step step_ = Step::raise;
    bool fresh_ = true;   ///< the first scan of a step: its blocks are called with Execute FALSE, so that the next one is an edge
    bool begun_ = false;  ///< its blocks have Execute TRUE
    bool works_ = true, stopped_ = false;
    bool holds_ = false;    ///< the gripper is closed
    bool carries_ = false;  ///< a box is off the chute and not on the pallet yet
    std::int64_t box_ = 0;  ///< the next one of this pallet
    struct {                // for people
        std::int64_t stacked = 0, pallets = 0, error = 0;
    } count_;

public:
    void declare(Declaration& d) override {
        const char* names[joints] = {"shoulder", "elbow", "lift", "wrist"};
        for (std::size_t i = 0; i < joints; ++i) axes_[i] = d.axis(names[i]);
        arm_ = d.axis_group("arm");
        box_there_ = d.input("box_there");
        pallet_there_ = d.input("pallet_there");
        go_on_ = d.input("go_on");
        grip_ = d.output("grip");
        pallet_full_ = d.output("pallet_full");
        pallet_x_ =
            d.parameter("pallet_x", {.value = 260, .minimum = 150, .maximum = 300, .unit = "mm", .doc = "its corner in the machine"});
        pallet_y_ = d.parameter("pallet_y", {.value = 130, .minimum = 50, .maximum = 200, .unit = "mm", .doc = "likewise"});
        pallet_turned_ =
            d.parameter("pallet_turned", {.value = 15, .minimum = -30, .maximum = 30, .unit = "deg", .doc = "counter-clockwise"});
        speed_ = d.parameter("speed",
                             {.value = 90, .minimum = 1, .maximum = 100, .unit = "%", .doc = "of the joints, between chute and pallet"});
        d.operator_switch("works", works_, {.doc = "boxes are stacked; a stop and an error switch it off"});
        d.monitor("box", box_, "", "the next one on this pallet");
        d.monitor("stacked", count_.stacked, "", "since start");
        d.monitor("pallets", count_.pallets, "", "filled");
        d.monitor("error", count_.error, "", "ErrorID that broke the last round off (docs/reference/errors.md); 0: it was aborted");
        d.block("over_pallet", go_.over_pallet);
        d.block("down", go_.down);
        d.alarm(0, Reaction::warn, "The arm was stopped on its way and waits for a person", "机械臂中途停止，等待人工操作",
                "remove the cause (alarms of its axes and of the bus name it), look that nobody is in its reach, reset, then press `go_on` "
                "(or switch `works` on): it goes up first, and lays down what it holds where it was meant to go");
        d.task<&Palletizer::scan>("main");
    }

    void start() override {
        // The gripper stays as it is: what hangs in it would fall.
        stopped_ = false;
        works_ = true;
        enter(Step::raise);
        for (auto& home : up_.homes) home.Execute = false;
        up_.enable.Execute = false;
    }

    void scan(TaskContext& ctx) {
        for (auto* group : {&up_.power.AxesGroup, &up_.enable.AxesGroup, &up_.status.AxesGroup, &up_.place.AxesGroup, &go_.raise.AxesGroup,
                            &go_.tool.AxesGroup, &go_.pallet.AxesGroup, &go_.over_chute.AxesGroup, &go_.onto_box.AxesGroup,
                            &go_.off_chute.AxesGroup, &go_.gripping.AxesGroup, &go_.over_pallet.AxesGroup, &go_.beside.AxesGroup,
                            &go_.down.AxesGroup, &go_.off_pallet.AxesGroup, &go_.letting_go.AxesGroup})
            *group = arm_;
        const bool ready = power(ctx);
        pressed_.CLK = ctx.get(go_on_);
        pressed_(ctx);
        if (pressed_.Q && !up_.status.GroupErrorStop) works_ = true;
        if (works_) stopped_ = false;
        describe(ctx);
        move(ctx, ready && (works_ || under_way()));
        ctx.set(grip_, holds_);
        ctx.set(pallet_full_, step_ == Step::change_pallet);
        ctx.alarm(0, stopped_);
    }

private:
    /// All that has to be so before anything moves.
    bool power(TaskContext& ctx) {
        up_.power.Enable = up_.status.Enable = up_.place.Enable = true;
        up_.power(ctx);
        bool homed = true;
        for (std::size_t i = 0; i < joints; ++i) {
            up_.homes[i].Axis = axes_[i];
            up_.homes[i].Execute = up_.power.Status && !ctx.view(axes_[i])->homed;
            up_.homes[i](ctx);
            homed = homed && ctx.view(axes_[i])->homed && !up_.homes[i].Busy;
        }
        up_.enable.Execute = up_.power.Status && homed;
        up_.enable(ctx);
        up_.status(ctx);
        up_.place.CoordSystem = mcACS;
        up_.place(ctx);
        return up_.power.Status && homed && up_.place.Valid && (up_.status.GroupStandby || up_.status.GroupMoving);
    }

    /// Where everything goes. Told in each scan; a command keeps what stood here at its edge.
    void describe(TaskContext& ctx) {
        // The lift alone, whatever is below it.
        go_.raise.CoordSystem = mcACS;
        if (!begun_) go_.raise.Distance.A.Axes = {0, 0, std::max(-up_.place.Position.A.Axes[2], 0.0), 0};
        go_.raise.Velocity = 200;
        go_.tool.ToolNumber = 1;
        go_.pallet.CoordSystem = mcPCS;
        go_.pallet.CoordTransform = {
            .X = ctx.get(pallet_x_), .Y = ctx.get(pallet_y_), .Z = pallet_height, .RZ = ctx.get(pallet_turned_) * degree};

        for (auto* direct : {&go_.over_chute, &go_.over_pallet})
            direct->Velocity = 300 * ctx.get(speed_) / 100;  // deg/s: of the joints together
        go_.over_chute.CoordSystem = go_.onto_box.CoordSystem = go_.off_chute.CoordSystem = mcMCS;
        go_.over_chute.Position.C.Tcp = go_.off_chute.Position.C.Tcp = {.X = chute_x, .Y = chute_y, .Z = chute_top + high};
        go_.onto_box.Position.C.Tcp = {.X = chute_x, .Y = chute_y, .Z = chute_top};
        go_.gripping.Duration = 150ms;

        go_.over_pallet.CoordSystem = go_.beside.CoordSystem = go_.down.CoordSystem = go_.off_pallet.CoordSystem = mcPCS;
        auto there = place_of(box_);
        go_.down.Position.C.Tcp = there;
        go_.down.Position.C.Tcp.Z += 0.5;  // it falls the last half millimetre
        there.X += aslant, there.Y += aslant;
        there.Z += near_by;
        go_.beside.Position.C.Tcp = there;
        there.Z += high - near_by;
        go_.over_pallet.Position.C.Tcp = go_.off_pallet.Position.C.Tcp = there;
        go_.letting_go.Duration = 120ms;

        for (auto* move : {&go_.onto_box, &go_.off_chute, &go_.beside, &go_.down, &go_.off_pallet}) move->BufferMode = mcBuffered;
        go_.gripping.BufferMode = go_.letting_go.BufferMode = mcBuffered;
        // From the slanting way into the one down there is a corner in the air: on a curve.
        go_.down.BufferMode = mcBlendingLow;
        go_.down.TransitionMode = mcTMCornerDistance;
        go_.down.TransitionParameter.Parameter[0] = 8;
        go_.onto_box.Velocity = go_.down.Velocity = 150;
    }

    void enter(Step step) {
        step_ = step;
        fresh_ = true;
        begun_ = false;
    }

    void move(TaskContext& ctx, bool ready) {
        if (!fresh_ && ready) begun_ = true;
        fresh_ = false;
        go_.raise.Execute = begun_ && step_ == Step::raise;
        // What is accepted from now on has this tool and this frame.
        go_.tool.Execute = go_.pallet.Execute = begun_ && step_ == Step::prepare;
        // Each of these is a row of commands that the group keeps in its queue.
        go_.over_chute.Execute = go_.onto_box.Execute = go_.gripping.Execute = go_.off_chute.Execute = begun_ && step_ == Step::take;
        go_.over_pallet.Execute = go_.beside.Execute = go_.down.Execute = go_.letting_go.Execute = go_.off_pallet.Execute =
            begun_ && step_ == Step::stack;

        go_.raise(ctx);
        go_.tool(ctx);
        go_.pallet(ctx);
        go_.over_chute(ctx);
        go_.onto_box(ctx);
        go_.gripping(ctx);
        go_.off_chute(ctx);
        go_.over_pallet(ctx);
        go_.beside(ctx);
        go_.down(ctx);
        go_.letting_go(ctx);
        go_.off_pallet(ctx);
        next(ctx);
    }

    /// A round that has begun is ended: no box hangs in the air because somebody switches `works` off.
    [[nodiscard]] bool under_way() const { return step_ == Step::take || step_ == Step::stack; }
    /// One that has ended otherwise than Done ends the round. `error` says which ErrorID it was; 0: somebody else's command, or a person, aborted it.
    [[nodiscard]] bool broken() {
        bool over = false;
        const auto look = [&](const auto&... block) {
            const auto one = [&](const auto& b) {
                if (over || !(b.Error || b.CommandAborted)) return;
                over = true;
                count_.error = b.Error ? static_cast<std::int64_t>(b.ErrorID) : 0;
            };
            (one(block), ...);
        };
        look(go_.raise, go_.pallet, go_.over_chute, go_.onto_box, go_.gripping, go_.off_chute, go_.over_pallet, go_.beside, go_.down,
             go_.letting_go, go_.off_pallet);
        if (go_.tool.Error) over = true, count_.error = static_cast<std::int64_t>(go_.tool.ErrorID);
        return over;
    }

    void next(TaskContext& ctx) {
        exchange_.IN = step_ == Step::change_pallet && ctx.get(pallet_there_) && works_;
        exchange_.PT = 1s;
        exchange_(ctx);
        if (begun_ && broken()) {
            if (!carries_) holds_ = false;
            works_ = false;
            stopped_ = true;
            return enter(Step::raise);
        }
        switch (step_) {
            case Step::raise:
                if (go_.raise.Done) enter(Step::prepare);
                break;
            case Step::prepare:
                if (go_.tool.Done && go_.pallet.Done) enter(carries_ ? Step::stack : Step::wait);
                break;
            case Step::wait:
                if (works_ && ctx.get(box_there_)) enter(Step::take);
                break;
            case Step::take:
                if (go_.onto_box.Done) holds_ = true;
                if (go_.gripping.Done) carries_ = true;
                if (go_.off_chute.Done) enter(Step::stack);
                break;
            case Step::stack:
                if (go_.down.Done && carries_) {
                    holds_ = carries_ = false;
                    ++box_, ++count_.stacked;
                }
                if (go_.off_pallet.Done) enter(box_ < layers * boxes_of_layer ? Step::wait : Step::change_pallet);
                break;
            case Step::change_pallet:
                if (!exchange_.Q) break;
                ++count_.pallets;
                box_ = 0;
                enter(Step::prepare);  // the next one may stand somewhere else
                break;
        }
    }
};

}  // namespace

TAKTWERK_PROGRAM(Palletizer)
