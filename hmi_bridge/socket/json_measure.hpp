#pragma once
// Measurements as JSON: what is ordered, the path before it is driven, the numbers and curves afterwards. README.md has the keys. Not real-time.

#include <string>

#include "axes/axis/axis_config.hpp"
#include "axes/excitation/excitation_plan.hpp"
#include "hmi_bridge/gateway/measurements.hpp"
#include "hmi_bridge/socket/json_fields.hpp"

namespace taktwerk::hmi {

/// Keys kind, count, distance, velocity, acceleration, from_hz, to_hz, period; a problem stays in `fields`.
[[nodiscard]] axes::MeasureOrder read_measure_order(JsonFields& fields);

[[nodiscard]] std::string plan_json(const axes::ExcitationPlan& plan, const std::string& unit);

/// `window`: u, for settling; 0: the axis' in-position window.
[[nodiscard]] std::string result_json(const Measurements::Run& run, const axes::AxisConfig& config, double window);

}  // namespace taktwerk::hmi
