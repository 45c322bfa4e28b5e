#pragma once
// The drive's hardware latch as homing uses it: armed on the index pulse or on a probe input, each new edge given once. Real-time safe.

#include <optional>

#include "axes/port/drive_port.hpp"

namespace taktwerk::axes {

class DriveLatch {
public:
    /// `probe`: 0 or 1.
    void arm(std::size_t probe, const ProbeCommand& command) noexcept {
        probe_ = probe;
        command_ = command;
        command_.armed = true;
        seen_ = 0;
        clear_ = false;
    }
    void release() noexcept { command_ = {}; }
    [[nodiscard]] bool armed() const noexcept { return command_.armed; }
    [[nodiscard]] std::size_t probe() const noexcept { return probe_; }
    [[nodiscard]] const ProbeCommand& command() const noexcept { return command_; }

    /// Once per cycle while armed: the place of an edge that was not there before, in counts. What the latch held before it was armed does
    /// not count: it must be seen empty once.
    [[nodiscard]] std::optional<std::int64_t> take(const DriveFeedback& feedback) noexcept {
        if (!command_.armed || !feedback.fresh) return std::nullopt;
        const auto& latch = feedback.probes[probe_];
        if (!latch.armed || !latch.latched) {
            clear_ = true;
            seen_ = 0;
            return std::nullopt;
        }
        if (!clear_ || latch.count == seen_) return std::nullopt;
        seen_ = latch.count;
        return latch.position;
    }

private:
    std::size_t probe_ = 0;
    ProbeCommand command_{};
    std::uint16_t seen_ = 0;
    bool clear_ = false;
};

}  // namespace taktwerk::axes
