#pragma once
// A simulated CiA 402 drive as a device on the simulated bus: one to many axes behind one slave controller. Copies the
// dictionary's objects to and from axes/sim/cia402_axis.hpp at each exchange.

#include <cstdint>
#include <memory>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/alarm_numbers.hpp"
#include "axes/sim/axis_entries.hpp"
#include "axes/sim/behaviour.hpp"
#include "axes/sim/cia402_axis.hpp"
#include "axes/sim/drive_parameters.hpp"
#include "axes/sim/encoder_orders.hpp"
#include "axes/sim/held_inputs.hpp"
#include "axes/sim/missed_frames.hpp"
#include "axes/sim/motor_behaviour.hpp"
#include "axes/sim/parameter_tunnel.hpp"
#include "axes/sim/state_display.hpp"
#include "axes/sim/state_refusal.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class Cia402Device final : public ecat::sim::DeviceModel {
public:
    struct AxisSetup {
        PlantConfig plant;
        SimulatedMotor motor;
    };
    Cia402Device(const DriveProfile& profile, const std::vector<AxisSetup>& axes);

    void power_on(ecat::sim::ObjectDictionary& dictionary, Instant now) override;
    void power_off(Instant now) override;
    std::uint16_t refuse(ecat::sim::EsmState from, ecat::sim::EsmState to, const ecat::sim::SyncSettings& settings) override;
    void entered(ecat::sim::EsmState state, Instant now) override;
    void exchange_due(const ecat::sim::ExchangeCause& cause) override { cause_ = cause; }
    void exchange(Instant now) override;
    void advance(Instant now) override;
    void outputs_lost(Instant now) override;
    std::uint32_t refuse_write(std::uint16_t index, std::uint8_t sub, std::int64_t value) override;
    void written(std::uint16_t index, std::uint8_t sub, Instant now) override;

    /// From now on the drive refuses this state with this AL status code; code 0: no more.
    void refuse_state(ecat::sim::EsmState state, std::uint16_t al_status_code) noexcept { refusal_.order(state, al_status_code); }

    /// From now on this object of the inputs says what a hand gives it, whatever the drive would say: a sensor at a device that is described
    /// as a drive, an analog value.
    void hold(std::uint16_t index, std::uint8_t sub, std::int64_t value) { held_.hold(index, sub, value); }

    void link_changed(Instant now) override;
    /// The supply of the main circuit, one for all axes.
    void main_power(bool on) noexcept {
        for (auto& axis : axes_) axis.model->main_power(on);
    }
    /// Its mains have all of their phases.
    void mains_complete(bool complete) noexcept {
        for (auto& axis : axes_) axis.behaviour->mains_complete(complete);
    }
    /// Volts of that supply, where the drive has limits of its own for it (SE-808X 4.4, 2000h:14 and :15).
    void supply_voltage(double volts) noexcept {
        for (auto& axis : axes_) axis.motor->supply(volts, *axis.model);
    }
    /// In the EEPROM before the power first comes: what its commissioner stored. As of the first axis of the drive.
    void commission(std::size_t axis, ParameterAddress object, std::int64_t value);

    /// An alarm by its number, with what the profile says of it: of the whole drive, or of one axis.
    void raise(std::size_t axis, std::uint16_t code) noexcept;

    [[nodiscard]] Cia402Axis& axis(std::size_t index) { return *axes_[index].model; }
    [[nodiscard]] const ParameterStore& parameters() const noexcept { return parameters_.store(); }
    /// What the objects that change a drive's behaviour make of this axis.
    [[nodiscard]] Behaviour& behaviour(std::size_t index) { return *axes_[index].behaviour; }
    [[nodiscard]] std::size_t axis_count() const noexcept { return axes_.size(); }

private:
    using Entry = ecat::sim::Entry;
    struct OneAxis {
        std::unique_ptr<Cia402Axis> model;
        std::unique_ptr<Behaviour> behaviour;
        std::unique_ptr<MotorBehaviour> motor;
        AxisEntries entries;
        EncoderOrders encoder;
        bool faulted = false;      ///< as announced
        std::uint16_t common = 0;  ///< alarm of the whole drive that it shows
    };
    /// An emergency when an axis enters FAULT (or its reaction) and code 0000h when the last one has left it.
    void announce(OneAxis& axis, bool faulted, std::uint16_t code, std::uint32_t detail);
    void raise_in_all(const AlarmCode& alarm) noexcept;
    void take_scale() noexcept;
    void share_common_alarm() noexcept;

    std::vector<OneAxis> axes_;
    DriveParameters parameters_;
    ScaleObjects scale_;
    bool scale_changed_ = false;  ///< while the motor had power
    std::uint16_t object_offset_;
    AlarmNumbers alarms_;
    AlarmCode missed_alarm_, link_alarm_;
    MissedFrames missed_;
    StateRefusal refusal_;
    HeldInputs held_;
    ParameterTunnel tunnel_;
    StateDisplay display_;  ///< of the first axis
    ParameterAddress bus_state_address_;
    Entry* bus_state_ = nullptr;
    ecat::sim::ExchangeCause cause_;
    Duration cycle_{std::chrono::milliseconds{1}};
    bool operational_ = false;
};

}  // namespace taktwerk::axes::sim
