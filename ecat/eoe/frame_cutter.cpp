#include "ecat/eoe/frame_cutter.hpp"

#include <algorithm>

namespace taktwerk::ecat {

bool FrameCutter::possible() const noexcept {
    return room_ > 0 && frame_.size() >= shortest_ethernet_frame && frame_.size() <= longest_ethernet_frame &&
           (frame_.size() + room_ - 1) / room_ <= eoe_most_fragments;
}

std::optional<EoeFragment> FrameCutter::next() noexcept {
    if (over_) return std::nullopt;
    EoeFragment fragment;
    fragment.frame = number_;
    fragment.number = fragment_++;
    fragment.blocks = static_cast<std::uint8_t>(fragment.number == 0 ? (frame_.size() + eoe_block - 1) / eoe_block : done_ / eoe_block);
    const auto rest = frame_.subspan(done_);
    fragment.data = rest.first(std::min(rest.size(), room_));
    done_ += fragment.data.size();
    fragment.last = over_ = done_ == frame_.size();
    return fragment;
}

}  // namespace taktwerk::ecat
