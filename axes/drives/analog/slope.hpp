#pragma once
// A velocity out of positions: over the last samples, so that a count more or less is no motion. Pure logic; real-time safe.

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::axes::analog {

class Slope {
public:
    static constexpr std::size_t samples = 8;

    void clear() noexcept { count_ = 0; }
    /// Counts/s; 0 until there are two.
    double add(Instant at, std::int64_t position) noexcept {
        if (count_ > 0 && at <= newest().at) return velocity_;
        ring_[count_ % samples] = {at, position};
        ++count_;
        const auto& oldest = ring_[count_ > samples ? count_ % samples : 0];
        const auto& now = newest();
        velocity_ = now.at > oldest.at ? static_cast<double>(now.position - oldest.position) / to_seconds(now.at - oldest.at) : 0;
        return velocity_;
    }

private:
    struct Sample {
        Instant at{};
        std::int64_t position = 0;
    };
    [[nodiscard]] const Sample& newest() const noexcept { return ring_[(count_ - 1) % samples]; }

    std::array<Sample, samples> ring_{};
    std::size_t count_ = 0;
    double velocity_ = 0;
};

}  // namespace taktwerk::axes::analog
