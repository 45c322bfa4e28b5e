// A rotary cutter that cuts a printed web at its marks. The cutter is geared to the web, one turn per nominal length; print is never
// exactly as long as it should be, so a sensor in front of the cutter latches the web's position at each mark, and the cutter's phase
// is corrected before that mark is under the knife. A mark counts only where one is expected; print that looks like one does not.
// While there are no marks to go by, a person at the machine trims the register with two buttons: the knife moves against the web as long as one is held.

#include <algorithm>
#include <cmath>

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

constexpr double turn = 360;              // deg
constexpr std::int64_t lost_at_most = 3;  // marks in a row
constexpr double trim_speed = 20;         // mm/s

/// Two buttons with which a person moves the knife against the web as long as one is held; the way that it has made by then stays.
class HandTrim {
    Input<bool> ahead_, back_;
    MC_PhasingRelative trim_;
    MC_HaltPhasing end_;

public:
    void declare(Declaration& d) {
        ahead_ = d.input("trim_ahead");
        back_ = d.input("trim_back");
    }
    void operator()(TaskContext& ctx, AxisRef web, AxisRef cutter, double length, bool permitted) {
        const bool ahead = permitted && ctx.get(ahead_), back = permitted && ctx.get(back_);
        trim_.Master = web;
        trim_.Slave = end_.Slave = cutter;
        trim_.PhaseShift = (ahead ? 1 : -1) * length;  // further than anybody wants: letting go ends it
        trim_.Velocity = trim_speed;
        trim_.Acceleration = trim_.Deceleration = end_.Deceleration = 200;
        trim_.Execute = ahead != back;
        trim_(ctx);
        end_.Execute = ahead == back && trim_.Busy;
        end_(ctx);
    }
};

class PrintMark final : public Program {
    AxisRef web_, cutter_;
    Input<bool> run_;
    Output<bool> in_register_;
    Parameter length_, speed_, sensor_, window_, step_, good_;

    MC_Power power_web_, power_cutter_;
    MC_Home home_cutter_;
    MC_MoveVelocity feed_;
    MC_Halt halt_;
    MC_GearIn gear_;
    MC_TouchProbe probe_;
    MC_PhasingRelative correct_;
    HandTrim trim_;

    bool armed_ = false;    ///< a probe waits, or will from this scan on
    bool locked_ = false;   ///< the next mark is expected at next_mark_
    double next_mark_ = 0;  ///< mm of web at the sensor
    double error_ = 0;      ///< mm
    std::int64_t marks_ = 0;
    std::int64_t lost_ = 0;  ///< in a row

public:
    void declare(Declaration& d) override {
        web_ = d.axis("web");
        cutter_ = d.axis("cutter");
        run_ = d.input("run");
        trim_.declare(d);
        in_register_ = d.output("in_register");
        length_ = d.parameter(
            "length", {.value = 297, .minimum = 100, .maximum = 1000, .unit = "mm", .doc = "nominal, from mark to mark; in 0.01 mm"});
        speed_ = d.parameter("speed", {.value = 400, .minimum = 10, .maximum = 600, .unit = "mm/s", .doc = "of the web"});
        sensor_ = d.parameter(
            "sensor", {.value = 200, .minimum = 50, .maximum = 1000, .unit = "mm", .doc = "from sensor to knife, less than a length"});
        window_ = d.parameter("window",
                              {.value = 10, .minimum = 1, .maximum = 50, .unit = "mm", .doc = "to each side of where a mark is expected"});
        step_ = d.parameter("largest_step", {.value = 50, .minimum = 0.1, .maximum = 50, .unit = "mm", .doc = "of one correction"});
        good_ = d.parameter(
            "good", {.value = 1, .minimum = 0.05, .maximum = 10, .unit = "mm", .doc = "error of a mark up to which pieces are good"});
        d.monitor("mark_error", error_, "mm", "how much later than the last mark the knife would have come, uncorrected");
        d.monitor("marks", marks_, "", "marks since start");
        d.monitor("lost", lost_, "", "marks in a row that did not come");
        d.block("feed", feed_);
        d.block("halt", halt_);
        d.block("gear", gear_);
        d.alarm(0, Reaction::warn, "No print mark where one is expected", "在预期位置未检测到色标",
                "look at sensor and print; check `length`; the search goes on by itself");
        d.alarm(1, Reaction::stop_machine, "The cutter cannot follow the web", "切刀轴无法跟随料带",
                "a lower speed or a smaller largest_step");
        d.task<&PrintMark::scan>("main");
    }

