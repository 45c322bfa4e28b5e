#pragma once
// BRK: released a while after the current is there; while moving it falls after a while without, or when the motor is slow (manual 4.8: Pr169,
// Pr167, Pr168).

#include "core/time.hpp"

namespace taktwerk::axes::sim::xp200 {

class BrakeOutput {
public:
    [[nodiscard]] bool released() const noexcept { return released_; }
    void close() noexcept { released_ = false; }
    void current_on(Instant now) noexcept { on_at_ = now; }
    /// `drop`: when it falls at the latest.
    void current_off(Instant drop) noexcept { drop_at_ = drop; }
    /// Each step while the motor runs, `delay` after the current; or has no current, `fast` or not.
    void run(Instant now, Duration delay) noexcept {
        if (now - on_at_ >= delay) released_ = true;
    }
    void fall(Instant now, bool fast) noexcept { released_ = released_ && now < drop_at_ && fast; }

private:
    bool released_ = false;
    Instant on_at_{}, drop_at_{};
};

}  // namespace taktwerk::axes::sim::xp200
