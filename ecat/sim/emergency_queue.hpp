#pragma once
// Emergencies of the application that wait for the mailbox to be free; one that does not fit is dropped.

#include <array>
#include <cstddef>

#include "ecat/sim/device_model.hpp"

namespace taktwerk::ecat::sim {

class EmergencyQueue {
public:
    static constexpr std::size_t limit = 8;

    void clear() noexcept { head_ = count_ = 0; }
    [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
    [[nodiscard]] bool full() const noexcept { return count_ == ring_.size(); }
    /// Only while it is not full.
    void push(const Emergency& emergency) noexcept { ring_[(head_ + count_++) % ring_.size()] = emergency; }
    [[nodiscard]] const Emergency& front() const noexcept { return ring_[head_]; }
    void pop() noexcept {
        head_ = (head_ + 1) % ring_.size();
        --count_;
    }

private:
    std::array<Emergency, limit> ring_{};
    std::size_t head_ = 0, count_ = 0;
};

}  // namespace taktwerk::ecat::sim
