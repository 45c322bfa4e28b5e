// A delta picks parts from a belt that never stops, and lays them into a tray. Several parts are on the belt at once: a light barrier in front of the arm latches
// the belt's position at each (a touch probe), so a part is a number from then on, and where it is now is that number and the belt. While the arm takes a part,
// its frame goes with the belt (MC_TrackConveyorBelt): the commands are the same as over a table.
//
//     ready ---> pick: track, above, down | suck | up ---> place: over, down | let go | up ---> ready ...
//
// Whatever stops the arm (a fault, a person), it goes on when a person says so: by the switch `picks`, after a reset where there was an error. It goes
// straight up first, and a
// part that hangs on it is laid down where it was meant to go.

#include <algorithm>
#include <array>

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace std::chrono_literals;
using namespace taktwerk;
using namespace taktwerk::fb;

// The machine, as its file draws it [mm]. Heights are those of the sucker's lip.
constexpr double barrier = -560, belt_line = -120, belt_height = -900;
constexpr double reach_begins = -220, reach_ends = 60;  // a part is begun in here, and is some 100 mm further when it is off the belt
constexpr double part_length = 30, part_height = 20;
constexpr double travel_height = -830;  // above everything that stands on belt and tray
constexpr double above = 50;            // of a part, where the way down begins
constexpr std::int64_t columns = 4, rows = 3;
constexpr double pitch = 50;

/// Parts between the barrier and the arm, oldest first: the belt's position at which the barrier saw each one's front.
class PartsOnBelt {
    std::array<double, 16> latched_{};
    std::size_t first_ = 0, count_ = 0;

public:
    void clear() { count_ = 0; }
    /// One that finds no room is not picked: it goes by.
    bool add(double latched) {
        if (count_ == latched_.size()) return false;
        latched_[(first_ + count_++) % latched_.size()] = latched;
        return true;
    }
    void remove_oldest() { first_ = (first_ + 1) % latched_.size(), --count_; }
    [[nodiscard]] bool empty() const { return count_ == 0; }
    [[nodiscard]] std::size_t count() const { return count_; }
    /// How far the middle of the oldest is behind the barrier.
    [[nodiscard]] double oldest(double belt) const { return belt - latched_[first_] - part_length / 2; }
};

class DeltaPicker final : public Program {
    static constexpr std::size_t arms = 3;
    enum class Step : std::uint8_t { raise, ready, wait, track, pick, place, change_tray };

    std::array<AxisRef, arms> axes_;
    AxisRef belt_;
    GroupRef delta_;
    Input<bool> gripped_, tray_there_, go_on_;
    Output<bool> vacuum_, tray_full_;
    Parameter belt_speed_;

    // Power and reference.
    MC_GroupPower power_;
    std::array<MC_Home, arms> homes_;
    MC_GroupEnable enable_;
    MC_GroupReadStatus status_;
    MC_GroupReadPosition place_;
    MC_Power belt_power_;
    // The belt and its parts.
    MC_MoveVelocity feed_;
    MC_Halt halt_;
    MC_TouchProbe probe_;
    PartsOnBelt parts_;
    // The arm, in the order of a round.
    MC_MoveLinearRelative raise_;
    MC_MoveDirectAbsolute ready_;
    MC_TrackConveyorBelt track_;
    MC_MoveLinearAbsolute to_part_, onto_part_, off_belt_;
    MC_GroupWaitTime sucking_;
    MC_MoveLinearAbsolute over_slot_, into_slot_, off_slot_;
    MC_GroupWaitTime letting_go_;
    TON exchange_;
    R_TRIG pressed_;

