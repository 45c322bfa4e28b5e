#pragma once
// Words for what an ESI file says in letters and numbers.

#include <string>

#include "ecat/esi/esi_device.hpp"

namespace taktwerk::apps {

[[nodiscard]] const char* esi_use_name(ecat::SmUse use);
[[nodiscard]] const char* esi_access_name(ecat::Access access);
/// "rx", "tx", "rx tx", nothing.
[[nodiscard]] const char* esi_mappable_name(ecat::Mappable mappable);
/// Physics: a letter a port. "YK" -> "ports: cable, E-bus".
[[nodiscard]] std::string esi_ports_text(const std::string& physics);
/// SYNC0 or SYNC1 of a mode: "1000 us", "bus cycle / 2, shift 10 us", "off".
[[nodiscard]] std::string esi_sync_text(const ecat::esi::EsiOpMode& mode, unsigned signal);

}  // namespace taktwerk::apps
