// A delta picks parts from a belt that never stops, and lays them into a tray. Several parts are on the belt at once: a light barrier in front of the arm latches
// the belt's position at each (a touch probe), so a part is a number from then on, and where it is now is that number and the belt. While the arm takes a part,
// its frame goes with the belt (MC_TrackConveyorBelt): the commands are the same as over a table.
//
//     ready ---> pick: track, above, down | suck | up ---> place: over, down | let go | up ---> ready ...
//
// Whatever stops the arm (a fault, a person), it goes on when a person says so: by the switch `picks`, after a reset where there was an error. It goes
// straight up first, and a part that hangs on it is laid down where it was meant to go.

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

    struct {  // power and reference
        MC_GroupPower power;
        std::array<MC_Home, arms> homes;
        MC_GroupEnable enable;
        MC_GroupReadStatus status;
        MC_GroupReadPosition place;
        MC_Power belt_power;
    } up_;
    struct {  // the belt and its parts
        MC_MoveVelocity feed;
        MC_Halt halt;
        MC_TouchProbe probe;
        PartsOnBelt parts;
    } line_;
    struct {  // the arm, in the order of a round
        MC_MoveLinearRelative raise;
        MC_MoveDirectAbsolute ready;
        MC_TrackConveyorBelt track;
        MC_MoveLinearAbsolute to_part, onto_part, off_belt;
        MC_GroupWaitTime sucking;
        MC_MoveLinearAbsolute over_slot, into_slot, off_slot;
        MC_GroupWaitTime letting_go;
    } go_;
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
    struct {                 // for people
        std::int64_t picked = 0, placed = 0, missed = 0, empty = 0, broken = 0, trays = 0, waiting = 0, missed_in_a_row = 0, error = 0;
    } count_;

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
        d.monitor("waiting", count_.waiting, "", "parts between light barrier and arm");
        d.monitor("picked", count_.picked, "", "parts taken off the belt since start");
        d.monitor("placed", count_.placed, "", "parts laid into trays");
        d.monitor("missed", count_.missed, "", "parts that had gone by before the arm was free");
        d.monitor("empty", count_.empty, "", "picks after which nothing hung on the gripper");
        d.monitor("broken", count_.broken, "", "rounds that were broken off");
        d.monitor("trays", count_.trays, "", "filled");
        d.monitor("error", count_.error, "", "ErrorID that broke the last round off (docs/reference/errors.md); 0: it was aborted");
        d.block("track", go_.track);
        d.block("onto_part", go_.onto_part);
        d.block("into_slot", go_.into_slot);
        d.alarm(0, Reaction::warn, "The arm was stopped on its way and waits for a person", "机械臂中途停止，等待人工操作",
                "remove the cause (alarms of its axes and of the bus name it), look that nobody is in its reach, reset, then press `go_on` "
                "(or switch `picks` on): it goes straight up first");
        d.alarm(1, Reaction::warn, "Parts go by without being picked", "工件未被拾取而通过", "lower belt_speed");
        d.task<&DeltaPicker::scan>("main");
    }

    void start() override {
        // The vacuum stays as it is: what hangs on the gripper would fall.
        line_.parts.clear();
        armed_ = stopped_ = false;
        picks_ = true;
        enter(Step::raise);
        for (auto& home : up_.homes) home.Execute = false;
        up_.enable.Execute = false;
    }

    void scan(TaskContext& ctx) {
        for (auto* group : {&up_.power.AxesGroup, &up_.enable.AxesGroup, &up_.status.AxesGroup, &up_.place.AxesGroup, &go_.raise.AxesGroup,
                            &go_.ready.AxesGroup, &go_.track.AxesGroup, &go_.to_part.AxesGroup, &go_.onto_part.AxesGroup,
                            &go_.off_belt.AxesGroup, &go_.sucking.AxesGroup, &go_.over_slot.AxesGroup, &go_.into_slot.AxesGroup,
                            &go_.off_slot.AxesGroup, &go_.letting_go.AxesGroup})
            *group = delta_;
        const bool ready = power(ctx);
        pressed_.CLK = ctx.get(go_on_);
        pressed_(ctx);
        if (pressed_.Q && !up_.status.GroupErrorStop) picks_ = true;
        if (picks_) stopped_ = false;
        run_belt(ctx, ready && picks_);
        watch_barrier(ctx);
        move(ctx, ready && (picks_ || under_way()));

        ctx.set(vacuum_, sucks_);
        ctx.set(tray_full_, step_ == Step::change_tray);
        ctx.alarm(0, stopped_);
        ctx.alarm(1, count_.missed_in_a_row >= 5);
        count_.waiting = static_cast<std::int64_t>(line_.parts.count());
    }

