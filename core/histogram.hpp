#pragma once
// How long something took, over millions of cycles, in a fixed 4 KB: maximum and percentiles without keeping samples.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/time.hpp"

namespace taktwerk {

/// Log-linear histogram of durations: 16 buckets per power of two, so a percentile is at most 1/16 (6.25 %) too large.
/// Exact below 32 ns. Durations above 137 s (2^37 ns) share the last bucket; max() stays exact. Negative ones count as 0.
/// Trivially copyable: one thread records, others get copies (a snapshot, a ring).
class Histogram {
public:
    static constexpr std::size_t bucket_count = 544;

    /// Real-time safe, some ten instructions.
    void record(Duration duration) noexcept {
        const std::int64_t ns = duration.count() < 0 ? 0 : duration.count();
        ++buckets_[bucket_of(ns)];
        ++count_;
        sum_ += ns;
        if (ns < min_ || count_ == 1) min_ = ns;
        if (ns > max_) max_ = ns;
    }

    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    /// 0 while empty, as are min, max and percentile.
    [[nodiscard]] Duration mean() const noexcept { return Duration{count_ == 0 ? 0 : sum_ / static_cast<std::int64_t>(count_)}; }
    [[nodiscard]] Duration min() const noexcept { return Duration{min_}; }
    [[nodiscard]] Duration max() const noexcept { return Duration{max_}; }

    /// The duration that `percent` (0..100) of the samples do not exceed: upper edge of its bucket, never above max().
    /// Nearest rank: the ceil(percent/100 * count)-th smallest sample.
    [[nodiscard]] Duration percentile(double percent) const noexcept;

    /// As if everything the other one recorded had been recorded here. Not for the cycle path (544 additions).
    void merge(const Histogram& other) noexcept;

    /// Back to empty. Real-time safe, 4 KB of stores.
    void reset() noexcept { *this = Histogram{}; }

    /// For plots: how often, and the range [first, last] in ns of a bucket.
    [[nodiscard]] std::uint64_t bucket(std::size_t index) const noexcept { return buckets_[index]; }
    [[nodiscard]] static constexpr std::int64_t bucket_last(std::size_t index) noexcept {
        return index < 2 * per_octave ? static_cast<std::int64_t>(index)
                                      : static_cast<std::int64_t>(((index % per_octave + per_octave + 1) << (index / per_octave - 1)) - 1);
    }
    [[nodiscard]] static constexpr std::int64_t bucket_first(std::size_t index) noexcept {
        return index == 0 ? 0 : bucket_last(index - 1) + 1;
    }
    [[nodiscard]] static constexpr std::size_t bucket_of(std::int64_t ns) noexcept {
        const auto value = static_cast<std::uint64_t>(ns);
        if (value < 2 * per_octave) return static_cast<std::size_t>(value);
        const auto octave = static_cast<std::size_t>(std::bit_width(value)) - 5;  // 0 for 16..31
        const std::size_t index = (octave + 1) * per_octave + ((value >> octave) & (per_octave - 1));
        return index < bucket_count ? index : bucket_count - 1;
    }

private:
    static constexpr std::size_t per_octave = 16;

    std::array<std::uint64_t, bucket_count> buckets_{};
    std::uint64_t count_ = 0;
    std::int64_t sum_ = 0;  // overflows after 292 years of recorded time
    std::int64_t min_ = 0, max_ = 0;
};

}  // namespace taktwerk
