#pragma once
// From one thread to one other: a queue of small values that never waits, never locks and never grows.

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace taktwerk {

/// Wait-free ring for exactly one producing and one consuming thread. Storage is taken at construction; after that
/// every member is real-time safe. What does not fit is dropped (the newest) and counted: the caller is told by `false`.
template <class T>
class SpscRing {
    static_assert(std::is_trivially_copyable_v<T>, "what crosses threads here is plain data");

public:
    /// Holds at least `capacity` values: rounded up to a power of two, at least 1.
    explicit SpscRing(std::size_t capacity)
        : mask_(std::bit_ceil(capacity < 1 ? std::size_t{1} : capacity) - 1), slots_(std::make_unique<T[]>(mask_ + 1)) {}
    SpscRing(const SpscRing&) = delete;
    SpscRing& operator=(const SpscRing&) = delete;

    /// Producer only. False: full, the value was not taken and is counted in dropped().
    bool try_push(const T& value) noexcept {
        const std::size_t tail = tail_.load(std::memory_order_relaxed);
        if (tail - head_seen_ > mask_) {
            head_seen_ = head_.load(std::memory_order_acquire);
            if (tail - head_seen_ > mask_) {
                dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
                return false;
            }
        }
        slots_[tail & mask_] = value;
        tail_.store(tail + 1, std::memory_order_release);
        return true;
    }

    /// Consumer only. False: empty, `out` is untouched.
    bool try_pop(T& out) noexcept {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        if (head == tail_seen_) {
            tail_seen_ = tail_.load(std::memory_order_acquire);
            if (head == tail_seen_) return false;
        }
        out = slots_[head & mask_];
        head_.store(head + 1, std::memory_order_release);
        return true;
    }

    /// Any thread; exact for producer and consumer as long as the other one rests, otherwise a moment's estimate.
    [[nodiscard]] std::size_t size() const noexcept {
        const std::size_t head = head_.load(std::memory_order_acquire);  // head first: it never passes the later tail
        const std::size_t waiting = tail_.load(std::memory_order_acquire) - head;
        return waiting > capacity() ? capacity() : waiting;
    }
    [[nodiscard]] std::size_t capacity() const noexcept { return mask_ + 1; }
    /// Any thread: pushes refused since construction.
    [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

private:
    static constexpr std::size_t cache_line = 64;  // bytes; the two sides share none

    std::size_t mask_;
    std::unique_ptr<T[]> slots_;
    alignas(cache_line) std::atomic<std::size_t> tail_{0};  // producer's
    std::size_t head_seen_ = 0;
    std::atomic<std::uint64_t> dropped_{0};
    alignas(cache_line) std::atomic<std::size_t> head_{0};  // consumer's
    std::size_t tail_seen_ = 0;
};

}  // namespace taktwerk
