#pragma once
// The text of a .lcm file: structs with their fields, constants, and the comment that stands behind each. Not real-time.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::hmi {

struct LcmDimension {
    std::string size;         ///< as written: a number, or the field that has the count
    std::int64_t fixed = -1;  ///< of a number; -1: a field has it
};

struct LcmField {
    std::string type;  ///< "int32_t", or "package.name" of another struct
    std::string name;
    std::string comment;  ///< behind it on its line; may be empty
    std::vector<LcmDimension> dimensions;
};

struct LcmConstant {
    std::string name;
    std::int64_t value = 0;  ///< of whole ones; others are left out
};

struct LcmType {
    std::string package, name;
    std::vector<LcmField> fields;
    std::vector<LcmConstant> constants;
    [[nodiscard]] std::string full_name() const { return package.empty() ? name : package + "." + name; }
};

[[nodiscard]] bool is_primitive(std::string_view type) noexcept;

/// `file`: for the errors. Errors: lcm.type_text (enums are not taken: LCM itself has given them up).
[[nodiscard]] Result<std::vector<LcmType>> parse_lcm_text(std::string_view text, const std::string& file);

}  // namespace taktwerk::hmi