private:
    /// All that has to be so before anything moves.
    bool power(TaskContext& ctx) {
        up_.power.Enable = up_.status.Enable = up_.place.Enable = true;
        up_.power(ctx);
        bool homed = true;
        for (std::size_t i = 0; i < arms; ++i) {
            up_.homes[i].Axis = axes_[i];
            up_.homes[i].Execute = up_.power.Status && !ctx.view(axes_[i])->homed;
            up_.homes[i](ctx);
            homed = homed && ctx.view(axes_[i])->homed && !up_.homes[i].Busy;
        }
        up_.enable.Execute = up_.power.Status && homed;
        up_.enable(ctx);
        up_.status(ctx);
        up_.place.CoordSystem = mcMCS;
        up_.place(ctx);
        up_.belt_power.Axis = belt_;
        up_.belt_power.Enable = true;
        up_.belt_power(ctx);
        return up_.power.Status && homed && up_.belt_power.Status && up_.place.Valid && (up_.status.GroupStandby || up_.status.GroupMoving);
    }

    /// Somebody has to look, and to say that it may go on.
    void wait_for_a_person() { picks_ = false, stopped_ = true; }

    /// It stands while the arm cannot work: no part goes by because of that.
    void run_belt(TaskContext& ctx, bool run) {
        if (line_.feed.Execute && (line_.feed.Error || line_.feed.CommandAborted))
            wait_for_a_person();  // not by this program: by a person, or a fault
        line_.feed.Axis = line_.halt.Axis = belt_;
        line_.feed.Velocity = ctx.get(belt_speed_);
        line_.feed.ContinuousUpdate = true;
        line_.feed.Execute = run;
        line_.feed(ctx);
        line_.halt.Execute = up_.belt_power.Status && !run;
        line_.halt(ctx);
    }

    /// Each part at the barrier becomes a number. Parts have to be a few cycles apart, so that the probe is armed again.
    void watch_barrier(TaskContext& ctx) {
        if (line_.probe.Done && !line_.parts.add(line_.probe.RecordedPosition)) ++count_.missed;
        if (line_.probe.Done || line_.probe.Error || line_.probe.CommandAborted) armed_ = false;
        line_.probe.Axis = belt_;
        line_.probe.TriggerInput = {.source = axes::TriggerSource::probe1};
        line_.probe.Execute = armed_;  // each part is an edge of its own
        line_.probe(ctx);
        armed_ = up_.belt_power.Status;
        if (!up_.belt_power.Status) line_.parts.clear();  // it may have been moved by hand: what lies on it now goes by
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
        go_.raise.Execute = begun_ && step_ == Step::raise;
        go_.ready.Execute = begun_ && step_ == Step::ready;
        go_.track.Execute = begun_ && step_ == Step::track;
        // All of them in one scan: the queue keeps their order, and the corner above the part is passed on a curve.
        go_.to_part.Execute = go_.onto_part.Execute = go_.sucking.Execute = go_.off_belt.Execute = begun_ && step_ == Step::pick;
        go_.over_slot.Execute = go_.into_slot.Execute = go_.letting_go.Execute = go_.off_slot.Execute = begun_ && step_ == Step::place;
        call(ctx);
        if (step_ == Step::wait && ready && picks_) choose_part(ctx);
        next(ctx);
    }

    void choose_part(const TaskContext& ctx) {
        const double belt = belt_now(ctx);
        while (!line_.parts.empty() && barrier + line_.parts.oldest(belt) > reach_ends) {
            line_.parts.remove_oldest();
            ++count_.missed, ++count_.missed_in_a_row;
        }
        if (!line_.parts.empty() && barrier + line_.parts.oldest(belt) >= reach_begins) enter(Step::track);
    }

    /// Where everything goes. Told in each scan; a command keeps what stood here at its edge.
    void describe(TaskContext& ctx) {
        go_.raise.CoordSystem = go_.ready.CoordSystem = mcMCS;
        // Relative, so that it is straight up from where the arm comes to rest; no way at all when it is up.
        if (step_ != Step::raise || !begun_) go_.raise.Distance.C.Tcp = {.Z = std::max(travel_height - up_.place.Position.C.Tcp.Z, 0.0)};
        go_.raise.Velocity = 200;
        go_.ready.Position.C.Tcp = {.X = reach_begins + 60, .Y = belt_line + 60, .Z = travel_height};
        go_.ready.Velocity = 60;  // deg/s: of the axes together; some 400 mm/s of the gripper, which may come from anywhere

        // The part's frame: the belt runs along the X of its origin, which is the barrier here. InitialObjectPosition counts from the scan of the edge, so
        // it does not matter how
        // long ago the barrier saw the part. Its origin is the middle of the part's top.
        go_.track.ConveyorBelt = belt_;
        go_.track.ConveyorBeltOrigin = {.X = barrier, .Y = belt_line, .Z = belt_height + part_height};
        if (!line_.parts.empty()) go_.track.InitialObjectPosition.X = line_.parts.oldest(belt_now(ctx));
        go_.track.CoordSystem = mcPCS;
        for (auto* on_belt : {&go_.to_part, &go_.onto_part, &go_.off_belt}) on_belt->CoordSystem = mcPCS;
        go_.to_part.Position.C.Tcp = go_.off_belt.Position.C.Tcp = {.Z = above};
        go_.onto_part.Position.C.Tcp = {};
        go_.sucking.Duration = 80ms;  // until the vacuum has built up; the arm goes with the part meanwhile

        const double x = pitch * static_cast<double>(slot_ % columns), y = pitch * static_cast<double>(slot_ / columns);
        for (auto* over_tray : {&go_.over_slot, &go_.into_slot, &go_.off_slot})
            over_tray->CoordSystem = mcPCS_2;  // of the machine file: the tray
        go_.over_slot.Position.C.Tcp = go_.off_slot.Position.C.Tcp = {.X = x, .Y = y, .Z = part_height + above};
        go_.into_slot.Position.C.Tcp = {.X = x, .Y = y, .Z = part_height + 0.5};  // it falls the last half millimetre
        go_.letting_go.Duration = 60ms;

        for (auto* later : {&go_.onto_part, &go_.into_slot}) {  // the corner above is rounded, from 20 mm before it on
            later->BufferMode = mcBlendingHigh;
            later->TransitionMode = mcTMCornerDistance;
            later->TransitionParameter.Parameter[0] = 20;
            later->Velocity = 600;
        }
        go_.off_belt.BufferMode = go_.off_slot.BufferMode = mcBuffered;
        go_.sucking.BufferMode = go_.letting_go.BufferMode = mcBuffered;
        // In another frame than the one before: the arm lets the belt go, comes to rest, and begins from there. Aborting would do the same to a command
        // that is not over.
        go_.over_slot.BufferMode = mcBuffered;
    }

    void call(TaskContext& ctx) {
        go_.raise(ctx);
        go_.ready(ctx);
        go_.track(ctx);
        go_.to_part(ctx);
        go_.onto_part(ctx);
        go_.sucking(ctx);
        go_.off_belt(ctx);
        go_.over_slot(ctx);
        go_.into_slot(ctx);
        go_.letting_go(ctx);
        go_.off_slot(ctx);
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
                count_.error = b.Error ? static_cast<std::int64_t>(b.ErrorID) : 0;
            };
            (one(block), ...);
        };
        return look(go_.raise, go_.ready, go_.track, go_.to_part, go_.onto_part, go_.sucking, go_.off_belt, go_.over_slot, go_.into_slot,
                    go_.letting_go, go_.off_slot),
               over;
    }

    void next(TaskContext& ctx) {
        if (begun_ && broken()) {
            if (!carries_) sucks_ = false;
            if ((step_ == Step::track || step_ == Step::pick) && !carries_ && !line_.parts.empty())
                line_.parts.remove_oldest();  // it is not tried twice
            // A part out of reach is one part. Everything else is something that a person has to look at.
            const bool of_the_part = (go_.to_part.Error || go_.track.Error) && !up_.status.GroupErrorStop;
            if (!of_the_part) wait_for_a_person();
            ++count_.broken;
            return enter(Step::raise);
        }
        switch (step_) {
            case Step::raise:
                if (go_.raise.Done) enter(carries_ ? Step::place : Step::ready);
                break;
            case Step::ready:
                if (go_.ready.Done) enter(Step::wait);
                break;
            case Step::wait: break;
            case Step::track:
                if (go_.track.Done) enter(Step::pick);
                break;
            case Step::pick:
                if (go_.onto_part.Done) sucks_ = true;  // Done: at its place, and in step with the belt
                if (go_.sucking.Done && !carries_) {
                    carries_ = true;
                    line_.parts.remove_oldest();
                    count_.missed_in_a_row = 0;
                }
                if (!go_.off_belt.Done) break;
                if (!ctx.get(gripped_)) sucks_ = carries_ = false;
                ++(carries_ ? count_.picked : count_.empty);
                enter(carries_ ? Step::place : Step::ready);
                break;
            case Step::place:
                if (go_.into_slot.Done && carries_) {
                    sucks_ = carries_ = false;
                    ++count_.placed, ++slot_;
                }
                if (go_.off_slot.Done) enter(slot_ < columns * rows ? Step::wait : Step::change_tray);
                break;
            case Step::change_tray:
                if (exchange_.Q) {
                    ++count_.trays;
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
