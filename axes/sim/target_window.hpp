#pragma once
// Bit 10 of the status word in the profile modes: the actual value has been inside the target's window for the window's time (6067h, 6068h,
// 606Dh, 606Eh).

#include "core/time.hpp"

namespace taktwerk::axes::sim {

class TargetWindow {
public:
    /// Another target, or another mode.
    void forget() noexcept { reached_ = false; }
    /// One inner step; `time`: how long it has to be inside.
    void step(bool inside, Instant now, Duration time) noexcept {
        if (!inside) since_ = now;
        reached_ = inside && now - since_ >= time;
    }
    [[nodiscard]] bool reached() const noexcept { return reached_; }
    /// The status word of the last exchange said so.
    void tell() noexcept { told_ = reached_; }
    [[nodiscard]] bool told() const noexcept { return told_; }

private:
    bool reached_ = false, told_ = false;
    Instant since_{};
};

}  // namespace taktwerk::axes::sim
