#pragma once
// The EEPROM content of a simulated slave, made from what its description says. Not real-time.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ecat/description/device_description.hpp"

namespace taktwerk::ecat::sim {

[[nodiscard]] std::vector<std::byte> sii_image(const DeviceDescription& description, std::uint16_t alias, std::uint8_t general_flags = 0);

}  // namespace taktwerk::ecat::sim
