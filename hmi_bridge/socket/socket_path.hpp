#pragma once
// Where the local socket of a machine is, for the runtime that makes it and the commands that look for it.

#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace taktwerk::hmi {

/// Folders in the order they are tried: /run/taktwerk, $XDG_RUNTIME_DIR/taktwerk, /tmp/taktwerk-<uid>, and those beside it that make_socket_path()
/// has made. What lies in /tmp counts only where it is this user's: everybody may make a folder there.
[[nodiscard]] std::vector<std::string> socket_folders();

/// Path for a runtime of this user; makes the folder (0755) in the first place where that is possible. Where somebody else has taken the name in
/// /tmp it is /tmp/taktwerk-<uid>-<something>.
/// Errors: socket.no_folder.
[[nodiscard]] Result<std::string> make_socket_path(std::string_view machine);

/// Path that a command connects to: `wanted` is a path (with a slash), a machine's name, or empty when only one machine runs.
/// Errors: socket.not_found, socket.ambiguous.
[[nodiscard]] Result<std::string> find_socket(std::string_view wanted);

}  // namespace taktwerk::hmi
