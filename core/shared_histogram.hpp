#pragma once
// A histogram that one thread writes and others read meanwhile: how long something took, how often, and when it took longest.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "core/histogram.hpp"
#include "core/time.hpp"

namespace taktwerk {

/// The buckets of Histogram. Readers see every count as it was at some moment of their reading, and the longest one with its own cycle. 4 KB.
class SharedHistogram {
public:
    struct Longest {
        Duration duration{};
        std::uint64_t cycle = 0;  ///< in which it happened; 0: nothing has been recorded
    };

    /// One thread. Real-time safe: some twenty instructions, no locked one.
    void record(Duration duration, std::uint64_t cycle) noexcept {
        const std::int64_t ns = duration.count() < 0 ? 0 : duration.count();
        auto& bucket = buckets_[Histogram::bucket_of(ns)];
        bucket.store(bucket.load(relaxed) + 1, relaxed);
        if (ns < longest_.load(relaxed) && longest_cycle_.load(relaxed) != 0) return;
        // Odd while the two do not belong together. Who reads one of them (acquire) sees that, too: no fences, which the thread sanitizer does not know.
        const auto version = version_.load(relaxed);
        version_.store(version + 1, relaxed);
        longest_.store(ns, std::memory_order_release);
        longest_cycle_.store(cycle, std::memory_order_release);
        version_.store(version + 2, std::memory_order_release);
    }
    /// The same thread: as if nothing had been recorded. Real-time safe, 4 KB of stores.
    void reset() noexcept {
        for (auto& bucket : buckets_) bucket.store(0, relaxed);
        const auto version = version_.load(relaxed);
        version_.store(version + 1, relaxed);
        longest_.store(0, std::memory_order_release);
        longest_cycle_.store(0, std::memory_order_release);
        version_.store(version + 2, std::memory_order_release);
    }

    // --- any thread ---
    [[nodiscard]] std::uint64_t bucket(std::size_t index) const noexcept { return buckets_[index].load(relaxed); }
    /// Not real-time: waits while it is being written.
    [[nodiscard]] Longest longest() const noexcept {
        for (;;) {
            const auto before = version_.load(std::memory_order_acquire);
            const Longest seen{Duration{longest_.load(std::memory_order_acquire)}, longest_cycle_.load(std::memory_order_acquire)};
            if (before % 2 == 0 && version_.load(relaxed) == before) return seen;
        }
    }

private:
    static constexpr auto relaxed = std::memory_order_relaxed;
    std::array<std::atomic<std::uint64_t>, Histogram::bucket_count> buckets_{};
    std::atomic<std::int64_t> longest_{0};
    std::atomic<std::uint64_t> longest_cycle_{0};
    std::atomic<std::uint32_t> version_{0};
};

}  // namespace taktwerk
