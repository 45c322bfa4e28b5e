#pragma once
// Objects of a drive that change how it takes commands and what it shows: between the dictionary and the axis. Which objects they are
// comes from DriveProfile::behaviour and DriveProfile::units; values that take effect after a restart are those of power-on.
// Sources: SV-DA200 2.1, 3.1.2, 3.3.2, 4.6, 5.2, 5.3.

#include <array>
#include <cstdint>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/cia402_axis.hpp"
#include "axes/sim/lost_data.hpp"
#include "core/time.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

/// One of those objects.
class BehaviourValue {
public:
    void power_on(ecat::sim::ObjectDictionary& dictionary, const DriveProfile& profile, ParameterAddress object);
    [[nodiscard]] bool present() const noexcept { return entry_ != nullptr; }
    /// What the drive goes by now.
    [[nodiscard]] std::int64_t get() const noexcept { return entry_ == nullptr || latched_ ? at_power_on_ : entry_->get(); }

private:
    const ecat::sim::Entry* entry_ = nullptr;
    std::int64_t at_power_on_ = 0;
    bool latched_ = false;
};

class Behaviour {
public:
    explicit Behaviour(const DriveProfile& profile);

    void power_on(ecat::sim::ObjectDictionary& dictionary, Instant now);
    /// SYNC0 runs, with which the drive's clock is in step.
    void synchronised(bool running) noexcept { sync0_ = running; }
    void exchange_due(const ecat::sim::ExchangeCause& cause, Instant now) noexcept;
    void operational(bool op, Instant now) noexcept;
    /// For tests of a clock that does not lock.
    void clock_locks(bool locks) noexcept { clock_locks_ = locks; }

    /// The objects as the axis is to understand them.
    void obey(AxisInputs& in, Cia402Axis& axis) noexcept;
    /// What the drive shows beside what every CiA 402 axis does.
    void show(AxisOutputs& out, const Cia402Axis& axis) noexcept;
    /// Finds out that nothing comes any more.
    void watch(Cia402Axis& axis, Instant now) noexcept;

    /// What drives the terminals: bit n is output n + 1; nothing while the drive sets them itself.
    [[nodiscard]] std::uint32_t digital_outputs() const noexcept;

private:
    void choose_units(Cia402Axis& axis) noexcept;
    void obey_position(AxisInputs& in, const Cia402Axis& axis) noexcept;
    void obey_limits(AxisInputs& in) const noexcept;
    void obey_units(AxisInputs& in) const noexcept;
    void obey_probes(AxisInputs& in) const noexcept;
    void stop_at_limits(const AxisInputs& in, Cia402Axis& axis) noexcept;
    void set_analogue_outputs() noexcept;
    [[nodiscard]] bool watches_sync() const noexcept { return sync_type_.present() ? sync_type_.get() == 2 : sync0_; }

    struct Analogue {
        BehaviourValue value, selection, gain;
        ecat::sim::Entry* monitor = nullptr;
    };

    const DriveProfile profile_;
    AlarmCode lost_data_alarm_, lost_sync_alarm_, negative_limit_alarm_, positive_limit_alarm_;
    BehaviourValue bus_control_, absolute_targets_, limit_masks_, lost_cycles_, lost_time_, sync_type_, output_control_, following_limit_;
    BehaviourValue unit_, turn_;
    std::array<BehaviourValue, 2> probe_input_;
    std::vector<Analogue> analogue_;
    const ecat::sim::Entry* outputs_ = nullptr;
    UnitVariant variant_{};
    double velocity_scale_ = 1;  ///< raw = counts/s times this
    LostData targets_;
    std::int64_t increments_ = 0;  ///< sum of the increments, as a position
    bool following_ = false;       ///< a cyclic position target is followed
    bool fresh_ = false, sync0_ = false, operational_ = false, clock_locks_ = true;
    bool at_negative_limit_ = false, at_positive_limit_ = false;
    std::int64_t demand_ = 0;
    Instant data_at_{}, sync_at_{};
};

}  // namespace taktwerk::axes::sim
