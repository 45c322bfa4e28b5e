// A gantry lays a bead of sealant onto covers, along lines and arcs. The bead is as thick everywhere because the pump turns with the length of the path
// (MC_SyncAxisToGroup), not with time: what slows the nozzle down (a corner, an override, a person who holds it) slows the pump down alike.
//
//     (0,100) ----------- (160,100)      the drawing, mm in the cover's frame: two sharp corners, cut by `corner`;
//        |                    |          two arcs of 20 mm, into which the lines lead without a corner
//        |                    |
//     (0,20)                (160,20)
//        (  ----- S -----  )             begins and ends at S
//      (20,0)   (80,0)   (140,0)
//
// The order at both ends is what counts: nozzle down, pump in sync while the path stands, valve open, bead; and at its end valve shut, pump back a little,
// nozzle up.

#include <algorithm>
#include <array>
#include <cmath>

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace std::chrono_literals;
using namespace taktwerk;
using namespace taktwerk::fb;

// mm in the cover's frame (mcPCS; where that is, the machine file says), Z up from its surface.
constexpr double gap = 1;         // of the nozzle's tip while it dispenses
constexpr double clearance = 40;  // of the tip on its way
constexpr double begin_x = 80, begin_y = 0;
// The pump: 500 mm3 a turn.
constexpr double degrees_per_mm3 = 360.0 / 500;
constexpr double drawn_back =
    20;  // deg: so much the pump turns back behind a bead, and forth in front of the next one, or the nozzle drips

class Dispensing final : public Program {
    static constexpr std::size_t members = 4;
    enum class Step : std::uint8_t { raise, square, wait, approach, prime, couple, bead, draw_back, leave };

    std::array<AxisRef, members> axes_;
    AxisRef pump_;
    GroupRef gantry_;
    Input<bool> cover_there_, go_on_;
    Output<bool> valve_, cover_done_;
    Parameter speed_, bead_, corner_;

    struct {  // power and reference
        MC_GroupPower power;
        std::array<MC_Home, members> homes;
        MC_GroupEnable enable;
        MC_GroupReadStatus status;
        MC_GroupReadPosition place;
        MC_Power pump_power;
    } up_;
    struct {  // a round, in its order
        MC_MoveDirectRelative raise;
        MC_MoveDirectAbsolute square;
        MC_MoveLinearAbsolute over, down;
        MC_MoveRelative prime;
        MC_SyncAxisToGroup sync;
        MC_MoveLinearAbsolute along_bottom, up_right, along_top, down_left, to_end;
        MC_MoveCircularAbsolute right_arc, left_arc;
        MC_MoveRelative draw_back;
        MC_Halt pump_halt;
        MC_MoveLinearAbsolute leave;
    } go_;
    TON exchange_;
    R_TRIG pressed_;

