#pragma once
// Every block there is, for whoever handles blocks without knowing their C++ type.

#include <span>
#include <string_view>

#include "fb_library/block_type.hpp"

namespace taktwerk::fb {

[[nodiscard]] std::span<const BlockType> all_block_types() noexcept;

/// nullptr when there is none of that name. Not for the cycle.
[[nodiscard]] const BlockType* find_block_type(std::string_view name) noexcept;

}  // namespace taktwerk::fb
