#include "ecat/dc/reference_clock.hpp"

#include <algorithm>
#include <cstdlib>

namespace taktwerk::ecat {

namespace {

constexpr std::int64_t billion = 1'000'000'000;
constexpr Duration longest_extrapolation = std::chrono::minutes{1};

/// What comes over the wire may be anything.
std::int64_t wrapping_difference(std::int64_t a, std::int64_t b) noexcept {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}
bool far(std::int64_t difference) noexcept {
    return difference > ReferenceClock::outlier_limit.count() || difference < -ReferenceClock::outlier_limit.count();
}

}  // namespace

void ReferenceClock::start(Instant sent, std::int64_t offset) noexcept {
    known_ = true;
    at_ = sent;
    offset_ = offset;
    part_ = 0;
    in_a_row_ = 1;
}

std::int64_t ReferenceClock::drift_in(Duration period) const noexcept {
    // A minute at the largest drift stays far inside 64 bits.
    const std::int64_t ns = std::clamp(period, -longest_extrapolation, longest_extrapolation).count();
    return ns * rate_ / (billion / (fine / rate_one));
}

std::optional<std::int64_t> ReferenceClock::offset() const noexcept {
    if (!known_) return std::nullopt;
    return offset_at(at_);
}

std::int64_t ReferenceClock::offset_at(Instant t) const noexcept {
    if (!known_) return 0;
    const std::int64_t part = part_ + drift_in(t - at_) + fine / 2;
    return offset_ + (part >= 0 ? part / fine : -((-part + fine - 1) / fine));
}

bool ReferenceClock::take(Instant sent, std::int64_t system_time) noexcept {
    const std::int64_t offset = wrapping_difference(system_time, sent.time_since_epoch().count());
    const bool stands = (known_ || outliers_ > 0) && system_time == last_;
    const bool outlier = stands || (known_ && far(wrapping_difference(offset, offset_at(sent))));
    last_ = system_time;
    if (outlier) {
        outliers_ = stands || far(wrapping_difference(offset, outlier_offset_)) ? 1 : outliers_ + 1;
        outlier_offset_ = offset;
        if (outliers_ < outliers_until_new_start) {
            miss();
            return false;
        }
    }
    outliers_ = 0;
    rejected_in_a_row_ = 0;
    ++samples_;
    if (!known_ || outlier) {
        start(sent, offset);
        return true;
    }
    const std::int64_t passed = (sent - at_).count();
    if (passed <= 0) return true;
    // Gains of the least-squares line through n + 1 samples: 2(2n + 1) and 6, over (n + 1)(n + 2). They stay at n = memory.
    const std::int64_t n = std::min(in_a_row_, memory);
    const std::int64_t below = (n + 1) * (n + 2);
    const std::int64_t error = (offset - offset_) * fine - part_ - drift_in(sent - at_);
    part_ += drift_in(sent - at_) + error * 2 * (2 * n + 1) / below;
    rate_ += error * 6 * (billion / (fine / rate_one)) / (below * passed);  // error at most outlier_limit: no overflow
    rate_ = std::clamp(rate_, -largest_drift_ppb * rate_one, largest_drift_ppb * rate_one);
    offset_ += part_ / fine;
    part_ %= fine;
    at_ = sent;
    if (in_a_row_ < memory) ++in_a_row_;
    return true;
}

}  // namespace taktwerk::ecat
