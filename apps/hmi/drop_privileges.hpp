#pragma once
// A server of pages needs nothing that a user of this host does not have.

#include "core/result.hpp"

namespace taktwerk::apps {

/// Gives up the capabilities that the command's file brought (a bus needs them, a page does not); no process of this one gets any again. Root stays root:
/// the socket of a machine may be somebody else's. System calls that no page makes are refused (core/process_fence.hpp).
/// Errors: fence.rights, fence.system_calls.
[[nodiscard]] Result<void> drop_privileges();

}  // namespace taktwerk::apps
