#include "ecat/dc/reference_clock.hpp"

#include <cstdlib>

namespace taktwerk::ecat {

namespace {

constexpr std::int64_t smoothing = 16;
constexpr Duration drift_window = std::chrono::seconds{1};

}  // namespace

void ReferenceClock::start(Instant sent, std::int64_t offset) noexcept {
    offset_ = offset;
    drift_from_ = offset;
    drift_since_ = sent;
}

bool ReferenceClock::take(Instant sent, std::int64_t system_time) noexcept {
    const std::int64_t offset = system_time - sent.time_since_epoch().count();
    const std::int64_t step = offset_ ? offset - *offset_ : 0;
    const bool outlier = std::abs(step) > outlier_limit.count();
    outliers_ = outlier ? outliers_ + 1 : 0;
    if (outlier && outliers_ < outliers_until_new_start) {
        ++rejected_;
        return false;
    }
    outliers_ = 0;
    ++samples_;
    if (!offset_ || outlier) start(sent, offset);
    else *offset_ += step / smoothing;
    if (sent - drift_since_ >= drift_window) {
        drift_ppb_ = (*offset_ - drift_from_) * 1'000'000'000 / (sent - drift_since_).count();
        drift_from_ = *offset_;
        drift_since_ = sent;
    }
    return true;
}

}  // namespace taktwerk::ecat
