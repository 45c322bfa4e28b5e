#pragma once
// What a simulated drive counts from: the place of an incremental encoder at power-on, or what an absolute one reads and homing has stored.
// With it goes all that an encoder may have lost or complains of. Counts, plant coordinates. Sources: SV33-E 3.1.4, 7.2; TSVM 7.2.

#include <cstdint>
#include <optional>

#include "axes/sim/absolute_encoder.hpp"
#include "axes/sim/drive_alarm_codes.hpp"
#include "axes/sim/plant_config.hpp"
#include "axes/sim/simulated_motor.hpp"

namespace taktwerk::axes::sim {

class CountOrigin {
public:
    CountOrigin(const PlantConfig& plant, const SimulatedMotor& motor, const DriveProfile& profile, const DriveAlarmCodes& codes);

    /// Where the drive counts 0, and whether homing has said so.
    [[nodiscard]] double zero() const noexcept { return zero_; }
    [[nodiscard]] bool homed() const noexcept { return homed_; }
    void rescale(double factor) noexcept;

    /// The drive is switched on: an encoder that failed works again. What it complains of goes on.
    void power_on() noexcept { failed_ = false; }
    /// The drive has started, the motor is at `position`; the answer is what the encoder complains of, code 0: nothing.
    AlarmCode wake(double position) noexcept;
    /// Homing moves the zero by `shift`; `seen` is what the drive takes for the position.
    void reference(double shift, double position, double seen) noexcept;
    /// Each step: the alarm of turns that no longer fit, once; code 0: none.
    AlarmCode watch(double position) noexcept;

    /// The encoder shows `count` for ever after, until power_on().
    void fail(std::int64_t count) noexcept;
    [[nodiscard]] std::int64_t shown(std::int64_t count) const noexcept { return failed_ ? frozen_ : count; }
    /// An alarm of the encoder cannot be reset yet.
    [[nodiscard]] bool complains() const noexcept { return failed_ || complaint_.code != 0; }

    void battery(Battery state) noexcept { battery_ = state; }
    void battery_voltage(double volts) noexcept;
    /// Where the manual lists it among the faults it stops the drive (TSVM 7.2, 27; SV-DA200 5.3, Er02-8); SV33-E 5.5 only warns.
    [[nodiscard]] bool battery_stops() const noexcept { return battery_low() && !low_.warning; }
    [[nodiscard]] bool battery_warns() const noexcept { return battery_low() && low_.warning; }

    /// What the encoder complains of is forgotten, unless only fewer turns help: false.
    bool reset(double position) noexcept;
    /// Its turns as well; false: this one has none.
    bool clear_turns(double position) noexcept;
    /// The same for a drive that sees it at its next power-on only.
    void order_reset() noexcept;

private:
    void read(double position) noexcept { zero_ = position - encoder_.reading(position) + stored_shift_; }
    [[nodiscard]] bool battery_low() const noexcept;

    bool absolute_;
    AbsoluteEncoder encoder_;
    double low_volts_, empty_volts_;
    bool keeps_fault_;                       ///< in the encoder, over power cycles (TSVM 7.2.1)
    AlarmCode lost_, low_, too_many_turns_;  ///< code 0: this drive has no such alarm
    Battery battery_;
    std::optional<double> battery_volts_;
    double zero_ = 0;
    double stored_shift_;  ///< EEPROM: what an absolute encoder reads where the drive counts 0
    bool homed_ = false, fault_kept_ = false, reset_ordered_ = false, failed_ = false;
    AlarmCode complaint_;  ///< stands until reset(); code 0: none
    std::int64_t frozen_ = 0;
};

}  // namespace taktwerk::axes::sim
