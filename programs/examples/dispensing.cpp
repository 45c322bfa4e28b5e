// A gantry lays a bead of sealant onto covers, along lines and arcs. The bead is as thick everywhere because the pump turns with the length of the path
// (MC_SyncAxisToGroup), not with time: what
// slows the nozzle down (a corner, an override, a person who holds it) slows the pump down alike.
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

    MC_GroupPower power_;
    std::array<MC_Home, members> homes_;
    MC_GroupEnable enable_;
    MC_GroupReadStatus status_;
    MC_GroupReadPosition place_;
    MC_Power pump_power_;
    // A round, in its order.
    MC_MoveDirectRelative raise_;
    MC_MoveDirectAbsolute square_;
    MC_MoveLinearAbsolute over_, down_;
    MC_MoveRelative prime_;
    MC_SyncAxisToGroup sync_;
    MC_MoveLinearAbsolute along_bottom_, up_right_, along_top_, down_left_, to_end_;
    MC_MoveCircularAbsolute right_arc_, left_arc_;
    MC_MoveRelative draw_back_;
    MC_Halt pump_halt_;
    MC_MoveLinearAbsolute leave_;
    TON exchange_;
    R_TRIG pressed_;

    Step step_ = Step::raise;
    bool fresh_ = true;   ///< the first scan of a step: its blocks are called with Execute FALSE, so that the next one is an edge
    bool begun_ = false;  ///< its blocks have Execute TRUE
    bool works_ = true, stopped_ = false;
    bool primed_ = false;  ///< the pump has not been drawn back since it was turned forth
    bool open_ = false;
    std::int64_t covers_ = 0, spoiled_ = 0, error_ = 0;
    double pumped_ = 0, pump_began_ = 0;

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
        d.monitor("covers", covers_, "", "with a whole bead, since start");
        d.monitor("spoiled", spoiled_, "", "covers whose bead was broken off");
        d.monitor("error", error_, "", "ErrorID that broke the last round off (docs/reference/errors.md); 0: it was aborted");
        d.monitor("pumped", pumped_, "mm3", "of the bead under way, or of the last one");
        d.block("sync", sync_);
        d.block("along_top", along_top_);
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
        for (auto& home : homes_) home.Execute = false;
        enable_.Execute = sync_.Execute = false;
    }

    void scan(TaskContext& ctx) {
        for (auto* group :
             {&power_.AxesGroup, &enable_.AxesGroup, &status_.AxesGroup, &place_.AxesGroup, &raise_.AxesGroup, &square_.AxesGroup,
              &over_.AxesGroup, &down_.AxesGroup, &sync_.AxesGroup, &along_bottom_.AxesGroup, &right_arc_.AxesGroup, &up_right_.AxesGroup,
              &along_top_.AxesGroup, &down_left_.AxesGroup, &left_arc_.AxesGroup, &to_end_.AxesGroup, &leave_.AxesGroup})
            *group = gantry_;
        const bool ready = power(ctx);
        pressed_.CLK = ctx.get(go_on_);
        pressed_(ctx);
        if (pressed_.Q && !status_.GroupErrorStop) works_ = true;
        if (works_) stopped_ = false;
        describe(ctx);
        move(ctx, ready && (works_ || under_way()));
        // Whatever the sequence believes: without the pump in step with a path that is gone there is no bead.
        ctx.set(valve_, open_ && sync_.InSync && status_.GroupMoving);
        ctx.set(cover_done_, step_ == Step::wait && covers_ + spoiled_ > 0);
        ctx.alarm(0, stopped_);
    }

