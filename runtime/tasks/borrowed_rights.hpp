#pragma once
// Rights that a process has from its file (capabilities by setcap, set-user-ID) and not from whoever called it. What a caller brings along, a
// program or a path, must not get them. The right way to give the runtime its rights is a service (docs/bus.md). Not real-time.

#include <string>

#include "core/result.hpp"

namespace taktwerk::runtime {

/// Has this process, now, rights that its caller has not.
[[nodiscard]] bool rights_are_borrowed() noexcept;

/// Gives them up for good, and cannot get them again. One thread so far. Nothing where there are none.
/// Errors: rights.kept.
[[nodiscard]] Result<void> give_back_rights();

/// Nobody but root can put something else in the place of this file: it and every folder above it are root's, and others may not write them.
[[nodiscard]] bool belongs_to_root(const std::string& path);

}  // namespace taktwerk::runtime
