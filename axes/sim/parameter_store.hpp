#pragma once
// The parameters of a simulated drive over power cycles: what stands in its RAM, what in its EEPROM, and with what it works.
// Any drive: each write is stored (SV33-E 7.2, P05.10; and where a manual is silent), stored on request (SE-808X 1010h, XP200 function 41h) or never (TSVM).
// Knows no bus: whoever has one asks refuse() before write(). Not for the cycle of a real drive; allocates when it is made only.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::sim {

class ParameterStore {
public:
    enum class Refusal : std::uint8_t { none, unknown, read_only, too_high, too_low, enabled };

    /// Keeps what can be written of `profile.parameters`, of each axis of the drive, except its actions and `transient` addresses: commands
    /// and set-points, that start at their factory value at each power-on.
    ParameterStore(const DriveProfile& profile, std::span<const ParameterAddress> transient);

    /// Whether the drive takes the value now; `enabled`: its motor is powered.
    [[nodiscard]] Refusal refuse(ParameterAddress at, std::int64_t value, bool enabled) const noexcept;
    /// A write from outside that was not refused. Stores it too where this drive does so.
    void write(ParameterAddress at, std::int64_t value, Instant now) noexcept;

    /// In its EEPROM since before the power came: it wears nothing.
    void commission(ParameterAddress at, std::int64_t value) noexcept;
    /// The control supply comes: RAM is what the EEPROM holds, and all of it counts.
    void power_on() noexcept;
    /// All of RAM into the EEPROM.
    void save(Instant now) noexcept;
    /// Factory values into the EEPROM; they count from the next power_on().
    void restore_factory(Instant now) noexcept;

    /// As it is read; nothing for addresses that are not kept.
    [[nodiscard]] std::optional<std::int64_t> value(ParameterAddress at) const noexcept;
    /// With what the drive works: of parameters that count after a restart, the value at power-on.
    [[nodiscard]] std::optional<std::int64_t> acting(ParameterAddress at) const noexcept;
    /// A parameter that counts after a restart was changed (SV33-E A.426).
    [[nodiscard]] bool restart_pending() const noexcept;
    /// Cells of the EEPROM written so far: what wears it.
    [[nodiscard]] std::uint64_t eeprom_writes() const noexcept { return eeprom_writes_; }
    /// "Very often and massively" (SV33-E 5.5, A.427): more than `often` cells within `window`. The manual gives no numbers.
    static constexpr std::uint32_t often = 100;
    static constexpr Duration window = std::chrono::seconds{10};
    [[nodiscard]] bool writes_too_often(Instant now) const noexcept;

    struct Cell {
        ParameterAddress address;
        std::int64_t factory = 0, ram = 0, eeprom = 0, acting = 0;
        std::optional<std::int64_t> minimum{}, maximum{};
        ParameterEffect effect = ParameterEffect::at_once;
        ParameterChange change = ParameterChange::any_time;
        bool transient = false;
    };
    [[nodiscard]] std::span<const Cell> cells() const noexcept { return cells_; }

private:
    [[nodiscard]] const Cell* find(ParameterAddress at) const noexcept;
    [[nodiscard]] bool stores_writes_to(const Cell& cell) const noexcept;
    void burn(Cell& cell, std::int64_t value, Instant now) noexcept;

    std::vector<Cell> cells_;  ///< ascending
    ParameterStorage storage_;
    ParameterAddress storage_switch_;
    std::uint64_t eeprom_writes_ = 0;
    std::vector<Instant> recent_;  ///< when the last `often` + 1 cells were written, a ring
    std::size_t next_recent_ = 0;
};

}  // namespace taktwerk::axes::sim
