#pragma once
// The fastest motion along one run of a curve: from a state of motion to rest, under every axis' limits and the path's own.
// Service side; the work area is kept between plans. docs/motion/path.md explains the method.

#include <span>
#include <vector>

#include "axes/path_time/braking.hpp"
#include "axes/path_time/cell_check.hpp"
#include "axes/path_time/cell_grid.hpp"
#include "axes/path_time/curve.hpp"
#include "axes/path_time/limit_use.hpp"
#include "axes/path_time/rest_check.hpp"
#include "axes/path_time/speed_problem.hpp"
#include "axes/path_time/time_piece.hpp"

namespace taktwerk::axes {

/// v2(s) of a plan as it was optimised: where a later plan begins to search, and which cells it takes over.
struct RunShape {
    std::vector<double> nodes;    ///< between the cells; the pieces at rest lie outside
    std::vector<double> squares;  ///< v2 at the nodes
    std::vector<double> middles;  ///< Bernstein's middle coefficient of each cell
    double end = 0;               ///< where it comes to rest
    double velocity_factor = 1;   ///< that it was made for
    bool coarse = false;          ///< planned as one of many spans
};

struct RunPlan {
    std::vector<TimePiece> pieces;  ///< times from 0
    RunShape shape;
    double duration = 0;
    LimitUse use;        ///< as verified
    bool found = false;  ///< otherwise the pieces are not to be run
    int cells = 0;
    int steps = 0;    ///< of the interior point method, all windows and rounds together
    int rounds = 0;   ///< of optimising and verifying
    int planned = 0;  ///< cells that were optimised; the others are those of the former plan
    /// From a moving state to a lowered velocity factor: so long [s] it is above that by more than a hundredth, and what braking to it would take.
    double above_for = 0, braking_for = 0;
};

class RunPlanner final : SpeedWitness {
public:
    /// Fastest along the curve. `limits`: one per axis of the curve. From a moving state: `former` is the plan that has this state at one of its
    /// nodes; it is where the search begins. Where only the run's end has moved on, what `former` does before it brakes for its own end is taken as
    /// it is. Not found: the former plan goes on; that nothing better is found does not say that there is nothing.
    void plan(const TimedCurve& curve, std::span<const PathAxisLimits> limits, const RunTask& task, RunPlan& out,
              const RunShape* former = nullptr);

private:
    /// A hair below, so that what rounding leaves is inside.
    static constexpr CellShare untouched{1 - 1e-5, 1 - 1e-5, 1 - 1e-5};

    void plan_onward(const RunTask& task, RunPlan& out, const RunShape* former);
    void plan_whole(const RunTask& task, RunPlan& out, const RunShape* former);
    [[nodiscard]] std::size_t grows_from(const RunTask& task, const RunShape& former) const;
    void keep_before(std::size_t kept, const RunTask& task, const RunShape& former, RunPlan& out) const;
    void make_problem();
    void add_cell(int cell);
    void measure_braking();
    void first_guess(double square = 0);
    void take_over(const RunShape& former);
    void brake();
    void make_ramp();
    void make_halt();
    [[nodiscard]] Braking halt_braking() const;
    [[nodiscard]] double wanted_first() const;
    [[nodiscard]] double top_velocity(double jerk) const;
    [[nodiscard]] Braking braking_to_factor(double part, double share) const;
    bool sweep(SpeedGuess guess, RunPlan& out);
    bool solve(const CellRange& range, SpeedGuess guess, SpeedWitness* witness, RunPlan& out);
    void come_near(const CellRange& cells, const std::vector<double>& middles) override;
    [[nodiscard]] bool keeps_to_wanted(std::size_t cell) const;
    [[nodiscard]] CellUse use_of_cell(std::size_t cell);
    LimitUse verify(const CellRange& range);
    void settle_braking(RunPlan& out);
    void settle_ramps(RunPlan& out);
    bool mend(RunPlan& out);
    void push_share(int cell);
    void split_cells();
    void slow_down(const LimitUse& use);
    void look_above(RunPlan& out) const;
    /// False: it would last too long to be a motion.
    [[nodiscard]] bool make_pieces(RunPlan& out) const;
    [[nodiscard]] bool from_rest() const noexcept { return grid_.start.rest_length > 0; }
    /// What the path's velocity limit is times where nothing may cross it.
    [[nodiscard]] double hard_factor() const noexcept { return task_.velocity > 0 ? 1 : task_.velocity_factor; }

    const TimedCurve* curve_ = nullptr;
    std::span<const PathAxisLimits> limits_;
    RunTask task_;
    CellGrid grid_;
    CellCheck check_;
    RestCheck rest_;
    SpeedProblem problem_;
    std::vector<double> middles_;
    std::vector<double> ramp_;  // v2 on the way down to a lowered velocity, three a cell as the problem has places; empty: there is none
    std::vector<double> halt_;  // v2 of a halt as along a line, likewise
    double begin_square_ = 0, end_square_ = 0;  // the greatest v2 where the pieces at rest end or begin
    std::vector<double> reach_;                 // of braking, from each cell
    std::vector<LimitUse> uses_;                // of the cells, as verified
    std::vector<CellShare> shares_;             // what share of each limit a cell may use
    std::vector<int> beyond_;                   // cells that use more than they may
    std::vector<int> split_;
    bool brisk_ = false;        // the search begins above the former plan where that brakes for an end that has moved on
    bool slower_ = false;       // the velocity factor is lower than that of the former plan
    double former_factor_ = 1;  // that one, then
    int splits_left_ = 0;       // rounds that may still do so
    int first_window_ = 0;      // cells that have to be solved at once
};

}  // namespace taktwerk::axes
