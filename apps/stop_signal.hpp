#pragma once
// Ctrl-C and SIGTERM as a level that the service loop reads: the axes stop along their ramps, power goes off, then the end.

namespace taktwerk::apps {

/// From now on SIGINT and SIGTERM only set the level; a second one does not hurry a ramp.
void watch_stop_signals();
[[nodiscard]] bool stop_requested() noexcept;
/// Which signal it was, for the message; nullptr before.
[[nodiscard]] const char* stop_signal_name() noexcept;

}  // namespace taktwerk::apps
