#pragma once
// The fastest motion along one run of a curve: from a state of motion to rest, under every axis' limits and the path's own.
// Service side; the work area is kept between plans. docs/motion/path.md explains the method.

#include <span>
#include <vector>

#include "axes/path_time/curve.hpp"
#include "axes/path_time/speed_problem.hpp"
#include "axes/path_time/time_piece.hpp"

namespace taktwerk::axes {

/// What share of its limits a motion uses at most, over everything that was looked at: 1 is the limit.
struct LimitUse {
    double velocity = 0;
    double acceleration = 0;
    double jerk = 0;

    void widen(const LimitUse& other) noexcept;
    /// Whether it may be run: velocity and acceleration with a hair left for what lies between samples, jerk within what is promised.
    [[nodiscard]] bool inside() const noexcept { return velocity <= 1 - 2e-6 && acceleration <= 1 - 2e-6 && jerk <= 1 + 2e-4; }
};

/// The use of all limits at a point of the curve by a motion along it.
[[nodiscard]] LimitUse limit_use(const TimedCurvePoint& point, std::span<const PathAxisLimits> limits, double velocity_factor,
                                 const PathMotion& motion) noexcept;

struct RunTask {
    double from = 0;
    double to = 0;
    /// At `from`. Both 0: from rest.
    double velocity = 0;
    double acceleration = 0;
    /// Override: scales the path's velocity limit. (0, 1].
    double velocity_factor = 1;
};

/// v2(s) of a plan as it was optimised: where a later plan begins to search, and which cells it takes over.
struct RunShape {
    std::vector<double> nodes;    ///< between the cells; the pieces at rest lie outside
    std::vector<double> squares;  ///< v2 at the nodes
    std::vector<double> middles;  ///< Bernstein's middle coefficient of each cell
    double end = 0;               ///< where it comes to rest
};

struct RunPlan {
    std::vector<TimePiece> pieces;  ///< times from 0
    RunShape shape;
    double duration = 0;
    LimitUse use;        ///< as verified
    bool found = false;  ///< otherwise the pieces are not to be run
    int cells = 0;
    int steps = 0;   ///< of the interior point method, all rounds together
    int rounds = 0;  ///< of optimising and verifying
};

class RunPlanner {
public:
    /// Fastest along the curve. `limits`: one per axis of the curve. From a moving state: `former` is the plan that has this state at one of its
    /// nodes; it is where the search begins. Not found: the state cannot be left better than the former plan does, which goes on.
    void plan(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const RunTask& task, RunPlan& out,
              const RunShape* former = nullptr);

private:
    struct CellLimits {
        double velocity, acceleration, jerk;
    };
    /// A hair below, so that what rounding leaves is inside.
    static constexpr CellLimits untouched{1 - 1e-5, 1 - 1e-5, 1 - 1e-5};

    void make_nodes(const RunTask& task);
    void add_breaks(const RunTask& task);
    void add_stations(double largest);
    double size_at(double s, std::size_t& station) const;
    void make_problem(const RunTask& task);
    void add_cell(int cell, const RunTask& task);
    void first_guess(const RunTask& task);
    void take_over(const RunTask& task, const RunShape& former);
    LimitUse verify(const RunTask& task, int round);
    void split_cells();
    void slow_down(const LimitUse& use);
    LimitUse use_of_cell(int cell, const RunTask& task) const;
    double rest_square(double at, double length, bool begins, double velocity_factor) const;
    void make_pieces(RunPlan& out);

    const TimedCurve* curve_ = nullptr;
    std::span<const PathAxisLimits> limits_;
    std::vector<double> breaks_, stations_, sizes_, nodes_, middles_;
    std::vector<CellLimits> cell_limits_;  // what share of each limit a cell may use
    std::vector<std::size_t> split_;
    SpeedProblem problem_;
    SpeedEnd start_, end_;
};

}  // namespace taktwerk::axes
