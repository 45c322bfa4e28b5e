#pragma once
// Measuring time inside the cycle, for statistics only. Nothing measured here may influence control: it would make two
// runs of the same machine differ. Control gets its time as an argument.

#include <ctime>

#include <array>
#include <cstddef>
#include <string_view>

#include "core/histogram.hpp"
#include "core/time.hpp"

namespace taktwerk {

/// Real (not virtual) time between laps: CLOCK_MONOTONIC by the vDSO, about 25 ns, no system call where the kernel has
/// that fast path. Real-time safe.
class Stopwatch {
public:
    Stopwatch() noexcept : last_(now()) {}

    /// Since construction, restart() or the last lap.
    Duration lap() noexcept {
        const Duration t = now();
        const Duration passed = t - last_;
        last_ = t;
        return passed;
    }
    void restart() noexcept { last_ = now(); }

private:
    static Duration now() noexcept {
        timespec t{};
        ::clock_gettime(CLOCK_MONOTONIC, &t);
        return std::chrono::seconds{t.tv_sec} + std::chrono::nanoseconds{t.tv_nsec};
    }
    Duration last_;
};

/// Per-step times of a cycle, and of the slowest cycle so far how it was spent. Trivially copyable: goes into snapshots.
///
///   StepStatistics<3> statistics{{"receive", "axes", "send"}};
///   statistics.begin();  receive();  statistics.done(0);  axes();  statistics.done(1);  send();  statistics.done(2);  statistics.end();
template <std::size_t Steps>
class StepStatistics {
public:
    /// The names must outlive this and its copies: string literals.
    explicit StepStatistics(const std::array<std::string_view, Steps>& names) noexcept : names_(names) {}

    /// Real-time safe, as are done, skip and end.
    void begin() noexcept {
        current_.fill(Duration{0});
        watch_.restart();
    }
    /// The time since begin() or the last done() went into this step.
    void done(std::size_t step) noexcept { current_[step] += watch_.lap(); }
    /// The time since then belongs to no step (waiting).
    void skip() noexcept { watch_.restart(); }
    /// Books the cycle.
    void end() noexcept {
        Duration sum{0};
        for (std::size_t i = 0; i < Steps; ++i) {
            times_[i].record(current_[i]);
            sum += current_[i];
        }
        total_.record(sum);
        if (sum >= worst_total_) {
            worst_total_ = sum;
            worst_ = current_;
        }
    }

    [[nodiscard]] static constexpr std::size_t size() noexcept { return Steps; }
    [[nodiscard]] std::string_view name(std::size_t step) const noexcept { return names_[step]; }
    [[nodiscard]] const Histogram& times(std::size_t step) const noexcept { return times_[step]; }
    [[nodiscard]] const Histogram& total() const noexcept { return total_; }
    /// Of the slowest cycle: this step's part.
    [[nodiscard]] Duration in_worst_cycle(std::size_t step) const noexcept { return worst_[step]; }
    /// Of the cycle being measured or the last one.
    [[nodiscard]] Duration in_this_cycle(std::size_t step) const noexcept { return current_[step]; }

    void reset() noexcept { *this = StepStatistics{names_}; }

private:
    std::array<std::string_view, Steps> names_;
    std::array<Histogram, Steps> times_{};
    Histogram total_;
    std::array<Duration, Steps> current_{}, worst_{};
    Duration worst_total_{0};
    Stopwatch watch_;
};

}  // namespace taktwerk
