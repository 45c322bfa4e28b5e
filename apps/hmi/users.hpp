#pragma once
// taktwerk hmi user add|remove|list|passwd: who may log in at the page.

#include "apps/taktwerk.hpp"

namespace taktwerk::apps {

void add_hmi_users(CLI::App& hmi, Action& action);

}  // namespace taktwerk::apps
