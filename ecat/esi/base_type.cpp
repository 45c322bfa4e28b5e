#include "ecat/esi/base_type.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "ecat/esi/esi_number.hpp"

namespace taktwerk::ecat::esi {

namespace {

using Named = std::pair<std::string_view, DataType>;

constexpr std::array<Named, 53> names{{
    {"BOOL", DataType::BOOL},
    {"BOOLEAN", DataType::BOOL},
    {"BIT", DataType::BOOL},
    {"BIT1", DataType::BOOL},
    {"BIT2", DataType::U8},
    {"BIT3", DataType::U8},
    {"BIT4", DataType::U8},
    {"BIT5", DataType::U8},
    {"BIT6", DataType::U8},
    {"BIT7", DataType::U8},
    {"BIT8", DataType::U8},
    {"BITARR8", DataType::U8},
    {"BYTE", DataType::U8},
    {"USINT", DataType::U8},
    {"UINT8", DataType::U8},
    {"UNSIGNED8", DataType::U8},
    {"BIT9", DataType::U16},
    {"BIT10", DataType::U16},
    {"BIT11", DataType::U16},
    {"BIT12", DataType::U16},
    {"BIT13", DataType::U16},
    {"BIT14", DataType::U16},
    {"BIT15", DataType::U16},
    {"BIT16", DataType::U16},
    {"BITARR16", DataType::U16},
    {"WORD", DataType::U16},
    {"UINT", DataType::U16},
    {"UINT16", DataType::U16},
    {"UNSIGNED16", DataType::U16},
    {"BITARR32", DataType::U32},
    {"DWORD", DataType::U32},
    {"UDINT", DataType::U32},
    {"UINT32", DataType::U32},
    {"UNSIGNED32", DataType::U32},
    {"ULINT", DataType::U64},
    {"LWORD", DataType::U64},
    {"UNSIGNED64", DataType::U64},
    {"SINT", DataType::I8},
    {"INT8", DataType::I8},
    {"INTEGER8", DataType::I8},
    {"INT", DataType::I16},
    {"INT16", DataType::I16},
    {"INTEGER16", DataType::I16},
    {"DINT", DataType::I32},
    {"INT32", DataType::I32},
    {"INTEGER32", DataType::I32},
    {"LINT", DataType::I64},
    {"INTEGER64", DataType::I64},
    {"REAL", DataType::REAL32},
    {"REAL32", DataType::REAL32},
    {"LREAL", DataType::REAL64},
    {"REAL64", DataType::REAL64},
    {"VISIBLE_STRING", DataType::STRING},
}};

}  // namespace

std::optional<DataType> basic_type(std::string_view name) {
    name = trimmed(name);
    if (name.rfind("STRING", 0) == 0) return DataType::STRING;
    const auto found = std::find_if(names.begin(), names.end(), [&](const Named& one) { return one.first == name; });
    return found == names.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace taktwerk::ecat::esi
