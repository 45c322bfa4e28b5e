#pragma once
// What people call the numbers in an EEPROM. Pure; not real-time.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat {

/// "strings", "sync managers"; "category 2048" for a vendor's own.
[[nodiscard]] std::string sii_category_name(std::uint16_t type);
[[nodiscard]] std::string_view name(SiiSyncManagerUse use) noexcept;
[[nodiscard]] std::string_view name(SiiFmmuUse use) noexcept;
/// "CoE", "FoE".
[[nodiscard]] std::vector<std::string> sii_protocol_names(std::uint16_t protocols);
/// "SDO information", "complete access".
[[nodiscard]] std::vector<std::string> sii_coe_names(std::uint8_t details);
/// "0 MII, 1 E-bus"; empty: none is said.
[[nodiscard]] std::string sii_ports_text(std::uint16_t ports);

}  // namespace taktwerk::ecat
