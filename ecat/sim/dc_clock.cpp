#include "ecat/sim/dc_clock.hpp"

#include <algorithm>
#include <cstdlib>

namespace taktwerk::ecat::sim {

namespace {

constexpr std::int64_t billion = 1'000'000'000;
/// a - b without overflow; the registers wrap, too.
constexpr std::int64_t wrapped_difference(std::int64_t a, std::int64_t b) noexcept {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}
constexpr std::int64_t decades_ns = billion * 1'000'000'000;  // 31 years

// The loop of a real controller nudges its clock by a fraction of a tick per ten: it never jumps. A master that leaves a large
// offset to the loop (instead of writing 0920h) waits for ever, as on hardware.
constexpr std::int64_t max_step_ns = 200;
constexpr std::int64_t max_trim_ppb = 400'000;
constexpr std::int64_t learning_range_ns = 1'000;      // speed is learned only near lock
constexpr std::int64_t shortest_learning_ns = 50'000;  // and not from frames sent back to back: rounding would dominate

}  // namespace

void DcClock::power_on(Instant now, std::int64_t local, std::int32_t drift_ppb) noexcept {
    *this = DcClock{};
    base_ = now;
    base_local_ = local;
    drift_ppb_ = drift_ppb;
}

std::int64_t DcClock::scaled(std::int64_t ns, std::int64_t ppb) noexcept {
    // Split at whole seconds: ns * ppb leaves 64 bits after a few hours.
    return ns / billion * ppb + ns % billion * ppb / billion;
}

std::int64_t DcClock::local(Instant at) const noexcept {
    const std::int64_t passed = (at - base_).count();
    return base_local_ + passed + scaled(passed, drift_ppb_ + trim_ppb_);
}

Instant DcClock::when_system(std::int64_t system_time) const noexcept {
    const std::int64_t target = wrapped_difference(system_time, offset_);
    const std::int64_t rate = drift_ppb_ + trim_ppb_;
    const std::int64_t ahead = wrapped_difference(target, base_local_);
    if (ahead > decades_ns) return Instant::max();
    if (ahead < -decades_ns) return base_;
    std::int64_t passed = ahead - scaled(ahead, rate);
    const auto error = [&](std::int64_t p) { return wrapped_difference(target, local(base_ + Duration{p})); };
    for (int i = 0; i < 4 && error(passed) != 0; ++i) passed += error(passed);
    while (error(passed) > 0) ++passed;
    while (error(passed - 1) <= 0) --passed;
    return base_ + Duration{passed};
}

void DcClock::correct(std::int64_t reference, Instant at) noexcept {
    const std::int64_t difference =
        std::clamp(wrapped_difference(wrapped_difference(system(at), reference), delay_), -decades_ns, decades_ns);
    const std::int64_t change = difference - mean_difference_;
    mean_difference_ = std::abs(change) > 4 * learning_range_ns ? difference : mean_difference_ + change / 4;
    if (!corrected_) mean_difference_ = difference;

    const std::int64_t step = std::clamp(-difference / 4, -max_step_ns, max_step_ns);
    const std::int64_t period = (at - last_correction_).count();
    std::int64_t trim = trim_ppb_;
    if (corrected_ && period >= shortest_learning_ns && std::abs(difference) <= learning_range_ns)
        trim = std::clamp(trim_ppb_ - difference * billion / period / 16, -max_trim_ppb, max_trim_ppb);
    base_local_ = local(at) + step;
    base_ = at;
    trim_ppb_ = trim;
    last_correction_ = at;
    corrected_ = true;
}

void DcClock::correct_low32(std::uint32_t reference, Instant at) noexcept {
    const auto own = static_cast<std::uint64_t>(system(at));
    const auto behind = static_cast<std::int32_t>(static_cast<std::uint32_t>(own) - reference);
    correct(static_cast<std::int64_t>(own) - behind, at);
}

void DcClock::set_drift(std::int32_t drift_ppb, Instant at) noexcept {
    base_local_ = local(at);
    base_ = at;
    drift_ppb_ = drift_ppb;
}

void DcClock::reset_control(Instant at) noexcept {
    // The local time goes on from where it is; only its speed falls back to the quartz.
    base_local_ = local(at);
    base_ = at;
    trim_ppb_ = 0;
    mean_difference_ = 0;
    corrected_ = false;
}

std::uint32_t DcClock::difference_register() const noexcept {
    const auto magnitude = static_cast<std::uint32_t>(std::min<std::int64_t>(std::abs(mean_difference_), 0x7FFF'FFFF));
    return mean_difference_ < 0 ? magnitude | 0x8000'0000u : magnitude;
}

}  // namespace taktwerk::ecat::sim
