#pragma once
// What an axis knows of a profile that its drive makes (PP, PV, PT): the set-point handed over last, whether the drive has taken it, whether it
// is there. Decides nothing about commands. Positions are local, u; what goes to the drive is in its own counts. Real-time safe.

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "axes/axis/axis_view.hpp"
#include "axes/axis/command_queue.hpp"
#include "axes/port/drive_port.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

class DriveProfileRun {
public:
    /// A set-point that the drive has not taken after this long was refused: the port gives the handshake 0.5 s, and writes up to four objects by
    /// SDO before it.
    static constexpr Duration patience = std::chrono::seconds{2};
    /// "Target reached" right after a set-point may be that of the one before: believed once it was seen to fall, or after this long.
    static constexpr Duration stale = std::chrono::milliseconds{50};
    /// Standing off the target by more than the axis' own window, the drive's word alone ends a move after this long, once it was seen to fall.
    static constexpr Duration off_window = std::chrono::milliseconds{500};
    /// On its way out of the mode a motor that still turns is halted after this long.
    static constexpr Duration halts_after = std::chrono::milliseconds{50};

    /// The fields of DriveCommand that make a set-point; counts and the drive's sense.
    struct Setpoint {
        bool relative = false, immediately = false;
        std::int64_t position = 0;
        double velocity = 0, torque = 0;
        double acceleration = 0, deceleration = 0, torque_slope = 0;
        double velocity_limit = std::numeric_limits<double>::infinity();
    };
    /// Where a move in the drive begins and ends.
    struct Way {
        double from = 0, target = 0;
        VelocityLimiter limiter = VelocityLimiter::none;
    };

    /// The drive is asked for `mode`; it has no set-point yet.
    void enter(DriveMode mode) noexcept {
        mode_ = mode;
        ahead_ = 0;
        under_way_ = barred_ = false;
        withdraw();
    }
    /// The axis' own mode again.
    void end() noexcept {
        enter(DriveMode::none);
        stands_by_ = {};
    }
    /// Now; those before are forgotten, unless it waits behind them (`hand_ahead`).
    void hand(const Setpoint& setpoint, const Way& way, Instant now) noexcept {
        ahead_ = 0;
        ways_[0] = way;
        announce(setpoint, now);
        under_way_ = true;
        barred_ = false;
    }
    /// Only with room: ahead() < the drive's buffer.
    void hand_ahead(const Setpoint& setpoint, const Way& way, Instant now) noexcept {
        ways_[++ahead_] = way;
        announce(setpoint, now);
    }
    /// The one in front is over. The next in the drive is the one in front; nothing is under way without one.
    void advance() noexcept {
        under_way_ = ahead_ > 0;
        barred_ = reached_ = stands_ = false;
        if (ahead_ == 0) return;
        for (std::size_t i = 0; i < ahead_; ++i) ways_[i] = ways_[i + 1];
        --ahead_;
    }
    /// The newest was refused while it waited behind others: it gets its turn once they are over.
    void drop_ahead() noexcept {
        --ahead_;
        barred_ = true;
        sequence_ = 0;  // nothing of it may be taken later; those before it were
        accepted_ = true;
    }

    /// Each cycle, with what the drive says.
    void watch(const DriveFeedback& feedback, bool stands, Instant now) noexcept {
        if (!feedback.fresh) return;
        if (!accepted_ && sequence_ != 0 && feedback.profile_accepted == sequence_) {
            accepted_ = true;
            since_ = now;
            fell_ = reached_ = false;
        }
        if (!feedback.target_reached) fell_ = true;
        const bool reached = accepted_ && feedback.target_reached;
        if (!reached || !stands) stands_ = false;
        else if (!stands_) stands_since_ = now;
        stands_ = reached && stands;
        reached_ = reached && (fell_ || now - since_ >= stale);
    }
    /// The newest set-point was not taken in time.
    [[nodiscard]] bool refused(Instant now) const noexcept { return sequence_ != 0 && !accepted_ && now - since_ >= patience; }
    /// Velocity or torque: the drive says it has what was asked.
    [[nodiscard]] bool in_target() const noexcept { return reached_; }
    /// The drive stands at the last of its targets. `near`: inside the axis' own window of it.
    [[nodiscard]] bool arrived(bool near, Instant now) const noexcept {
        return stands_ && (near || (fell_ && now - stands_since_ >= off_window));
    }

    [[nodiscard]] DriveMode mode() const noexcept { return mode_; }
    [[nodiscard]] bool accepted() const noexcept { return accepted_; }
    /// A set-point is in the drive's hands and not over.
    [[nodiscard]] bool under_way() const noexcept { return under_way_; }
    /// Set-points in the drive behind the one in front.
    [[nodiscard]] std::size_t ahead() const noexcept { return ahead_; }
    [[nodiscard]] bool barred() const noexcept { return barred_; }
    [[nodiscard]] const Way& front() const noexcept { return ways_[0]; }
    [[nodiscard]] const Way& last() const noexcept { return ways_[ahead_]; }
    [[nodiscard]] const Setpoint& setpoint() const noexcept { return setpoint_; }
    [[nodiscard]] ProfileSetpoint announced() const noexcept { return {sequence_, setpoint_.relative, setpoint_.immediately}; }

    // --- the way out ---------------------------------------------------------------------------------------------------
    /// It takes the motor no longer than `most` to stand.
    void leave(Instant now, Duration most) noexcept {
        left_ = now;
        stands_by_ = now + most;
    }
    [[nodiscard]] bool may_still_turn(Instant now) const noexcept { return now < stands_by_; }
    [[nodiscard]] bool turns_too_long(Instant now) const noexcept { return now - left_ >= halts_after; }

private:
    void announce(const Setpoint& setpoint, Instant now) noexcept {
        setpoint_ = setpoint;
        if (++counter_ == 0) ++counter_;
        sequence_ = counter_;
        since_ = now;
        accepted_ = fell_ = reached_ = stands_ = false;
    }
    void withdraw() noexcept {
        sequence_ = 0;
        setpoint_ = {};
        accepted_ = fell_ = reached_ = stands_ = false;
    }

    DriveMode mode_ = DriveMode::none;
    std::uint32_t counter_ = 0, sequence_ = 0;  // never one twice: the port remembers the last that was taken
    Setpoint setpoint_;
    std::array<Way, CommandQueue::capacity + 1> ways_{};  // the one in front, and those that wait
    std::size_t ahead_ = 0;
    bool under_way_ = false, barred_ = false;
    bool accepted_ = false, fell_ = false, reached_ = false, stands_ = false;
    Instant since_{}, stands_since_{};  // since_: announced, then accepted
    Instant left_{}, stands_by_{};
};

}  // namespace taktwerk::axes
