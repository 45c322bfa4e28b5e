#pragma once
// The `taktwerk` command. Each sub-command registers itself on the CLI11 application and returns an exit code (apps/terminal/exit_code.hpp).

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

namespace taktwerk::apps {

/// What a sub-command leaves to be run after parsing.
using Action = std::function<int()>;

int run(int argc, char** argv);

// One line a sub-command; each lives in its own file.
void add_run(CLI::App& app, Action& action);
void add_record(CLI::App& app, Action& action);  ///< the run so far is kept
void add_replay(CLI::App& app, Action& action);  ///< a recording of `run --record` again
void add_check(CLI::App& app, Action& action);
void add_sim(CLI::App& app, Action& action);
void add_simulate(CLI::App& app, Action& action);
void add_bus(CLI::App& app, Action& action);    ///< scan, state, pdo, sdo, dc, counters, why
void add_drive(CLI::App& app, Action& action);  ///< identify, params, get, set, save, restore, diff, alarms, reset
void add_esi(CLI::App& app, Action& action);    ///< list, show, import
void add_plot(CLI::App& app, Action& action);
void add_gcode(CLI::App& app, Action& action);  ///< check, plot
/// Measures an axis while it is held.
void add_measure(CLI::App& app, Action& action);
void add_hmi(CLI::App& app, Action& action);     ///< the page's server
void add_lcm(CLI::App& app, Action& action);     ///< spy, record, play
void add_status(CLI::App& app, Action& action);  ///< is a running machine well?
void add_monitor(CLI::App& app, Action& action);
void add_operate(CLI::App& app, Action& action);  ///< jog, home, enable, reset, start, stop, set, mode, ...
void add_alarms(CLI::App& app, Action& action);   ///< of a running machine: those that stand, and the history
void add_retain(CLI::App& app, Action& action);   ///< show, export, import, clear what is kept over a time without power
void add_bundle(CLI::App& app, Action& action);   ///< make, keygen, show, install, activate, rollback, list, diff, remove
void add_doctor(CLI::App& app, Action& action);   ///< is this computer fit for a cycle?
void add_diag(CLI::App& app, Action& action);     ///< everything about a machine in one file
void add_docs(CLI::App& app, Action& action);     ///< generated reference: blocks, configuration, alarms, errors

}  // namespace taktwerk::apps
