#pragma once
// The units of a slave controller that give process data and mailboxes their places: FMMUs and sync managers, as their registers lay them out.
// Source: ETG.1000.4, SV33-E manual 6.2.4.

#include <cstddef>
#include <cstdint>
#include <span>

namespace taktwerk::ecat {

/// One FMMU: maps logical bits to physical memory. All offsets in bits 0..7, `length` in bytes touched on the logical side.
struct Fmmu {
    static constexpr std::size_t size = 16;
    std::uint32_t logical_start = 0;
    std::uint16_t length = 0;
    std::uint8_t logical_start_bit = 0;
    std::uint8_t logical_stop_bit = 7;  ///< last bit used in the last byte
    std::uint16_t physical_start = 0;
    std::uint8_t physical_start_bit = 0;
    bool read = false;   ///< inputs: the master reads
    bool write = false;  ///< outputs: the master writes
    bool active = false;
    friend bool operator==(const Fmmu&, const Fmmu&) = default;
};
/// The 16 register bytes; reserved ones are 0. Real-time safe.
void encode(const Fmmu& fmmu, std::span<std::byte, Fmmu::size> registers) noexcept;
[[nodiscard]] Fmmu decode_fmmu(std::span<const std::byte, Fmmu::size> registers) noexcept;

/// One sync manager.
struct SyncManager {
    static constexpr std::size_t size = 8;
    std::uint16_t start = 0;
    std::uint16_t length = 0;
    std::uint8_t control = 0;
    std::uint8_t status = 0;  ///< read only on the bus
    std::uint8_t activate = 0;
    std::uint8_t pdi_control = 0;  ///< read only on the bus

    // control
    static constexpr std::uint8_t mode_mask = 0x03, mode_buffered = 0x00, mode_mailbox = 0x02;
    static constexpr std::uint8_t direction_mask = 0x0C, master_writes = 0x04;
    static constexpr std::uint8_t ecat_interrupt = 0x10, pdi_interrupt = 0x20, watchdog_trigger = 0x40;
    static constexpr std::uint8_t usual_mailbox_out = 0x26, usual_mailbox_in = 0x22, usual_outputs = 0x64, usual_inputs = 0x20;
    // status
    static constexpr std::uint8_t interrupt_write = 0x01, interrupt_read = 0x02, mailbox_full = 0x08, buffer_mask = 0x30;
    // activate
    static constexpr std::uint8_t enable = 0x01, repeat_request = 0x02;
    // pdi_control
    static constexpr std::uint8_t pdi_deactivate = 0x01, repeat_acknowledge = 0x02;

    [[nodiscard]] constexpr bool is_mailbox() const noexcept { return (control & mode_mask) == mode_mailbox; }
    [[nodiscard]] constexpr bool is_written_by_master() const noexcept { return (control & direction_mask) == master_writes; }
    [[nodiscard]] constexpr bool enabled() const noexcept { return (activate & enable) != 0; }
    friend bool operator==(const SyncManager&, const SyncManager&) = default;
};
void encode(const SyncManager& sm, std::span<std::byte, SyncManager::size> registers) noexcept;
[[nodiscard]] SyncManager decode_sync_manager(std::span<const std::byte, SyncManager::size> registers) noexcept;
/// Offset of the status and activate bytes inside one sync manager, for single-byte access.
inline constexpr std::uint16_t sm_status_offset = 5;
inline constexpr std::uint16_t sm_activate_offset = 6;
inline constexpr std::uint16_t sm_pdi_control_offset = 7;

}  // namespace taktwerk::ecat
