#pragma once
// What a drive type means to an axis: modes, homing, units, timing, quirks, alarms. Filled from a drive YAML by config/.
// The bus half of the same YAML is ecat::DeviceDescription. Plain data.

#include <cstdint>
#include <string>
#include <vector>

#include "axes/port/drive_alarm_kind.hpp"
#include "axes/port/drive_hazard.hpp"
#include "axes/port/drive_parameter.hpp"
#include "axes/port/drive_port.hpp"
#include "axes/port/drive_setting.hpp"
#include "axes/port/drive_stop.hpp"
#include "core/time.hpp"

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

/// What a drive does that gets a change of mode which its manual forbids.
enum class ModeViolation : std::uint8_t {
    obeyed,   ///< it changes all the same
    ignored,  ///< the old mode stays (TSVM 5.4.1: "may not switch")
    alarm,    ///< a fault of the kind mode_change (TSVM 5.4.1: "or may raise an abnormality")
};

struct DriveAlarmText {
    std::uint16_t code = 0;    ///< 603Fh
    std::uint32_t detail = 0;  ///< value of the further object that tells apart; 0 = code alone
    std::string panel;         ///< what the drive's own display shows: "E.200.0"
    std::string english, chinese, cause, remedy;
    bool resettable = true;
    bool clears_itself = false;  ///< with its cause, without a reset (SV33-E E.218), as all warnings do
    bool warning = false;
    bool whole_drive = false;  ///< common to all axes of the drive (TSVM 603Fh 71..96)
    DriveAlarmKind kind = DriveAlarmKind::other;
    std::string section;  ///< of the manual
};

/// What a drive does when a certain value is written to one of its parameters.
enum class DriveOrder : std::uint8_t {
    emergency_stop,      ///< as its input does, until another value is written (SV33-E P20.02)
    reset_alarm,         ///< (SV33-E P20.03)
    save_parameters,     ///< (SE-808X 1010h:01 = 65766173h)
    restore_parameters,  ///< factory values, from the next power-on (SV33-E P05.01, SE-808X 1011h:01 = 64616F6Ch)
};
struct DriveOrderObject {
    DriveOrder order{};
    ParameterAddress address{};
    std::int64_t value = 1;
};

/// Where a drive shows its earlier alarms: `select` chooses one, the others show it. Index 0: it does not.
struct AlarmHistoryObjects {
    ParameterAddress select{}, code{}, time{}, speed{};
};

/// How parameters get into the EEPROM.
enum class ParameterStorage : std::uint8_t {
    not_stated,
    each_write,  ///< every write wears it, unless `storage_switch` says otherwise (SV33-E P05.10)
    on_request,  ///< by DriveService::save_parameters (SE-808X 1010h, XP200 function 41h)
    never,       ///< writes are lost at power off: the maker's own tool stores (TSVM)
};

