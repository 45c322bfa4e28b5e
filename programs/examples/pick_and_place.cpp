// A three-axis pick-and-place cell, as a machine builder writes it: power, home, then pick, carry and place until the operator
// stops it. x and y travel together, z lifts, a gripper closes. Everything it needs is declared by name.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;
using namespace std::chrono_literals;

constexpr double z_up = 10, z_down = 90;  // mm
struct Place {
    double x, y;  // mm
};
constexpr Place pick{60, 40}, place{520, 260};

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

    AxisRef x_, y_, z_;
    Input<bool> start_;
    Output<bool> lamp_, gripper_;
    Parameter speed_, grip_time_;

    MC_Power power_x_, power_y_, power_z_;
    MC_Reset reset_x_, reset_y_, reset_z_;
    MC_Home home_x_, home_y_, home_z_;
    MC_MoveAbsolute move_x_, move_y_, move_z_;
    R_TRIG start_pressed_;
    TON grip_;
    CTU cycles_;

    std::int32_t step_ = waiting;
    std::int64_t pieces_ = 0;

public:
    void declare(Declaration& d) override {
        x_ = d.axis("x");
        y_ = d.axis("y");
        z_ = d.axis("z");
        start_ = d.input("start_button");
        lamp_ = d.output("lamp_run");
        gripper_ = d.output("gripper");
        speed_ = d.parameter("speed", {.value = 400, .minimum = 10, .maximum = 600, .unit = "mm/s", .doc = "travel of x and y"});
        grip_time_ =
            d.parameter("grip_time", {.value = 0.15, .minimum = 0.05, .maximum = 2, .unit = "s", .doc = "closing and opening the gripper"});
        d.monitor("step", step_, "", "step of the sequence");
        d.monitor("pieces", pieces_, "", "pieces placed since start");
        d.alarm(0, Reaction::warn, "An axis is in ErrorStop: remove the cause, reset, then press start",
                "有轴处于 ErrorStop:排除原因、复位,然后按启动按钮", "see the axis' own alarm");
        d.task<&PickAndPlace::scan>("main");
    }

    void start() override {
        step_ = waiting;
        pieces_ = 0;
    }

    void scan(TaskContext& ctx) {
        const bool ready = power_axes(ctx);
        start_pressed_.CLK = ctx.get(start_);
        start_pressed_(ctx);

        const bool error = in_error(ctx, x_) || in_error(ctx, y_) || in_error(ctx, z_);
        ctx.alarm(0, error);
        if (error || !ready) step_ = waiting;  // whatever was moving has been stopped by its axis
        reset_axes(ctx, error && start_pressed_.Q);

        run_sequence(ctx, ready && !error);

        ctx.set(lamp_, step_ != waiting);
    }

private:
    static bool in_error(const TaskContext& ctx, AxisRef axis) { return ctx.view(axis)->state == axes::AxisState::ErrorStop; }

    bool power_axes(TaskContext& ctx) {
        bool all = true;
        const auto power = [&](MC_Power& block, AxisRef axis) {
            block.Axis = axis;
            block.Enable = true;
            block(ctx);
            all = all && block.Status;
        };
        power(power_x_, x_);
        power(power_y_, y_);
        power(power_z_, z_);
        return all;
    }

    void reset_axes(TaskContext& ctx, bool execute) {
        const auto reset = [&](MC_Reset& block, AxisRef axis) {
            block.Axis = axis;
            block.Execute = execute || block.Busy;
            block(ctx);
        };
        reset(reset_x_, x_);
        reset(reset_y_, y_);
        reset(reset_z_, z_);
    }

    void run_sequence(TaskContext& ctx, bool ready) {
        const double xy = ctx.get(speed_);
        const auto homed = [&](AxisRef axis) { return ctx.view(axis)->homed; };

        switch (step_) {
            case waiting:
                if (ready && (start_pressed_.Q || (pieces_ == 0 && ctx.get(start_)))) step_ = homing_z;
                break;
            case homing_z:  // z first: nothing must hang down while x and y search
                if (homed(z_) || home_z_.Done) step_ = homing_xy;
                break;
            case homing_xy:
                if ((homed(x_) || home_x_.Done) && (homed(y_) || home_y_.Done)) step_ = above_pick;
                break;
            case above_pick:
                if (move_x_.Done && move_y_.Done && move_z_.Done) step_ = down_pick;
                break;
            case down_pick:
                if (move_z_.Done) step_ = close;
                break;
            case close:
                ctx.set(gripper_, true);
                if (grip_.Q) step_ = lift;
                break;
            case lift:
                if (move_z_.Done) step_ = carry;
                break;
            case carry:
                if (move_x_.Done && move_y_.Done) step_ = down_place;
                break;
            case down_place:
                if (move_z_.Done) step_ = open;
                break;
            case open:
                ctx.set(gripper_, false);
                if (grip_.Q) {
                    ++pieces_;
                    step_ = raise;
                }
                break;
            case raise:
                if (move_z_.Done) step_ = above_pick;
                break;
            default: step_ = waiting;
        }

        home(ctx, home_z_, z_, step_ == homing_z && !homed(z_));
        home(ctx, home_x_, x_, step_ == homing_xy && !homed(x_));
        home(ctx, home_y_, y_, step_ == homing_xy && !homed(y_));

        const bool at_pick = step_ == above_pick;
        const auto& target = at_pick ? pick : place;
        move(ctx, move_x_, x_, target.x, xy, at_pick || step_ == carry);
        move(ctx, move_y_, y_, target.y, xy, at_pick || step_ == carry);
        const bool down = step_ == down_pick || step_ == down_place;
        const bool up = at_pick || step_ == lift || step_ == raise;
        move(ctx, move_z_, z_, down ? z_down : z_up, 150, down || up);

        grip_.IN = step_ == close || step_ == open;
        grip_.PT = from_seconds(ctx.get(grip_time_));
        grip_(ctx);
    }

    static void home(TaskContext& ctx, MC_Home& block, AxisRef axis, bool execute) {
        block.Axis = axis;
        block.Position = 0;
        block.Execute = execute;
        block(ctx);
    }

    /// A new step means a new edge: the block sees Execute fall for the scan in which the step changed.
    void move(TaskContext& ctx, MC_MoveAbsolute& block, AxisRef axis, double position, double velocity, bool execute) {
        block.Axis = axis;
        block.Velocity = velocity;
        const bool new_target = execute && block.Position != position;
        block.Position = position;
        block.Execute = execute && !new_target;
        block(ctx);
    }
};

}  // namespace

TAKTWERK_PROGRAM(PickAndPlace)
