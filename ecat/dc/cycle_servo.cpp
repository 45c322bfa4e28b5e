#include "ecat/dc/cycle_servo.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace taktwerk::ecat {

namespace {

constexpr std::int64_t fine = 65536;  // parts of a ns

}  // namespace

std::string_view name(DcLock lock) noexcept {
    switch (lock) {
        case DcLock::none: return "none";
        case DcLock::acquiring: return "acquiring";
        case DcLock::locked: return "locked";
        case DcLock::coasting: return "coasting";
        case DcLock::lost: return "lost";
    }
    return "?";
}

CycleServo::CycleServo(Duration cycle, const ServoSettings& settings) noexcept
    : cycle_(cycle), settings_(settings), limit_(cycle.count() / settings.largest_correction), slew_(cycle.count() / settings.slew) {}

Duration CycleServo::wait() noexcept {
    correction_ = part_ = 0;
    inside_ = outside_ = without_sample_ = 0;
    held_ = false;
    lock_ = DcLock::none;
    return Duration{0};
}

void CycleServo::judge(const ServoSample& sample) noexcept {
    const std::int64_t error = std::abs(sample.phase_error);
    inside_ = error <= cycle_.count() / settings_.lock_window ? std::min(inside_ + 1, settings_.lock_cycles) : 0;
    outside_ = error > cycle_.count() / settings_.unlock_window ? std::min(outside_ + 1, settings_.unlock_cycles) : 0;
    without_sample_ = sample.fresh ? 0 : std::min(without_sample_ + 1, std::numeric_limits<std::uint32_t>::max() - 1);
    if (outside_ >= settings_.unlock_cycles) held_ = false;
    // A phase that is only extrapolated proves nothing.
    if (sample.fresh && inside_ >= settings_.lock_cycles) held_ = true;
    if (without_sample_ * cycle_ >= settings_.lost_after) held_ = false;

    if (without_sample_ * cycle_ >= settings_.lost_after) lock_ = DcLock::lost;
    else if (!held_) lock_ = DcLock::acquiring;
    else lock_ = without_sample_ >= settings_.coast_after ? DcLock::coasting : DcLock::locked;
}

Duration CycleServo::step(const ServoSample& sample) noexcept {
    judge(sample);
    const std::int64_t half = cycle_.count() / 2;
    const std::int64_t error = std::clamp(sample.phase_error, -half, half);
    const std::int64_t wanted = -sample.drift - error * fine / settings_.proportional + part_;
    const std::int64_t low = std::max(correction_ - slew_, -limit_), high = std::min(correction_ + slew_, limit_);
    correction_ = std::clamp(wanted / fine, low, high);
    // Parts of a ns are carried over; what the limits cut off is not.
    part_ = wanted - correction_ * fine;
    if (part_ >= fine || part_ <= -fine) part_ = 0;
    return Duration{correction_};
}

}  // namespace taktwerk::ecat
