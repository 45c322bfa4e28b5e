#pragma once
// What of a slave's process data is known before the bus is there. Not real-time.

#include <string_view>
#include <vector>

#include "runtime/machine_config.hpp"

namespace taktwerk::runtime {

/// The objects in one way of a slave's process data as far as they are known without it; empty: they are not.
[[nodiscard]] std::vector<ecat::PdoEntry> mapped(const ecat::PdoSelection& selection, const std::vector<ecat::PdoDescription>& known,
                                                 const std::vector<std::uint16_t>& assigned);

/// Bits of an input or output by its name, as far as its slave is known without the bus; 0: it is not.
[[nodiscard]] unsigned bits_of_point(const MachineConfig& config, std::string_view name, IoDirection direction);

/// How often the process data of a slave is exchanged; the machine's cycle where there is none of this name.
[[nodiscard]] Duration exchange_period_of(const MachineConfig& config, std::string_view slave);

}  // namespace taktwerk::runtime
