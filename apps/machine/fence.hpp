#pragma once
// What a machine in real time gives up before its file is read and its programs are loaded (docs/security.md).

#include "core/result.hpp"

namespace taktwerk::apps {

/// Of root's rights those stay that a bus, a real-time thread, locked memory, ports and files of other owners need; system calls that no controller
/// makes are refused. Errors: fence.rights, fence.system_calls: the machine runs as well without.
[[nodiscard]] Result<void> fence_machine();

}  // namespace taktwerk::apps
