#pragma once
// taktwerk jog: see jog.cpp.

#include <CLI/CLI.hpp>

#include "apps/taktwerk.hpp"

namespace taktwerk::apps {

void add_jog(CLI::App& app, Action& action);

}  // namespace taktwerk::apps
