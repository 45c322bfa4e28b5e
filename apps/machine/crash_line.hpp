#pragma once
// The last line of a process that crashes: which signal, in which task of which program. Written by the signal handler itself.

namespace taktwerk::apps {

/// From now on SIGSEGV, SIGBUS, SIGFPE, SIGILL and SIGABRT write one line to standard error and then do what they always did (a core,
/// an exit status that names the signal). Under a sanitizer nothing: it says more itself.
void say_crashes();

}  // namespace taktwerk::apps
