#pragma once
// The parameter table of a simulated XP200: working memory, EEPROM behind it, ranges, and values that count only after a restart
// (manual 3.4, 3.5, 9.4). Words as on the wire; signed ones in two's complement.

#include <array>
#include <cstdint>
#include <vector>

#include "axes/drives/xp200/registers.hpp"
#include "axes/port/drive_parameter.hpp"
#include "modbus/wire/frame.hpp"

namespace taktwerk::axes::sim::xp200 {

class Parameters {
public:
    /// Rows as the profile has them; addresses without a row are reserved. Starts with the factory values.
    explicit Parameters(const std::vector<DriveParameter>& rows);

    /// Reserved ones read 0. Error: illegal_address beyond 249.
    [[nodiscard]] modbus::ExceptionCode read(std::uint16_t address, std::uint16_t& word) const noexcept;
    /// Errors (which of them the manual does not say): illegal_address for a reserved one, illegal_value out of range, device_failure for
    /// one that cannot be written. Pr002 and Pr099 without the password are not changed, without an error (5.4.1).
    [[nodiscard]] modbus::ExceptionCode write(std::uint16_t address, std::uint16_t word) noexcept;

    /// What holds now: of those that need a restart the value at the last one.
    [[nodiscard]] std::int64_t operator[](std::uint16_t number) const noexcept;
    /// Working memory into the EEPROM, whole (9.6.6).
    void save() noexcept { stored_ = memory_; }
    /// Power on: working memory from the EEPROM, everything counts.
    void restart() noexcept;
    /// As if set at the panel and saved there before.
    void commission(std::uint16_t number, std::int64_t value) noexcept;

private:
    struct Row {
        bool documented = false, read_only = false, is_signed = false, after_restart = false;
        std::int64_t low = 0, high = 0xFFFF;
    };
    [[nodiscard]] std::int64_t value(std::uint16_t number, std::uint16_t word) const noexcept;

    std::array<Row, axes::xp200::parameter_count> rows_{};
    std::array<std::uint16_t, axes::xp200::parameter_count> memory_{}, stored_{}, in_force_{};
};

}  // namespace taktwerk::axes::sim::xp200
