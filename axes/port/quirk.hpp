#pragma once
// The deviations from CiA 402 that some drives have: each with its source, the name that drive files choose it by, and the line that people
// read about it. A new one is added here and nowhere else; the driver, the simulated drive or both ask `DriveProfile::has`.

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace taktwerk::axes {

/// A deviation from CiA 402, chosen by name in YAML; each has a doc line here, code behind it and a test.
enum class Quirk : std::uint8_t {
    fault_low_nibble_f,         ///< Fault reads x0xx1111 like Fault Reaction (SE-808X 3.2.2.2): bit 3 alone decides
    fault_reset_needs_disable,  ///< drop enable before the reset edge (SV33-E 5.1)
    limit_stop_is_warning,      ///< overtravel stops with position lock while Operation enabled (SV33-E A.220/A.221)
    no_remote_bit,              ///< statusword bit 9 is unsupported (SE-808X 3.2.2.2)
    no_internal_limit_bit,      ///< statusword bit 11 is unsupported (SE-808X 3.2.2.2)
    csp_bits_12_13_reserved,    ///< no "following" and "following error" bits in CSP (SE-808X 3.2.6)
    disable_may_coast,          ///< Shutdown / Disable voltage may cut power at once: ramp to zero before (SV33-E 3.4.1)
    probe_toggle_bits,          ///< 60B9h bits 6, 7, 14, 15 change with each latch in continuous mode (SV-DA200 3.8.3)
    homing_limit_is_fault,      ///< a limit switch that homing does not look for is a fault (SV-DA200 Er25-6), not only bit 13
    homing_19_starts_negative,  ///< method 19 sets out in negative direction from beside the switch (SV-DA200 3.4.6, the table), as 21 of CiA 402
    fault_reaction_02b6,        ///< Fault Reaction shows as 02B6h, without bit 3 and like no state (TSVM 5.3.1, transition 13)
    alarm_sets_warning_bit,       ///< bit 7 stands with every alarm, faults among them (TSVM 5.3.2)
    remote_bit_from_preop,        ///< bit 9 stands from PREOP on, not only in OP (TSVM 5.3.2)
    quick_stop_bit_rests_high,    ///< bit 5 stands in Switch On Disabled and in the fault states too (TSVM 5.3.1: 0270h, 02B6h)
    cyclic_bit_10_reserved,       ///< no "target reached" in the cyclic modes (TSVM 5.3.2: 1237h)
    pp_bit_5_blends,              ///< control word bit 5 in PP: go on to the next set-point at full speed, not at once (SE-808X 3.2.4)
    pp_shared_ramp,               ///< in PP 6083h is the deceleration too, 6084h is not used (SV-DA200 3.2.3)
    pp_stop_forgets,              ///< after a halt or quick stop in PP nothing goes on: the set-points are gone (SV-DA200 3.2.7)
    csv_ramps,                    ///< CSV applies 6083h and 6084h on top of the master's profile (SV-DA200 3.6)
    pv_bits_12_13_reserved,       ///< no "speed zero" bit in PV (SE-808X 3.2.2.2, SV33-E 3.4.3(7))
    velocity_window_in_rpm,       ///< 606Dh is in r/min (SV33-E 7.3)
    clock_bit_8,                  ///< statusword bit 8: the drive's clock follows SYNC0 (SV-DA200 3.1.2)
    standstill_bit_14,            ///< statusword bit 14: the motor stands (SV-DA200 3.1.2)
    limit_stop_is_fault,          ///< overtravel in a position mode is a fault (SV-DA200 5.3, Er21)
    torque_offset_not_in_torque,  ///< 60B2h counts in all modes but those of torque (SV-DA200 4.10)
    ramp_before_mode_change,      ///< out of CSV, CST, PV and PT it stops along 6084h first (SV33-E 3.4.3 (3), (4), (7), (8))
};
inline constexpr std::size_t quirk_count = 26;

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
