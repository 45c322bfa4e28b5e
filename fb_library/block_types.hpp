#pragma once
// Every block there is, for whoever handles blocks without knowing their C++ type.

#include <span>
#include <string_view>

#include "fb_library/block_type.hpp"

namespace taktwerk::fb {

[[nodiscard]] std::span<const BlockType> all_block_types() noexcept;
// Those of a list of all_blocks.hpp, without the compiler's time for it.
[[nodiscard]] std::span<const BlockType> iec_block_types() noexcept;
[[nodiscard]] std::span<const BlockType> motion_block_types() noexcept;  ///< beginning with axis_block_types()
[[nodiscard]] std::span<const BlockType> axis_block_types() noexcept;
[[nodiscard]] std::span<const BlockType> homing_block_types() noexcept;
[[nodiscard]] std::span<const BlockType> group_block_types() noexcept;
[[nodiscard]] std::span<const BlockType> path_block_types() noexcept;
[[nodiscard]] std::span<const BlockType> fieldbus_block_types() noexcept;

/// nullptr when there is none of that name. Not for the cycle.
[[nodiscard]] const BlockType* find_block_type(std::string_view name) noexcept;

}  // namespace taktwerk::fb