    Step step_ = Step::raise;
    bool fresh_ = true;   ///< the first scan of a step: its blocks are called with Execute FALSE, so that the next one is an edge
    bool begun_ = false;  ///< its blocks have Execute TRUE
    bool picks_ = true, stopped_ = false;
    bool sucks_ = false;     ///< the vacuum is wanted
    bool carries_ = false;   ///< a part is off the belt and not in the tray yet
    bool armed_ = false;     ///< a probe waits, or will from this scan on
    std::int64_t slot_ = 0;  ///< the next one of the tray
    std::int64_t picked_ = 0, placed_ = 0, missed_ = 0, empty_ = 0, broken_ = 0, trays_ = 0;
    std::int64_t waiting_ = 0, error_ = 0;

public:
    void declare(Declaration& d) override {
        const char* names[arms] = {"arm1", "arm2", "arm3"};
        for (std::size_t i = 0; i < arms; ++i) axes_[i] = d.axis(names[i]);
        belt_ = d.axis("belt");
        delta_ = d.axis_group("delta");
        gripped_ = d.input("part_gripped");
        tray_there_ = d.input("tray_there");
        go_on_ = d.input("go_on");
        vacuum_ = d.output("vacuum");
        tray_full_ = d.output("tray_full");
        belt_speed_ = d.parameter("belt_speed", {.value = 90, .minimum = 10, .maximum = 250, .unit = "mm/s", .doc = "of the parts"});
        d.operator_switch("picks", picks_, {.doc = "belt and arm work; a stop and an error switch it off"});
        d.monitor("waiting", waiting_, "", "parts between light barrier and arm");
        d.monitor("picked", picked_, "", "parts taken off the belt since start");
        d.monitor("placed", placed_, "", "parts laid into trays");
        d.monitor("missed", missed_, "", "parts that had gone by before the arm was free");
        d.monitor("empty", empty_, "", "picks after which nothing hung on the gripper");
        d.monitor("broken", broken_, "", "rounds that were broken off");
        d.monitor("trays", trays_, "", "filled");
        d.monitor("error", error_, "", "ErrorID that broke the last round off (docs/reference/errors.md); 0: it was aborted");
        d.block("track", track_);
        d.block("onto_part", onto_part_);
        d.block("into_slot", into_slot_);
        d.alarm(0, Reaction::warn, "The arm was stopped on its way and waits for a person", "机械臂中途停止，等待人工操作",
                "remove the cause (alarms of its axes and of the bus name it), look that nobody is in its reach, reset, then press `go_on` "
                "(or switch `picks` on): it goes straight up first");
        d.alarm(1, Reaction::warn, "Parts go by without being picked", "工件未被拾取而通过", "lower belt_speed");
        d.task<&DeltaPicker::scan>("main");
    }

    void start() override {
        // The vacuum stays as it is: what hangs on the gripper would fall.
        parts_.clear();
        armed_ = stopped_ = false;
        picks_ = true;
        enter(Step::raise);
        for (auto& home : homes_) home.Execute = false;
        enable_.Execute = false;
    }

    void scan(TaskContext& ctx) {
        for (auto* group :
             {&power_.AxesGroup, &enable_.AxesGroup, &status_.AxesGroup, &place_.AxesGroup, &raise_.AxesGroup, &ready_.AxesGroup,
              &track_.AxesGroup, &to_part_.AxesGroup, &onto_part_.AxesGroup, &off_belt_.AxesGroup, &sucking_.AxesGroup,
              &over_slot_.AxesGroup, &into_slot_.AxesGroup, &off_slot_.AxesGroup, &letting_go_.AxesGroup})
            *group = delta_;
        const bool ready = power(ctx);
        pressed_.CLK = ctx.get(go_on_);
        pressed_(ctx);
        if (pressed_.Q && !status_.GroupErrorStop) picks_ = true;
        if (picks_) stopped_ = false;
        run_belt(ctx, ready && picks_);
        watch_barrier(ctx);
        move(ctx, ready && (picks_ || under_way()));

        ctx.set(vacuum_, sucks_);
        ctx.set(tray_full_, step_ == Step::change_tray);
        ctx.alarm(0, stopped_);
        ctx.alarm(1, missed_in_a_row_ >= 5);
        waiting_ = static_cast<std::int64_t>(parts_.count());
    }

private:
    std::int64_t missed_in_a_row_ = 0;

    /// All that has to be so before anything moves.
    bool power(TaskContext& ctx) {
        power_.Enable = status_.Enable = place_.Enable = true;
        power_(ctx);
        bool homed = true;
        for (std::size_t i = 0; i < arms; ++i) {
            homes_[i].Axis = axes_[i];
            homes_[i].Execute = power_.Status && !ctx.view(axes_[i])->homed;
            homes_[i](ctx);
            homed = homed && ctx.view(axes_[i])->homed && !homes_[i].Busy;
        }
        enable_.Execute = power_.Status && homed;
        enable_(ctx);
        status_(ctx);
        place_.CoordSystem = mcMCS;
        place_(ctx);
        belt_power_.Axis = belt_;
        belt_power_.Enable = true;
        belt_power_(ctx);
        return power_.Status && homed && belt_power_.Status && place_.Valid && (status_.GroupStandby || status_.GroupMoving);
    }

