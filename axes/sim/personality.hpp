#pragma once
// How a drive type behaves where CiA 402 leaves room. Plain data; what a drive's manual says of it comes from its profile.

#include <cstdint>
#include <string>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/touch_probe.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::sim {

/// How a drive takes power from a motor that may still move; SE-808X 605Eh = 0 coasts, SV33-E P04.12 = 2 ramps.
using FaultStop = DriveStop;

/// Alarms that the drive finds out by itself.
struct AlarmCode {
    std::uint16_t code = 0;
    bool resettable = true;
    std::uint32_t detail = 0;  ///< what the detail object shows (P21.08)
    bool warning = false;      ///< the drive goes on
    bool whole_drive = false;  ///< stands in every axis, before the axis' own (TSVM 7.1)
};

/// An alarm of the profile, to be provoked by what the panel shows or by its kind.
struct AlarmRow {
    std::string panel{};
    AlarmCode alarm{};
    DriveAlarmKind kind = DriveAlarmKind::other;
    bool warning = false, clears_itself = false;
};

/// A way in which a drive fails at once, whatever it is doing. How it shows and whether it clears is the personality's.
enum class Failure : std::uint8_t { overspeed, following_error, undervoltage, overload, encoder, communication };

/// How this drive type behaves where CiA 402 leaves room.
struct Personality {
    std::int64_t counts_per_revolution = 10000;
    double velocity_counts_per_unit = 1.0;  ///< raw 606Ch/60FFh = counts/s * this
    double torque_rated_raw = 1000.0;
    bool absolute_encoder = false;  ///< keeps its coordinate over a power cycle
    bool fault_pattern_f = false;   ///< Fault shows as x0xx1111
    bool remote_bit = true;         ///< bit 9 set in OP
    bool internal_limit_bit = true;
    bool csp_following_bits = true;  ///< bits 12 and 13 in CSP
    bool home_found_bit_15 = false;
    bool reset_needs_disable = false;                  ///< fault reset only with enable dropped
    bool limit_stop_is_warning = false;                ///< overtravel: stop with position lock, warning, still enabled
    bool quick_stop_leaves = true;                     ///< after the quick stop: Switch On Disabled by itself
    std::uint64_t homing_methods = ~std::uint64_t{0};  ///< that it knows: bit method + 2
    bool homing_limit_is_fault = false;                ///< homing that meets a limit: homing_limit_alarm; else statusword bit 13 alone
    bool homing_19_starts_negative = false;
    ProbeToggle probe_toggle = ProbeToggle::none;
    std::uint8_t encoder_turn_bits = 0;  ///< of an absolute encoder; 0: it never begins anew
    FaultStop fault_stop = FaultStop::ramp;
    FaultStop off_stop = FaultStop::coast;  ///< power taken away by command while it moves
    /// The holding brake opens this long after enabling; set-points and homing starts before are lost (SV33-E 3.1.2, P05.13).
    Duration brake_release{};
    /// After power is taken at standstill the motor holds this long until the brake does (SV33-E P05.14). 0: no brake.
    Duration brake_hold{};
    /// Power gone in motion: the brake closes below this speed [counts/s], or after this time (TSVM PA49, PA48). 0: at standstill only.
    double brake_moving_speed = 0;
    Duration brake_moving_wait{};
    double quick_stop_deceleration = 0;  ///< counts/s2; 0 = torque limit
    std::vector<StopOption> stops;       ///< documented options; they go before off_stop, fault_stop and quick_stop_leaves
    // Modes of operation.
    std::uint16_t modes = 0xFFFF;  ///< bit per DriveMode that the drive has
    ModeViolation mode_violation = ModeViolation::obeyed;
    bool mode_change_at_standstill = false;
    Duration mode_change_interval{}, mode_indeterminate{};
    AlarmCode mode_not_set_alarm{0}, mode_change_alarm{0};  ///< code 0: the drive has none
    std::uint8_t profile_buffer = 1;
    bool pp_bit_5_blends = false, pp_shared_ramp = false, pp_stop_forgets = false;
    bool csv_ramps = false;
    bool ramp_before_mode_change = false;
    bool pv_speed_zero_bit = true;  ///< bit 12 in PV
    bool velocity_window_in_rpm = false;
    double following_error_limit = 0;  ///< counts; 0 = no check
    double maximum_velocity = 0;       ///< counts/s; CSP increments beyond 3 times that are counted; 0 = no check
    double overspeed = 0;              ///< counts/s beyond which the measured speed is an alarm; 0 = no check
    AlarmCode following_error_alarm{0x8611};
    AlarmCode increment_alarm{0x0424};
    AlarmCode undervoltage_alarm{0x3220};
    AlarmCode communication_alarm{0x7500};
    AlarmCode overspeed_alarm{0x8400};
    AlarmCode overload_alarm{0x3230};
    AlarmCode encoder_alarm{0x7305, false};
    // Code 0: this drive has no such alarm; statusword bit 13 tells alone, and a lost turn shows in the position only.
    AlarmCode homing_timeout_alarm, homing_limit_alarm, homing_method_alarm;
    AlarmCode battery_low_alarm, reference_lost_alarm, turn_overflow_alarm;
    double battery_low = 0, battery_empty = 0;  ///< V (TSVM 7.2: 3.1 and 2.5)
    bool encoder_keeps_fault = false;  ///< lost turns are complained of until the encoder is reset, whatever the battery (TSVM PA80)
    // A drive like the TSVM-D6, sections of its manual.
    bool fault_reaction_02b6 = false;        ///< Fault Reaction reads 02B6h (5.3.1)
    bool alarm_sets_warning_bit = false;     ///< bit 7 with every alarm (5.3.2)
    bool remote_bit_from_preop = false;      ///< bit 9 from PREOP on (5.3.2)
    bool quick_stop_bit_rests_high = false;  ///< bit 5 in Switch On Disabled and the fault states (5.3.1)
    bool target_reached_in_cyclic = true;    ///< bit 10 in the cyclic modes
    Duration self_test{};                    ///< Not Ready To Switch On after power-on
    Duration deaf_after_enable{};            ///< set-points that come earlier are lost (5.3.1)
    double torque_overload = 0;              ///< rated torques; longer than `torque_overload_time` is an alarm (PA30, PA31); 0 = no check
    Duration torque_overload_time{};
    AlarmCode left_operational_alarm, link_alarm, torque_overload_alarm;  ///< code 0: the drive has none
    std::uint16_t negative_limit_code = 0x5444, positive_limit_code = 0x5443;
    std::vector<AlarmRow> alarms{};  ///< all of the profile
    double start_speed = 0;          ///< counts/s; enabling a faster motor is an alarm (SV33-E E.417); 0 = no check
    AlarmCode start_speed_alarm{0x0417};
    Duration stall_time{};  ///< at the torque limit without turning; longer is an alarm (SV33-E P08.18); 0 = no check
    AlarmCode stall_alarm{0x7121};
    double overload_seconds = 0;  ///< at twice the rated torque until the overload alarm, by I2t; 0 = no check
};

/// What the profile says of the drive's behaviour; the rest keeps its defaults.
[[nodiscard]] Personality personality_of(const DriveProfile& profile, std::int64_t counts_per_revolution);

}  // namespace taktwerk::axes::sim
