#pragma once
// Objects of a drive that change how it takes commands and what it shows: between the dictionary and the axis. Which objects they are
// comes from DriveProfile::behaviour and DriveProfile::units; values that take effect after a restart are those of power-on.
// Sources: SV-DA200 2.1, 3.1.2, 3.3.2, 4.6, 5.2, 5.3; SV33-E 5.4, 7.2, 8.1.

#include <array>
#include <cstdint>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/behaviour_value.hpp"
#include "axes/sim/cia402_axis.hpp"
#include "axes/sim/lost_data.hpp"
#include "axes/sim/sync_watch.hpp"
#include "axes/sim/unit_choice.hpp"
#include "core/time.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class Behaviour {
public:
    explicit Behaviour(const DriveProfile& profile);

    void power_on(ecat::sim::ObjectDictionary& dictionary, Instant now);
    /// SYNC0 runs each `cycle`, and the drive's clock is in step with it.
    void synchronised(bool running, Duration cycle) noexcept {
        sync0_ = running;
        sync_watch_.restart(running ? cycle : Duration{});
    }
    void exchange_due(const ecat::sim::ExchangeCause& cause, Instant now) noexcept;
    void operational(bool op, Instant now) noexcept;
    /// For tests of a clock that does not lock.
    void clock_locks(bool locks) noexcept { clock_locks_ = locks; }
    /// The mains have all of their phases.
    void mains_complete(bool complete) noexcept { phase_missing_ = !complete; }

    /// The objects as the axis is to understand them.
    void obey(AxisInputs& in, Cia402Axis& axis) noexcept;
    /// What the drive shows beside what every CiA 402 axis does.
    void show(AxisOutputs& out, const Cia402Axis& axis) noexcept;
    /// Looks for what does not come: process data, SYNC0, a phase of the mains.
    void watch(Cia402Axis& axis, Instant now) noexcept;

    /// What drives the terminals: bit n is output n + 1; nothing while the drive sets them itself.
    [[nodiscard]] std::uint32_t digital_outputs() const noexcept;

private:
    void obey_position(AxisInputs& in, const Cia402Axis& axis) noexcept;
    void obey_brake(Cia402Axis& axis) noexcept;
    void obey_limits(AxisInputs& in) const noexcept;
    void obey_probes(AxisInputs& in) const noexcept;
    void stop_at_limits(const AxisInputs& in, Cia402Axis& axis) noexcept;
    void watch_enable(const AxisInputs& in, Cia402Axis& axis) noexcept;
    void watch_data(Cia402Axis& axis, Instant now) noexcept;
    void watch_sync(Cia402Axis& axis, Instant now) noexcept;
    void watch_mains(Cia402Axis& axis) noexcept;
    void set_analogue_outputs() noexcept;
    [[nodiscard]] bool watches_sync() const noexcept { return sync_type_.present() ? sync_type_.get() == 2 : sync0_; }
    [[nodiscard]] Duration sync_deviation() const noexcept { return Duration{sync_deviation_.get()}; }
    [[nodiscard]] bool enabled_by_input() const noexcept;

    struct Analogue {
        BehaviourValue value, selection, gain;
        ParameterAddress monitor_object;
        ecat::sim::Entry* monitor = nullptr;
    };

    // What the drive type is.
    bool torque_offset_not_in_torque_, limit_stop_is_fault_, clock_bit_8_, standstill_bit_14_;
    std::int64_t bus_control_value_, servo_enable_function_;
    AlarmCode lost_data_alarm_, lost_sync_alarm_, negative_limit_alarm_, positive_limit_alarm_;
    // The objects.
    BehaviourValue bus_control_, absolute_targets_, limit_masks_, lost_cycles_, lost_time_, sync_type_, output_control_, following_limit_;
    BehaviourValue sync_losses_, sync_deviation_, phase_detection_, inputs_count_, input_levels_;
    std::array<BehaviourValue, 2> probe_input_;
    std::vector<BehaviourValue> input_functions_;
    std::vector<Analogue> analogue_;
    UnitChoice units_;
    const ecat::sim::Entry *outputs_ = nullptr, *output_mask_ = nullptr;
    BrakeObject brake_object_;
    // What happens.
    LostData targets_;
    SyncWatch sync_watch_;
    std::int64_t increments_ = 0;  ///< sum of the increments, as a position
    bool following_ = false;       ///< a cyclic position target is followed
    bool fresh_ = false, sync0_ = false, operational_ = false, clock_locks_ = true;
    bool at_negative_limit_ = false, at_positive_limit_ = false;
    bool phase_missing_ = false, phase_fault_ = false, phase_warned_ = false, enabled_twice_ = false;  ///< as the axis was told
    std::int64_t demand_ = 0;
    Instant data_at_{}, sync_at_{};
};

}  // namespace taktwerk::axes::sim
