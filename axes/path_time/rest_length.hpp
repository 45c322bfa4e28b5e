#pragma once
// How long the piece at constant jerk is that begins a run from rest, or ends it.

#include <array>
#include <cstddef>
#include <span>

#include "axes/path_time/curve.hpp"
#include "axes/path_time/rest_check.hpp"

namespace taktwerk::axes {

struct RestRun {
    double from = 0, to = 0;
    double velocity_factor = 1;
    bool halts = false;  ///< comes to rest as soon as it can
};

class RestLength {
public:
    /// In u of s; `room` is what lies between that end of the run and the curve's next break. Service side.
    [[nodiscard]] double length(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const RestRun& run, CurveSide side,
                                double room);

private:
    static constexpr std::size_t places = 24;

    [[nodiscard]] double first_peak(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const RestRun& run, CurveSide side);

    RestCheck check_;
    std::array<double, places + 1> squares_{}, accelerations_{};
};

}  // namespace taktwerk::axes
