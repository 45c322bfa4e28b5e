#pragma once
// Each quirk with the name that drive files choose it by and the line that people read about it.

#include <string_view>

#include "axes/port/drive_profile.hpp"

namespace taktwerk::axes {

struct QuirkInfo {
    Quirk quirk{};
    std::string_view name;  ///< in `quirks:` of a drive file
    std::string_view doc;   ///< what the drive does otherwise than CiA 402
};

/// One row an enumerator, in any order. A page says so where one is missing.
inline constexpr QuirkInfo quirk_table[] = {
    {Quirk::fault_low_nibble_f, "fault_low_nibble_f", "Fault reads x0xx1111 like Fault Reaction Active: bit 3 alone decides"},
    {Quirk::fault_reset_needs_disable, "fault_reset_needs_disable", "the enable is dropped before the reset edge, else nothing is reset"},
    {Quirk::limit_stop_is_warning, "limit_stop_is_warning", "overtravel stops with position lock and a warning, Operation enabled remains"},
    {Quirk::no_remote_bit, "no_remote_bit", "statusword bit 9 (remote) means nothing"},
    {Quirk::no_internal_limit_bit, "no_internal_limit_bit", "statusword bit 11 (internal limit) means nothing"},
    {Quirk::csp_bits_12_13_reserved, "csp_bits_12_13_reserved",
     "no \"follows\" and \"following error\" bits in the cyclic modes: the axis computes the following error"},
    {Quirk::disable_may_coast, "disable_may_coast", "Shutdown and Disable voltage may take the power at once: the axis stops before"},
    {Quirk::probe_toggle_bits, "probe_toggle_bits", "60B9h bits 6, 7, 14 and 15 change with each latch in continuous mode"},
    {Quirk::homing_limit_is_fault, "homing_limit_is_fault", "a limit switch that homing does not look for is a fault, not only bit 13"},
    {Quirk::homing_19_starts_negative, "homing_19_starts_negative",
     "homing method 19 sets out in negative direction from beside the switch, as 21 of CiA 402"},
    {Quirk::fault_reaction_02b6, "fault_reaction_02b6", "Fault Reaction shows as 02B6h, without bit 3 and like no state"},
    {Quirk::alarm_sets_warning_bit, "alarm_sets_warning_bit", "bit 7 stands with every alarm, faults among them"},
    {Quirk::remote_bit_from_preop, "remote_bit_from_preop", "bit 9 stands from PREOP on, not only in OP"},
    {Quirk::quick_stop_bit_rests_high, "quick_stop_bit_rests_high", "bit 5 stands in Switch On Disabled and in the fault states too"},
    {Quirk::cyclic_bit_10_reserved, "cyclic_bit_10_reserved", "no \"target reached\" in the cyclic modes"},
    {Quirk::pp_bit_5_blends, "pp_bit_5_blends", "control word bit 5 in PP: go on to the next set-point at full speed, not at once"},
    {Quirk::pp_shared_ramp, "pp_shared_ramp", "in PP 6083h is the deceleration too, 6084h is not used"},
    {Quirk::pp_stop_forgets, "pp_stop_forgets", "after a halt or quick stop in PP nothing goes on: the set-points are gone"},
    {Quirk::csv_ramps, "csv_ramps", "CSV applies 6083h and 6084h on top of the master's profile"},
    {Quirk::pv_bits_12_13_reserved, "pv_bits_12_13_reserved", "no \"speed zero\" bit in PV"},
    {Quirk::velocity_window_in_rpm, "velocity_window_in_rpm", "606Dh is in r/min"},
    {Quirk::clock_bit_8, "clock_bit_8", "statusword bit 8: the drive's clock follows SYNC0"},
    {Quirk::standstill_bit_14, "standstill_bit_14", "statusword bit 14: the motor stands"},
    {Quirk::limit_stop_is_fault, "limit_stop_is_fault", "overtravel in a position mode is a fault"},
    {Quirk::torque_offset_not_in_torque, "torque_offset_not_in_torque", "60B2h counts in all modes but those of torque"},
    {Quirk::ramp_before_mode_change, "ramp_before_mode_change",
     "out of CSV, CST, PV and PT in motion it stops along its ramp (6084h) before it changes the mode"},
};

[[nodiscard]] constexpr const QuirkInfo* find_quirk(Quirk quirk) noexcept {
    for (const auto& row : quirk_table)
        if (row.quirk == quirk) return &row;
    return nullptr;
}

}  // namespace taktwerk::axes
