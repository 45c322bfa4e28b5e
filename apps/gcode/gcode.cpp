// taktwerk gcode: programs of moves, without a machine that runs.

#include "apps/gcode/gcode.hpp"

namespace taktwerk::apps {

void add_gcode(CLI::App& app, Action& action) {
    auto* gcode = app.add_subcommand(
        "gcode", "G-code programs: what is wrong with one, what is in it, what it looks like, what a machine makes of it");
    gcode->require_subcommand(1);
    add_gcode_check(*gcode, action);
    add_gcode_plot(*gcode, action);
    add_gcode_run(*gcode, action);
}

}  // namespace taktwerk::apps
