#pragma once
// Leads one side of a portal to where it is square with the other, slowly and with ramps: how far it has been led by now. Real-time safe.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "axes/port/drive_port.hpp"
#include "core/time.hpp"

namespace taktwerk::axes::gantry {

class Squaring {
public:
    /// From `from` to `to`, counts. Begun again under way, it goes on from the velocity it has.
    void begin(std::int64_t from, std::int64_t to, const SquaringPace& pace) noexcept {
        if (!under_way_) velocity_ = 0;
        pace_ = pace;
        from_ = from;
        way_ = static_cast<double>(to - from);
        gone_ = 0;
        under_way_ = true;
    }
    /// Brakes, and stays where it comes to rest.
    void stop() noexcept {
        if (under_way_) way_ = gone_ + velocity_ * std::abs(velocity_) / (2 * pace_.acceleration);
    }
    void forget() noexcept { under_way_ = false; }
    /// One cycle on; the counts that the side is shifted by now. Only while under way.
    std::int64_t step(Duration dt) noexcept {
        const double t = to_seconds(dt), left = way_ - gone_;
        // Half a cycle is looked ahead, so that the last step ends in the place instead of around it.
        const double room = std::max(0.0, std::abs(left) - std::abs(velocity_) * t / 2);
        const double wanted = std::copysign(std::min(pace_.velocity, std::sqrt(2 * pace_.acceleration * room)), left);
        velocity_ += std::clamp(wanted - velocity_, -pace_.acceleration * t, pace_.acceleration * t);
        if (std::abs(left) <= std::max(0.5, std::abs(velocity_) * t) && std::abs(velocity_) <= 2 * pace_.acceleration * t) {
            gone_ = way_;
            under_way_ = false;
        } else {
            gone_ += velocity_ * t;
        }
        return from_ + std::llround(gone_);
    }
    [[nodiscard]] bool under_way() const noexcept { return under_way_; }

private:
    SquaringPace pace_;
    std::int64_t from_ = 0;
    double way_ = 0, gone_ = 0, velocity_ = 0;
    bool under_way_ = false;
};

}  // namespace taktwerk::axes::gantry
