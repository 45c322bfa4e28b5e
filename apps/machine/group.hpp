#pragma once
// `taktwerk group`: what a person may ask of axes that move together.

#include "apps/taktwerk.hpp"

namespace taktwerk::apps {

void add_group(CLI::App& app, Action& action);

}  // namespace taktwerk::apps
