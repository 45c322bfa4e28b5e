#pragma once
// A gear: the slave's place is a straight line over the master's. Also the second half of MC_GearInPos. Real-time safe.

#include <cstdint>

#include "axes/coupling/endless.hpp"
#include "axes/coupling/step_ratio.hpp"

namespace taktwerk::axes {

/// numerator : denominator, slave to master; the denominator is not 0. Wide enough for the INT and UINT of the blocks in any sense.
struct Ratio {
    std::int64_t numerator = 1;
    std::int64_t denominator = 1;
    [[nodiscard]] constexpr double value() const noexcept { return static_cast<double>(numerator) / static_cast<double>(denominator); }
};

class GearLine {
public:
    /// Through the point (master, slave). Feeds in u of each. False when the ratio cannot be kept exactly (StepRatio).
    [[nodiscard]] bool set(Ratio ratio, double master_feed, double slave_feed, const EndlessPlace& master,
                           const EndlessPlace& slave) noexcept {
        ratio_ = ratio;
        master_ = master;
        slave_ = slave;
        return feeds_.set(master_feed, ratio.numerator, ratio.denominator, slave_feed);
    }

    [[nodiscard]] EndlessMotion at(const EndlessMotion& master) noexcept {
        feeds_.advance(master.place.feeds - master_.feeds);
        master_.feeds = master.place.feeds;
        const double n = static_cast<double>(ratio_.numerator), d = static_cast<double>(ratio_.denominator);
        return {{slave_.feeds + feeds_.whole(), slave_.local + feeds_.rest() + n * (master.place.local - master_.local) / d},
                n * master.velocity / d,
                n * master.acceleration / d,
                n * master.trend / d};
    }

    /// The whole line moves by `delta` u of the slave.
    void shift(double delta) noexcept { slave_.local += delta; }

private:
    Ratio ratio_;
    EndlessPlace master_, slave_;  // master_.feeds goes along; the rest stays where the line was set
    StepRatio feeds_;
};

}  // namespace taktwerk::axes
