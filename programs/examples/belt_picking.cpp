// An arm of six joints picks parts from a belt that runs, and places them on a tray. A light barrier tells where each part is; the arm joins the belt,
// goes down on the part, closes its gripper, lifts the part and lets the belt go. What fails is reset, the arm goes up and home, and picks on.

#include <numbers>

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace std::chrono_literals;
using namespace taktwerk;
using namespace taktwerk::fb;

constexpr auto cooling_time = 500ms;  // what failed gets a moment before it is reset

/// The belt, and the parts on it between the light barrier and the arm.
struct Belt {
    AxisRef axis;
    MC_Power power;
    MC_Reset reset;
    MC_MoveVelocity run;
    MC_Halt halt;
    MC_TouchProbe probe;
    TON cooling;
    std::array<double, 8> parts{};  ///< where the belt was when each was in front of the barrier, mm; the first one first
    std::size_t part_count = 0;
    bool was_failed = false;
    std::int64_t failures = 0, recoveries = 0, missed = 0;

    void call(TaskContext& ctx, bool may_run, double speed) {
        power.Axis = reset.Axis = run.Axis = halt.Axis = probe.Axis = axis;
        const bool failed = ctx.view(axis)->state == axes::AxisState::ErrorStop;
        failures += failed && !was_failed;
        recoveries += was_failed && !failed;
        was_failed = failed;
        cooling.IN = failed && !reset.Busy;
        cooling.PT = cooling_time;
        cooling(ctx);
        power.Enable = true;
        power(ctx);
        reset.Execute = failed && (cooling.Q || reset.Busy);
        reset(ctx);

        const bool able = power.Status && !failed;
        run.Velocity = speed;
        run.Acceleration = run.Deceleration = halt.Deceleration = 200;  // gently: whoever stands on it has to keep up
        run.Jerk = halt.Jerk = 2000;
        run.ContinuousUpdate = true;
        run.Execute = able && may_run && !run.Error && !run.CommandAborted;
        run(ctx);
        halt.Execute = able && !may_run;
        halt(ctx);
        watch_barrier(ctx);
    }
    void watch_barrier(TaskContext& ctx) {
        const bool seen = ctx.view(axis)->online;
        if (!seen) part_count = 0;  // it may come back with other numbers
        if (probe.Done) {
            if (part_count == parts.size()) drop_first();
            parts[part_count++] = probe.RecordedPosition;
        }
        probe.TriggerInput = {.source = axes::TriggerSource::probe1};
        probe.Execute = seen && !probe.Done && !probe.Error && !probe.CommandAborted;  // each part is an edge of its own
        probe(ctx);
    }
    void drop_first() {
        for (std::size_t i = 1; i < part_count; ++i) parts[i - 1] = parts[i];
        --part_count;
    }
    /// How far the belt has carried the first part from the barrier. By its set-point: that is what the arm will follow.
    [[nodiscard]] double carried(const TaskContext& ctx) const { return ctx.view(axis)->set_position - parts[0]; }
};

/// The six joints as one group: power, references, what failed is reset.
struct Arm {
    static constexpr std::size_t joint_count = 6;
    std::array<AxisRef, joint_count> joints;
    GroupRef group;
    MC_GroupPower power;
    std::array<MC_Home, joint_count> homes;
    MC_GroupEnable enable;
    MC_GroupReset reset;
    MC_GroupReadStatus status;
    MC_GroupReadPosition tool;  ///< its point in the machine, set
    TON cooling;
    bool was_failed = false;
    std::int64_t failures = 0, recoveries = 0;

