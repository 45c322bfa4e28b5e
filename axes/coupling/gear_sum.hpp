#pragma once
// Two gears added (MC_CombineAxes): each master moves the slave from where all three were when it was set. Real-time safe.

#include "axes/coupling/gear_line.hpp"

namespace taktwerk::axes {

class GearSum {
public:
    /// A difference is a sum with the second ratio negative. False when a ratio cannot be kept exactly.
    [[nodiscard]] bool set(Ratio first, Ratio second, double first_feed, double second_feed, double slave_feed,
                           const EndlessPlace& first_master, const EndlessPlace& second_master, const EndlessPlace& slave) noexcept {
        const bool one = first_.set(first, first_feed, slave_feed, first_master, slave);
        return second_.set(second, second_feed, slave_feed, second_master, {}) && one;
    }
    [[nodiscard]] EndlessMotion at(const EndlessMotion& first, const EndlessMotion& second) noexcept {
        const auto a = first_.at(first), b = second_.at(second);
        return {{a.place.feeds + b.place.feeds, a.place.local + b.place.local}, a.velocity + b.velocity, a.acceleration + b.acceleration};
    }
    void shift(double delta) noexcept { first_.shift(delta); }

private:
    GearLine first_, second_;
};

}  // namespace taktwerk::axes
