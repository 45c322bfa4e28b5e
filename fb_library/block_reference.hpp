#pragma once
// The reference page of all blocks, made from their pin tables.

#include <string>

namespace taktwerk::fb {

/// Markdown: one section a block with its pins, types, units and notes, then the values of the enumerations. Not for the cycle.
[[nodiscard]] std::string block_reference_markdown();

}  // namespace taktwerk::fb