    /// TRUE: it takes commands.
    bool call(TaskContext& ctx) {
        for (auto* block : {&power.AxesGroup, &enable.AxesGroup, &reset.AxesGroup, &status.AxesGroup, &tool.AxesGroup}) *block = group;
        power.Enable = status.Enable = tool.Enable = true;
        power(ctx);
        status(ctx);
        tool.CoordSystem = mcMCS;
        tool(ctx);
        enable.Execute = status.GroupDisabled && !enable.Error;
        enable(ctx);

        const bool failed = status.GroupErrorStop;
        failures += failed && !was_failed;
        recoveries += was_failed && !failed;
        was_failed = failed;
        cooling.IN = failed && !reset.Busy;
        cooling.PT = cooling_time;
        cooling(ctx);
        reset.Execute = failed && (cooling.Q || reset.Busy);
        reset(ctx);

        bool homed = true;
        for (std::size_t i = 0; i < joint_count; ++i) {
            const bool knows = ctx.view(joints[i])->homed;
            homes[i].Axis = joints[i];
            homes[i].Execute = power.Status && !failed && (homes[i].Busy || !knows);
            homes[i](ctx);
            homed = homed && knows && !homes[i].Busy;
        }
        return power.Status && homed && tool.Valid && (status.GroupStandby || status.GroupMoving);
    }
    [[nodiscard]] const MC_CART_REF& place() const { return tool.Position.C.Tcp; }
};

class BeltPicking final : public Program {
    static constexpr double down = std::numbers::pi;  // RX of a tool that points down
    // mm. The belt lies across the front of the arm; along it, 0 is straight ahead.
    static constexpr double belt_forward = 450, belt_height = 300, barrier = -300;
    static constexpr double first_place = -220, last_place = 60;  // of a part that the arm sets out for
    static constexpr double above = 60, off_belt = 5, lifted = 100, safe_height = 420;
    static constexpr double tray_pitch = 60, tray_above = 100;
    static constexpr std::int64_t tray_columns = 3, tray_places = 6;
    static constexpr auto grip_time = 100ms;  // of the gripper, both ways

    enum class Step : std::uint16_t {
        stand,   // there is no power, or an error
        rise,    // straight up, off whatever is below
        fold,    // if that is no way
        home,    // to where it waits for parts
        wait,    //
        sight,   // the part's frame goes with the belt
        pick,    // above it, and down
        grip,    //
        lift,    //
        place,   // over the tray, and down
        let_go,  //
        leave    // up
    };

    Arm arm_;
    Belt belt_;
    Output<bool> gripper_;
    Parameter speed_;

    TON gripping_, retry_;
    MC_TrackConveyorBelt track_;
    MC_MoveDirectAbsolute fold_, home_;
    MC_MoveLinearAbsolute rise_, over_, down_, lift_, carry_, lower_, leave_;

    Step step_ = Step::stand;
    std::uint16_t shown_ = 0;
    bool ready_ = false, in_work_ = false;
    bool closed_ = false;  // the gripper
    bool holds_ = false;   // a part that is off the belt
    bool lost_ = false;    // it finds no way home
    std::int64_t picked_ = 0, placed_ = 0;

public:
    void declare(Declaration& d) override {
        static constexpr std::array names{"j1", "j2", "j3", "j4", "j5", "j6"};
        for (std::size_t i = 0; i < names.size(); ++i) arm_.joints[i] = d.axis(names[i]);
        arm_.group = d.axis_group("arm");
        belt_.axis = d.axis("belt");
        gripper_ = d.output("gripper");
        speed_ = d.parameter("belt_speed", {.value = 80, .minimum = 10, .maximum = 120, .unit = "mm/s", .doc = "of the belt"});
        d.monitor("step", shown_, "", "0 stands, 1 rises, 2 folds, 3 goes home, 4 waits, 5 to 8 picks, 9 to 11 places");
        d.monitor("picked", picked_, "", "parts that were lifted off the belt");
        d.monitor("placed", placed_, "", "parts that are on the tray");
        d.monitor("missed", belt_.missed, "", "parts that passed by");
        d.monitor("arm_failures", arm_.failures, "", "how often the arm failed");
        d.monitor("arm_recoveries", arm_.recoveries, "", "how often it came back");
        d.monitor("belt_failures", belt_.failures, "", "how often the belt failed");
        d.monitor("belt_recoveries", belt_.recoveries, "", "how often it came back");
        d.block("down", down_);
        d.block("track", track_);
        d.alarm(0, Reaction::warn, "The arm finds no way home", "机械臂找不到回原位的路径",
                "lead it by hand to where its tool points down in front of it; it tries again each second");
        d.task<&BeltPicking::scan>("main");
    }

