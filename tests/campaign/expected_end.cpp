#include "tests/campaign/expected_end.hpp"

#include <fmt/format.h>

#include "ecat/alarms.hpp"

namespace taktwerk::campaign {

namespace {

using ecat::BusAlarm;
using Axes = ExpectedEnd::Axes;

constexpr bool in_bring_up(Phase phase) noexcept { return phase <= Phase::safeop; }

/// The bring-up. A register access is repeated three times within some 60 ms; from SAFEOP on the SM watchdogs of 10 ms run, and
/// a slave that falls back while OP is asked for ends the bring-up. Who loses its power or its address after the scan is missed.
ExpectedEnd of_bring_up(FaultKind kind, Phase phase) {
    ExpectedEnd survives{};
    ExpectedEnd either;
    either.failed = true;
    ExpectedEnd fails_for_good;  // or it was found out only in OP
    fails_for_good.failed = fails_for_good.degraded = true;
    fails_for_good.operational = false;
    const bool watchdogs_run = phase == Phase::safeop;
    switch (kind) {
        case FaultKind::frames_lost:
        case FaultKind::answers_late:
        case FaultKind::answers_twice:
        case FaultKind::answers_reordered:
        case FaultKind::foreign_frames: return survives;
        case FaultKind::answers_late_long:  // requests arrive: no watchdog runs out
        case FaultKind::counter_too_small:  // five good cycles in a row are waited for
        case FaultKind::counter_too_large:
        case FaultKind::reference_frozen: return survives;
        case FaultKind::frames_lost_long:
        case FaultKind::stall_20ms: return watchdogs_run ? either : survives;
        case FaultKind::mailbox_dead: {
            // Between the last start-up SDO and OP nothing is asked of the mailbox; in OP the watch notices.
            ExpectedEnd end = fails_for_good;
            end.operational = true;
            return end;
        }
        case FaultKind::power_gone:
        case FaultKind::cable_gone: return fails_for_good;
        case FaultKind::other_device: return fails_for_good;
        default: return either;
    }
}

ExpectedEnd of_operation(FaultKind kind) {
    const auto runs_on = [](std::vector<AlarmId> announced = {}) {
        ExpectedEnd end;
        end.axes = Axes::run_on;
        end.announced = std::move(announced);
        return end;
    };
    const auto stops = [](std::vector<AlarmId> announced) {
        ExpectedEnd end;
        end.axes = Axes::stop;
        end.announced = std::move(announced);
        return end;
    };
    const auto stops_for_good = [&](std::vector<AlarmId> announced) {
        ExpectedEnd end = stops(std::move(announced));
        end.operational = false;
        end.degraded = true;
        return end;
    };
    const std::vector<AlarmId> gone{id(BusAlarm::slave_lost), id(BusAlarm::cable_broken), id(BusAlarm::frames_lost)};
    switch (kind) {
        // Up to two cycles in a row without an answer are counted and nothing else (lost_frames_limit 3).
        case FaultKind::frames_lost:
        case FaultKind::answers_late:
        case FaultKind::answers_twice:
        case FaultKind::answers_reordered: return runs_on();
        case FaultKind::frames_lost_long:
        case FaultKind::answers_late_long: return stops({id(BusAlarm::frames_lost)});
        case FaultKind::counter_too_small:
        case FaultKind::counter_too_large: return stops({id(BusAlarm::working_counter_wrong)});
        case FaultKind::state_refused: return runs_on();  // nobody changes a state
        case FaultKind::power_cycled:
        case FaultKind::power_cycled_twice:
        case FaultKind::cable_pulled: return stops(gone);
        case FaultKind::power_gone:
        case FaultKind::cable_gone: return stops_for_good(gone);
        case FaultKind::other_device: return stops_for_good({id(BusAlarm::other_device)});
        case FaultKind::link_down: return stops({id(BusAlarm::link_down)});
        case FaultKind::foreign_frames: return runs_on({id(BusAlarm::foreign_master)});
        case FaultKind::address_changed: return runs_on({id(BusAlarm::station_address_lost)});
        case FaultKind::state_changed: return stops({id(BusAlarm::foreign_command)});
        case FaultKind::settings_changed: return stops({id(BusAlarm::working_counter_wrong)});
        case FaultKind::mailbox_stuck: return runs_on();
        case FaultKind::mailbox_dead: {
            ExpectedEnd end = runs_on({id(BusAlarm::mailbox_silent)});
            end.operational = false;
            end.degraded = true;
            return end;
        }
        case FaultKind::reference_frozen: return runs_on({id(BusAlarm::reference_clock_lost)});
        case FaultKind::stall_20ms:
        case FaultKind::stall_200ms:
        case FaultKind::stall_2s: return stops({id(BusAlarm::starved_slave_left_op)});
        // A wrong input may be an emergency stop or a following error; a wrong register may be anything of a slave. Nobody can see
        // a flipped bit in a target behind a valid checksum: there the drive's own supervision of increments is what remains.
        case FaultKind::answer_bits_flipped: {
            ExpectedEnd end;
            end.axes = Axes::may_stop;
            return end;
        }
        case FaultKind::request_bits_flipped: {
            ExpectedEnd end;
            end.axes = Axes::may_stop;
            end.drives_may_see_a_jump = true;
            return end;
        }
    }
    return {};
}

}  // namespace

ExpectedEnd expected_end(FaultKind kind, Phase phase) {
    if (phase == Phase::stopping) {
        ExpectedEnd end;
        end.operational = false;
        end.stopped = true;
        return end;
    }
    return in_bring_up(phase) ? of_bring_up(kind, phase) : of_operation(kind);
}

std::string text(const ExpectedEnd& end) {
    std::string out;
    const auto add = [&](std::string_view word, std::string_view separator) {
        if (!out.empty()) out += separator;
        out += word;
    };
    if (end.operational) add("operational", " or ");
    if (end.degraded) add("operational without it", " or ");
    if (end.failed) add("failed", " or ");
    if (end.stopped) add("stopped", " or ");
    if (end.axes == Axes::run_on) add("axes run on", "; ");
    if (end.axes == Axes::may_stop) add("axes may stop", "; ");
    if (end.axes == Axes::stop) add("axes stop", "; ");
    std::string alarms;
    for (const AlarmId id : end.announced) alarms += (alarms.empty() ? "" : " or ") + std::string{find_alarm(ecat::bus_alarms, id)->name};
    if (!alarms.empty()) add(alarms, "; ");
    if (end.drives_may_see_a_jump) add("a drive may see a jump", "; ");
    return out;
}

}  // namespace taktwerk::campaign
