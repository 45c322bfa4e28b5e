#pragma once
// Objects of a drive with which its behaviour changes: those that must have a certain value before it may be enabled, the one
// that chooses its units, and those that the simulated drive obeys. Which object does what comes from the drive file; what it
// does is code. Plain data; read at start, never in the cycle.

#include <cstdint>
#include <string>
#include <vector>

#include "axes/port/drive_port.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

/// In which machines a required setting counts.
enum class SettingApplies : std::uint8_t {
    always,
    with_clocks,     ///< the slave runs on SYNC0
    without_clocks,  ///< it runs free
};

/// With another value the drive must not be enabled. Read by SDO each time the drive comes into OP.
struct RequiredSetting {
    ParameterAddress object;
    std::vector<std::int64_t> values;  ///< raw; any of them
    std::vector<Duration> cycles;      ///< instead of `values`: raw value n means the cycle in place n, which must be the one of the bus
    SettingApplies when = SettingApplies::always;
    std::string text;     ///< what the object is and what goes wrong otherwise, in one sentence
    std::string remedy;   ///< what to write, and when it takes effect
    std::string section;  ///< of the manual
};

enum class VelocityUnit : std::uint8_t {
    profile,  ///< DriveProfile::velocity_counts_per_unit
    rpm,      ///< revolutions of the motor per minute (SV-DA200 P4.25 = 0)
};
enum class AccelerationUnit : std::uint8_t {
    counts,  ///< counts/s2
    time,    ///< ms from standstill to rated speed (SV-DA200 P4.25 = 0); greater is gentler
};

/// What one value of the unit object makes of the drive.
struct UnitVariant {
    std::int64_t value = 0;
    VelocityUnit velocity = VelocityUnit::profile;
    AccelerationUnit acceleration = AccelerationUnit::counts;
    bool zero_limits_count = false;    ///< torque limits of 0 are never ignored, whatever the limit masks say (SV-DA200 P4.25 = 2)
    bool index_before_inputs = false;  ///< 60FDh: bit 16 is the index pulse, the inputs follow from bit 17 on, bit 25 is emergency stop
    bool index_probe = true;           ///< touch probes can latch on the index pulse
    std::uint16_t status_hidden = 0;   ///< bits of 6041h that stay 0, of those that are the vendor's own (SV-DA200 P4.25 = 3)
    bool cyclic_bit_12 = false;        ///< 6041h bit 12 stands in the cyclic modes while the drive follows, as CiA 402-2 has it
};

struct DriveUnits {
    ParameterAddress object{};                 ///< chooses the variant; index 0: the units never change
    ParameterAddress counts_per_revolution{};  ///< of the motor, in the drive's position unit
    std::vector<UnitVariant> variants;
};

/// What a machine relies on in the EEPROM of a drive, because a start-up list comes too late for it: whoever commissions the drive stores
/// it there, the drive is not enabled with another value, a simulated one comes with it.
struct StoredSetting {
    ParameterAddress object;  ///< as of the first axis of the drive
    std::int64_t value = 0;
    std::string remedy{};  ///< how it gets there
};

/// Which objects say how many of the drive's position counts are one turn of the motor: compared with the axis before it is enabled.
struct ScaleObjects {
    ParameterAddress counts{};  ///< counts of a turn (SE-808X 2000h:02); 0 in it: `encoder` and the gear, if there are (SV-DA200 P0.22)
    ParameterAddress counts_high{};  ///< times `counts_high_unit`, is added to it (TSVM PA84, 10000)
    std::int64_t counts_high_unit = 0;
    ParameterAddress encoder{};                   ///< counts of the encoder (SV33-E P01.05)
    ParameterAddress numerator{}, denominator{};  ///< encoder counts = counts * numerator / denominator (SV33-E 6091h)
    std::vector<ParameterAddress>
        only_one;           ///< ratios whose part in it is not stated: with another value than 1 nobody knows (SV-DA200 6091h)
    std::string doubt{};    ///< why nobody knows, where the objects do not tell; one sentence
    std::string remedy{};   ///< how the drive is given another scale
    std::string section{};  ///< of the manual
};

/// An analogue output that the bus sets: its volts are value / gain while the selection is 0.
struct AnalogueOutput {
    ParameterAddress value{}, selection{}, gain{};
    ParameterAddress monitor{};  ///< shows the voltage in mV
};

