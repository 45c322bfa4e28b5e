#include "core/cyclic_thread.hpp"

#include <algorithm>

namespace taktwerk {

CycleTiming CyclicThread::wait() noexcept {
    if (!started_) {
        started_ = true;
        if (const Instant now = clock_.now(); next_ <= now) next_ = now + config_.period;
    }
    clock_.sleep_until(next_);
    CycleTiming timing;
    timing.scheduled = next_;
    timing.woken = clock_.now();
    timing.lateness = std::max(timing.woken - timing.scheduled, Duration{0});
    timing.cycle = counters_.cycles;
    timing.missed = just_missed_;
    return timing;
}

CycleVerdict CyclicThread::finish(const CycleTiming& timing) noexcept {
    ++counters_.cycles;
    next_ = timing.scheduled + config_.period + shift_;
    shift_ = Duration{0};

    const Duration late = clock_.now() - next_;
    just_missed_ = 0;
    if (late <= Duration{0}) {
        counters_.consecutive = 0;
        return CycleVerdict::carry_on;
    }
    const auto missed = (late + config_.period - Duration{1}) / config_.period;  // rounded up: the next instant is not past
    next_ += missed * config_.period;
    just_missed_ = static_cast<std::uint64_t>(missed);
    counters_.missed += just_missed_;
    ++counters_.overruns;
    ++counters_.consecutive;
    counters_.worst_run = std::max(counters_.worst_run, counters_.consecutive);

    const OverrunPolicy& policy = config_.on_overruns;
    if (policy.limit == 0 || policy.decide == nullptr || counters_.consecutive % policy.limit != 0) return CycleVerdict::carry_on;
    return policy.decide(policy.context, timing, counters_.consecutive);
}

void CyclicThread::shift_grid(Duration by) noexcept { shift_ = std::clamp(by, -config_.period / 2, config_.period / 2); }

}  // namespace taktwerk
