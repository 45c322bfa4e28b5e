#pragma once
// The CoE number of a description's data type: what simulated slaves answer and the diagnosis shows. Source: ETG.1000.6.

#include <cstdint>

#include "ecat/description/device_description.hpp"
#include "ecat/wire/sdo_info.hpp"

namespace taktwerk::ecat {

[[nodiscard]] constexpr std::uint16_t type_number(DataType type) noexcept {
    switch (type) {
        case DataType::BOOL: return coe_type::boolean;
        case DataType::I8: return coe_type::integer8;
        case DataType::I16: return coe_type::integer16;
        case DataType::I32: return coe_type::integer32;
        case DataType::I64: return coe_type::integer64;
        case DataType::U8: return coe_type::unsigned8;
        case DataType::U16: return coe_type::unsigned16;
        case DataType::U32: return coe_type::unsigned32;
        case DataType::U64: return coe_type::unsigned64;
        case DataType::REAL32: return coe_type::real32;
        case DataType::REAL64: return coe_type::real64;
        case DataType::STRING: return coe_type::visible_string;
    }
    return 0;
}

}  // namespace taktwerk::ecat
