#pragma once
// The EEPROM of a device as its vendor's ESI file describes it (ETG.2000 to ETG.2010), as a configuration tool would write it. Pure; not real-time.

#include <cstddef>
#include <string>
#include <vector>

#include "ecat/esi/esi_device.hpp"
#include "ecat/wire/sii.hpp"

namespace taktwerk::ecat::esi {

struct EsiImage {
    std::vector<std::byte> bytes;
    std::vector<std::string> leftovers;  ///< what the file says and an EEPROM cannot hold, or what the file leaves open
};

/// Modules are not in an EEPROM. Alias and serial number are 0. Where the file holds the whole image (Eeprom/Data), that.
[[nodiscard]] EsiImage esi_image(const EsiDevice& device);

/// The fields of it; `leftovers` grows.
[[nodiscard]] Sii sii_of(const EsiDevice& device, std::vector<std::string>& leftovers);

}  // namespace taktwerk::ecat::esi
