// One axis of each kind of drive that moves alone: every axis powers, homes, and goes to and fro until the machine stops. An axis that fails is reset
// after a while, homes again where it has lost its reference, and goes on; the others do not wait for it. The arm of the same machine: belt_picking.cpp.

#include "fb_library/all_blocks.hpp"
#include "programs/api/entry.hpp"

namespace {

using namespace taktwerk;
using namespace taktwerk::fb;

/// What every axis does until it moves, and after it failed. The serial one and the others differ in how they move.
struct Station {
    AxisRef axis;
    MC_Power power;
    MC_Reset reset;
    MC_Home home;
    TON cooling;  ///< a drive gets a moment before it is reset
    bool was_failed = false;
    std::int64_t strokes = 0, failures = 0, recoveries = 0;

    [[nodiscard]] bool failed(const TaskContext& ctx) const { return ctx.view(axis)->state == axes::AxisState::ErrorStop; }
    [[nodiscard]] bool ready(const TaskContext& ctx) const { return power.Status && !failed(ctx) && ctx.view(axis)->homed && !home.Busy; }

    void call(TaskContext& ctx) {
        power.Axis = reset.Axis = home.Axis = axis;
        const bool failure = failed(ctx);
        failures += failure && !was_failed;
        recoveries += was_failed && !failure;
        was_failed = failure;
        cooling.IN = failure && !reset.Busy;
        cooling.PT = from_seconds(0.5);
        cooling(ctx);

        power.Enable = true;
        power(ctx);
        reset.Execute = failure && (cooling.Q || reset.Busy);
        reset(ctx);
        home.Execute = power.Status && !failure && (home.Busy || !ctx.view(axis)->homed);
        home(ctx);
    }
};

/// Between two places.
struct Positioning : Station {
    double near_end, far_end, velocity;
    MC_MoveAbsolute move;

    Positioning(double from, double to, double speed) : near_end(from), far_end(to), velocity(speed) {}

    void scan(TaskContext& ctx) {
        call(ctx);
        strokes += move.Done;
        const bool go = ready(ctx) && !move.Done && !move.Error && !move.CommandAborted;
        move.Axis = axis;
        if (go && !move.Execute) {
            move.Position = strokes % 2 == 0 ? far_end : near_end;
            move.Velocity = velocity;
        }
        move.Execute = go;
        move(ctx);
    }
};

/// Forward until beyond one place, backward until beyond the other: what a drive can that knows speeds alone.
struct ToAndFro : Station {
    double near_end, far_end, velocity;
    MC_MoveVelocity move;
    bool forward = true;

    ToAndFro(double from, double to, double speed) : near_end(from), far_end(to), velocity(speed) {}

    void scan(TaskContext& ctx) {
        call(ctx);
        const double position = ctx.view(axis)->actual_position;
        const bool turn = forward ? position > far_end : position < near_end;
        const bool go = ready(ctx) && !turn && !move.Error && !move.CommandAborted;
        if (turn && ready(ctx)) {
            forward = !forward;
            ++strokes;
        }
        move.Axis = axis;
        move.Velocity = velocity;
        move.Direction = forward ? mcPositiveDirection : mcNegativeDirection;
        move.Execute = go;
        move(ctx);
    }
};

class FiveDrives final : public Program {
    // mm, mm/s
    Positioning sv33_{20, 300, 200}, da200_{20, 250, 150}, stepper_{10, 100, 40};
    ToAndFro spindle_{20, 200, 90};

    std::int64_t least_strokes_ = 0, failures_ = 0, recoveries_ = 0;

    template <class Do>
    void each(Do&& action) {
        action(sv33_);
        action(da200_);
        action(stepper_);
        action(spindle_);
    }

public:
    void declare(Declaration& d) override {
        sv33_.axis = d.axis("sv33");
        da200_.axis = d.axis("da200");
        stepper_.axis = d.axis("stepper");
        spindle_.axis = d.axis("xp200");
        d.monitor("least_strokes", least_strokes_, "", "of the axis that made the fewest");
        d.monitor("failures", failures_, "", "how often an axis failed");
        d.monitor("recoveries", recoveries_, "", "how often one came back");
        d.task<&FiveDrives::scan>("main");
    }

    void scan(TaskContext& ctx) {
        std::int64_t least = INT64_MAX, failures = 0, recoveries = 0;
        each([&](auto& station) {
            station.scan(ctx);
            least = std::min(least, station.strokes);
            failures += station.failures;
            recoveries += station.recoveries;
        });
        least_strokes_ = least;
        failures_ = failures;
        recoveries_ = recoveries;
    }
};

}  // namespace

TAKTWERK_PROGRAM(FiveDrives)
