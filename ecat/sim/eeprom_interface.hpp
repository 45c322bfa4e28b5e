#pragma once
// The EEPROM interface of a slave controller (0500h..050Fh): commands take machine time, the busy bit stands until then.
// Reads deliver 8 bytes, or 4 as older controllers do. Source: ETG.1000.4, reference/ethercat-masters.md section 5.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/time.hpp"

namespace taktwerk::ecat::sim {

/// What can be wrong with a memory and its interface.
struct EepromFaults {
    bool stays_busy = false;                   ///< a command that was begun never ends
    std::uint32_t refused = 0;                 ///< so many commands more are not acknowledged by the memory
    std::optional<std::uint32_t> worn_word{};  ///< writing it is acknowledged, and changes nothing
    bool write_protected = false;              ///< the controller never takes the enable bit
    bool held_by_application = false;          ///< its processor takes the EEPROM again at once whatever 0500h says
};

class EepromInterface {
public:
    /// `image`: little-endian words as SII tools store them.
    EepromInterface(std::vector<std::byte> image, Duration read_time, Duration write_time, bool reads_8_bytes = true);

    /// A write to 0502h/0503h; `control` is the word as it came from the bus. Commands while busy are ignored.
    void control_written(std::uint16_t control, Instant now) noexcept;
    void address_written(std::uint32_t word) noexcept { address_ = word; }
    void data_written(std::uint16_t data) noexcept { write_data_ = data; }
    /// What 0502h reads.
    [[nodiscard]] std::uint16_t status() const noexcept;
    [[nodiscard]] std::uint32_t address() const noexcept { return address_; }
    [[nodiscard]] std::span<const std::byte, 8> data() const noexcept { return data_; }

    [[nodiscard]] bool busy() const noexcept { return busy_; }
    [[nodiscard]] Instant due() const noexcept { return due_; }  ///< only when busy()
    /// The running command ends. True when it was a reload: the controller takes its configuration words again.
    [[nodiscard]] bool complete() noexcept;
    void power_on() noexcept;

    [[nodiscard]] std::uint16_t word(std::uint32_t address) const noexcept;  ///< FFFFh beyond the end
    /// CRC-8 over words 0..6 matches word 7. Without it the controller loads neither alias nor PDI settings.
    [[nodiscard]] bool checksum_ok() const noexcept;
    [[nodiscard]] std::vector<std::byte>& image() noexcept { return image_; }
    /// For tests: what is wrong from now on. Not even a power cycle mends it.
    [[nodiscard]] EepromFaults& faults() noexcept { return faults_; }

private:
    enum class Running : std::uint8_t { none, read, write, reload };

    std::vector<std::byte> image_;
    Duration read_time_, write_time_;
    bool reads_8_bytes_;
    EepromFaults faults_;
    std::byte data_[8]{};
    std::uint32_t address_ = 0;
    std::uint16_t write_data_ = 0;
    std::uint16_t errors_ = 0;
    Running running_ = Running::none;
    bool busy_ = false;
    Instant due_{};
};

}  // namespace taktwerk::ecat::sim
