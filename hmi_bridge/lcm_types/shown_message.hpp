#pragma once
// A message as people read it: "set_position: 12.5 mm". Not real-time.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "hmi_bridge/lcm_types/type_catalog.hpp"

namespace taktwerk::hmi {

/// `message`: of read_message(). The unit is what the field's comment begins with ("u/s, measured"); u is the text of the field `unit` of the same struct. A comment that names
/// constants ("STATE_...") puts the constant's word behind the number. An array of structs has a line for each field of each.
[[nodiscard]] std::vector<std::string> shown_lines(const TypeCatalog& catalog, const LcmType& type, const nlohmann::ordered_json& message);

/// The unit that a comment begins with; empty: none. "us since 1970" is one.
[[nodiscard]] std::string unit_in(std::string_view comment);

}  // namespace taktwerk::hmi
