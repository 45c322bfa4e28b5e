#pragma once
// One touch probe of a simulated drive: it sees the signal between two inner steps and keeps the count at which it changed. Sources:
// CiA 402-2 (60B8h, 60B9h); SV33-E 3.4.4(1): function bits 0 enable, 1 continuous, 2 index pulse, 4 rising edge, 5 falling edge; status
// bits 0 enabled, 1 rising and 2 falling edge latched. Settings are taken with the rising enable bit; without it everything is forgotten.

#include <array>
#include <cmath>
#include <cstdint>

namespace taktwerk::axes::sim {

/// The signal on the probe's input: on from `from` to `to` [counts of the drive, not whole]; from > to = never.
struct ProbeSignal {
    double from = 1, to = 0;
};

/// Of a signal that repeats every so many counts the one nearest to `at`; 0 = there is one only.
[[nodiscard]] inline ProbeSignal nearest(const ProbeSignal& signal, double every, double at) noexcept {
    if (!(every > 0)) return signal;
    const double shift = every * std::round((at - (signal.from + signal.to) / 2) / every);
    return {signal.from + shift, signal.to + shift};
}

class TouchProbe {
public:
    /// Bits 0..7 of 60B8h.
    void command(std::uint8_t function) noexcept {
        const bool enable = (function & 1u) != 0;
        if (!enable) *this = {};
        else if (!enabled_) {
            enabled_ = true;
            function_ = function;
        }
    }
    /// The motor went from `before` to `after` [counts]; an index pulse stands at each multiple of `revolution`.
    void motion(double before, double after, const ProbeSignal& signal, double revolution) noexcept {
        if (!enabled_ || before == after) return;
        if ((function_ & 4u) != 0) {
            const double turn = std::floor(std::fmax(before, after) / revolution);
            if (turn != std::floor(std::fmin(before, after) / revolution)) latch(0, turn * revolution);
            return;
        }
        const bool was = inside(signal, before), is = inside(signal, after);
        const bool upwards = after > before;
        // Whoever passes a short signal in one step sees both edges.
        const bool passed = !was && !is && signal.from <= signal.to &&
                            (upwards ? before < signal.from && after > signal.to : before > signal.to && after < signal.from);
        if (passed || (!was && is)) latch(0, upwards ? signal.from : signal.to);
        if (passed || (was && !is)) latch(1, upwards ? signal.to : signal.from);
    }

    /// Bits 0..7 of 60B9h.
    [[nodiscard]] std::uint8_t status() const noexcept {
        return static_cast<std::uint8_t>((enabled_ ? 1u : 0u) | (latched_[0] ? 2u : 0u) | (latched_[1] ? 4u : 0u));
    }
    /// 60BAh, 60BCh.
    [[nodiscard]] std::int64_t rising() const noexcept { return position_[0]; }
    /// 60BBh, 60BDh.
    [[nodiscard]] std::int64_t falling() const noexcept { return position_[1]; }

private:
    [[nodiscard]] static bool inside(const ProbeSignal& signal, double at) noexcept { return signal.from <= at && at <= signal.to; }
    void latch(std::size_t edge, double at) noexcept {
        const bool wanted = (function_ & (edge == 0 ? 16u : 32u)) != 0, continuous = (function_ & 2u) != 0;
        if (!wanted || (latched_[edge] && !continuous)) return;
        latched_[edge] = true;
        position_[edge] = static_cast<std::int64_t>(std::floor(at));  // like the actual position
    }

    bool enabled_ = false;
    std::uint8_t function_ = 0;
    std::array<bool, 2> latched_{};
    std::array<std::int64_t, 2> position_{};
};

}  // namespace taktwerk::axes::sim
