#pragma once
// Power as an axis sees it, above the port: asking for it, waiting for the drive and for the dwell after it, noticing its loss.
// The steps 6-7-15 of CiA 402 are the port's. Real-time safe.

#include "axes/port/drive_port.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

class PowerSequence {
public:
    enum class Phase : std::uint8_t {
        off,            ///< set-point follows the actual position
        enabling,       ///< asked for, drive not there yet; set-point still follows
        settling,       ///< drive enabled: set-point held through the dwell (brake, servo-on)
        on,             ///< motion is accepted
        engaging,       ///< asked off, the brake closes: drive stays enabled, set-point held
        switching_off,  ///< asked off, drive still enabled: set-point held
    };
    enum class Event : std::uint8_t { none, ready, timeout, lost, off };

    struct Input {
        bool wanted = false;
        bool aligned = false;  ///< set-point equals the actual position: needed before power is asked for
        bool online = false;
        bool mode_confirmed = false;
        bool drive_stops = false;  ///< by itself, before its power goes
        bool stands = false;
        bool away = false;     ///< taken off the machine: it has none of its power any more
        bool at_once = false;  ///< its power goes without waiting for the brake
        PowerState drive = PowerState::unknown;
        Instant now{};
    };

    /// `engage`: what a brake needs to close before the power goes; 0 = there is none that the controller works.
    PowerSequence(Duration dwell, Duration timeout, Duration engage = {}) noexcept : dwell_(dwell), timeout_(timeout), engage_(engage) {}

    Event step(const Input& in) noexcept {
        const bool enabled = in.online && in.drive == PowerState::enabled;
        quick_ = in.drive_stops && (in.drive == PowerState::enabled || (in.drive == PowerState::quick_stop && !in.stands));
        switch (phase_) {
            case Phase::off:
                // A bus that is not up yet is not the drive's delay: time runs from when the drive can be asked.
                if (!in.wanted || !in.online) waiting_ = false;
                else if (!waiting_) {
                    waiting_ = true;
                    since_ = in.now;
                }
                if (waiting_ && in.aligned) phase_ = Phase::enabling;
                return timed_out(in.now);
            case Phase::enabling:
                if (!in.wanted) return leave(Phase::switching_off, Event::none);
                if (enabled && in.mode_confirmed) {
                    phase_ = Phase::settling;
                    waiting_ = false;
                    since_ = in.now;
                    return Event::none;
                }
                return timed_out(in.now);
            case Phase::settling:
                if (!enabled) return leave(Phase::off, Event::lost);
                if (!in.wanted) return let_go(in);  // the brake may be open already
                if (in.now - since_ < dwell_) return Event::none;
                phase_ = Phase::on;
                return Event::ready;
            case Phase::on:
                if (in.online && !enabled) return leave(Phase::off, Event::lost);
                if (in.wanted) return Event::none;
                return let_go(in);
            case Phase::engaging:
                if (in.online && !enabled) return leave(Phase::off, Event::off);
                return in.at_once || in.now - since_ >= engage_ ? leave(Phase::switching_off, Event::none) : Event::none;
            case Phase::switching_off:
                if (!in.away && (enabled || !in.online)) return Event::none;  // a silent drive may still be enabled: hold its set-point
                return leave(Phase::off, Event::off);
        }
        return Event::none;
    }

    [[nodiscard]] Phase phase() const noexcept { return phase_; }
    [[nodiscard]] bool on() const noexcept { return phase_ == Phase::on; }
    /// The drive is in, or on its way into, a quick stop that was asked for: its power must not go before it stands.
    [[nodiscard]] bool quick_stops() const noexcept { return quick_; }
    /// The drive takes no set-point, so the set-point follows the actual position.
    [[nodiscard]] bool follows_actual() const noexcept { return phase_ == Phase::off || phase_ == Phase::enabling; }
    [[nodiscard]] PowerRequest request() const noexcept {
        if (quick_) return PowerRequest::quick_stop;
        return phase_ == Phase::off || phase_ == Phase::switching_off ? PowerRequest::off : PowerRequest::on;
    }

private:
    Event leave(Phase to, Event event) noexcept {
        phase_ = to;
        waiting_ = false;
        return event;
    }
    Event let_go(const Input& in) noexcept {
        since_ = in.now;
        return leave(engage_ > Duration::zero() && !in.at_once ? Phase::engaging : Phase::switching_off, Event::none);
    }
    Event timed_out(Instant now) noexcept {
        if (!waiting_ || now - since_ < timeout_) return Event::none;
        return leave(Phase::off, Event::timeout);
    }

    Duration dwell_, timeout_, engage_;
    Phase phase_ = Phase::off;
    bool waiting_ = false;
    bool quick_ = false;
    Instant since_{};
};

}  // namespace taktwerk::axes
