#pragma once
// A drive file that says only what its drive has of its own: `based_on: cia402`. The rest is that file's.

#include <string>
#include <vector>

#include "config/reading/document.hpp"

namespace taktwerk::config {

/// `own` over `base`. Sections that stand in both are merged where each key counts for itself (motion, mailbox, dc, behaviour), `objects` row
/// by row; everything else is the one or the other. Assumptions of the base that `own` states (their `unless`) are gone. What comes of the base
/// stands at the place of `based_on`.
[[nodiscard]] Node merged_drive(const Node& own, const Node& base);

/// The place of a key ("motion.modes") in a tree; nullptr: it is not there.
[[nodiscard]] const Node* find_path(const Node& node, std::string_view path) noexcept;

/// What of it stands in the file `path` and, where it is based on another, in that one; it is looked up beside it, then in `folders`.
/// Further errors: config.based_on.
[[nodiscard]] Document read_drive_document(const std::string& path, const std::vector<std::string>& folders);

}  // namespace taktwerk::config