    /// Somebody has to look, and to say that it may go on.
    void wait_for_a_person() { picks_ = false, stopped_ = true; }

    /// It stands while the arm cannot work: no part goes by because of that.
    void run_belt(TaskContext& ctx, bool run) {
        if (feed_.Execute && (feed_.Error || feed_.CommandAborted)) wait_for_a_person();  // not by this program: by a person, or a fault
        feed_.Axis = halt_.Axis = belt_;
        feed_.Velocity = ctx.get(belt_speed_);
        feed_.ContinuousUpdate = true;
        feed_.Execute = run;
        feed_(ctx);
        halt_.Execute = belt_power_.Status && !run;
        halt_(ctx);
    }

    /// Each part at the barrier becomes a number. Parts have to be a few cycles apart, so that the probe is armed again.
    void watch_barrier(TaskContext& ctx) {
        if (probe_.Done && !parts_.add(probe_.RecordedPosition)) ++missed_;
        if (probe_.Done || probe_.Error || probe_.CommandAborted) armed_ = false;
        probe_.Axis = belt_;
        probe_.TriggerInput = {.source = axes::TriggerSource::probe1};
        probe_.Execute = armed_;  // each part is an edge of its own
        probe_(ctx);
        armed_ = belt_power_.Status;
        if (!belt_power_.Status) parts_.clear();  // it may have been moved by hand: what lies on it now goes by
    }

    /// The belt as the arm sees it: its set-point. The arm's drives are behind their set-points as the belt's is behind its own.
    [[nodiscard]] double belt_now(const TaskContext& ctx) const { return ctx.view(belt_)->set_position; }

    void enter(Step step) {
        step_ = step;
        fresh_ = true;
        begun_ = false;
    }

    void move(TaskContext& ctx, bool ready) {
        describe(ctx);
        const bool begins = !fresh_ && !begun_ && ready;
        fresh_ = false;
        begun_ = begun_ || begins;
        raise_.Execute = begun_ && step_ == Step::raise;
        ready_.Execute = begun_ && step_ == Step::ready;
        track_.Execute = begun_ && step_ == Step::track;
        // All of them in one scan: the queue keeps their order, and the corner above the part is passed on a curve.
        to_part_.Execute = onto_part_.Execute = sucking_.Execute = off_belt_.Execute = begun_ && step_ == Step::pick;
        over_slot_.Execute = into_slot_.Execute = letting_go_.Execute = off_slot_.Execute = begun_ && step_ == Step::place;
        call(ctx);
        if (step_ == Step::wait && ready && picks_) choose_part(ctx);
        next(ctx);
    }

    void choose_part(const TaskContext& ctx) {
        const double belt = belt_now(ctx);
        while (!parts_.empty() && barrier + parts_.oldest(belt) > reach_ends) {
            parts_.remove_oldest();
            ++missed_, ++missed_in_a_row_;
        }
        if (!parts_.empty() && barrier + parts_.oldest(belt) >= reach_begins) enter(Step::track);
    }

