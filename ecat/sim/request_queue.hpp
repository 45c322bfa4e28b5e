#pragma once
// Mailbox requests that wait for their answer, in the order in which they came. Room for a fixed number of them.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace taktwerk::ecat::sim {

class RequestQueue {
public:
    RequestQueue(std::size_t slots, std::size_t bytes) : slots_(slots) {
        for (auto& slot : slots_) slot.bytes.resize(bytes);
    }
    void clear() noexcept { head_ = count_ = 0; }
    [[nodiscard]] std::size_t size() const noexcept { return count_; }
    [[nodiscard]] bool full() const noexcept { return count_ == slots_.size(); }
    /// Only while it is not full. What does not fit into a mailbox is cut off.
    void push(std::span<const std::byte> message) noexcept {
        auto& slot = slots_[(head_ + count_++) % slots_.size()];
        slot.size = std::min(message.size(), slot.bytes.size());
        std::copy_n(message.begin(), slot.size, slot.bytes.begin());
    }
    /// Only while there is one. Stays valid until the next push().
    [[nodiscard]] std::span<const std::byte> front() const noexcept { return {slots_[head_].bytes.data(), slots_[head_].size}; }
    void pop() noexcept {
        head_ = (head_ + 1) % slots_.size();
        --count_;
    }

private:
    struct Slot {
        std::vector<std::byte> bytes;
        std::size_t size = 0;
    };
    std::vector<Slot> slots_;
    std::size_t head_ = 0, count_ = 0;
};

}  // namespace taktwerk::ecat::sim