    void start() override {
        step_ = Step::stand;
        ready_ = in_work_ = closed_ = holds_ = lost_ = false;
        belt_.part_count = 0;
        arm_.was_failed = belt_.was_failed = false;
    }

    void scan(TaskContext& ctx) {
        ready_ = arm_.call(ctx);
        const bool runs = ready_ && in_work_;
        belt_.call(ctx, runs, ctx.get(speed_));
        if (!ready_) give_up();
        move(ctx);
        ctx.set(gripper_, closed_);
        ctx.alarm(0, lost_);
        shown_ = static_cast<std::uint16_t>(step_);
    }

private:
    /// The belt stands soon, and the arm where it is. What is held above the belt stays held; what is still on it is let go at once, or it would be torn.
    void give_up() {
        step_ = Step::stand;
        in_work_ = false;
        if (!holds_) closed_ = false;
    }

    void move(TaskContext& ctx) {
        decide(ctx);
        for (auto* group : {&track_.AxesGroup, &fold_.AxesGroup, &home_.AxesGroup, &rise_.AxesGroup, &over_.AxesGroup, &down_.AxesGroup,
                            &lift_.AxesGroup, &carry_.AxesGroup, &lower_.AxesGroup, &leave_.AxesGroup})
            *group = arm_.group;
        way_home(ctx);
        on_belt(ctx);
        to_tray(ctx);
    }

    /// By what became of the blocks in the scan before.
    void decide(TaskContext& ctx) {
        const auto over_with = [](const auto& block) { return block.Error || block.CommandAborted; };
        const auto after = [&](const auto& block, Step next) {
            if (block.Done) step_ = next;
            else if (over_with(block)) step_ = Step::stand;
        };
        gripping_.IN = step_ == Step::grip || step_ == Step::let_go;
        gripping_.PT = grip_time;
        gripping_(ctx);
        retry_.IN = lost_;
        retry_.PT = 1s;
        retry_(ctx);
        switch (step_) {
            case Step::stand:
                if (!ready_ || (lost_ && !retry_.Q)) return;
                lost_ = false;
                closed_ = holds_;
                begin_way_home();
                step_ = Step::rise;
                return;
            case Step::rise:
                after(rise_, Step::home);
                if (rise_.Error) step_ = Step::fold;
                return;
            case Step::fold:
                after(fold_, Step::home);
                lost_ = fold_.Error;
                return;
            case Step::home:
                after(home_, holds_ ? Step::place : Step::wait);
                lost_ = home_.Error;
                in_work_ = in_work_ || home_.Done;
                return;
            case Step::wait: return look_for_part(ctx);
            case Step::sight: return after(track_, Step::pick);
            case Step::pick:
                after(down_, Step::grip);
                if (over_with(over_)) step_ = Step::stand;
                if (step_ == Step::pick) return;
                if (belt_.part_count > 0) belt_.drop_first();
                closed_ = step_ == Step::grip;
                return;
            case Step::grip:
                if (gripping_.Q) step_ = Step::lift;
                return;
            case Step::lift:
                after(lift_, Step::place);
                if (!holds_ && arm_.place().Z > belt_height + off_belt) {
                    holds_ = true;
                    ++picked_;
                }
                closed_ = step_ != Step::stand || holds_;
                return;
            case Step::place:
                after(lower_, Step::let_go);
                if (over_with(carry_)) step_ = Step::stand;
                if (step_ != Step::let_go) return;
                closed_ = holds_ = false;
                ++placed_;
                return;
            case Step::let_go:
                if (gripping_.Q) step_ = Step::leave;
                return;
            case Step::leave: return after(leave_, Step::home);
        }
    }

