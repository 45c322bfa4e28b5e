// taktwerk lcm: what is said over LCM.

#include "apps/lcm/lcm.hpp"

namespace taktwerk::apps {

void add_lcm(CLI::App& app, Action& action) {
    auto* lcm = app.add_subcommand("lcm", "what machines say over LCM: looked at, kept in a file, said again");
    lcm->require_subcommand(1);
    add_lcm_spy(*lcm, action);
    add_lcm_record(*lcm, action);
    add_lcm_play(*lcm, action);
}

}  // namespace taktwerk::apps
