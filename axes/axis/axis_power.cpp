#include "axes/axis/axis_power.hpp"

#include <algorithm>
#include <cmath>

#include "axes/axis/aim.hpp"
#include "axes/axis/conduct.hpp"

namespace taktwerk::axes {

namespace {

// A way that takes longer than this at the axis' velocity, s, is a long one; all but a third of it is covered in the other.
constexpr double long_way = 1, long_way_time = 0.1;
// Of the axis' velocity: whoever follows it as a master takes twice of it for another zero.
constexpr double followed_by_slaves = 1.9;

}  // namespace

bool AxisPower::wanted() const noexcept {
    using Phase = PowerSequence::Phase;
    if (!body_.driven) return false;
    if (body_.state == AxisState::Disabled)
        return body_.power_wish && connected(body_.presence) && !conduct_.power_dropping() && body_.emergency == EmergencyStop::none;
    if (body_.state != AxisState::ErrorStop) return true;  // these states end in Disabled before power goes
    const bool drive_on = body_.power.phase() == Phase::on || body_.power.phase() == Phase::settling;
    // A slow line stops the motor later than the set-point.
    const bool still_slows_down = body_.slow_line && measured_.online() && !measured_.stands();
    return drive_on && body_.emergency != EmergencyStop::power_off_now && !conduct_.off_at_once() &&
           (conduct_.moves() || still_slows_down || (body_.power_wish && !conduct_.off_after_error()));
}

bool AxisPower::run() noexcept {
    const auto event = body_.power.step({.wanted = wanted(),
                                         .aligned = aligned_,
                                         .online = measured_.online(),
                                         .mode_confirmed = measured_.feedback.mode == modes_.wanted() || runs_.drive.busy(),
                                         .drive_stops = conduct_.drive_stops() && body_.emergency != EmergencyStop::power_off_now,
                                         .stands = measured_.stands(),
                                         .away = !connected(body_.presence),
                                         .at_once = body_.emergency == EmergencyStop::power_off_now || conduct_.off_at_once(),
                                         .drive = measured_.feedback.power,
                                         .now = body_.now});
    if (body_.power.phase() == PowerSequence::Phase::off) conduct_.power_is_off();
    switch (event) {
        case PowerSequence::Event::ready:
            conduct_.fire(AxisEvent::powered);
            return body_.queue.waiting() > 0;  // table 4: Status lets begin what is buffered behind MC_Power
        case PowerSequence::Event::timeout:
            if (turns_by_itself())
                conduct_.fail(AxisAlarm::motor_turns, body_.shown.actual_velocity, turning_by_itself * body_.config.limits.velocity);
            else if (measured_.feedback.power == PowerState::switched_on && measured_.feedback.mode != modes_.wanted())
                conduct_.fail(AxisAlarm::drive_mode_mismatch, static_cast<double>(measured_.feedback.mode),
                              static_cast<double>(modes_.wanted()));
            else if (body_.port.alarm().found == PortFault::not_ready)
                conduct_.fail(AxisAlarm::drive_not_ready, to_seconds(body_.config.patience.enable));
            else
                conduct_.fail(AxisAlarm::enable_timeout, to_seconds(body_.config.patience.enable),
                              static_cast<double>(measured_.feedback.power));
            break;
        case PowerSequence::Event::lost:
            runs_.abort();
            // A fault has its own alarm, also between two samples of a drive that is polled; in ErrorStop the power may go for reasons already
            // announced.
            if (body_.state == AxisState::ErrorStop) break;
            if (measured_.faulted()) conduct_.fail(AxisAlarm::drive_fault, measured_.feedback.error_code, body_.port.alarm().detail);
            else conduct_.fail(AxisAlarm::drive_power_lost, static_cast<double>(measured_.feedback.power));
            break;
        case PowerSequence::Event::none:
        case PowerSequence::Event::off: break;
    }
    return false;
}

/// Power would hold it with a jolt: it is asked for when the motor is slow, or not at all.
bool AxisPower::turns_by_itself() const noexcept {
    // What counts as standstill is none, however slow the axis is: the velocity of a drive at rest is seldom 0.
    return !runs_.drive.busy() && !measured_.stands() &&
           std::abs(body_.shown.actual_velocity) > turning_by_itself * body_.config.limits.velocity;
}

void AxisPower::follow_actual(Duration period) noexcept {
    if (!measured_.online()) {
        aligned_ = false;
        return;
    }
    // Not faster than the axis may be or its motor turns, so that no trace shows a jump where a drive falls with a following error. But who
    // turned a motor without power by hand, very fast and far, does not wait for it: power is asked for when the set-point has come.
    const double way = measured_.local() - motion_.setpoint.state().position;
    const double limit = body_.config.limits.velocity, turns = std::abs(body_.shown.actual_velocity);
    const double velocity = std::clamp(turns, limit, followed_by_slaves * limit);
    const bool far = std::abs(way) > velocity * long_way;
    const double most = (far ? std::abs(way) / long_way_time : velocity) * to_seconds(period);
    const bool here = runs_.drive.busy() || std::abs(way) <= most;
    aligned_ = here && !turns_by_itself();
    motion_.setpoint.place(here ? measured_.local() : motion_.setpoint.state().position + std::copysign(most, way));
    if (body_.endless && body_.units.far_from_anchor(measured_.local())) aim_.reanchor();  // an encoder turns for years
    if (!body_.power.follows_actual()) return;
    modes_.end_profile();
    modes_.torque_idle = modes_.waits = false;
    motion_.goal = {};
    motion_.goal_pending = body_.begin_pending = motion_.held = false;
}

bool AxisPower::goes_with(AlarmId reason) noexcept {
    const bool powered = body_.driven && (body_.state != AxisState::Disabled || body_.power_wish) &&
                         (body_.state != AxisState::ErrorStop || body_.error == id(AxisAlarm::axis_feedback_lost));
    if (powered) (void)conduct_.stop_for_error(reason, true);
    body_.power_wish = false;
    if (body_.state == AxisState::Disabled) body_.queue.finish_waiting(Outcome::aborted);
    return powered;
}

void AxisPower::give_up() noexcept { conduct_.shut_down(); }

}  // namespace taktwerk::axes
