#pragma once
// A block as bytes, for whoever handles blocks without knowing their C++ type: instance arrays, monitor, retain, virtual machine.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

#include "axes/axis/motion_context.hpp"
#include "fb_library/pins/pin.hpp"

namespace taktwerk::fb {

struct BlockType {
    std::string_view name;
    std::string_view summary;
    std::size_t size = 0, alignment = 0;
    const void* prototype = nullptr;  ///< a fresh instance: copy `size` bytes of it to make one
    /// One call of the instance at `bytes` (aligned). Real-time safe.
    void (*run)(void* bytes, const axes::MotionContext& context) noexcept = nullptr;
    /// After a reboot, on an instance whose bytes were retained: running timers go on, commands under way are CommandAborted.
    void (*warm_start)(void* bytes, Instant now) noexcept = nullptr;
    std::span<const Pin> pins;  ///< in the standard's order

    [[nodiscard]] std::span<const std::byte> prototype_bytes() const noexcept { return {static_cast<const std::byte*>(prototype), size}; }
    [[nodiscard]] constexpr const Pin* pin(std::string_view pin_name) const noexcept {
        for (const Pin& p : pins)
            if (p.name == pin_name) return &p;
        return nullptr;
    }
};

namespace detail {

template <class Block>
inline constexpr Block prototype_of{};

template <class Block>
void run_block(void* bytes, const axes::MotionContext& context) noexcept {
    (*static_cast<Block*>(bytes))(context);
}
template <class Block>
void warm_start_block([[maybe_unused]] void* bytes, [[maybe_unused]] Instant now) noexcept {
    if constexpr (requires(Block & block) { block.warm_start(now); }) static_cast<Block*>(bytes)->warm_start(now);
}

}  // namespace detail

/// What a user of the block relies on, without what runs it.
template <class Block>
[[nodiscard]] consteval BlockType block_layout() {
    return {block_name<Block>(), {}, sizeof(Block), alignof(Block), nullptr, nullptr, nullptr, pins_of<Block>};
}

template <class Block>
[[nodiscard]] consteval BlockType block_type() {
    static_assert(std::is_trivially_copyable_v<Block> && std::is_trivially_destructible_v<Block>,
                  "a block is plain data: it is copied, kept and dropped as bytes");
    return {block_name<Block>(),
            Block::summary,
            sizeof(Block),
            alignof(Block),
            &detail::prototype_of<Block>,
            &detail::run_block<Block>,
            &detail::warm_start_block<Block>,
            pins_of<Block>};
}

/// FNV-1a over what a user of the block relies on: name, size, alignment and each pin's name, direction, type (with
/// the values of an enumeration) and place.
[[nodiscard]] constexpr std::uint64_t layout_hash(std::uint64_t hash, const BlockType& block) noexcept {
    const auto number = [&hash](std::uint64_t value) {
        for (int i = 0; i < 8; ++i) hash = (hash ^ ((value >> (8 * i)) & 0xFF)) * 0x100000001B3;
    };
    const auto text = [&hash, &number](std::string_view value) {
        number(value.size());
        for (const char c : value) hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x100000001B3;
    };
    text(block.name);
    number(block.size);
    number(block.alignment);
    for (const Pin& pin : block.pins) {
        text(pin.name);
        text(pin.type.name);
        number(static_cast<std::uint64_t>(pin.direction));
        number(pin.offset);
        number(pin.size);
        for (const auto value : pin.type.values) text(value);
    }
    return hash;
}

}  // namespace taktwerk::fb
