#pragma once
// Where the cells of a run lie: they follow the curve, grow away from where they are small, and shrink towards rest.

#include <cstdint>
#include <span>
#include <vector>

#include "axes/path_time/curve.hpp"
#include "axes/path_time/rest_length.hpp"
#include "axes/path_time/speed_problem.hpp"

namespace taktwerk::axes {

struct RunTask {
    double from = 0;
    double to = 0;
    /// At `from`. Both 0: from rest.
    double velocity = 0;
    double acceleration = 0;
    /// Override: scales the path's velocity limit. (0, 1].
    double velocity_factor = 1;
    /// > 0: comes to rest as soon as it can, and `to` is halt_way() with this share of the limits: the search begins with that braking.
    double halt_share = 0;
    /// Of that braking, or of one to a lowered velocity: the ways in which its deceleration comes and goes.
    double halt_ramp = 0, halt_last = 0;
    /// What share of its usual deceleration and jerk the search begins with that brakes to a lowered velocity factor.
    double softness = 1;
    /// From a moving state: so long it brakes for a lowered velocity. The cells are small there.
    double brake_way = 0;
};

class CellGrid {
public:
    /// Coarse: as for a run of many spans, whatever this one is.
    enum class Grain : std::uint8_t { by_run, coarse };
    void make(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const RunTask& task, Grain grain);

    /// Between the cells, ascending; pieces at rest lie outside.
    std::vector<double> nodes;
    std::vector<double> breaks;  ///< of the curve, with both ends of the run
    SpeedEnd start, end;
    bool coarse = false;  ///< as it was made

private:
    void add_breaks(const RunTask& task);
    void add_stations(double largest_of_run, double brake_way);
    [[nodiscard]] double size_at(double s, std::size_t& station) const;
    void add_corners_of_halt(const RunTask& task);
    void add_nodes();
    void split_at_narrow_places();
    [[nodiscard]] bool too_long(double a, double b) const;

    const TimedCurve* curve_ = nullptr;
    RestLength rest_;
    std::vector<double> stations_, sizes_;
    enum class Bends : std::uint8_t { not_at_all, little, much };
    std::vector<Bends> bends_;  // the curve behind the station
};

}  // namespace taktwerk::axes
