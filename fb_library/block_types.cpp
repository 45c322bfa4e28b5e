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

template <class... Blocks>
consteval std::size_t size_of(BlockList<Blocks...>) {
    return sizeof...(Blocks);
}
// In the order of AllBlocks.
constexpr std::size_t motion_begins = size_of(IecBlocks{}), homing_begins = motion_begins + size_of(MotionBlocks{}),
                      groups_begin = homing_begins + size_of(HomingBlocks{}), paths_begin = groups_begin + size_of(GroupBlocks{}),
                      fieldbus_begins = paths_begin + size_of(PathBlocks{});
static_assert(fieldbus_begins + size_of(FieldbusBlocks{}) == size_of(AllBlocks{}));

std::span<const BlockType> part(std::size_t begin, std::size_t end) noexcept { return all_block_types().subspan(begin, end - begin); }

}  // namespace

std::span<const BlockType> all_block_types() noexcept { return types_of<AllBlocks>; }

std::span<const BlockType> iec_block_types() noexcept { return part(0, motion_begins); }
std::span<const BlockType> motion_block_types() noexcept { return part(motion_begins, homing_begins); }
std::span<const BlockType> axis_block_types() noexcept { return part(motion_begins, motion_begins + size_of(AxisBlocks{})); }
std::span<const BlockType> homing_block_types() noexcept { return part(homing_begins, groups_begin); }
std::span<const BlockType> group_block_types() noexcept { return part(groups_begin, paths_begin); }
std::span<const BlockType> path_block_types() noexcept { return part(paths_begin, fieldbus_begins); }
std::span<const BlockType> fieldbus_block_types() noexcept { return part(fieldbus_begins, size_of(AllBlocks{})); }

const BlockType* find_block_type(std::string_view name) noexcept {
    for (const BlockType& type : all_block_types())
        if (type.name == name) return &type;
    return nullptr;
}

}  // namespace taktwerk::fb
