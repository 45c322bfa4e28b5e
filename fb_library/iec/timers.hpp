#pragma once
// TON, TOF, TP: IEC 61131-3 ed. 3, 6.6.3.5.5. Real-time safe. Time is the scan's, constant while the scan lasts.
//
// Where the standard leaves room, or products differ:
//   * PT = 0: TON.Q is TRUE in the call in which IN rises, as the equation says (ET >= PT); TP gives no pulse, TOF no delay.
//   * PT counts live while the timer runs; once it has expired it stays expired, with ET at that PT, until it starts anew.
//   * A negative PT is 0.
//   * The first call with IN TRUE is a rising edge (against the initial FALSE); with IN FALSE it is no falling edge.
//   * Between calls time passes but ET stands: a timer that was not called for long expires in its next call.
//   * Warm start: `warm_start(now)` continues with the elapsed time of the last call; absolute times mean nothing after a reboot.

#include <algorithm>
#include <array>
#include <string_view>

#include "core/cycle_context.hpp"
#include "fb_library/pins/pin.hpp"

namespace taktwerk::fb {

/// What the three timers remember between calls.
class TimerState {
public:
    /// Edge of IN against the call before.
    [[nodiscard]] constexpr bool rose(bool level) const noexcept { return level && !level_; }
    [[nodiscard]] constexpr bool fell(bool level) const noexcept { return !level && level_; }
    constexpr void store(bool level) noexcept { level_ = level; }

    constexpr void start(Instant now) noexcept {
        start_ = now;
        running_ = true;
        expired_ = false;
    }
    constexpr void clear() noexcept { running_ = expired_ = false; }
    [[nodiscard]] constexpr bool running() const noexcept { return running_; }
    [[nodiscard]] constexpr bool expired() const noexcept { return expired_; }

    /// Lets a running timer go on to `now`; the elapsed time, at most `preset`. Only while running or expired.
    constexpr Duration advance(Instant now, Duration preset, Duration last) noexcept {
        if (!running_) return last;
        preset = std::max(preset, Duration::zero());
        const Duration elapsed = now - start_;
        if (elapsed < preset) return elapsed;
        running_ = false;
        expired_ = true;
        return preset;
    }
    constexpr void rebase(Instant now, Duration elapsed) noexcept { start_ = now - elapsed; }

private:
    Instant start_{};
    bool level_ = false, running_ = false, expired_ = false;
};

struct TON {
    bool IN = false;
    Duration PT{};
    bool Q = false;
    Duration ET{};
    TimerState state{};

    static constexpr std::string_view summary = "On-delay: Q follows a rising IN after PT, a falling IN at once.";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in<&TON::IN>("", "starts the delay while TRUE"),
            in<&TON::PT>("", "delay; live until expired; negative = 0"),
            out<&TON::Q>("", "IN has been TRUE for PT"),
            out<&TON::ET>("", "elapsed time, at most PT; 0 while IN is FALSE"),
        };
    }

    constexpr void operator()(const CycleContext& ctx) noexcept {
        if (!IN) {
            state.clear();
            ET = Duration::zero();
        } else {
            if (state.rose(IN)) state.start(ctx.now);
            ET = state.advance(ctx.now, PT, ET);
        }
        Q = state.expired();
        state.store(IN);
    }
    constexpr void warm_start(Instant now) noexcept { state.rebase(now, ET); }
};

struct TOF {
    bool IN = false;
    Duration PT{};
    bool Q = false;
    Duration ET{};
    TimerState state{};

    static constexpr std::string_view summary = "Off-delay: Q follows a rising IN at once, a falling IN after PT.";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in<&TOF::IN>("", "a falling edge starts the delay, a rising one cancels it"),
            in<&TOF::PT>("", "delay; live until expired; negative = 0"),
            out<&TOF::Q>("", "IN is TRUE, or was within PT"),
            out<&TOF::ET>("", "time since the falling edge, at most PT; 0 while IN is TRUE"),
        };
    }

    constexpr void operator()(const CycleContext& ctx) noexcept {
        if (IN) {
            state.clear();
            ET = Duration::zero();
        } else {
            if (state.fell(IN)) state.start(ctx.now);
            ET = state.advance(ctx.now, PT, ET);
        }
        Q = IN || state.running();
        state.store(IN);
    }
    constexpr void warm_start(Instant now) noexcept { state.rebase(now, ET); }
};

struct TP {
    bool IN = false;
    Duration PT{};
    bool Q = false;
    Duration ET{};
    TimerState state{};

    static constexpr std::string_view summary = "Pulse: a rising IN gives one pulse of length PT, whatever IN does meanwhile.";
    template <class Self>
    static consteval auto pins() {
        return std::array{
            in<&TP::IN>("", "a rising edge starts the pulse; ignored while it lasts"),
            in<&TP::PT>("", "length; live until expired; negative = 0"),
            out<&TP::Q>("", "the pulse"),
            out<&TP::ET>("", "elapsed time, at most PT; 0 once the pulse is over and IN is FALSE"),
        };
    }

    constexpr void operator()(const CycleContext& ctx) noexcept {
        if (!state.running() && state.rose(IN)) state.start(ctx.now);
        if (state.running() || state.expired()) ET = state.advance(ctx.now, PT, ET);
        if (state.expired() && !IN) {
            state.clear();
            ET = Duration::zero();
        }
        Q = state.running();
        state.store(IN);
    }
    constexpr void warm_start(Instant now) noexcept { state.rebase(now, ET); }
};

}  // namespace taktwerk::fb
