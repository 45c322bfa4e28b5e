#pragma once
// The newest of something large (a snapshot), from one thread to one other, with neither ever waiting.

#include <array>
#include <atomic>
#include <cstdint>

namespace taktwerk {

/// Triple buffer for exactly one writer and one reader thread. T may own memory (vectors sized beforehand): the three
/// buffers are copies of a prototype and are only ever written through back(). All members are real-time safe if filling a T is.
template <class T>
class LatestValue {
public:
    LatestValue() = default;
    explicit LatestValue(const T& prototype) : buffers_{prototype, prototype, prototype} {}
    LatestValue(const LatestValue&) = delete;
    LatestValue& operator=(const LatestValue&) = delete;

    /// Writer only: the buffer to fill. It holds some older value, not the last one: write all of it.
    [[nodiscard]] T& back() noexcept { return buffers_[back_]; }

    /// Writer only: makes back() the newest value. The reference from back() is void from here on.
    void publish() noexcept {
        back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | fresh_bit), std::memory_order_acq_rel) & index_bits;
    }

    struct Reading {
        const T* value;  ///< never null; before the first publish() the prototype. Valid until the reader's next read().
        bool is_new;     ///< false: the same value as at the last read()
    };

    /// Reader only: the newest published value.
    [[nodiscard]] Reading read() noexcept {
        if ((middle_.load(std::memory_order_relaxed) & fresh_bit) == 0) return {&buffers_[front_], false};
        front_ = middle_.exchange(front_, std::memory_order_acq_rel) & index_bits;
        return {&buffers_[front_], true};
    }

private:
    static constexpr std::uint8_t index_bits = 0b011;
    static constexpr std::uint8_t fresh_bit = 0b100;

    std::array<T, 3> buffers_{};
    alignas(64) std::uint8_t back_ = 0;
    alignas(64) std::atomic<std::uint8_t> middle_{1};
    alignas(64) std::uint8_t front_ = 2;
};

}  // namespace taktwerk
