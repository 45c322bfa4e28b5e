#pragma once
// The keys of an axis whose amplifier is told its velocity in volts, and of the amplifier that is played.

#include "config/reading/field_table.hpp"
#include "runtime/machine_config.hpp"

namespace taktwerk::config {

[[nodiscard]] Table<runtime::AnalogAxis> analog_table();
[[nodiscard]] Table<runtime::AnalogSimulation> analog_simulation_table();

}  // namespace taktwerk::config
