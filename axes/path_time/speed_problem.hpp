#pragma once
// The fastest v2(s), the square of the path's velocity, as a quadratic spline with one coefficient per cell, under inequalities at points.
// A convex problem but for the jerk, whose bound 1/v is used as it is. Solved by an interior-point method whose equations have five
// diagonals. Service side: its work area grows and is kept. docs/motion/path.md has the mathematics.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace taktwerk::axes {

/// How the spline begins or ends.
struct SpeedEnd {
    /// Rest: constant jerk over this length before (or behind) the first (last) cell. 0: moving.
    double rest_length = 0;
    /// Moving: v2 and d(v2)/ds there. Only a beginning moves.
    double square = 0;
    double slope = 0;
};

/// A place where something is limited: in a cell, at x in [0, 1] of it.
struct SpeedPoint {
    int cell = 0;
    double x = 0;
    double weight = 0;  ///< of this point in the time; 0: only limits
};

/// l = at v2 + slope d(v2)/ds + bend d2(v2)/ds2 with -below <= l <= above; for a jerk both bounds are divided by v.
struct SpeedRow {
    double at = 0;
    double slope = 0;
    double bend = 0;
    double above = 1;
    double below = 1;
};

/// How near the beginning of the search is to its end: it says how carefully the search starts.
enum class SpeedGuess : std::uint8_t { rough, near };

enum class SpeedGoal : std::uint8_t { fastest, slowest };

struct SpeedOutcome {
    bool feasible = false;  ///< every row holds strictly
    bool settled = false;   ///< and nothing more is to be had
    int steps = 0;
};

class SpeedProblem {
public:
    /// Begins a problem of the cells between `nodes` (ascending, two or more).
    void begin(const std::vector<double>& nodes, const SpeedEnd& start, const SpeedEnd& end);
    /// Points of one cell after those of the cell before; rows after their point.
    void add_point(const SpeedPoint& point);
    /// v2 <= square at the last point.
    void add_cap(double square);
    /// The middle of the last point's cell <= square: then v2 <= square all over it, if it is at both ends.
    void add_cap_on_middle(double square);
    void add_acceleration(const SpeedRow& row) { add_row(row, Bound::plain); }
    void add_jerk(const SpeedRow& row) { add_row(row, Bound::over_velocity); }

    /// From `middles` (one per cell, > 0, feasible or not) to the best; they are replaced by what was found.
    SpeedOutcome solve(std::vector<double>& middles, SpeedGoal goal, SpeedGuess guess);

    [[nodiscard]] int cells() const noexcept { return static_cast<int>(lengths_.size()); }
    /// v2 at the beginning of cell i (or at the end of the last) for these middles.
    [[nodiscard]] double node(int i, const std::vector<double>& middles) const noexcept;

private:
    enum class Bound : std::uint8_t { plain, over_velocity, cap };
    struct Triple {
        double g[3] = {0, 0, 0};  // of the middles of the cell before, of the cell, of the cell behind
        double k = 0;
    };
    struct Point {
        int cell;
        double weight;
        Triple square, slope, bend;
        int first_row, rows;
        // of the present iterate
        double v2, over_v;
    };
    struct Row {
        Triple l;
        double above, below;
        double s_up, s_down, z_up, z_down;
        double move;  // change of l by the step
        Bound bound;
    };

    void add_row(const SpeedRow& row, Bound bound);
    [[nodiscard]] Triple node_triple(int node, int cell) const noexcept;
    [[nodiscard]] double value(const Triple& t, int cell, const std::vector<double>& d) const noexcept;
    void look(const std::vector<double>& d);
    void make_feasible(std::vector<double>& d, double share);
    void start_slacks(const std::vector<double>& d, double mu);
    double assemble(double mu, SpeedGoal goal);
    bool factor_and_solve();
    [[nodiscard]] double primal_step() noexcept;
    [[nodiscard]] double dual_step(double mu) noexcept;
    [[nodiscard]] double residual(const Row& row, const Point& point, bool up, double l) const noexcept;

    std::vector<double> nodes_, lengths_;
    SpeedEnd start_, end_;
    std::vector<Point> points_;
    std::vector<Row> rows_;
    std::vector<double> band_, right_;  // three numbers per cell: the diagonal and two above it
    double scale_ = 1;                  // of the goal
};

}  // namespace taktwerk::axes
