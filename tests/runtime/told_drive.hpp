#pragma once
// What a drive is told in its process data and what it answers there, read from the image that goes out with the frames; and what of it arrived in
// the dictionary of the simulated slave.

#include <cstdint>
#include <optional>

#include "axes/drives/cia402/own_modes.hpp"
#include "axes/drives/cia402/words.hpp"
#include "core/process_image.hpp"
#include "ecat/master.hpp"
#include "ecat/sim/object_dictionary.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::runtime::testing {

/// Raw values; what is not mapped is not there.
struct ToldDrive {
    std::int64_t control = 0, mode = 0;                                       ///< 6040h, 6060h
    std::optional<std::int64_t> position, velocity, torque, velocity_offset;  ///< 607Ah, 60FFh, 6071h, 60B1h
    std::int64_t actual_position = 0, shown_mode = 0;                         ///< 6064h, 6061h: its answer of this cycle

    [[nodiscard]] bool enables() const { return (control & 0xF) == axes::cia402::enable_operation; }
    /// The same outputs.
    [[nodiscard]] bool tells_like(const ToldDrive& other) const {
        return control == other.control && mode == other.mode && position == other.position && velocity == other.velocity &&
               torque == other.torque;
    }
};

/// One axis behind one slave. Usable once the bus has planned its process data.
class DriveTap {
public:
    DriveTap(const ecat::Master& bus, std::size_t slave, const AxisBinding& binding)
        : bus_(bus), slave_(slave), offset_(static_cast<std::uint16_t>(binding.drive_axis * binding.profile->object_offset)) {
        const auto out = [&](std::uint16_t index, bool is_signed) {
            Signal signal;
            if (bus.maps_output(slave, object(index), 0)) signal = *bus.output(slave, object(index), 0);
            signal.is_signed = is_signed;
            return signal;
        };
        const auto in = [&](std::uint16_t index) {
            Signal signal;
            if (bus.maps_input(slave, object(index), 0)) signal = *bus.input(slave, object(index), 0);
            signal.is_signed = true;
            return signal;
        };
        control_ = out(0x6040, false);
        mode_ = out(0x6060, true);
        position_ = out(0x607A, true);
        velocity_ = out(0x60FF, true);
        torque_ = out(0x6071, true);
        velocity_offset_ = out(0x60B1, true);
        actual_position_ = in(0x6064);
        shown_mode_ = in(0x6061);
        if (!mode_.mapped() || !shown_mode_.mapped()) fixed_mode_ = axes::cia402::mode_code(axes::cia402::own_mode(binding.axis));
    }
    [[nodiscard]] ToldDrive told(std::span<const std::byte> outputs) const {
        const auto read = [&](const Signal& signal) {
            return signal.mapped() ? std::optional{read_signal(outputs, signal)} : std::nullopt;
        };
        ToldDrive told;
        told.control = read_signal(outputs, control_);
        told.mode = fixed_mode_ ? *fixed_mode_ : read_signal(outputs, mode_);
        told.position = read(position_);
        told.velocity = read(velocity_);
        told.torque = read(torque_);
        told.velocity_offset = read(velocity_offset_);
        told.actual_position = read_signal(bus_.inputs(), actual_position_);
        told.shown_mode = fixed_mode_ ? *fixed_mode_ : read_signal(bus_.inputs(), shown_mode_);
        return told;
    }
    /// What the slave has of it.
    [[nodiscard]] ToldDrive arrived(const ecat::sim::ObjectDictionary& dictionary) const {
        const auto value = [&](std::uint16_t index, const Signal& signal) {
            return signal.mapped() ? std::optional{dictionary.value(object(index), 0)} : std::nullopt;
        };
        ToldDrive told;
        told.control = dictionary.value(object(0x6040), 0);
        told.mode = dictionary.value(object(0x6060), 0);
        told.position = value(0x607A, position_);
        told.velocity = value(0x60FF, velocity_);
        told.torque = value(0x6071, torque_);
        told.velocity_offset = value(0x60B1, velocity_offset_);
        return told;
    }
    [[nodiscard]] const ecat::SlaveHealth& health() const { return bus_.health(slave_); }

private:
    [[nodiscard]] std::uint16_t object(std::uint16_t base) const { return static_cast<std::uint16_t>(base + offset_); }

    const ecat::Master& bus_;
    std::size_t slave_;
    std::uint16_t offset_;
    std::optional<std::int64_t> fixed_mode_;  ///< given by SDO before, where frames do not carry it
    Signal control_, mode_, position_, velocity_, torque_, velocity_offset_, actual_position_, shown_mode_;
};

}  // namespace taktwerk::runtime::testing
