#pragma once
// What a slave checks when the master writes a PDO mapping (16xxh, 1Axxh) or assignment (1C12h, 1C13h).
// Source: ETG.1000.6 5.6.7.4, CiA 301 7.4.1, SV33-E manual 6.2.9 (count to 0, entries, count to n; only in PREOP).

#include <cstdint>

#include "ecat/description/device_description.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::ecat::sim {

/// SDO abort code for writing `value` to `entry`; 0 accepts. Entries whose role is `plain` are always accepted.
[[nodiscard]] std::uint32_t refuse_pdo_write(const DeviceDescription& description, const ObjectDictionary& dictionary, const Entry& entry,
                                             std::int64_t value, EsmState state) noexcept;

}  // namespace taktwerk::ecat::sim