/// Inputs that exist in the drive's parameters only, each with a function like that of a terminal (SV33-E VDI1 to VDI16).
struct VirtualInputs {
    ParameterAddress enable{};                  ///< 1: they count (P23.00)
    ParameterAddress levels{};                  ///< bit n is input n + 1 (P20.50)
    std::vector<ParameterAddress> functions{};  ///< of each input, in order (P23.06, P23.08, ...)
    std::int64_t servo_enable = 1;              ///< the function that enables the motor (SV33-E 8.1)
};

/// Which motor hangs on a drive that turns several kinds (SE-808X 4.4, 2000h:11).
struct MotorObjects {
    ParameterAddress type{};              ///< chooses the kind; index 0: one kind only, with an encoder
    std::vector<std::int64_t> open_loop;  ///< values of it without an encoder: the actual position is the commanded one
    ParameterAddress standby_current{};   ///< % of the current that an open-loop motor is held with at standstill
};

/// What a terminal of the drive is wired to.
enum class InputUse : std::uint8_t { negative_limit, positive_limit, home };

/// The switches on a drive's own terminals, before they become 60FDh.
struct InputObjects {
    std::vector<InputUse> terminals;  ///< of input 1, 2, ...; empty: nothing comes between switch and 60FDh
    ParameterAddress polarity{};      ///< bit 0 is input 1: 0 normally open, 1 normally closed
    Duration filter{};                ///< an active signal that lasts no longer is not seen
};

/// What a drive shows of its state and its errors on objects of its own.
struct StateObjects {
    struct OfAlarm {
        std::uint16_t code = 0;  ///< 603Fh
        std::int64_t value = 0;
    };
    ParameterAddress state{};            ///< index 0: none
    std::int64_t enabled = 0, free = 0;  ///< its values with and without power in the motor
    std::vector<OfAlarm> alarms;         ///< its values while one of these stands; others show as `free`
    ParameterAddress error_code{};       ///< as 603Fh
    ParameterAddress error_sub_code{};   ///< of a communication error: 1 general, 2 SYNC, 3 watchdog
    ParameterAddress history_next{};     ///< place (from 1) of the record that the next error will be written to
    ParameterAddress history{};          ///< first record of the ring, the others at the sub-indices behind it
    std::uint8_t history_length = 0;
};

/// Objects that the simulated drive obeys; index 0: this drive has no such object.
struct BehaviourObjects {
    ParameterAddress bus_control{};  ///< unless it reads `bus_control_value`, control word and mode mean nothing
    std::int64_t bus_control_value = 0;
    ParameterAddress absolute_targets{};    ///< 0: a target in CSP is an increment each cycle; 1: a position
    ParameterAddress limit_masks{};         ///< bit 0: torque limits of 0 are ignored, bit 1: a speed limit of 0 is
    ParameterAddress lost_target_cycles{};  ///< CSP goes on by the last increment for so many cycles without process data
    ParameterAddress lost_data_time{};      ///< ms without process data until the alarm; while enabled only
    ParameterAddress sync_type{};           ///< 2: SYNC0 is watched while enabled; 0: free run
    ParameterAddress output_control{};      ///< 1: 60FEh drives the outputs
    std::vector<AnalogueOutput> analogue_outputs{};
    ParameterAddress bus_state{};          ///< shows 10 + AL state
    ParameterAddress parameter_tunnel{};   ///< sub 1 address (index << 8 | sub), sub 2 value, sub 3 result
    ParameterAddress following_limit{};    ///< counts of following error that are an alarm; 0: no check
    ParameterAddress probe_input[2] = {};  ///< must be 0 for the probe's input to latch
    ParameterAddress sync_losses{};        ///< SYNC0 in a row that may be missing or out of place; one more is an alarm (SV33-E P0A.31)
    ParameterAddress sync_deviation{};     ///< ns between two SYNC0 more or less than the cycle that put one out of place (P0A.32)
    ParameterAddress phase_detection{};    ///< a missing mains phase is 0 a fault, 1 a warning until enabling, 2 nothing (P08.00)
    VirtualInputs virtual_inputs{};
    ParameterAddress least_voltage{}, greatest_voltage{};  ///< V of the supply, beyond them an alarm
    MotorObjects motor{};
    InputObjects inputs{};
    StateObjects state{};
};

}  // namespace taktwerk::axes
