#pragma once
// The incremental encoder of a simulated XP200: it counts from where it wakes up (manual 1.3, not stated), has an index pulse (3.3 note 6), and
// may break. Counts; `at` is the plant's position.

#include <cmath>
#include <cstdint>

namespace taktwerk::axes::sim::xp200 {

class CountingEncoder {
public:
    void power_on(double at) noexcept {
        zero_ = at;
        broken_ = index_seen_ = false;
    }
    /// It shows the same position for ever after, until power_on().
    void fail(double at) noexcept {
        frozen_ = position(at);
        broken_ = true;
    }
    /// The motor went from `before` to `after`; an index pulse stands at `index`, the others whole turns from it.
    void step(double before, double after, double index, double turn) noexcept {
        const auto turns = [&](double at) { return std::floor((at - index) / turn); };
        index_seen_ = index_seen_ || turns(before) != turns(after);
    }
    [[nodiscard]] double zero() const noexcept { return zero_; }
    [[nodiscard]] std::int64_t position(double at) const noexcept {
        return broken_ ? frozen_ : static_cast<std::int64_t>(std::floor(at - zero_));
    }
    /// 0 at the index pulse. Before the first one since power-on it counts from where it woke up: not stated.
    [[nodiscard]] std::int64_t since_index(double at, double index) const noexcept {
        return index_seen_ && !broken_ ? static_cast<std::int64_t>(std::floor(at - index)) : position(at);
    }

private:
    double zero_ = 0;  // plant position where the counter is 0
    bool broken_ = false, index_seen_ = false;
    std::int64_t frozen_ = 0;
};

}  // namespace taktwerk::axes::sim::xp200
