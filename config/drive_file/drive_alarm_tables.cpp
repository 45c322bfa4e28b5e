#include "config/drive_file/drive_alarm_tables.hpp"

#include <limits>

#include "config/drive_file/drive_motion_tables.hpp"
#include "config/drive_file/setting_tables.hpp"
#include "config/reading/codecs.hpp"

namespace taktwerk::config {

using axes::DriveAlarmText;

namespace {

Codec<axes::DriveAlarmKind> alarm_kind() {
    using K = axes::DriveAlarmKind;
    return choice<K>({{"other", K::other},
                      {"overspeed", K::overspeed},
                      {"following_error", K::following_error},
                      {"setpoint_leap", K::setpoint_leap},
                      {"undervoltage", K::undervoltage},
                      {"overload", K::overload},
                      {"encoder", K::encoder},
                      {"communication", K::communication},
                      {"sync_lost", K::sync_lost},
                      {"negative_limit", K::negative_limit},
                      {"positive_limit", K::positive_limit},
                      {"emergency_stop", K::emergency_stop},
                      {"battery_low", K::battery_low},
                      {"reference_lost", K::reference_lost},
                      {"turn_overflow", K::turn_overflow},
                      {"homing_timeout", K::homing_timeout},
                      {"homing_limit", K::homing_limit},
                      {"homing_method", K::homing_method},
                      {"power_cycle_pending", K::power_cycle_pending},
                      {"mode_not_set", K::mode_not_set},
                      {"mode_change", K::mode_change},
                      {"left_operational", K::left_operational},
                      {"link_changed", K::link_changed},
                      {"torque_overload", K::torque_overload},
                      {"parameter_storage", K::parameter_storage},
                      {"cycle_setting", K::cycle_setting},
                      {"limits_crossed", K::limits_crossed},
                      {"home_outside_limits", K::home_outside_limits},
                      {"start_too_fast", K::start_too_fast},
                      {"enabled_twice", K::enabled_twice},
                      {"phase_lost", K::phase_lost},
                      {"phase_warning", K::phase_warning},
                      {"safe_torque_off", K::safe_torque_off},
                      {"stall", K::stall},
                      {"overvoltage", K::overvoltage}});
}

}  // namespace

Table<DriveAlarmText> alarm_row_table() {
    using A = DriveAlarmText;
    return {"alarms",
            "One alarm of the drive.",
            {
                required(field("code", &A::code, integer<std::uint16_t>(1, u16), "603Fh")),
                with_default(field("detail", &A::detail, integer<std::uint32_t>(0, u32), "value of the detail object"), "the code alone"),
                field("panel", &A::panel, text(), "what the drive's own display shows"),
                required(field("english", &A::english, text(), "its name in English")),
                required(field("chinese", &A::chinese, text(), "its name in Chinese, as the manual prints it")),
                field("cause", &A::cause, text(), "why it comes"),
                field("remedy", &A::remedy, text(), "what to do"),
                field("resettable", &A::resettable, boolean(), "false: only a power cycle clears it"),
                field("clears_itself", &A::clears_itself, boolean(), "with its cause, without a reset"),
                field("warning", &A::warning, boolean(), "the drive goes on"),
                field("whole_drive", &A::whole_drive, boolean(), "common to all axes of the drive"),
                field("kind", &A::kind, alarm_kind(), "what it means, whatever its number"),
                field("section", &A::section, text(), "of the manual"),
            },
            {},
            {}};
}

Table<axes::AlarmHistoryObjects> alarm_history_table() {
    using H = axes::AlarmHistoryObjects;
    return {"alarm_history",
            "Where the drive shows its earlier alarms.",
            {
                required(field("select", &H::select, parameter_address(), "0 the present alarm, 1 the latest before it, and so on")),
                required(field("code", &H::code, parameter_address(), "as the object of `alarm_detail` shows it")),
                field("time", &H::time, parameter_address(), "since power-on, 0.1 s"),
                field("speed", &H::speed, parameter_address(), "of the motor at that time, rpm"),
            },
            {},
            {}};
}

Table<axes::DriveHazard> hazard_table() {
    using H = axes::DriveHazard;
    using C = axes::HazardCondition;
    return {"hazards",
            "What is dangerous about the drive in a machine that forgot something; `taktwerk check` warns of it.",
            {
                required(field("when", &H::when,
                               choice<C>({{"always", C::always},
                                          {"not_written", C::not_written},
                                          {"not_set_to", C::not_set_to},
                                          {"set_to", C::set_to},
                                          {"mapped", C::mapped},
                                          {"not_mapped", C::not_mapped},
                                          {"mode_mapped", C::mode_mapped},
                                          {"homed_by_drive", C::homed_by_drive},
                                          {"no_software_limits", C::no_software_limits},
                                          {"absolute_homing", C::absolute_homing}}),
                               "what makes it a hazard of this machine (axes/port/drive_hazard.hpp)")),
                field("objects", &H::objects, list(parameter_address()), "that the condition looks at"),
                field("values", &H::values,
                      list(integer<std::int64_t>(std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max())),
                      "that the condition compares with"),
                field("mode", &H::mode, drive_mode(), "that the condition looks at"),
                required(field("text", &H::text, text(), "what happens, in one sentence")),
                field("remedy", &H::remedy, text(), "what to write or wire"),
                required(field("section", &H::section, text(), "of the manual")),
            },
            {},
            {}};
}

}  // namespace taktwerk::config