    void start() override {
        armed_ = locked_ = false;
        error_ = next_mark_ = 0;
        marks_ = lost_ = 0;
    }

    void scan(TaskContext& ctx) {
        const bool ready = power(ctx);
        const bool run = ready && ctx.get(run_);

        // The web waits for the cutter: it is geared while both stand.
        gear_.Master = web_;
        gear_.Slave = cutter_;
        gear_.RatioNumerator = 100 * static_cast<std::int32_t>(turn);
        gear_.RatioDenominator = static_cast<std::uint32_t>(std::lround(100 * ctx.get(length_)));
        gear_.ContinuousUpdate = true;
        gear_.Execute = ready;
        gear_(ctx);

        feed_.Axis = halt_.Axis = web_;
        feed_.Velocity = ctx.get(speed_);
        feed_.ContinuousUpdate = true;
        feed_.Execute = run && gear_.InGear;
        feed_(ctx);
        halt_.Execute = ready && !run;
        halt_(ctx);

        watch_marks(ctx, run);
        trim_(ctx, web_, cutter_, ctx.get(length_), run && !locked_);

        ctx.alarm(0, lost_ >= lost_at_most);
        ctx.alarm(1, ready && (gear_.Error || correct_.Error));
        ctx.set(in_register_, locked_ && lost_ == 0 && std::abs(error_) <= ctx.get(good_));
    }

private:
    bool power(TaskContext& ctx) {
        power_web_.Axis = web_;
        power_cutter_.Axis = home_cutter_.Axis = cutter_;
        power_web_.Enable = power_cutter_.Enable = true;
        power_web_(ctx);
        power_cutter_(ctx);
        // Where the knife is down: here it is set by hand, a real cutter has a switch or an absolute encoder.
        const bool homed = ctx.view(cutter_)->homed;
        home_cutter_.Execute = power_cutter_.Status && !homed;
        home_cutter_(ctx);
        return power_web_.Status && power_cutter_.Status && homed && !home_cutter_.Busy &&
               ctx.view(cutter_)->state != axes::AxisState::ErrorStop;
    }

    void watch_marks(TaskContext& ctx, bool run) {
        const double length = ctx.get(length_), window = ctx.get(window_);

        const double web = ctx.view(web_)->actual_position;
        if (next_mark_ == 0) next_mark_ = web + length;  // begun: the first may be anywhere within a length

        // One that did not come: the next is a length further, or, after some, anywhere.
        if (probe_.Busy && web > next_mark_ + window) {
            ++lost_;
            locked_ = locked_ && lost_ < lost_at_most;
            next_mark_ += length;
            armed_ = false;
        }
        if (probe_.Done) {
            on_mark(ctx, probe_.RecordedPosition, length);
            armed_ = false;
        }

        probe_.Axis = web_;
        probe_.TriggerInput = {.source = axes::TriggerSource::probe1};
        probe_.WindowOnly = locked_;
        probe_.FirstPosition = next_mark_ - window;
        probe_.LastPosition = next_mark_ + window;
        probe_.Execute = armed_;  // each mark is an edge of its own
        probe_(ctx);
        armed_ = run;

        correct_.Master = web_;
        correct_.Slave = cutter_;
        correct_.Velocity = ctx.get(speed_) / 2;
        correct_.Acceleration = correct_.Deceleration = 3000;  // done before the mark is under the knife
        correct_.Jerk = 60000;
        correct_(ctx);
        if (!correct_.Busy) correct_.Execute = false;
    }

    void on_mark(TaskContext& ctx, double mark, double length) {
        ++marks_;
        lost_ = 0;
        locked_ = true;
        next_mark_ = mark + length;
        // Where the knife will be when the mark is below it: the way that both still have to go is the gear's.
        const double way = mark + ctx.get(sensor_) - ctx.view(web_)->set_position;
        const double angle = std::remainder(ctx.view(cutter_)->set_position + way / length * turn, turn);
        error_ = -angle / turn * length;
        // Positive phase: the cutter is further than it was. The rest of a large error is the next mark's.
        correct_.PhaseShift = std::clamp(error_, -ctx.get(step_), ctx.get(step_));
        correct_.Execute = error_ != 0;
    }
};

}  // namespace

TAKTWERK_PROGRAM(PrintMark)
