// A three-axis pick-and-place cell, as a machine builder writes it: power, home, then pick, carry and place until the operator
// stops it. x and y travel together, z lifts, a gripper closes. Everything it needs is declared by name.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

constexpr double z_up = 10, z_down = 90, z_speed = 150;  // mm, mm/s
struct Place {
    double x, y;  // mm
};
constexpr Place pick{60, 40}, place{520, 260};

/// An axis and the blocks that work on it.
struct Joint {
    AxisRef axis;
    MC_Power power;
    MC_Reset reset;
    MC_Home home;
    MC_MoveAbsolute move;

    [[nodiscard]] bool failed(const TaskContext& ctx) const { return ctx.view(axis)->state == axes::AxisState::ErrorStop; }
    [[nodiscard]] bool homed(const TaskContext& ctx) const { return ctx.view(axis)->homed; }
    [[nodiscard]] bool there() const { return move.Done; }

    void find_home(const TaskContext& ctx) { home.Execute = !homed(ctx); }
    void go(const TaskContext& ctx, double position, double velocity) {
        move.Execute = false;  // so that the next call sees an edge
        move(ctx);
        move.Position = position;
        move.Velocity = velocity;
        move.Execute = true;
    }
    void call(const TaskContext& ctx, bool reset_errors) {
        power.Axis = reset.Axis = home.Axis = move.Axis = axis;
        power.Enable = true;
        power(ctx);
        reset.Execute = reset_errors || reset.Busy;
        reset(ctx);
        home(ctx);
        move(ctx);
        if (!home.Busy) home.Execute = false;
    }
};

class PickAndPlace final : public Program {
    enum Step : std::int32_t {
        waiting = 0,
        homing_z = 10,
        homing_xy = 20,
        above_pick = 30,
        down_pick = 40,
        close = 50,
        lift = 60,
        carry = 70,
        down_place = 80,
        open = 90,
        raise = 100
    };

    Joint x_, y_, z_;
    Input<bool> start_;
    Output<bool> lamp_, gripper_;
    Parameter speed_, grip_time_;
    R_TRIG start_pressed_;
    TON grip_;

    // From the machine's own page: start works as the button at the input does.
    bool start_by_page_ = false, stop_at_end_ = false;
    double pace_ = 100;               // percent of `speed`
    std::int32_t pieces_wanted_ = 0;  // 0: until somebody stops it
    bool running_ = false;

    bool wanted_ = false;  // start was pressed, and power is still on its way: after an emergency stop the same press brings it back
    std::int32_t step_ = waiting;
    std::int64_t pieces_ = 0;

public:
    void declare(Declaration& d) override {
        x_.axis = d.axis("x");
        y_.axis = d.axis("y");
        z_.axis = d.axis("z");
        start_ = d.input("start_button");
        lamp_ = d.output("lamp_run");
        gripper_ = d.output("gripper");
        speed_ = d.parameter("speed", {.value = 400, .minimum = 10, .maximum = 600, .unit = "mm/s", .doc = "travel of x and y"});
        grip_time_ =
            d.parameter("grip_time", {.value = 0.15, .minimum = 0.05, .maximum = 2, .unit = "s", .doc = "closing and opening the gripper"});
        d.operator_button("start", start_by_page_, {.doc = "begins the sequence; after an error it resets first, as the button does"});
        d.operator_switch("stop_at_end", stop_at_end_, {.doc = "stops when the piece under way has been placed"});
        d.operator_value("pace", pace_,
                         {.minimum = 10, .maximum = 100, .unit = "%", .doc = "of the parameter speed, from the next motion on"});
        d.operator_value("pieces_wanted", pieces_wanted_, {.minimum = 0, .maximum = 9999, .doc = "stops after so many; 0: never"});
        d.monitor("running", running_, "", "the sequence is under way");
        d.monitor("step", step_, "", "step of the sequence");
        d.monitor("pieces", pieces_, "", "pieces placed since start");
        d.alarm(0, Reaction::warn, "An axis is in ErrorStop: remove the cause, reset, then press start",
                "有轴处于 ErrorStop:排除原因、复位,然后按启动按钮", "see the axis' own alarm");
        d.block("x", x_);  // all blocks of a joint under its name: who moves or holds an axis
        d.block("y", y_);
        d.block("z", z_);
        d.task<&PickAndPlace::scan>("main");
    }

