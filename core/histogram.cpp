#include "core/histogram.hpp"

#include <algorithm>
#include <cmath>

namespace taktwerk {

Duration Histogram::percentile(double percent) const noexcept {
    if (count_ == 0) return Duration{0};
    const double share = std::clamp(percent, 0.0, 100.0) / 100.0;
    const auto wanted = std::clamp<std::uint64_t>(static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_))), 1, count_);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i + 1 < bucket_count; ++i) {
        seen += buckets_[i];
        if (seen >= wanted) return Duration{std::min(bucket_last(i), max_)};
    }
    return Duration{max_};  // the last bucket is open-ended
}

void Histogram::merge(const Histogram& other) noexcept {
    if (other.count_ == 0) return;
    for (std::size_t i = 0; i < bucket_count; ++i) buckets_[i] += other.buckets_[i];
    min_ = count_ == 0 ? other.min_ : std::min(min_, other.min_);
    max_ = std::max(max_, other.max_);
    count_ += other.count_;
    sum_ += other.sum_;
}

}  // namespace taktwerk