    /// Where everything goes. Told in each scan; a command keeps what stood here at its edge.
    void describe(TaskContext& ctx) {
        raise_.CoordSystem = ready_.CoordSystem = mcMCS;
        // Relative, so that it is straight up from where the arm comes to rest; no way at all when it is up.
        if (step_ != Step::raise || !begun_) raise_.Distance.C.Tcp = {.Z = std::max(travel_height - place_.Position.C.Tcp.Z, 0.0)};
        raise_.Velocity = 200;
        ready_.Position.C.Tcp = {.X = reach_begins + 60, .Y = belt_line + 60, .Z = travel_height};
        ready_.Velocity = 60;  // deg/s: of the axes together; some 400 mm/s of the gripper, which may come from anywhere

        // The part's frame: the belt runs along the X of its origin, which is the barrier here. InitialObjectPosition counts from the scan of the edge, so
        // it does not matter how
        // long ago the barrier saw the part. Its origin is the middle of the part's top.
        track_.ConveyorBelt = belt_;
        track_.ConveyorBeltOrigin = {.X = barrier, .Y = belt_line, .Z = belt_height + part_height};
        if (!parts_.empty()) track_.InitialObjectPosition.X = parts_.oldest(belt_now(ctx));
        track_.CoordSystem = mcPCS;
        for (auto* on_belt : {&to_part_, &onto_part_, &off_belt_}) on_belt->CoordSystem = mcPCS;
        to_part_.Position.C.Tcp = off_belt_.Position.C.Tcp = {.Z = above};
        onto_part_.Position.C.Tcp = {};
        sucking_.Duration = 80ms;  // until the vacuum has built up; the arm goes with the part meanwhile

        const double x = pitch * static_cast<double>(slot_ % columns), y = pitch * static_cast<double>(slot_ / columns);
        for (auto* over_tray : {&over_slot_, &into_slot_, &off_slot_}) over_tray->CoordSystem = mcPCS_2;  // of the machine file: the tray
        over_slot_.Position.C.Tcp = off_slot_.Position.C.Tcp = {.X = x, .Y = y, .Z = part_height + above};
        into_slot_.Position.C.Tcp = {.X = x, .Y = y, .Z = part_height + 0.5};  // it falls the last half millimetre
        letting_go_.Duration = 60ms;

        for (auto* later : {&onto_part_, &into_slot_}) {  // the corner above is rounded, from 20 mm before it on
            later->BufferMode = mcBlendingHigh;
            later->TransitionMode = mcTMCornerDistance;
            later->TransitionParameter.Parameter[0] = 20;
            later->Velocity = 600;
        }
        off_belt_.BufferMode = off_slot_.BufferMode = mcBuffered;
        sucking_.BufferMode = letting_go_.BufferMode = mcBuffered;
        // In another frame than the one before: the arm lets the belt go, comes to rest, and begins from there. Aborting would do the same to a command
        // that is not over.
        over_slot_.BufferMode = mcBuffered;
    }

    void call(TaskContext& ctx) {
        raise_(ctx);
        ready_(ctx);
        track_(ctx);
        to_part_(ctx);
        onto_part_(ctx);
        sucking_(ctx);
        off_belt_(ctx);
        over_slot_(ctx);
        into_slot_(ctx);
        letting_go_(ctx);
        off_slot_(ctx);
    }

    /// A round that has begun is ended: no part hangs in the air because somebody switches `picks` off.
    [[nodiscard]] bool under_way() const { return step_ == Step::track || step_ == Step::pick || step_ == Step::place; }
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
        return look(raise_, ready_, track_, to_part_, onto_part_, sucking_, off_belt_, over_slot_, into_slot_, letting_go_, off_slot_),
               over;
    }

    void next(TaskContext& ctx) {
        if (begun_ && broken()) {
            if (!carries_) sucks_ = false;
            if ((step_ == Step::track || step_ == Step::pick) && !carries_ && !parts_.empty())
                parts_.remove_oldest();  // it is not tried twice
            // A part out of reach is one part. Everything else is something that a person has to look at.
            const bool of_the_part = (to_part_.Error || track_.Error) && !status_.GroupErrorStop;
            if (!of_the_part) wait_for_a_person();
            ++broken_;
            return enter(Step::raise);
        }
        switch (step_) {
            case Step::raise:
                if (raise_.Done) enter(carries_ ? Step::place : Step::ready);
                break;
            case Step::ready:
                if (ready_.Done) enter(Step::wait);
                break;
            case Step::wait: break;
            case Step::track:
                if (track_.Done) enter(Step::pick);
                break;
            case Step::pick:
                if (onto_part_.Done) sucks_ = true;  // Done: at its place, and in step with the belt
                if (sucking_.Done && !carries_) {
                    carries_ = true;
                    parts_.remove_oldest();
                    missed_in_a_row_ = 0;
                }
                if (!off_belt_.Done) break;
                if (!ctx.get(gripped_)) sucks_ = carries_ = false;
                ++(carries_ ? picked_ : empty_);
                enter(carries_ ? Step::place : Step::ready);
                break;
            case Step::place:
                if (into_slot_.Done && carries_) {
                    sucks_ = carries_ = false;
                    ++placed_, ++slot_;
                }
                if (off_slot_.Done) enter(slot_ < columns * rows ? Step::wait : Step::change_tray);
                break;
            case Step::change_tray:
                if (exchange_.Q) {
                    ++trays_;
                    slot_ = 0;
                    enter(Step::ready);
                }
                break;
        }
        exchange_.IN = step_ == Step::change_tray && ctx.get(tray_there_);
        exchange_.PT = 1s;
        exchange_(ctx);
    }
};

}  // namespace

TAKTWERK_PROGRAM(DeltaPicker)