    Step step_ = Step::raise;
    bool fresh_ = true;   ///< the first scan of a step: its blocks are called with Execute FALSE, so that the next one is an edge
    bool begun_ = false;  ///< its blocks have Execute TRUE
    bool works_ = true, stopped_ = false;
    bool primed_ = false;  ///< the pump has not been drawn back since it was turned forth
    bool open_ = false;
    struct {  // for people
        std::int64_t covers = 0, spoiled = 0, error = 0;
        double pumped = 0, pump_began = 0;  // mm3, deg
    } count_;

public:
    void declare(Declaration& d) override {
        const char* names[members] = {"near", "far", "across", "lift"};
        for (std::size_t i = 0; i < members; ++i) axes_[i] = d.axis(names[i]);
        pump_ = d.axis("pump");
        gantry_ = d.axis_group("gantry");
        cover_there_ = d.input("cover_there");
        go_on_ = d.input("go_on");
        valve_ = d.output("valve");
        cover_done_ = d.output("cover_done");
        speed_ = d.parameter("speed", {.value = 120, .minimum = 5, .maximum = 300, .unit = "mm/s", .doc = "along the bead"});
        bead_ = d.parameter("bead", {.value = 3, .minimum = 0.1, .maximum = 20, .unit = "mm2", .doc = "section of the bead"});
        corner_ = d.parameter("corner",
                              {.value = 2, .minimum = 0, .maximum = 5, .unit = "mm", .doc = "by which the sharp corners are cut at most"});
        d.operator_switch("works", works_, {.doc = "covers are worked on; a stop and an error switch it off"});
        d.monitor("covers", count_.covers, "", "with a whole bead, since start");
        d.monitor("spoiled", count_.spoiled, "", "covers whose bead was broken off");
        d.monitor("error", count_.error, "", "ErrorID that broke the last round off (docs/reference/errors.md); 0: it was aborted");
        d.monitor("pumped", count_.pumped, "mm3", "of the bead under way, or of the last one");
        d.block("sync", go_.sync);
        d.block("along_top", go_.along_top);
        d.alarm(0, Reaction::warn, "The bead or the way to it was broken off, and the gantry waits for a person",
                "涂胶或其路径中断，龙门等待人工操作",
                "remove the cause (alarms of its axes and of the bus name it), take the cover away if its bead is not whole, reset, then "
                "press `go_on` (or switch `works` on): it goes up first and begins with a new cover");
        d.task<&Dispensing::scan>("main");
    }

    void start() override {
        open_ = stopped_ = false;
        works_ = true;
        enter(Step::raise);
        for (auto& home : up_.homes) home.Execute = false;
        up_.enable.Execute = go_.sync.Execute = false;
    }

