#pragma once
// One axis of a drive as its bus knows it: which slave, which of its axes, where its objects lie in the dictionary and in the process image.

#include <cstdint>
#include <string>

#include "axes/drives/cia402/mapped_output.hpp"
#include "axes/port/drive_profile.hpp"
#include "core/process_image.hpp"
#include "core/time.hpp"
#include "ecat/master.hpp"

namespace taktwerk::axes::cia402 {

class DriveOnBus {
public:
    /// `bus` outlives it. `axis`: 0-based on that slave, `object_offset` per further axis.
    DriveOnBus(ecat::Master& bus, std::size_t slave, std::uint8_t axis, std::uint16_t object_offset) noexcept
        : bus_(bus), slave_(slave), axis_(axis), offset_(static_cast<std::uint16_t>(axis * object_offset)) {}

    [[nodiscard]] ecat::Master& bus() const noexcept { return bus_; }
    [[nodiscard]] std::size_t number() const noexcept { return slave_; }
    [[nodiscard]] std::uint8_t axis() const noexcept { return axis_; }
    [[nodiscard]] decltype(auto) slave() const noexcept { return bus_.slave(slave_); }
    [[nodiscard]] const ecat::SlaveHealth& health() const noexcept { return bus_.health(slave_); }
    [[nodiscard]] Instant effective(Instant send_time) const noexcept { return bus_.outputs_effective(slave_, send_time); }
    /// "slave 'y_drive' axis 1", of errors.
    [[nodiscard]] std::string subject() const;

    /// The axis' own of an object that the first axis has at `base`.
    [[nodiscard]] std::uint16_t object(std::uint16_t base) const noexcept;
    /// False, and not mapped: it is not in the process data. The range is the dictionary's.
    [[nodiscard]] bool find_output(MappedOutput& output, std::uint16_t base, std::uint8_t sub, bool is_signed) const;
    [[nodiscard]] bool find_input(Signal& signal, std::uint16_t base, std::uint8_t sub, bool is_signed) const;

private:
    ecat::Master& bus_;
    std::size_t slave_;
    std::uint8_t axis_;
    std::uint16_t offset_;
};

}  // namespace taktwerk::axes::cia402
