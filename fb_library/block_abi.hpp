#pragma once
// What a program was compiled against: the library's part of the ABI hash. Costs the compiler seconds: for the file with a program's entry.

#include <cstdint>

#include "fb_library/all_blocks.hpp"

namespace taktwerk::fb {

namespace detail {
template <class... Blocks>
consteval std::uint64_t layouts_hash(BlockList<Blocks...>) {
    std::uint64_t hash = 0xCBF29CE484222325;
    ((hash = layout_hash(hash, block_layout<Blocks>())), ...);
    return hash;
}
}  // namespace detail

/// Differs when a block or pin is added, removed, moved, renamed or retyped.
inline constexpr std::uint64_t block_abi_hash = detail::layouts_hash(AllBlocks{});

}  // namespace taktwerk::fb