    void scan(TaskContext& ctx) {
        for (auto* group : {&up_.power.AxesGroup, &up_.enable.AxesGroup, &up_.status.AxesGroup, &up_.place.AxesGroup, &go_.raise.AxesGroup,
                            &go_.square.AxesGroup, &go_.over.AxesGroup, &go_.down.AxesGroup, &go_.sync.AxesGroup,
                            &go_.along_bottom.AxesGroup, &go_.right_arc.AxesGroup, &go_.up_right.AxesGroup, &go_.along_top.AxesGroup,
                            &go_.down_left.AxesGroup, &go_.left_arc.AxesGroup, &go_.to_end.AxesGroup, &go_.leave.AxesGroup})
            *group = gantry_;
        const bool ready = power(ctx);
        pressed_.CLK = ctx.get(go_on_);
        pressed_(ctx);
        if (pressed_.Q && !up_.status.GroupErrorStop) works_ = true;
        if (works_) stopped_ = false;
        describe(ctx);
        move(ctx, ready && (works_ || under_way()));
        // Whatever the sequence believes: without the pump in step with a path that is gone there is no bead.
        ctx.set(valve_, open_ && go_.sync.InSync && up_.status.GroupMoving);
        ctx.set(cover_done_, step_ == Step::wait && count_.covers + count_.spoiled > 0);
        ctx.alarm(0, stopped_);
    }

private:
    /// All that has to be so before anything moves.
    bool power(TaskContext& ctx) {
        up_.power.Enable = up_.status.Enable = up_.place.Enable = true;
        up_.power(ctx);
        bool homed = true;
        for (std::size_t i = 0; i < members; ++i) {
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
        up_.pump_power.Axis = pump_;
        up_.pump_power.Enable = true;
        up_.pump_power(ctx);
        return up_.power.Status && homed && up_.pump_power.Status && up_.place.Valid && (up_.status.GroupStandby || up_.status.GroupMoving);
    }

    /// Where everything goes. Told in each scan; a command keeps what stood here at its edge.
    void describe(TaskContext& ctx) {
        // Of the axes themselves: no path of the tool begins while the beam is askew, and it may be after a fault. Straight up first, then square, which
        // moves both ends alike but for what one lacks.
        const auto& here = up_.place.Position.A.Axes;
        go_.raise.CoordSystem = go_.square.CoordSystem = mcACS;
        if (!begun_) go_.raise.Distance.A.Axes = {0, 0, 0, std::max(-here[3], 0.0)};
        go_.raise.Velocity = 150;
        if (!begun_) go_.square.Position.A.Axes = {std::max(here[0], 0.0), std::max(here[0], 0.0), here[2], 0};
        go_.square.Velocity = 5;

        for (auto* line : {&go_.over, &go_.down, &go_.along_bottom, &go_.up_right, &go_.along_top, &go_.down_left, &go_.to_end, &go_.leave})
            line->CoordSystem = mcPCS;
        go_.over.Position.C.Tcp = go_.leave.Position.C.Tcp = {.X = begin_x, .Y = begin_y, .Z = clearance};
        go_.down.Position.C.Tcp = {.X = begin_x, .Y = begin_y, .Z = gap};
        go_.down.Velocity = 150;
        go_.down.BufferMode = mcBlendingHigh;
        go_.down.TransitionMode = mcTMCornerDistance;
        go_.down.TransitionParameter.Parameter[0] = 15;

        go_.along_bottom.Position.C.Tcp = {.X = 140, .Y = 0, .Z = gap};
        go_.up_right.Position.C.Tcp = {.X = 160, .Y = 100, .Z = gap};
        go_.along_top.Position.C.Tcp = {.X = 0, .Y = 100, .Z = gap};
        go_.down_left.Position.C.Tcp = {.X = 0, .Y = 20, .Z = gap};
        go_.to_end.Position.C.Tcp = {.X = begin_x, .Y = begin_y, .Z = gap};
        for (auto* arc : {&go_.right_arc, &go_.left_arc}) {
            arc->CoordSystem = mcPCS;
            arc->CircMode = mcCENTER;
            arc->PathChoice = mcCounterClockwise;
        }
        go_.right_arc.AuxPoint.C.Tcp = {.X = 140, .Y = 20, .Z = gap};
        go_.right_arc.EndPoint.C.Tcp = {.X = 160, .Y = 20, .Z = gap};
        go_.left_arc.AuxPoint.C.Tcp = {.X = 20, .Y = 20, .Z = gap};
        go_.left_arc.EndPoint.C.Tcp = {.X = 20, .Y = 0, .Z = gap};
        // How the corner in front of each is passed. Where a line leads into an arc there is none, but without a curve the nozzle would have to stand
        // there: what makes it turn would be there at once.
        const auto pass = [&](auto& move, double deviation) {
            move.Velocity = ctx.get(speed_);
            move.BufferMode = mcBlendingPrevious;
            move.TransitionMode = mcTMMaxCornerDeviation;
            move.TransitionParameter.Parameter[0] = deviation;
        };
        go_.along_bottom.Velocity = ctx.get(speed_);
        constexpr double smooth = 0.1;
        pass(go_.right_arc, smooth);
        pass(go_.up_right, smooth);
        pass(go_.along_top, ctx.get(corner_));
        pass(go_.down_left, ctx.get(corner_));
        pass(go_.left_arc, smooth);
        pass(go_.to_end, smooth);

        go_.prime.Axis = go_.draw_back.Axis = go_.pump_halt.Axis = go_.sync.SlaveAxis = pump_;
        go_.prime.Distance = primed_ ? 0 : drawn_back;
        go_.draw_back.Distance = -drawn_back;
        go_.prime.Velocity = go_.draw_back.Velocity = 180;
        // deg of the pump for each mm of the path, as two whole numbers.
        go_.sync.RatioNumerator = static_cast<std::int16_t>(std::lround(1000 * ctx.get(bead_) * degrees_per_mm3));
        go_.sync.RatioDenominator = 1000;
    }

    void enter(Step step) {
        step_ = step;
        fresh_ = true;
        begun_ = false;
    }

    void move(TaskContext& ctx, bool ready) {
        if (!fresh_ && ready) begun_ = true;
        fresh_ = false;
        // Behind a break the pump has to leave the path at once: it would go on turning against a shut valve.
        go_.pump_halt.Execute = step_ == Step::raise && up_.pump_power.Status;
        go_.pump_halt(ctx);
        go_.raise.Execute = begun_ && step_ == Step::raise;
        go_.square.Execute = begun_ && step_ == Step::square;
        go_.over.Execute = go_.down.Execute = begun_ && step_ == Step::approach;
        go_.prime.Execute = begun_ && step_ == Step::prime;
        // It stays coupled until the pump gets a command of its own, which is go_.draw_back.
        go_.sync.Execute = (begun_ && step_ == Step::couple) || step_ == Step::bead;
        // All of them in one scan: seven moves are one path, and the nozzle does not wait for the program in any corner.
        go_.along_bottom.Execute = go_.right_arc.Execute = go_.up_right.Execute = go_.along_top.Execute = go_.down_left.Execute =
            go_.left_arc.Execute = go_.to_end.Execute = begun_ && step_ == Step::bead;
        go_.draw_back.Execute = begun_ && step_ == Step::draw_back;
        go_.leave.Execute = begun_ && step_ == Step::leave;

        go_.raise(ctx);
        go_.square(ctx);
        go_.over(ctx);
        go_.down(ctx);
        go_.prime(ctx);
        go_.sync(ctx);
        go_.along_bottom(ctx);
        go_.right_arc(ctx);
        go_.up_right(ctx);
        go_.along_top(ctx);
        go_.down_left(ctx);
        go_.left_arc(ctx);
        go_.to_end(ctx);
        go_.draw_back(ctx);
        go_.leave(ctx);
        next(ctx);
    }

    /// A round that has begun is ended: the nozzle does not stay on the cover because somebody switches `works` off.
    [[nodiscard]] bool under_way() const { return step_ > Step::wait; }
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
        look(go_.raise, go_.square, go_.over, go_.down, go_.prime, go_.along_bottom, go_.right_arc, go_.up_right, go_.along_top,
             go_.down_left, go_.left_arc, go_.to_end, go_.draw_back, go_.leave);
        if (step_ == Step::couple || step_ == Step::bead) look(go_.sync);
        return over;
    }

