#pragma once
// What the maker has mapped is allowed, even where the general rule forbids it.

#include <algorithm>
#include <cstdint>

#include "ecat/description/device_description.hpp"

namespace taktwerk::ecat {

/// Does a PDO of the factory map just these bits of the object? Fewer than the object has are refused otherwise (SE-808X 3.1.2 maps
/// 60FDh, of 32 bits, as 60FD0010h). Any thread; linear in the PDOs.
[[nodiscard]] inline bool mapped_by_maker(const DeviceDescription& device, std::uint16_t index, std::uint8_t sub, std::uint32_t bits,
                                          bool rx) noexcept {
    const auto& pdos = rx ? device.rx_pdos : device.tx_pdos;
    return std::any_of(pdos.begin(), pdos.end(), [&](const PdoDescription& pdo) {
        return std::any_of(pdo.entries.begin(), pdo.entries.end(),
                           [&](const PdoEntry& entry) { return entry.index == index && entry.sub == sub && entry.bits == bits; });
    });
}

}  // namespace taktwerk::ecat
