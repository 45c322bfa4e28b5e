#include "axes/axis/axis_reset.hpp"

#include <chrono>

#include "axes/axis/conduct.hpp"

namespace taktwerk::axes {

namespace {

using namespace std::chrono_literals;

constexpr Duration reset_patience = 2s;  // a drive that still reports its fault after this long will not be reset

}  // namespace

ErrorId AxisReset::request() noexcept {
    if (body_.state != AxisState::ErrorStop) return ErrorId::none;
    if (body_.emergency != EmergencyStop::none) return ErrorId::interlocked;
    if (!resetting_) since_ = body_.now;
    resetting_ = true;
    conduct_.reset_error(ErrorId::none);
    return ErrorId::none;
}

void AxisReset::run() noexcept {
    if (body_.state != AxisState::ErrorStop) {
        resetting_ = false;
        return;
    }
    // A polled drive that was away still carries out what comes first, mostly being disabled: the fault it may have is not known before.
    const bool under_way = measured_.online() && !measured_.feedback.commands_acknowledged;
    if (under_way || conduct_.moves() || body_.power.quick_stops()) since_ = body_.now;  // a ramp is no cause, however long it is
    // What a drive said that is away counts no more: its axis waits for it Disabled.
    const bool of_the_drive = !measured_.online() || under_way || measured_.faulted() || measured_.feedback.setup_refused;
    const bool cause_present =
        (of_the_drive && connected(body_.presence)) || body_.power.quick_stops() || body_.emergency != EmergencyStop::none;
    const bool still_turns = body_.slow_line && body_.power.on() && !measured_.stands();  // it stops later than the set-point
    if (!conduct_.moves() && !cause_present && !still_turns) {
        if (body_.power.on() && body_.power_wish && !conduct_.off_after_error()) {
            end(AxisEvent::reset_powered);
            return;
        }
        if (body_.power.phase() == PowerSequence::Phase::off) {
            end(AxisEvent::reset_unpowered);
            return;
        }
        // Power is on its way off (note 3 or 4 holds when it is there).
    }
    const bool hopeless =
        connected(body_.presence) && measured_.faulted() && !body_.port.alarm().resettable;  // the drive says: power cycle
    if (hopeless || body_.now - since_ >= reset_patience) {
        resetting_ = false;
        conduct_.reset_error(ErrorId::reset_failed);
    }
}

void AxisReset::end(AxisEvent event) noexcept {
    resetting_ = false;
    conduct_.reset_error(ErrorId::none);
    body_.error = 0;
    conduct_.error_is_over();
    motion_.goal = {};
    motion_.goal_pending = false;                                    // the stop out of a mode of the drive's own, which had not begun
    if (body_.slow_line) motion_.setpoint.place(measured_.local());  // where it was stopped: it holds no place of ours
    body_.alarms.clear_all_but(AxisAlarm::drive_warning);
    conduct_.fire(event);
}

}  // namespace taktwerk::axes
