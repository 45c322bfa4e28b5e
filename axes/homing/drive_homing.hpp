#pragma once
// Homing done by the drive itself (CiA 402 mode 6): change the mode at standstill, start, wait, change back. While it is busy the drive
// moves on its own and the axis' set-point follows the actual position. Positions are not touched here. Real-time safe.

#include <cstdint>

#include "axes/port/drive_port.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

class DriveHoming {
public:
    enum class Result : std::uint8_t { none, attained, failed, timed_out, aborted };
    enum class Phase : std::uint8_t {
        idle,
        entering,   ///< mode homing asked for, not confirmed yet
        searching,  ///< started; the drive moves
        braking,    ///< start taken back after an error or an abort; the drive ends its motion
        leaving,    ///< the axis' own mode asked for, not confirmed yet
        settling,   ///< confirmed; the drive's dwell after a change of mode
    };

    /// `timeout` bounds the search; `mode_delay` is the drive's dwell after a change of mode; `back` the mode it runs in afterwards.
    void start(Instant now, Duration timeout, Duration mode_delay, DriveMode back = DriveMode::cyclic_position) noexcept;
    /// Ends it early: result `aborted` once the drive stands and is back in cyclic position, or is gone from the bus.
    void abort(Instant now) noexcept;
    /// Forgets it at once: the drive has no power any more.
    void cancel() noexcept { phase_ = Phase::idle; }

    /// Once per cycle while busy. Gives the result in the call in which it gets idle, `none` before.
    Result step(const DriveFeedback& feedback, bool stands, Instant now) noexcept;

    [[nodiscard]] bool busy() const noexcept { return phase_ != Phase::idle; }
    [[nodiscard]] Phase phase() const noexcept { return phase_; }
    [[nodiscard]] DriveMode mode() const noexcept {
        return phase_ == Phase::entering || phase_ == Phase::searching || phase_ == Phase::braking ? DriveMode::homing : back_;
    }
    [[nodiscard]] bool start_level() const noexcept { return phase_ == Phase::searching; }

private:
    void go(Phase phase, Instant now) noexcept {
        phase_ = phase;
        since_ = now;
    }
    void end(Result result, Instant now) noexcept {
        result_ = result;
        go(Phase::braking, now);
    }

    Phase phase_ = Phase::idle;
    Result result_ = Result::none;
    DriveMode back_ = DriveMode::cyclic_position;
    Instant since_{}, begun_{};
    Duration timeout_{}, mode_delay_{};
    bool seen_unattained_ = false;
};

}  // namespace taktwerk::axes
