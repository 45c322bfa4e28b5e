#pragma once
// The sub-commands of `taktwerk gcode`.

#include "apps/taktwerk.hpp"

namespace taktwerk::apps {

void add_gcode_check(CLI::App& gcode, Action& action);
void add_gcode_plot(CLI::App& gcode, Action& action);
void add_gcode_run(CLI::App& gcode, Action& action);

}  // namespace taktwerk::apps