struct DriveProfile {
    std::string name;           ///< "sv33-e"
    std::string vendor, title;  ///< for people
    std::vector<DriveMode> modes;
    std::vector<std::int8_t> homing_methods;  ///< 6098h values the drive documents
    double velocity_counts_per_unit = 1.0;    ///< 606Ch/60FFh raw = counts/s * this
    double torque_rated_raw = 1000.0;         ///< 6077h/6071h raw value of rated torque
    std::uint8_t position_bits = 32;
    std::uint8_t probes = 0;
    bool motor_has_encoder = true;
    Duration minimum_cycle_csp{}, minimum_cycle_csv{}, minimum_cycle_cst{};  ///< 0: not stated
    Duration enable_delay{}, mode_change_delay{}, enable_timeout = std::chrono::seconds{2};
    bool mode_change_at_standstill = false;
    Duration mode_change_interval{};                       ///< least time between two changes of 6060h (TSVM 5.4.1: 20 ms)
    Duration mode_indeterminate{};                         ///< 6061h means nothing this long after a change of 6060h (TSVM 5.4.1: 2 ms)
    ModeViolation mode_violation = ModeViolation::obeyed;  ///< sooner than `mode_change_interval`, or in motion
    std::uint8_t profile_buffer = 1;                       ///< set-points that PP takes behind the running one (SV33-E 1, SV-DA200 8)
    std::uint16_t enable_status_bits =
        0;  ///< of 6041h, all set before Enable Operation (SV-DA200 3.1.2: bit 8 DC locked, bit 4 main power)
    // What the drive does by itself; the simulator plays it, the axis plans with it.
    Duration brake_release{};                ///< after enabling the brake still holds: earlier commands are lost (SV33-E P05.13)
    Duration brake_hold{};                   ///< after disabling at standstill the motor holds until the brake does (SV33-E P05.14)
    Duration brake_moving_wait{};            ///< power gone in motion: the brake closes after this at the latest (TSVM PA48)
    double brake_moving_speed = 0;           ///< rpm: it closes as soon as the motor is slower (TSVM PA49); 0: at standstill
    Duration self_test{};                    ///< Not Ready To Switch On lasts this long after power-on
    Duration deaf_after_enable{};            ///< set-points are not obeyed this long after enabling (TSVM 5.3.1: 100 ms)
    std::uint8_t missed_frames_allowed = 0;  ///< in a row in OP; one more is its communication alarm (TSVM 7.1.1: 3); 0: not counted
    double overspeed_limit = 0;              ///< of the motor's maximum speed, beyond it an alarm (TSVM PA23: 1.0); 0: none
    double torque_overload = 0;              ///< rated torques; for longer than `torque_overload_time` an alarm (TSVM PA30, PA31); 0: none
    Duration torque_overload_time{};
    DriveStop off_stop = DriveStop::coast;   ///< power taken away while it moves (SV33-E P04.12 = 2: ramp)
    DriveStop fault_stop = DriveStop::ramp;  ///< fault reaction (SE-808X 605Eh = 0: coast)
    bool quick_stop_leaves = true;           ///< Quick Stop Active ends by itself in Switch On Disabled (SE-808X 3.2.1: it stays)
    std::vector<StopOption> stops;           ///< options that the manual documents; they go before the three above
    ParameterAddress
        emergency_torque{};        ///< object with the torque of StopBy::emergency_torque, per `torque_rated_raw`; index 0: all there is
    bool csp_interpolates = true;  ///< reaches a CSP target one cycle after the SYNC0 that brought it
    std::uint16_t object_offset = 0x0800, pdo_offset = 0x40;  ///< per further axis of a multi-axis drive
    std::uint8_t axes = 1;
    std::uint8_t input_bit_negative_limit = 0, input_bit_positive_limit = 1, input_bit_home = 2;  ///< in 60FDh
    ParameterAddress homing_timeout{};                       ///< object that bounds the drive's own homing (SV33-E P13.49); index 0: none
    Duration homing_timeout_unit = std::chrono::seconds{1};  ///< of that object (SV33-E: 10 ms)
    std::uint8_t encoder_turn_bits = 0;  ///< width of an absolute encoder's turn counter (SV33-E 3.1.4: 16); 0: not stated
    // How the encoder is told to forget its turns (DriveService::clear_multi_turn): one of the two; neither: the drive cannot.
    ParameterAddress clear_turns{};      ///< object that is written (SV33-E P20.05)
    std::int64_t clear_turns_value = 0;  ///< ... with this value (SV33-E: 2)
    ParameterAddress encoder_reset{};    ///< object: 1 ends its fault and its turns, seen at the next power-on (TSVM PA80); index 0: none
    double battery_low = 0, battery_empty = 0;  ///< V of its battery: warned of below the one, turns lost below the other; 0: not stated
    std::uint16_t clear_turns_control = 0;      ///< bit of 6040h that is set for a while (TSVM 5.3.2: bit 12)
    std::vector<Quirk> quirks;
    std::uint16_t alarm_detail_index = 0;  ///< object that tells ambiguous 603Fh apart (P21.08 = 2021h:09); 0 = none
    std::uint8_t alarm_detail_sub = 0;
    std::vector<DriveAlarmText> alarms;
    AlarmHistoryObjects alarm_history;
    ParameterAddress limits_switch{};        ///< object that switches 607Dh: 0 off, 1 on, 2 on after homing (SV33-E P05.43); index 0: none
    std::vector<DriveOrderObject> orders;    ///< parameters that are commands: never stored
    std::vector<DriveParameter> parameters;  ///< all that the manual lists, those of the dictionary included
    std::vector<DriveHazard> hazards;
    std::vector<RequiredSetting> required_settings;  ///< checked by DrivePort::setup_problems()
    DriveUnits units;
    ScaleObjects scale;
    BehaviourObjects behaviour;
    ParameterStorage storage = ParameterStorage::not_stated;
    ParameterAddress storage_switch{};   ///< while this object is 0 writes are not stored; index 0: there is none
    std::vector<std::string> questions;  ///< what only the vendor or a real drive can answer
    std::vector<std::string> assumed;    ///< what the manual leaves open and we took, in words

    [[nodiscard]] bool has(Quirk quirk) const noexcept {
        for (const auto q : quirks)
            if (q == quirk) return true;
        return false;
    }
};

}  // namespace taktwerk::axes
