#pragma once
// One touch probe of a simulated drive: it sees the signal between two inner steps and keeps the count at which it changed. Sources:
// CiA 402-2 (60B8h, 60B9h); SV33-E 3.4.4(1): function bits 0 enable, 1 continuous, 2 index pulse, 4 rising edge, 5 falling edge; status
// bits 0 enabled, 1 rising and 2 falling edge latched; SV-DA200 3.8.3: bits 6 and 7 toggle with each of them in continuous mode. Settings are
// taken with the rising enable bit; without it everything is forgotten.

#include <array>
#include <cmath>
#include <cstdint>

#include "axes/sim/index_pulse.hpp"

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

/// Whether the status tells consecutive latches apart.
enum class ProbeToggle : std::uint8_t { none, bits_6_and_7 };

class TouchProbe {
public:
    TouchProbe() = default;
    explicit TouchProbe(ProbeToggle toggles) noexcept : toggles_(toggles) {}

    /// Bits 0..7 of 60B8h.
    void command(std::uint8_t function) noexcept {
        const bool enable = (function & 1u) != 0;
        if (!enable) *this = TouchProbe(toggles_);
        else if (!enabled_) {
            enabled_ = true;
            function_ = function;
        }
    }
    /// The motor went from `before` to `after`; all in counts of the drive.
    void motion(double before, double after, const ProbeSignal& signal, const IndexPulses& pulses) noexcept {
        if (!enabled_ || before == after) return;
        if ((function_ & 4u) != 0) {
            if (const auto pulse = pulses.between(before, after)) latch(0, *pulse);
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
        return static_cast<std::uint8_t>((enabled_ ? 1u : 0u) | (latched_[0] ? 2u : 0u) | (latched_[1] ? 4u : 0u) |
                                         (toggled_[0] ? 64u : 0u) | (toggled_[1] ? 128u : 0u));
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
        if (continuous && toggles_ == ProbeToggle::bits_6_and_7) toggled_[edge] = !toggled_[edge];
        position_[edge] = static_cast<std::int64_t>(std::floor(at));  // like the actual position
    }

    ProbeToggle toggles_ = ProbeToggle::none;
    bool enabled_ = false;
    std::uint8_t function_ = 0;
    std::array<bool, 2> latched_{}, toggled_{};
    std::array<std::int64_t, 2> position_{};
};

}  // namespace taktwerk::axes::sim