    void start() override {
        step_ = waiting;
        wanted_ = false;
        pieces_ = 0;
    }

    void scan(TaskContext& ctx) {
        start_pressed_.CLK = ctx.get(start_) || start_by_page_;
        start_pressed_(ctx);

        const bool error = x_.failed(ctx) || y_.failed(ctx) || z_.failed(ctx);
        const bool ready = x_.power.Status && y_.power.Status && z_.power.Status;
        ctx.alarm(0, error);
        if (start_pressed_.Q && step_ == waiting) {
            wanted_ = true;
            stop_at_end_ = false;
            if (pieces_wanted_ > 0 && pieces_ >= pieces_wanted_) pieces_ = 0;  // the next batch
        }
        if (error) wanted_ = false;            // that press resets
        if (error || !ready) step_ = waiting;  // whatever was moving has been stopped by its axis
        else run_sequence(ctx);

        for (Joint* joint : {&x_, &y_, &z_}) joint->call(ctx, error && start_pressed_.Q);
        grip_.IN = step_ == close || step_ == open;
        grip_.PT = from_seconds(ctx.get(grip_time_));
        grip_(ctx);
        running_ = step_ != waiting;
        ctx.set(lamp_, running_);
    }

private:
    /// Each step waits for what the one before has begun, begins the next motion and hands over.
    void run_sequence(TaskContext& ctx) {
        switch (step_) {
            case waiting:
                if (!wanted_ && !(pieces_ == 0 && ctx.get(start_))) break;
                wanted_ = false;
                z_.find_home(ctx);  // z first: nothing must hang down while x and y search
                step_ = homing_z;
                break;
            case homing_z:
                if (!z_.homed(ctx)) break;
                x_.find_home(ctx);
                y_.find_home(ctx);
                step_ = homing_xy;
                break;
            case homing_xy:
                if (x_.homed(ctx) && y_.homed(ctx)) travel(ctx, pick, above_pick);
                break;
            case above_pick:
                if (x_.there() && y_.there() && z_.there()) lower(ctx, down_pick);
                break;
            case down_pick:
                if (z_.there()) grip(ctx, true, close);
                break;
            case close:
                if (grip_.Q) lift_up(ctx, lift);
                break;
            case lift:
                if (z_.there()) travel(ctx, place, carry);
                break;
            case carry:
                if (x_.there() && y_.there()) lower(ctx, down_place);
                break;
            case down_place:
                if (z_.there()) grip(ctx, false, open);
                break;
            case open:
                if (!grip_.Q) break;
                ++pieces_;
                lift_up(ctx, raise);
                break;
            case raise:
                if (!z_.there()) break;
                if (stop_at_end_ || (pieces_wanted_ > 0 && pieces_ >= pieces_wanted_)) {
                    stop_at_end_ = false;  // done: the switch shows it
                    step_ = waiting;
                } else {
                    travel(ctx, pick, above_pick);
                }
                break;
            default: step_ = waiting;
        }
    }

    void travel(TaskContext& ctx, const Place& to, Step next) {
        const double speed = ctx.get(speed_) * pace_ / 100;
        x_.go(ctx, to.x, speed);
        y_.go(ctx, to.y, speed);
        if (next == above_pick) z_.go(ctx, z_up, z_speed);  // after homing it is anywhere
        step_ = next;
    }
    void lower(TaskContext& ctx, Step next) {
        z_.go(ctx, z_down, z_speed);
        step_ = next;
    }
    void lift_up(TaskContext& ctx, Step next) {
        z_.go(ctx, z_up, z_speed);
        step_ = next;
    }
    void grip(TaskContext& ctx, bool closed, Step next) {
        ctx.set(gripper_, closed);
        step_ = next;
    }
};

}  // namespace

TAKTWERK_PROGRAM(PickAndPlace)