    void next(TaskContext& ctx) {
        exchange_.IN = step_ == Step::wait && ctx.get(cover_there_) && works_;
        exchange_.PT = 500ms;
        exchange_(ctx);
        if (begun_ && broken()) {
            open_ = false;
            if (step_ == Step::bead) ++count_.spoiled;
            works_ = false;
            stopped_ = true;
            return enter(Step::raise);
        }
        if (step_ == Step::bead) count_.pumped = (ctx.view(pump_)->actual_position - count_.pump_began) / degrees_per_mm3;
        switch (step_) {
            case Step::raise:
                if (go_.raise.Done) enter(Step::square);
                break;
            case Step::square:
                if (go_.square.Done) enter(Step::wait);
                break;
            case Step::wait:
                if (exchange_.Q) enter(Step::approach);
                break;
            case Step::approach:
                if (go_.down.Done) enter(Step::prime);
                break;
            case Step::prime:
                if (!go_.prime.Done) break;
                primed_ = true;
                enter(Step::couple);
                break;
            case Step::couple:
                // The path stands: the pump has nothing to catch up with, and nothing of the bead is lost.
                if (!go_.sync.InSync) break;
                count_.pump_began = ctx.view(pump_)->actual_position;
                enter(Step::bead);
                break;
            case Step::bead:
                open_ = go_.along_bottom.Active || open_;
                if (!go_.to_end.Done) break;
                open_ = false;
                ++count_.covers;
                enter(Step::draw_back);
                break;
            case Step::draw_back:
                if (!go_.draw_back.Done) break;
                primed_ = false;
                enter(Step::leave);
                break;
            case Step::leave:
                if (go_.leave.Done) enter(Step::wait);
                break;
        }
    }
};

}  // namespace

TAKTWERK_PROGRAM(Dispensing)
