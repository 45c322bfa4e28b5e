#pragma once
// What a program was compiled against: the library's part of the ABI hash. Costs the compiler seconds: for the file with a program's entry.

#include <cstdint>

#include "fb_library/all_blocks.hpp"

namespace taktwerk::fb {

/// Differs when a block or pin is added, removed, moved, renamed or retyped.
inline constexpr std::uint64_t block_abi_hash = [] {
    std::uint64_t hash = 0xCBF29CE484222325;
    for (const BlockType& type : types_of<AllBlocks>) hash = layout_hash(hash, type);
    return hash;
}();

}  // namespace taktwerk::fb