private:
    /// All that has to be so before anything moves.
    bool power(TaskContext& ctx) {
        power_.Enable = status_.Enable = place_.Enable = true;
        power_(ctx);
        bool homed = true;
        for (std::size_t i = 0; i < members; ++i) {
            homes_[i].Axis = axes_[i];
            homes_[i].Execute = power_.Status && !ctx.view(axes_[i])->homed;
            homes_[i](ctx);
            homed = homed && ctx.view(axes_[i])->homed && !homes_[i].Busy;
        }
        enable_.Execute = power_.Status && homed;
        enable_(ctx);
        status_(ctx);
        place_.CoordSystem = mcACS;
        place_(ctx);
        pump_power_.Axis = pump_;
        pump_power_.Enable = true;
        pump_power_(ctx);
        return power_.Status && homed && pump_power_.Status && place_.Valid && (status_.GroupStandby || status_.GroupMoving);
    }

    /// Where everything goes. Told in each scan; a command keeps what stood here at its edge.
    void describe(TaskContext& ctx) {
        // Of the axes themselves: no path of the tool begins while the beam is askew, and it may be after a fault. Straight up first, then square, which
        // moves both ends alike but for what one lacks.
        const auto& here = place_.Position.A.Axes;
        raise_.CoordSystem = square_.CoordSystem = mcACS;
        if (!begun_) raise_.Distance.A.Axes = {0, 0, 0, std::max(-here[3], 0.0)};
        raise_.Velocity = 150;
        if (!begun_) square_.Position.A.Axes = {std::max(here[0], 0.0), std::max(here[0], 0.0), here[2], 0};
        square_.Velocity = 5;

        for (auto* line : {&over_, &down_, &along_bottom_, &up_right_, &along_top_, &down_left_, &to_end_, &leave_})
            line->CoordSystem = mcPCS;
        over_.Position.C.Tcp = leave_.Position.C.Tcp = {.X = begin_x, .Y = begin_y, .Z = clearance};
        down_.Position.C.Tcp = {.X = begin_x, .Y = begin_y, .Z = gap};
        down_.Velocity = 150;
        down_.BufferMode = mcBlendingHigh;
        down_.TransitionMode = mcTMCornerDistance;
        down_.TransitionParameter.Parameter[0] = 15;

        along_bottom_.Position.C.Tcp = {.X = 140, .Y = 0, .Z = gap};
        up_right_.Position.C.Tcp = {.X = 160, .Y = 100, .Z = gap};
        along_top_.Position.C.Tcp = {.X = 0, .Y = 100, .Z = gap};
        down_left_.Position.C.Tcp = {.X = 0, .Y = 20, .Z = gap};
        to_end_.Position.C.Tcp = {.X = begin_x, .Y = begin_y, .Z = gap};
        for (auto* arc : {&right_arc_, &left_arc_}) {
            arc->CoordSystem = mcPCS;
            arc->CircMode = mcCENTER;
            arc->PathChoice = mcCounterClockwise;
        }
        right_arc_.AuxPoint.C.Tcp = {.X = 140, .Y = 20, .Z = gap};
        right_arc_.EndPoint.C.Tcp = {.X = 160, .Y = 20, .Z = gap};
        left_arc_.AuxPoint.C.Tcp = {.X = 20, .Y = 20, .Z = gap};
        left_arc_.EndPoint.C.Tcp = {.X = 20, .Y = 0, .Z = gap};
        // How the corner in front of each is passed. Where a line leads into an arc there is none, but without a curve the nozzle would have to stand
        // there: what makes it turn would be there at once.
        const auto pass = [&](auto& move, double deviation) {
            move.Velocity = ctx.get(speed_);
            move.BufferMode = mcBlendingPrevious;
            move.TransitionMode = mcTMMaxCornerDeviation;
            move.TransitionParameter.Parameter[0] = deviation;
        };
        along_bottom_.Velocity = ctx.get(speed_);
        constexpr double smooth = 0.1;
        pass(right_arc_, smooth);
        pass(up_right_, smooth);
        pass(along_top_, ctx.get(corner_));
        pass(down_left_, ctx.get(corner_));
        pass(left_arc_, smooth);
        pass(to_end_, smooth);

        prime_.Axis = draw_back_.Axis = pump_halt_.Axis = sync_.SlaveAxis = pump_;
        prime_.Distance = primed_ ? 0 : drawn_back;
        draw_back_.Distance = -drawn_back;
        prime_.Velocity = draw_back_.Velocity = 180;
        // deg of the pump for each mm of the path, as two whole numbers.
        sync_.RatioNumerator = static_cast<std::int16_t>(std::lround(1000 * ctx.get(bead_) * degrees_per_mm3));
        sync_.RatioDenominator = 1000;
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
        pump_halt_.Execute = step_ == Step::raise && pump_power_.Status;
        pump_halt_(ctx);
        raise_.Execute = begun_ && step_ == Step::raise;
        square_.Execute = begun_ && step_ == Step::square;
        over_.Execute = down_.Execute = begun_ && step_ == Step::approach;
        prime_.Execute = begun_ && step_ == Step::prime;
        // It stays coupled until the pump gets a command of its own, which is draw_back_.
        sync_.Execute = (begun_ && step_ == Step::couple) || step_ == Step::bead;
        // All of them in one scan: seven moves are one path, and the nozzle does not wait for the program in any corner.
        along_bottom_.Execute = right_arc_.Execute = up_right_.Execute = along_top_.Execute = down_left_.Execute = left_arc_.Execute =
            to_end_.Execute = begun_ && step_ == Step::bead;
        draw_back_.Execute = begun_ && step_ == Step::draw_back;
        leave_.Execute = begun_ && step_ == Step::leave;

        raise_(ctx);
        square_(ctx);
        over_(ctx);
        down_(ctx);
        prime_(ctx);
        sync_(ctx);
        along_bottom_(ctx);
        right_arc_(ctx);
        up_right_(ctx);
        along_top_(ctx);
        down_left_(ctx);
        left_arc_(ctx);
        to_end_(ctx);
        draw_back_(ctx);
        leave_(ctx);
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
                error_ = b.Error ? static_cast<std::int64_t>(b.ErrorID) : 0;
            };
            (one(block), ...);
        };
        look(raise_, square_, over_, down_, prime_, along_bottom_, right_arc_, up_right_, along_top_, down_left_, left_arc_, to_end_,
             draw_back_, leave_);
        if (step_ == Step::couple || step_ == Step::bead) look(sync_);
        return over;
    }

    void next(TaskContext& ctx) {
        exchange_.IN = step_ == Step::wait && ctx.get(cover_there_) && works_;
        exchange_.PT = 500ms;
        exchange_(ctx);
        if (begun_ && broken()) {
            open_ = false;
            if (step_ == Step::bead) ++spoiled_;
            works_ = false;
            stopped_ = true;
            return enter(Step::raise);
        }
        if (step_ == Step::bead) pumped_ = (ctx.view(pump_)->actual_position - pump_began_) / degrees_per_mm3;
        switch (step_) {
            case Step::raise:
                if (raise_.Done) enter(Step::square);
                break;
            case Step::square:
                if (square_.Done) enter(Step::wait);
                break;
            case Step::wait:
                if (exchange_.Q) enter(Step::approach);
                break;
            case Step::approach:
                if (down_.Done) enter(Step::prime);
                break;
            case Step::prime:
                if (!prime_.Done) break;
                primed_ = true;
                enter(Step::couple);
                break;
            case Step::couple:
                // The path stands: the pump has nothing to catch up with, and nothing of the bead is lost.
                if (!sync_.InSync) break;
                pump_began_ = ctx.view(pump_)->actual_position;
                enter(Step::bead);
                break;
            case Step::bead:
                open_ = along_bottom_.Active || open_;
                if (!to_end_.Done) break;
                open_ = false;
                ++covers_;
                enter(Step::draw_back);
                break;
            case Step::draw_back:
                if (!draw_back_.Done) break;
                primed_ = false;
                enter(Step::leave);
                break;
            case Step::leave:
                if (leave_.Done) enter(Step::wait);
                break;
        }
    }
};

}  // namespace

TAKTWERK_PROGRAM(Dispensing)
