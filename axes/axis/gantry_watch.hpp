#pragma once
// A portal on two drives, as its axis sees it: how far they are apart, and whether both are still there. That both get the same set-point is
// the port's business (axes/drives/gantry).

#include <cmath>

#include "axes/axis/axis_body.hpp"
#include "axes/axis/conduct.hpp"
#include "axes/axis/measured.hpp"

namespace taktwerk::axes {

class GantryWatch {
public:
    GantryWatch(AxisBody& body, const Measured& measured, Conduct& conduct) noexcept
        : body_(body), measured_(measured), conduct_(conduct) {}

    /// Once a cycle, where the axis is a gantry.
    void watch() noexcept {
        if (!measured_.feedback.fresh) return;
        const auto& limits = body_.config.gantry;
        skew_ = body_.port.skew() / body_.units.counts_per_unit();
        if (body_.port.side_lost() && !measured_.faulted()) conduct_.fail(AxisAlarm::gantry_side_lost);
        if (std::abs(skew_) > limits.error) conduct_.fail(AxisAlarm::gantry_skew, skew_, limits.error);
        if (limits.warning > 0 && std::abs(skew_) > limits.warning) conduct_.fail(AxisAlarm::gantry_skew_warning, skew_, limits.warning);
        else body_.alarms.clear(AxisAlarm::gantry_skew_warning);
    }
    /// u that the follower is ahead.
    [[nodiscard]] double skew() const noexcept { return skew_; }

private:
    AxisBody& body_;
    const Measured& measured_;
    Conduct& conduct_;
    double skew_ = 0;
};

}  // namespace taktwerk::axes