    void look_for_part(const TaskContext& ctx) {
        while (belt_.part_count > 0 && barrier + belt_.carried(ctx) > last_place) {
            belt_.drop_first();
            ++belt_.missed;
        }
        if (belt_.part_count > 0 && barrier + belt_.carried(ctx) >= first_place) step_ = Step::sight;
    }

    void begin_way_home() {
        rise_.Position.C.Tcp = arm_.place();
        rise_.Position.C.Tcp.Z = std::max(arm_.place().Z, safe_height);
    }
    void way_home(TaskContext& ctx) {
        rise_.CoordSystem = home_.CoordSystem = mcMCS;
        rise_.Velocity = 100;
        rise_.Execute = step_ == Step::rise;
        rise_(ctx);
        fold_.CoordSystem = mcACS;
        fold_.Position.A.Axes = {0, -90, 90, 0, 90, 0};
        fold_.Velocity = 30;  // deg/s
        fold_.Execute = step_ == Step::fold;
        fold_(ctx);
        home_.Position.C.Tcp = {.X = belt_forward, .Y = first_place, .Z = safe_height, .RX = down, .RZ = std::numbers::pi};
        home_.Position.C.Cfg = {.ConfigValid = true, .Shoulder = true, .Elbow = true, .Wrist = true};
        home_.Velocity = in_work_ ? 150 : 45;  // deg/s: slowly, where it does not come from its work
        home_.Execute = step_ == Step::home;
        home_(ctx);
    }

    void on_belt(TaskContext& ctx) {
        track_.ConveyorBelt = belt_.axis;
        track_.ConveyorBeltOrigin = {.X = belt_forward, .Z = belt_height, .RZ = std::numbers::pi / 2};
        track_.CoordSystem = over_.CoordSystem = down_.CoordSystem = lift_.CoordSystem = mcPCS;
        if (belt_.part_count > 0) track_.InitialObjectPosition.X = barrier + belt_.carried(ctx);
        track_.Execute = step_ == Step::sight;
        track_(ctx);

        // Both are one path: the second one follows as soon as the first is accepted. The tool is turned as it is while the arm waits.
        over_.Position.C.Tcp = {.Z = above, .RX = down, .RZ = std::numbers::pi / 2};
        over_.Execute = step_ == Step::pick;
        over_(ctx);
        down_.Position.C.Tcp = {.RX = down, .RZ = std::numbers::pi / 2};
        down_.Velocity = 200;
        down_.BufferMode = mcBlendingLow;
        down_.TransitionMode = mcTMCornerDistance;
        down_.TransitionParameter.Parameter[0] = 20;
        down_.Execute = over_.Execute && (over_.CommandAccepted || down_.Execute);
        down_(ctx);
        lift_.Position.C.Tcp = {.Z = lifted, .RX = down, .RZ = std::numbers::pi / 2};
        lift_.Execute = step_ == Step::lift;
        lift_(ctx);
    }

    void to_tray(TaskContext& ctx) {
        const auto place = placed_ % tray_places;
        carry_.CoordSystem = lower_.CoordSystem = leave_.CoordSystem = mcPCS_2;
        if (step_ == Step::place)
            lower_.Position.C.Tcp = {.X = tray_pitch * static_cast<double>(place % tray_columns),
                                     .Y = tray_pitch * static_cast<double>(place / tray_columns),
                                     .RX = down,
                                     .RZ = std::numbers::pi};
        carry_.Position = leave_.Position = lower_.Position;
        carry_.Position.C.Tcp.Z = leave_.Position.C.Tcp.Z = tray_above;
        carry_.Execute = step_ == Step::place;
        carry_(ctx);
        lower_.Velocity = 200;
        lower_.BufferMode = mcBlendingLow;
        lower_.TransitionMode = mcTMCornerDistance;
        lower_.TransitionParameter.Parameter[0] = 40;
        lower_.Execute = carry_.Execute && (carry_.CommandAccepted || lower_.Execute);
        lower_(ctx);
        leave_.Execute = step_ == Step::leave;
        leave_(ctx);
    }
};

}  // namespace

TAKTWERK_PROGRAM(BeltPicking)
