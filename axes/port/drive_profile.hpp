#pragma once
// What a drive type means to an axis: modes, homing, units, timing, quirks, alarms. Filled from a drive YAML by config/.
// The bus half of the same YAML is ecat::DeviceDescription. Plain data.

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "axes/port/drive_alarm_kind.hpp"
#include "axes/port/drive_assumption.hpp"
#include "axes/port/drive_hazard.hpp"
#include "axes/port/drive_parameter.hpp"
#include "axes/port/drive_port.hpp"
#include "axes/port/drive_setting.hpp"
#include "axes/port/drive_stop.hpp"
#include "axes/port/quirk.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// What a drive does that gets a change of mode which its manual forbids.
enum class ModeViolation : std::uint8_t {
    obeyed,   ///< it changes all the same
    ignored,  ///< the old mode stays (TSVM 5.4.1: "may not switch")
    alarm,    ///< a fault of the kind mode_change (TSVM 5.4.1: "or may raise an abnormality")
};

struct DriveAlarmText {
    std::uint16_t code = 0;    ///< 603Fh
    std::uint32_t detail = 0;  ///< value of the further object that tells apart; 0 = code alone
    std::string panel{};       ///< what the drive's own display shows: "E.200.0"
    std::string english{}, chinese{}, cause{}, remedy{};
    bool resettable = true;
    bool clears_itself = false;  ///< with its cause, without a reset (SV33-E E.218), as all warnings do
    bool warning = false;
    bool whole_drive = false;  ///< common to all axes of the drive (TSVM 603Fh 71..96)
    DriveAlarmKind kind = DriveAlarmKind::other;
    std::string section{};  ///< of the manual
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

/// How the controller may work the holding brake.
enum class BrakeObject : std::uint8_t {
    none,        ///< not at all: the drive works it, or has no output for it
    output_bit,  ///< 60FEh:01 bit 0 closes it (CiA 402-2), where the mask 60FEh:02 lets it
    mask_opens,  ///< 60FEh:02 bit 0 opens it (SV-DA200 4.7), once BehaviourObjects::output_control says so
};

/// The holding brake, as the drive works it.
struct DriveBrake {
    Duration release{};       ///< after enabling the brake still holds: earlier commands are lost (SV33-E P05.13)
    Duration hold{};          ///< after disabling at standstill the motor holds until the brake does (SV33-E P05.14)
    Duration moving_wait{};   ///< power gone in motion: the brake closes after this at the latest (TSVM PA48)
    double moving_speed = 0;  ///< rpm: it closes as soon as the motor is slower (TSVM PA49); 0: at standstill
    BrakeObject object = BrakeObject::none;
};

/// When and how a drive takes another mode of operation.
struct DriveModeRules {
    Duration change_delay{};
    bool change_at_standstill = false;
    Duration change_interval{};                       ///< least time between two changes of 6060h (TSVM 5.4.1: 20 ms)
    Duration indeterminate{};                         ///< 6061h means nothing this long after a change of 6060h (TSVM 5.4.1: 2 ms)
    ModeViolation violation = ModeViolation::obeyed;  ///< sooner than `change_interval`, or in motion
};

/// How a drive stops by itself.
struct DriveStops {
    DriveStop off = DriveStop::coast;   ///< power taken away while it moves (SV33-E P04.12 = 2: ramp)
    DriveStop fault = DriveStop::ramp;  ///< fault reaction (SE-808X 605Eh = 0: coast)
    bool quick_stop_leaves = true;      ///< Quick Stop Active ends by itself in Switch On Disabled (SE-808X 3.2.1: it stays)
    std::vector<StopOption> options;    ///< that the manual documents; they go before the three above
    ParameterAddress
        emergency_torque{};  ///< object with the torque of StopBy::emergency_torque, per `torque_rated_raw`; index 0: all there is
};

/// What the motor's position comes from.
struct DriveEncoder {
    bool present = true;
    std::uint8_t turn_bits = 0;  ///< width of an absolute encoder's turn counter (SV33-E 3.1.4: 16); 0: not stated
    // How it is told to forget its turns (DriveService::clear_multi_turn): one of the two; neither: the drive cannot.
    ParameterAddress clear_turns{};         ///< object that is written (SV33-E P20.05)
    std::int64_t clear_turns_value = 0;     ///< ... with this value (SV33-E: 2)
    std::uint16_t clear_turns_control = 0;  ///< bit of 6040h that is set for a while (TSVM 5.3.2: bit 12)
    ParameterAddress reset{};  ///< object: 1 ends its fault and its turns, seen at the next power-on (TSVM PA80); index 0: none
    double battery_low = 0, battery_empty = 0;  ///< V of its battery: warned of below the one, turns lost below the other; 0: not stated
};

/// What becomes of a parameter that is written.
struct DriveStorage {
    ParameterStorage way = ParameterStorage::not_stated;
    ParameterAddress switched_by{};  ///< while this object is 0 writes are not stored; index 0: there is none
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
    Duration minimum_cycle_csp{}, minimum_cycle_csv{}, minimum_cycle_cst{};  ///< 0: not stated
    Duration enable_delay{}, enable_timeout = std::chrono::seconds{2};
    DriveModeRules mode_rules;
    std::uint8_t profile_buffer = 1;  ///< set-points that PP takes behind the running one (SV33-E 1, SV-DA200 8)
    std::uint16_t enable_status_bits =
        0;  ///< of 6041h, all set before Enable Operation (SV-DA200 3.1.2: bit 8 DC locked, bit 4 main power)
    // What the drive does by itself; the simulator plays it, the axis plans with it.
    DriveBrake brake;
    DriveStops stops;
    DriveEncoder encoder;
    Duration self_test{};                    ///< Not Ready To Switch On lasts this long after power-on
    Duration deaf_after_enable{};            ///< set-points are not obeyed this long after enabling (TSVM 5.3.1: 100 ms)
    std::uint8_t missed_frames_allowed = 0;  ///< in a row in OP; one more is its communication alarm (TSVM 7.1.1: 3); 0: not counted
    double overspeed_limit = 0;              ///< of the motor's maximum speed, beyond it an alarm (TSVM PA23: 1.0); 0: none
    double torque_overload = 0;              ///< rated torques; for longer than `torque_overload_time` an alarm (TSVM PA30, PA31); 0: none
    Duration torque_overload_time{};
    bool csp_interpolates = true;                             ///< reaches a CSP target one cycle after the SYNC0 that brought it
    std::uint16_t object_offset = 0x0800, pdo_offset = 0x40;  ///< per further axis of a multi-axis drive
    std::uint8_t axes = 1;
    std::uint8_t input_bit_negative_limit = 0, input_bit_positive_limit = 1, input_bit_home = 2;  ///< in 60FDh
    ParameterAddress homing_timeout{};                       ///< object that bounds the drive's own homing (SV33-E P13.49); index 0: none
    Duration homing_timeout_unit = std::chrono::seconds{1};  ///< of that object (SV33-E: 10 ms)
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
    DriveStorage storage;
    std::vector<std::string> questions;        ///< what only the vendor or a real drive can answer
    std::vector<std::string> assumed;          ///< what the manual leaves open and we took, in words
    std::vector<DriveAssumption> assumptions;  ///< of a drive without a manual: what nobody stated so far

    [[nodiscard]] bool assumes(AssumedPart part) const noexcept {
        return std::any_of(assumptions.begin(), assumptions.end(), [&](const auto& a) { return a.part == part; });
    }
    [[nodiscard]] bool has(Quirk quirk) const noexcept {
        for (const auto q : quirks)
            if (q == quirk) return true;
        return false;
    }
};

}  // namespace taktwerk::axes
