#pragma once
// MC_Jog, with the pins of TwinCAT's block of that name (not part of PLCopen). Real-time safe.
//
//   * Level based: the axis moves while an input is TRUE. Forward wins when both become TRUE in one call. While it moves or still
//     brakes the other input, or the same one pressed again, has no effect; pressed still at standstill, it starts then.
//   * Each call renews the axis' jog lease; a program that is no longer called stops the axis after it (AxisPatience::jog_lease).
//   * Releasing halts with Deceleration and Jerk, then Done for one call.
//   * After Error or CommandAborted both inputs must be released before it moves again.
//   * Slow and fast take the axis' configured manual velocities and default dynamics; continuous takes the block's, and follows Velocity.
//   * Inching moves by Position once per press and finishes also when released; Done stays while the input is TRUE. Inching modulo moves
//     to the next multiple of Position; on a modulo axis the multiples begin anew at 0 of each turn.

#include <cmath>
#include <cstdint>
#include <string_view>

#include "fb_library/motion/execute_block.hpp"

namespace taktwerk::fb {

struct MC_Jog {
    AxisRef Axis{};
    bool JogForward = false, JogBackwards = false;
    MC_JogMode Mode = mcJogStandardSlow;
    double Position = 0, Velocity = 0, Acceleration = 0, Deceleration = 0, Jerk = 0;

    bool Done = false, Busy = false, Active = false, CommandAborted = false, Error = false;
    ErrorId ErrorID{};

    ExecuteCore core{};
    struct Press {              ///< what the last press latched; not pins
        std::int8_t sense = 0;  ///< +1 forward, -1 backwards
        MC_JogMode mode = mcJogStandardSlow;
        bool released = false;
        bool halting = false;
    } press{};

    static constexpr std::string_view summary = "Moves the axis by hand, as long as an input is TRUE.";
    template <class Self>
    static consteval auto pins() {
        return pin_table(shared<&Self::Axis>(), in<&Self::JogForward>("", "moves in positive direction while TRUE; wins over JogBackwards"),
                         in<&Self::JogBackwards>("", "moves in negative direction while TRUE"),
                         in<&Self::Mode>("", "which speed, or inching; taken when pressed"),
                         in<&Self::Position>("u", "inching: distance, > 0; inching modulo: what the target is a multiple of"),
                         in<&Self::Velocity>("u/s", "continuous, inching: > 0; continuous follows changes"),
                         in<&Self::Acceleration>("u/s2", "continuous, inching; 0 = the axis' default"),
                         in<&Self::Deceleration>("u/s2", "continuous, inching; 0 = the axis' default"),
                         in<&Self::Jerk>("u/s3", "continuous, inching; 0 = the axis' default"),
                         out<&Self::Done>("", "standing again after a jog"), out<&Self::Busy>("", "moving or braking"),
                         out<&Self::Active>("", "this block controls the axis"),
                         shared<&Self::CommandAborted, &Self::Error, &Self::ErrorID>());
    }

    void operator()(const MotionContext& ctx) noexcept {
        const bool hold = core.running() ? !press.released && (press.sense > 0 ? JogForward : JogBackwards) : JogForward || JogBackwards;
        if (core.begin(hold) == ExecuteCore::Edge::rising) start(ctx);
        if (core.running()) {
            press.released = !hold;
            core.follow(ctx, Completion::done);  // first: a command that someone else has ended is not to be renewed or halted
            if (core.running() && !inches(press.mode)) keep_moving_or_halt(ctx);
        }
        core.publish(*this);
    }
    void warm_start(Instant) noexcept {
        core.warm_start(true);
        core.publish(*this);
    }

private:
    void start(const MotionContext& ctx) noexcept {
        press = {.sense = static_cast<std::int8_t>(JogForward ? 1 : -1), .mode = Mode, .released = false, .halting = false};
        if (Mode > mcJogInchingModulo) return core.refuse(ErrorId::invalid_parameter);
        const axes::AxisView* view = ctx.view(Axis);
        if (view == nullptr) return core.refuse(ErrorId::invalid_axis);
        const double velocity = speed(*view);
        if (!(velocity > 0) || !std::isfinite(velocity)) return core.refuse(ErrorId::invalid_velocity);
        if (inches(Mode)) {
            if (!(Position > 0) || !std::isfinite(Position)) return core.refuse(ErrorId::invalid_position);
            return core.submit(ctx, Axis,
                               {.kind = axes::CommandKind::move_relative,
                                .position = Mode == mcJogInching ? press.sense * Position : to_next_multiple(*view),
                                .velocity = velocity,
                                .acceleration = Acceleration,
                                .deceleration = Deceleration,
                                .jerk = Jerk});
        }
        const bool own = Mode == mcJogContinuous;
        core.submit(ctx, Axis,
                    {.kind = axes::CommandKind::jog,
                     .velocity = press.sense * velocity,
                     .acceleration = own ? Acceleration : 0.0,
                     .deceleration = own ? Deceleration : 0.0,
                     .jerk = own ? Jerk : 0.0});
    }

    void keep_moving_or_halt(const MotionContext& ctx) noexcept {
        if (press.halting) return;
        const axes::AxisView* view = ctx.view(core.axis());
        const double velocity = speed(*view);
        if (press.released) {
            press.halting = true;
            const bool own = press.mode == mcJogContinuous;
            core.submit(ctx, core.axis(),
                        {.kind = axes::CommandKind::halt, .deceleration = own ? Deceleration : 0.0, .jerk = own ? Jerk : 0.0});
        } else if (!(velocity > 0) || !std::isfinite(velocity)) {
            core.refuse(ErrorId::invalid_velocity);  // no renewal: the axis stops when the lease ends
        } else if (const ErrorId error = ctx.requests->renew_jog(core.axis(), core.command(), press.sense * velocity, ctx.owner);
                   error != ErrorId::none) {
            core.refuse(error);
        }
    }

    [[nodiscard]] static constexpr bool inches(MC_JogMode mode) noexcept { return mode == mcJogInching || mode == mcJogInchingModulo; }

    /// From the set position; one that stands on a multiple, within a millionth of Position, goes to the next.
    [[nodiscard]] double to_next_multiple(const axes::AxisView& view) const noexcept {
        constexpr double on_it = 1e-6;
        const double here = view.set_position / Position;
        double target = Position * (press.sense > 0 ? std::floor(here + on_it) + 1 : std::ceil(here - on_it) - 1);
        if (view.modulo > 0) {
            const double highest = Position * (std::ceil(view.modulo / Position - on_it) - 1);  // below the end of the turn
            if (target > highest) target = view.modulo;
            if (target < 0) target = highest - view.modulo;
        }
        return target - view.set_position;
    }

    [[nodiscard]] double speed(const axes::AxisView& view) const noexcept {
        return press.mode == mcJogStandardSlow ? view.manual_slow : press.mode == mcJogStandardFast ? view.manual_fast : Velocity;
    }
};

}  // namespace taktwerk::fb
