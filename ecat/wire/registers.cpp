#include "ecat/wire/registers.hpp"

#include <algorithm>

#include "core/bytes.hpp"

namespace taktwerk::ecat {

void encode(const Fmmu& fmmu, std::span<std::byte, Fmmu::size> registers) noexcept {
    std::fill(registers.begin(), registers.end(), std::byte{0});
    store_le<std::uint32_t>(registers, 0, fmmu.logical_start);
    store_le<std::uint16_t>(registers, 4, fmmu.length);
    registers[6] = static_cast<std::byte>(fmmu.logical_start_bit & 7u);
    registers[7] = static_cast<std::byte>(fmmu.logical_stop_bit & 7u);
    store_le<std::uint16_t>(registers, 8, fmmu.physical_start);
    registers[10] = static_cast<std::byte>(fmmu.physical_start_bit & 7u);
    registers[11] = static_cast<std::byte>((fmmu.read ? 1u : 0u) | (fmmu.write ? 2u : 0u));
    registers[12] = static_cast<std::byte>(fmmu.active ? 1u : 0u);
}

Fmmu decode_fmmu(std::span<const std::byte, Fmmu::size> registers) noexcept {
    Fmmu fmmu;
    fmmu.logical_start = load_le<std::uint32_t>(registers, 0);
    fmmu.length = load_le<std::uint16_t>(registers, 4);
    fmmu.logical_start_bit = static_cast<std::uint8_t>(registers[6] & std::byte{7});
    fmmu.logical_stop_bit = static_cast<std::uint8_t>(registers[7] & std::byte{7});
    fmmu.physical_start = load_le<std::uint16_t>(registers, 8);
    fmmu.physical_start_bit = static_cast<std::uint8_t>(registers[10] & std::byte{7});
    fmmu.read = (registers[11] & std::byte{1}) != std::byte{0};
    fmmu.write = (registers[11] & std::byte{2}) != std::byte{0};
    fmmu.active = (registers[12] & std::byte{1}) != std::byte{0};
    return fmmu;
}

void encode(const SyncManager& sm, std::span<std::byte, SyncManager::size> registers) noexcept {
    store_le<std::uint16_t>(registers, 0, sm.start);
    store_le<std::uint16_t>(registers, 2, sm.length);
    registers[4] = static_cast<std::byte>(sm.control);
    registers[5] = static_cast<std::byte>(sm.status);
    registers[6] = static_cast<std::byte>(sm.activate);
    registers[7] = static_cast<std::byte>(sm.pdi_control);
}

SyncManager decode_sync_manager(std::span<const std::byte, SyncManager::size> registers) noexcept {
    SyncManager sm;
    sm.start = load_le<std::uint16_t>(registers, 0);
    sm.length = load_le<std::uint16_t>(registers, 2);
    sm.control = static_cast<std::uint8_t>(registers[4]);
    sm.status = static_cast<std::uint8_t>(registers[5]);
    sm.activate = static_cast<std::uint8_t>(registers[6]);
    sm.pdi_control = static_cast<std::uint8_t>(registers[7]);
    return sm;
}

}  // namespace taktwerk::ecat
