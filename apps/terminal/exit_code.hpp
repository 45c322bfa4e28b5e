#pragma once
// How the command ends, for scripts. Documented in docs/command-line.md and `taktwerk --help`.

namespace taktwerk::apps {

enum ExitCode : int {
    exit_ok = 0,
    exit_warnings = 1,    ///< `doctor`: fit, with warnings
    exit_usage = 2,       ///< wrong arguments
    exit_bad_file = 3,    ///< a configuration, program or trace is wrong or missing
    exit_bus = 4,         ///< the bus did not come up, or the NIC cannot be used
    exit_refused = 5,     ///< the running machine refused the command
    exit_no_runtime = 6,  ///< no running machine to talk to
    exit_realtime = 7,    ///< real time was required and is not there
    exit_alarm = 8,       ///< the run ended with a machine-wide alarm standing
    exit_hung = 9,        ///< the run was told to end and could not: something hangs, and the process was ended as it was
    exit_differs = 10,    ///< a replay did something else than was recorded
};

}  // namespace taktwerk::apps
