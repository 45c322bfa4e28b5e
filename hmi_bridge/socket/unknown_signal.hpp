#pragma once
// The error for a signal that there is not.

#include <string>

#include "core/result.hpp"
#include "runtime/recording/signal_rows.hpp"

namespace taktwerk::hmi {

/// Code scope.unknown_signal, with the nearest name that there is.
[[nodiscard]] Error unknown_signal(const runtime::SignalRows& rows, const std::string& name);

}  // namespace taktwerk::hmi
