#pragma once
// The parameters of a simulated drive on the bus: its dictionary in front of the store, the parameters that are commands, the
// alarms that settings cause, and the record of earlier alarms. Sources: SV33-E manual 5.1, 5.5, 7.2; CiA 301 7.5.2.13 (1010h, 1011h).

#include <cstdint>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "axes/sim/axis_objects.hpp"
#include "axes/sim/parameter_store.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

class Cia402Axis;

class DriveParameters {
public:
    explicit DriveParameters(const DriveProfile& profile);

    /// Before the axes get their power: the dictionary gets what the EEPROM holds.
    void power_on(ecat::sim::ObjectDictionary& dictionary);
    /// SDO abort code; 0 accepts. Ranges and access were checked by the dictionary.
    [[nodiscard]] std::uint32_t refuse(std::uint16_t index, std::uint8_t sub, std::int64_t value, bool motor_powered) const;
    /// An SDO wrote: stores it, does what it orders (to `axis`, the one whose object it is), sees what it makes wrong.
    void written(std::uint16_t index, std::uint8_t sub, Instant now, Cia402Axis& axis);
    /// Each exchange: warnings that come and go, and the record that is asked for. Real-time safe.
    void step(Instant now, Cia402Axis& first) noexcept;
    /// After power_on() of the axes: what stored settings make wrong. `axis` counts from 0.
    void check_settings(unsigned axis, Cia402Axis& model) const noexcept;

    /// When 607Dh counts.
    [[nodiscard]] SoftwareLimits software_limits() const noexcept;
    /// The axis that an object belongs to.
    [[nodiscard]] unsigned axis_of(std::uint16_t index) const noexcept;
    [[nodiscard]] const ParameterStore& store() const noexcept { return store_; }
    void commission(ParameterAddress at, std::int64_t value) noexcept { store_.commission(at, value); }

private:
    using Entry = ecat::sim::Entry;
    [[nodiscard]] bool is_order(ParameterAddress at) const noexcept;
    void obey(ParameterAddress at, std::int64_t value, Instant now, Cia402Axis& axis);
    void show_record(Cia402Axis& first) noexcept;
    [[nodiscard]] std::int64_t value_of(unsigned axis, std::uint16_t index, std::uint8_t sub, std::int64_t otherwise) const noexcept;

    std::vector<DriveOrderObject> orders_;
    AlarmHistoryObjects history_objects_;
    ParameterAddress limits_switch_;
    std::uint16_t object_offset_;
    std::uint8_t axes_;
    ParameterStore store_;
    ecat::sim::ObjectDictionary* dictionary_ = nullptr;
    struct {
        Entry *select = nullptr, *code = nullptr, *time = nullptr, *speed = nullptr;
    } record_;
    bool restart_pending_ = false;
    bool restart_warned_ = false, storage_warned_ = false;  ///< as the axis was told
};

}  // namespace taktwerk::axes::sim
