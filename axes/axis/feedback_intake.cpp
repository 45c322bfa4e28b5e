#include "axes/axis/feedback_intake.hpp"

#include <cmath>

#include "axes/axis/aim.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/retained_coordinates.hpp"

namespace taktwerk::axes {

bool FeedbackIntake::read(const DriveFeedback& from_drive) noexcept {
    bool placed = false;
    measured_.feedback = from_drive;
    if (!measured_.feedback.online && !measured_.absolute_encoder()) body_.homed = false;  // it may come back with another zero
    if (measured_.feedback.reference_epoch != measured_.reference_epoch) retained_.lose_reference();
    measured_.reference_epoch = measured_.feedback.reference_epoch;
    if (!measured_.feedback.fresh) {
        if (measured_.stale < 0xFFFFFFFF) ++measured_.stale;
        return placed;
    }
    measured_.stale = 0;
    measured_.counts = measured_.feedback.position;
    // A drive that was away may count from another zero: the set-point of a drive without power goes there at once.
    // (One that was enabled when it went has to be seen without power first; its own homing is followed elsewhere.)
    const bool other_zero = measured_.feedback.position_epoch != measured_.position_epoch;
    if (!measured_.seeded || (other_zero && body_.power.follows_actual()) || runs_.drive.busy())
        measured_.position_epoch = measured_.feedback.position_epoch;
    if (!measured_.seeded || (other_zero && body_.power.follows_actual() && !runs_.drive.busy())) {
        if (!measured_.seeded) retained_.apply();
        measured_.seeded = true;
        aim_.anchor_near_actual();
        motion_.setpoint.place(measured_.local());
        placed = true;
    }
    // Switches are wired to the drive's sense of direction.
    const bool inverted = body_.config.gearing.inverted;
    measured_.negative_switch =
        measured_.feedback.has_inputs && (inverted ? measured_.feedback.positive_limit : measured_.feedback.negative_limit);
    measured_.positive_switch =
        measured_.feedback.has_inputs && (inverted ? measured_.feedback.negative_limit : measured_.feedback.positive_limit);
    if (measured_.negative_switch && measured_.positive_switch) conduct_.fail(AxisAlarm::both_limit_switches);
    else body_.alarms.clear(AxisAlarm::both_limit_switches);
    return placed;
}

void FeedbackIntake::watch_encoder() noexcept {
    if (body_.port.alarm().kind == DriveAlarmKind::encoder) conduct_.fail(AxisAlarm::encoder_invalid);
    else body_.alarms.clear(AxisAlarm::encoder_invalid);
}

/// What a port found by itself has words of its own.
bool FeedbackIntake::tell_found() noexcept {
    const auto fallen = body_.port.alarm();
    switch (fallen.found) {
        case PortFault::encoder: conduct_.fail(AxisAlarm::encoder_lost, body_.shown.actual_position); return true;
        case PortFault::polarity:
            conduct_.fail(AxisAlarm::drive_polarity, fallen.detail / std::abs(body_.units.counts_per_unit()));
            return true;
        case PortFault::amplifier: conduct_.fail(AxisAlarm::amplifier_fault); return true;
        case PortFault::none:
        case PortFault::not_ready: break;
    }
    return false;
}

void FeedbackIntake::watch_drive() noexcept {
    const bool asked = body_.power.phase() != PowerSequence::Phase::off && connected(body_.presence);
    if (measured_.seeded && asked && !measured_.online())
        conduct_.fail(AxisAlarm::axis_feedback_lost, static_cast<double>(measured_.stale), static_cast<double>(measured_.stale_limit));
    if (!measured_.feedback.fresh || !measured_.online()) return;

    // The detail that tells shared codes apart is read beside the cycle and comes later (P21.08 of the SV33-E).
    const auto announce = [&](AxisAlarm alarm) {
        const auto detail = body_.port.alarm().detail;
        conduct_.fail(alarm, measured_.feedback.error_code, detail);
        if (measured_.feedback.error_code != 0) body_.alarms.renumber(alarm, measured_.feedback.error_code, detail);
    };
    if (measured_.feedback.warning) announce(AxisAlarm::drive_warning);
    else body_.alarms.clear(AxisAlarm::drive_warning);
    if (measured_.feedback.fault || measured_.feedback.warning) {
        const auto kind = body_.port.alarm().kind;
        if (kind == DriveAlarmKind::reference_lost || kind == DriveAlarmKind::turn_overflow) retained_.lose_reference();
    }

    if (measured_.faulted()) {
        // Its motor is free, or was stopped by itself: nobody counts where one without an encoder comes to rest (SE-808X 2.4, 4.3: 605Eh = 0).
        if (!body_.port.capabilities().motor_has_encoder) body_.homed = false;
        if (!tell_found()) announce(AxisAlarm::drive_fault);
    } else if (asked && measured_.feedback.setup_refused) conduct_.fail(AxisAlarm::drive_setup_refused);
    else if (asked && measured_.feedback.power == PowerState::unknown)
        conduct_.fail(AxisAlarm::drive_unknown_state, measured_.feedback.status_word);
    else if (body_.power.on() && !runs_.drive.busy() && !modes_.changes() && measured_.feedback.mode != modes_.wanted())
        conduct_.fail(AxisAlarm::drive_mode_mismatch, static_cast<double>(measured_.feedback.mode), static_cast<double>(modes_.wanted()));
}

}  // namespace taktwerk::axes
