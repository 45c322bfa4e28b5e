#pragma once
// The bytes of what programs keep (Declaration::retain), as they stood between two scans. Who may read them when is the program runner's
// business; here is one copy of them and whether it has changed. Real-time safe.

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

#include "runtime/retain/retained_item.hpp"

namespace taktwerk::runtime {

class RetainedImage {
public:
    explicit RetainedImage(std::span<const RetainedItem> items) {
        std::size_t size = 0;
        for (const auto& item : items) {
            places_.push_back(size);
            size += item.size;
        }
        bytes_.resize(size);
    }
    /// `from`: the item's bytes of this cycle.
    void take(std::size_t item, const void* from, std::size_t size) noexcept {
        auto* place = bytes_.data() + places_[item];
        if (std::memcmp(place, from, size) == 0) return;
        std::memcpy(place, from, size);
        changed_ = true;
    }
    [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }
    /// Since it was asked last.
    [[nodiscard]] bool take_changed() noexcept {
        const bool was = changed_;
        changed_ = false;
        return was;
    }

private:
    std::vector<std::size_t> places_;
    std::vector<std::byte> bytes_;
    bool changed_ = false;
};

}  // namespace taktwerk::runtime
