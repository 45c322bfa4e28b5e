#pragma once
// Names of data types in ESI files, and the types of our dictionaries. ETG.2000 and ETG.1020 names, and those of CiA 301 that vendors write.

#include <optional>
#include <string_view>

#include "ecat/description/device_description.hpp"

namespace taktwerk::ecat::esi {

/// "UINT", "BIT3", "STRING(8)", "UNSIGNED16". Nothing: a type that our dictionaries do not have (ARRAY OF BYTE, UINT24, a type of the file).
[[nodiscard]] std::optional<DataType> basic_type(std::string_view name);

}  // namespace taktwerk::ecat::esi
