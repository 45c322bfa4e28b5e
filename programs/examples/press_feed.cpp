// A press and the feeder of its strip, coupled by a cam: while the tool is open the strip is fed by an exact length, while the tool is
// closed it stands. The cam makes the strip a function of the crank's angle, so both stay in step however fast the press turns, and
// also while it stops. A new feed length is a new cam, entered at the bottom of a stroke, when the strip stands anyway.

#include <array>
#include <cmath>

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

// Angles of the crank in degrees, 0 = top.
constexpr double stand_from = 80, stand_to = 280;     // here the strip stands, by the cam
constexpr double closed_from = 120, closed_to = 240;  // here the tool holds it: what is between is the drive's, to come to rest
constexpr double enter_from = 150, enter_at = 180;    // here a cam is entered

class PressFeed final : public Program {
    AxisRef press_, feeder_;
    CamRef cam_;
    Input<bool> run_, feed_;
    Output<bool> in_step_;
    Parameter length_, strokes_, tolerance_;

    MC_Power power_press_, power_feeder_;
    MC_MoveVelocity turn_;
    MC_MoveAbsolute to_top_;
    MC_CamTableSelect select_;
    MC_CamIn couple_;
    MC_Halt release_;
    R_TRIG bottom_;

    double selected_ = 0;   ///< mm per stroke of the cam that was selected last; 0 = none
    double held_at_ = 0;    ///< mm: where the strip was when the tool closed on it
    bool held_ = false;     ///< the tool is closed, and held_at_ is of this stroke
    bool slipped_ = false;  ///< the strip moved in the closed tool; until the operator switches the feed off
    std::int64_t count_ = 0;

public:
    void declare(Declaration& d) override {
        press_ = d.axis("press");
        feeder_ = d.axis("feeder");
        run_ = d.input("run");
        feed_ = d.input("feed");
        in_step_ = d.output("in_step");
        length_ = d.parameter("feed_length", {.value = 32.5, .minimum = 1, .maximum = 60, .unit = "mm", .doc = "strip per stroke"});
        strokes_ = d.parameter("strokes", {.value = 240, .minimum = 10, .maximum = 300, .unit = "1/min", .doc = "of the press"});
        tolerance_ = d.parameter(
            "tolerance", {.value = 0.1, .minimum = 0.01, .maximum = 5, .unit = "mm", .doc = "motion of the strip in the closed tool"});
        cam_ = d.cam("feed", cam_points(32.5));
        d.monitor("count", count_, "", "strokes since start");
        d.monitor("in_step", couple_.InSync, "", "the strip follows the press");
        d.block("turn", turn_);
        d.block("to_top", to_top_);
        d.block("couple", couple_);
        d.block("release", release_);
        d.alarm(0, Reaction::stop_machine, "The strip moved while the tool was closed", "模具闭合时料带移动",
                "look for a slipping roll or a blocked strip, check `tolerance`; switch the feed off and on");
        d.alarm(1, Reaction::stop_machine, "The feeder cannot follow the press", "送料轴无法跟随压力机",
                "fewer strokes per minute or a shorter feed; then switch the feed off and on");
        d.task<&PressFeed::scan>("main");
    }

    void start() override {
        selected_ = 0;
        held_ = slipped_ = false;
        count_ = 0;
    }

    void scan(TaskContext& ctx) {
        const bool ready = power(ctx);
        turn_press(ctx, ready);

        const auto& press = *ctx.view(press_);
        const double angle = press.set_position;
        const bool closed = angle >= closed_from && angle <= closed_to;
        bottom_.CLK = angle >= 180;
        bottom_(ctx);
        if (bottom_.Q) ++count_;

        select_cam(ctx, ready);

        // The strip follows from the next bottom on. Execute falls for the scan in which a cam has been selected, so a new one is an edge.
        const bool wanted = ready && ctx.get(feed_);
        couple_.Master = press_;
        couple_.Slave = feeder_;
        couple_.CamTableID = select_.CamTableID;
        couple_.StartMode = mcRampIn;
        couple_.MasterSyncPosition = enter_at;
        couple_.MasterStartDistance = enter_at - enter_from;
        couple_.Execute = wanted && couple_.CamTableID.value != 0 && !select_.Done;
        couple_(ctx);

        // Never in the middle of a feed: a piece would have the wrong length, and the tool would close on a moving strip.
        release_.Axis = feeder_;
        release_.Execute = ready && !ctx.get(feed_) && (closed || press.set_velocity == 0);
        release_(ctx);

        watch_strip(ctx, closed);
        ctx.alarm(1, ready && (couple_.Error || select_.Error));
        ctx.set(in_step_, couple_.InSync);
    }

private:
    /// The strip over one turn of the crank. It leaves and reaches its rests with velocity and acceleration 0.
    static std::array<axes::CamPoint, 3> cam_points(double length) {
        return {{{.master = stand_from, .slave = 0}, {.master = stand_to, .slave = 0}, {.master = stand_from + 360, .slave = length}}};
    }

    bool power(TaskContext& ctx) {
        power_press_.Axis = press_;
        power_feeder_.Axis = feeder_;
        power_press_.Enable = power_feeder_.Enable = true;
        power_press_(ctx);
        power_feeder_(ctx);
        return power_press_.Status && power_feeder_.Status && ctx.view(feeder_)->state != axes::AxisState::ErrorStop;
    }

    void turn_press(TaskContext& ctx, bool ready) {
        const bool run = ready && ctx.get(run_) && !slipped_;
        turn_.Axis = to_top_.Axis = press_;
        turn_.Velocity = ctx.get(strokes_) * 6;  // 1/min * 360 deg / 60 s
        turn_.ContinuousUpdate = true;
        turn_.Execute = run;
        turn_(ctx);
        // The strip stops with the press, and goes on with it.
        to_top_.Position = 0;
        to_top_.Velocity = turn_.Velocity;
        to_top_.Direction = mcPositiveDirection;
        to_top_.Execute = ready && !run && count_ > 0;
        to_top_(ctx);
    }

    /// Another feed length: the points are written, checked and prepared; the cam that runs is a copy and does not notice.
    void select_cam(TaskContext& ctx, bool ready) {
        const double length = ctx.get(length_);
        select_.Master = press_;
        select_.Slave = feeder_;
        select_.CamTable = cam_;
        select_.Periodic = true;
        select_.MasterAbsolute = true;  // angles of the crank
        select_.SlaveAbsolute = false;  // from wherever the strip is: it is endless
        const bool start = ready && length != selected_ && !select_.Execute;
        if (start) {
            ctx.tables->cam(cam_)->points[2].slave = length;
            selected_ = length;
        }
        select_.Execute = start || select_.Busy;
        select_(ctx);
    }

    void watch_strip(TaskContext& ctx, bool closed) {
        const auto& strip = *ctx.view(feeder_);
        if (closed && !held_) held_at_ = strip.actual_position;
        held_ = closed;
        if (!ctx.get(feed_)) slipped_ = false;
        else if (closed && std::abs(strip.actual_position - held_at_) > ctx.get(tolerance_)) slipped_ = true;
        ctx.alarm(0, slipped_);
    }
};

}  // namespace

TAKTWERK_PROGRAM(PressFeed)
