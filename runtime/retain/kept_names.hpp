#pragma once
// The names under which items stand in the file of what is kept (kept_text.hpp): a variable's own, and of a block also one for each of its pins. Two of one
// name would make a file that nobody can read again. Service side, not real-time.

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "runtime/retain/retained_item.hpp"

namespace taktwerk::runtime {

/// A name that one of the items from `first` on has, and another one too; of those whose own names are the same it says nothing.
[[nodiscard]] std::optional<std::string> name_kept_twice(std::span<const RetainedItem> items, std::size_t first);

}  // namespace taktwerk::runtime
