#pragma once
// What `taktwerk gcode check --json` says. Pure.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/gcode/summary_text.hpp"

namespace taktwerk::apps {

/// {"ok":true, ..., "warnings":[...]}; lengths in mm, feeds in mm/min, times in s.
[[nodiscard]] nlohmann::ordered_json program_json(const CheckedProgram& program, const std::string& name);
/// {"ok":false, "errors":[...]}.
[[nodiscard]] nlohmann::ordered_json program_errors_json(const std::vector<Error>& errors);

}  // namespace taktwerk::apps
