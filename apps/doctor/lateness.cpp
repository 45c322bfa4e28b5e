#include "apps/doctor/lateness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>

#include "core/clock.hpp"
#include "ecat/wire/frame.hpp"

namespace taktwerk::apps {
namespace {

using std::chrono::microseconds;

/// One frame at a time, known again by its datagram's index.
class Prober {
public:
    Prober(ecat::Transport& bus, RoundTrips& trips) : bus_(bus), trips_(trips) {}

    void step(Instant now) noexcept {
        while (const auto received = bus_.receive(buffer_, now)) take(received->size, received->at);
        ecat::FrameBuilder frame{buffer_, bus_.mac()};
        frame.add(ecat::Command::BRD, index_, ecat::Address::physical(0, 0), 1);
        sent_at_[index_++] = now;
        if (bus_.send(frame.finish(), now)) ++trips_.sent;
    }

private:
    void take(std::size_t size, Instant at) noexcept {
        ecat::FrameReader reader{std::span<const std::byte>{buffer_}.first(size)};
        const auto answer = reader.next();
        if (!answer || answer->command != ecat::Command::BRD) return;
        auto& sent = sent_at_[answer->index];
        if (sent == Instant{}) return;
        trips_.took.record(at - sent);
        ++trips_.answered;
        trips_.slaves = std::max<unsigned>(trips_.slaves, answer->working_counter());
        sent = {};
    }

    ecat::Transport& bus_;
    RoundTrips& trips_;
    std::array<std::byte, ecat::max_frame_size> buffer_{};
    std::array<Instant, 256> sent_at_{};
    std::uint8_t index_ = 0;
};

}  // namespace

void MicrosecondHistogram::record(Duration duration) noexcept {
    const auto us = std::chrono::duration_cast<microseconds>(std::max(duration, Duration{})).count();
    ++counts_[std::min<std::size_t>(static_cast<std::size_t>(us), bins)];
    ++count_;
    max_ = std::max(max_, duration);
}

double MicrosecondHistogram::percentile_us(double percent) const noexcept {
    if (count_ == 0) return 0;
    // 99.9 % of 1000 is a little more than 999 in binary fractions, and the 999th is meant.
    const auto rank = std::max(1.0, std::ceil(percent / 100 * static_cast<double>(count_) - 1e-6));
    std::uint64_t passed = 0;
    for (std::size_t us = 0; us < bins; ++us)
        if (passed += counts_[us]; static_cast<double>(passed) >= rank) return static_cast<double>(us);
    return max_us();
}

std::uint64_t MicrosecondHistogram::at_least(Duration limit) const noexcept {
    const auto us = static_cast<std::size_t>(std::max<std::int64_t>(0, std::chrono::ceil<microseconds>(limit).count()));
    std::uint64_t all = 0;
    for (std::size_t i = std::min(us, bins); i < counts_.size(); ++i) all += counts_[i];
    return all;
}

Lateness measure_lateness(const LatenessPlan& plan, ecat::Transport* bus, RoundTrips* trips) {
    RealtimeRequest request;
    request.priority = plan.priority;
    if (plan.cpu >= 0) request.cpus = {plan.cpu};
    Lateness result;
    CpuLatencyHold hold;
    result.granted = prepare_process(request, hold);
    std::thread thread{[&] {
        const auto own = prepare_cycle_thread(request);
        result.granted.items.insert(result.granted.items.end(), own.items.begin(), own.items.end());
        std::optional<Prober> prober;
        if (bus != nullptr && trips != nullptr) prober.emplace(*bus, *trips);
        SystemClock clock;
        auto next = clock.now() + plan.interval;
        const auto end = next + plan.lasts;
        while (next < end) {
            clock.sleep_until(next);
            const auto woken = clock.now();
            result.woken.record(woken - next);
            if (prober) prober->step(woken);
            next += plan.interval;
            if (const auto now = clock.now(); next <= now)
                next += ((now - next) / plan.interval + 1) * plan.interval;  // a stall counts once
        }
    }};
    thread.join();
    return result;
}

}  // namespace taktwerk::apps
