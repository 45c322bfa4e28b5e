#pragma once
// Orders to enable and disable one drive by its port, none more often than RUN needs to follow (Pr169, Pr166). Service side.

#include "core/time.hpp"

namespace taktwerk::axes::xp200 {

class EnableOrders {
public:
    static constexpr Duration again = std::chrono::seconds{1};

    /// An enabling order was sent, and no disabling one since.
    [[nodiscard]] bool enabled() const noexcept { return enabled_; }
    void forget() noexcept { enabled_ = false; }
    /// True: send it now.
    bool enable(Instant now) noexcept {
        if (now - enable_tried_ < again) return false;
        enable_tried_ = now;
        return enabled_ = true;
    }
    bool disable(Instant now) noexcept {
        if (now - disable_tried_ < again) return false;
        disable_tried_ = now;
        enabled_ = false;
        return true;
    }

private:
    bool enabled_ = false;
    Instant enable_tried_{}, disable_tried_{};
};

}  // namespace taktwerk::axes::xp200
