#include "ecat/eoe/frame_assembly.hpp"

#include <algorithm>

#include "ecat/eoe/frame_cutter.hpp"

namespace taktwerk::ecat {

void FrameAssembly::drop() noexcept {
    ++dropped_;
    due_ = 0;
}

std::optional<std::span<const std::byte>> FrameAssembly::take(const EoeFragment& fragment) noexcept {
    if (fragment.number == 0) {
        if (due_ != 0) drop();
        frame_ = fragment.frame;
        size_ = 0;
        announced_ = std::size_t{fragment.blocks} * eoe_block;
    } else if (due_ == 0 || fragment.number != due_ || fragment.frame != frame_ || std::size_t{fragment.blocks} * eoe_block != size_) {
        // The rest of a frame that was dropped is counted once.
        if (due_ != 0) drop();
        return std::nullopt;
    }
    const bool whole_blocks = fragment.data.size() % eoe_block == 0 && !fragment.data.empty();
    const bool fits = size_ + fragment.data.size() <= std::min(announced_, bytes_.size());
    if (!fits || !(fragment.last || whole_blocks)) {
        drop();
        return std::nullopt;
    }
    std::copy(fragment.data.begin(), fragment.data.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += fragment.data.size();
    if (!fragment.last) {
        due_ = static_cast<std::uint8_t>(fragment.number + 1);  // a 65th has a number that nobody can send
        return std::nullopt;
    }
    due_ = 0;
    if (size_ < shortest_ethernet_frame || size_ > longest_ethernet_frame) {
        drop();
        return std::nullopt;
    }
    return std::span<const std::byte>{bytes_}.first(size_);
}

}  // namespace taktwerk::ecat
