#pragma once
// The sub-commands of `taktwerk lcm`.

#include "apps/taktwerk.hpp"

namespace taktwerk::apps {

void add_lcm_spy(CLI::App& lcm, Action& action);
void add_lcm_record(CLI::App& lcm, Action& action);
void add_lcm_play(CLI::App& lcm, Action& action);

}  // namespace taktwerk::apps
