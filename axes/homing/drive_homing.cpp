#include "axes/homing/drive_homing.hpp"

namespace taktwerk::axes {

namespace {

using namespace std::chrono_literals;

// A drive shows "attained" of an earlier homing until it has seen the new start: believed only after it was seen FALSE, or after
// this long (methods such as 35 and 37 are over before a frame has passed).
constexpr Duration stale_attained = 50ms;
// A drive that does not confirm the way back, or does not stand, after this long never will.
constexpr Duration patience = 2s;

}  // namespace

void DriveHoming::start(Instant now, Duration timeout, Duration mode_delay, DriveMode back) noexcept {
    back_ = back;
    timeout_ = timeout;
    mode_delay_ = mode_delay;
    begun_ = now;
    result_ = Result::none;
    seen_unattained_ = false;
    go(Phase::entering, now);
}

void DriveHoming::abort(Instant now) noexcept {
    if (phase_ == Phase::entering || phase_ == Phase::searching) end(Result::aborted, now);
    else if (busy()) result_ = Result::aborted;
}

DriveHoming::Result DriveHoming::step(const DriveFeedback& feedback, bool stands, Instant now) noexcept {
    const bool late = now - since_ >= patience;
    switch (phase_) {
        case Phase::idle: return Result::none;
        case Phase::entering:
            if (now - begun_ >= timeout_) end(Result::timed_out, now);
            else if (feedback.fresh && feedback.mode == DriveMode::homing) {
                if (now - since_ >= mode_delay_) go(Phase::searching, now);
            } else since_ = now;
            return Result::none;
        case Phase::searching:
            if (now - begun_ >= timeout_) {
                end(Result::timed_out, now);
                return Result::none;
            }
            if (!feedback.fresh) return Result::none;
            if (!feedback.homing_attained) seen_unattained_ = true;
            if (feedback.homing_error) end(Result::failed, now);
            else if (feedback.homing_attained && (seen_unattained_ || now - since_ >= stale_attained)) {
                result_ = Result::attained;
                go(Phase::leaving, now);
            }
            return Result::none;
        case Phase::braking:
            if ((feedback.fresh && stands) || late) go(Phase::leaving, now);
            return Result::none;
        case Phase::leaving:
            if (feedback.fresh && feedback.mode == back_) go(Phase::settling, now);
            else if (late) {
                result_ = feedback.online ? Result::failed : Result::aborted;  // who is gone has not failed: the bus says why
                go(Phase::settling, now);
            }
            return Result::none;
        case Phase::settling:
            if (now - since_ < mode_delay_) return Result::none;
            phase_ = Phase::idle;
            return result_;
    }
    return Result::none;
}

}  // namespace taktwerk::axes
