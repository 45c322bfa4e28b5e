#include "fb_library/block_types.hpp"

#include "fb_library/all_blocks.hpp"

namespace taktwerk::fb {

namespace {

consteval bool names_differ() {
    constexpr auto& types = types_of<AllBlocks>;
    for (std::size_t i = 0; i < types.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (types[i].name == types[j].name) return false;
    return true;
}
static_assert(names_differ());

}  // namespace

std::span<const BlockType> all_block_types() noexcept { return types_of<AllBlocks>; }

const BlockType* find_block_type(std::string_view name) noexcept {
    for (const BlockType& type : all_block_types())
        if (type.name == name) return &type;
    return nullptr;
}

}  // namespace taktwerk::fb
