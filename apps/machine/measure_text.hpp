#pragma once
// A measurement in words and as CSV, from the JSON of the socket (hmi_bridge/README.md).

#include <string>

#include <nlohmann/json.hpp>

#include "core/result.hpp"

namespace taktwerk::apps {

/// "step: moves between 120 and 130 mm at up to 20 mm/s and 500 mm/s2, 6.2 s"
[[nodiscard]] std::string plan_text(const nlohmann::ordered_json& plan);
/// Lines, each with its newline.
[[nodiscard]] std::string result_text(const nlohmann::ordered_json& result);
/// Every curve of the result, one below the other. Errors: file.write.
[[nodiscard]] Result<void> write_curves(const nlohmann::ordered_json& result, const std::string& file);

}  // namespace taktwerk::apps
