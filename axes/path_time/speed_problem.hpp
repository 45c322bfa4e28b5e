#pragma once
// The fastest v2(s), the square of the path's velocity, as a quadratic spline with one coefficient per cell, under inequalities at points.
// A convex problem but for the jerk, whose bound 1/v is used as it is. Solved window by window, by an interior-point method whose equations have
// five diagonals. Service side: its work area grows and is kept. docs/motion/path.md has the mathematics.

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

/// Where in a cell something is limited: at its beginning, as Bernstein's middle coefficient (or at its middle), at its end.
enum class CellPlace : std::uint8_t { begin, middle, end };

/// l = at v2 + slope d(v2)/ds + bend d2(v2)/ds2 with -below <= l <= above; for a jerk both bounds are divided by v.
struct SpeedRow {
    double at = 0;
    double slope = 0;
    double bend = 0;
    double above = 1;
    double below = 1;
};

/// What share of its limits a cell may use.
struct CellShare {
    double velocity, acceleration, jerk;
};

/// Where a search begins: inside all limits or nearly, and far from the best; outside of some by little, and near the best; outside by much. From
/// outside it first comes in; from nearly inside it comes in on the way, or not: who looks at the end sees.
enum class SpeedGuess : std::uint8_t { inside, near, outside };

struct SpeedOutcome {
    bool feasible = false;   ///< every row holds strictly, but for soft caps
    bool settled = false;    ///< and nothing more is to be had
    bool soft_open = false;  ///< something is above a soft cap
    int steps = 0;
};

/// Cells [first, last).
struct CellRange {
    int first = 0, last = 0;
};

/// Asked once on the way, when the search has come near its end: may lower shares of cells in the range.
class SpeedWitness {
public:
    virtual void come_near(const CellRange& cells, const std::vector<double>& middles) = 0;

protected:
    SpeedWitness() = default;
    SpeedWitness(const SpeedWitness&) = default;
    SpeedWitness& operator=(const SpeedWitness&) = default;
    ~SpeedWitness() = default;
};

class SpeedProblem {
public:
    /// Begins a problem of the cells between `nodes` (ascending, two or more); each may use `all` until told otherwise.
    void begin(const std::vector<double>& nodes, const SpeedEnd& start, const SpeedEnd& end, const CellShare& all);
    /// The places of a cell in their order, cell after cell; rows after their place.
    void add_place(int cell, CellPlace place);
    /// v2 <= square at the last place (its middle: Bernstein's coefficient; then v2 <= square all over the cell, if it is at both ends).
    void add_cap(double square) { add_plain(cap_of(square), Bound::cap); }
    /// The same, for a velocity that a moving beginning may be above: it is come back to.
    void add_soft_cap(double square) { add_plain(cap_of(square), Bound::soft_cap); }
    void add_acceleration(const SpeedRow& row);
    void add_jerk(const SpeedRow& row);

    /// What the rows of a place may use from now on.
    void share(int cell, CellPlace place, const CellShare& share);

    /// From rest: scales all of v2 down until every row holds, and `room` is left.
    void come_inside(std::vector<double>& middles, double room);
    /// The cells of the range from `middles` (> 0, feasible or not) to the best; the others stay as they are. All do where no way in is found.
    SpeedOutcome solve(std::vector<double>& middles, const CellRange& range, SpeedGuess guess, SpeedWitness* witness);

    /// From now on the soft caps of the cell hold as the others do, until a search finds no way into them.
    void hold(int cell);
    [[nodiscard]] int cells() const noexcept { return static_cast<int>(lengths_.size()); }
    /// v2 at the beginning of cell i (or at the end of the last) for these middles.
    [[nodiscard]] double node(int i, const std::vector<double>& middles) const noexcept;

private:
    using Lanes [[gnu::vector_size(16)]] = double;  // two sides at once
    enum class Room : std::uint8_t { first, less, half };
    /// held_cap: a soft cap that the guess was inside of, so that it holds as the others do.
    enum class Bound : std::uint8_t { none, acceleration, cap, soft_cap, held_cap };
    struct Triple {
        double g[3] = {0, 0, 0};  // of the middles of the cell before, of the cell, of the cell behind
        double k = 0;
    };
    struct Place {
        Triple square;
        double weight = 0;  // in the time
        int plain = 0, plain_count = 0, jerk = 0, jerk_count = 0;
        // of the present iterate
        double v2 = 0, over_v = 0, cube = 0;  // cube: 1/v3
    };
    /// Two inequalities g d + k <= bound: for a jerk both sides of one row, with bound/v. `inverse` of what is left, z the multiplier, `move` of what is
    /// left by a step, as its part. What a step reads: 128 bytes.
    struct Pair {
        Lanes g0, g1, g2, k, bound, z, inverse, move;
    };
    /// The limits that a pair's bound comes from.
    struct PairLimits {
        Lanes limit, wanted;
        Bound kind[2];
    };

    [[nodiscard]] static double share_of(Bound kind, const CellShare& share) noexcept;
    [[nodiscard]] SpeedRow cap_of(double square) const noexcept { return {1 / square, 0, 0, 1, 0}; }
    [[nodiscard]] Triple triple_of(const SpeedRow& row) const noexcept;
    void add_plain(const SpeedRow& row, Bound kind);
    void add_side(const Triple& l, double sign, double limit, Bound kind);
    [[nodiscard]] Triple node_triple(int node, int cell) const noexcept;
    [[nodiscard]] double value(const Triple& t, int cell, const std::vector<double>& d) const noexcept;
    [[nodiscard]] bool moving() const noexcept { return start_.rest_length <= 0; }
    template <class Do>
    void each_place(const CellRange& range, const Do& act);
    void look_at_squares(const CellRange& range);
    bool let_go(const CellRange& range);
    void relax(const CellRange& range, Room room, double beyond);
    void center(const CellRange& range, double mu);
    void assemble(const CellRange& range, double mu);
    bool factor_and_solve(const CellRange& range);
    [[nodiscard]] double measure_step(const CellRange& range);
    /// Returns s z summed.
    [[nodiscard]] double take_step(const CellRange& range, double mu, double step);

    std::vector<double> nodes_, lengths_;
    SpeedEnd start_, end_;
    CellShare all_{};
    std::vector<Place> places_;  // three per cell
    std::vector<Pair> plain_, jerk_;
    std::vector<PairLimits> plain_limits_, jerk_limits_;  // of each pair
    Triple square_, slope_, bend_;                        // of the last place
    bool half_ = false;                                   // the last plain pair has room for another side
    std::vector<double> d_;                               // middles, one more at both ends
    std::vector<double> band_, right_;
    double scale_ = 1;      // of the goal
    double decrement_ = 0;  // Newton's: what a step promises
    bool feasible_ = false;
    bool holds_ = true;                         // soft caps are held where the guess is inside
    double hard_beyond_ = 0, soft_beyond_ = 0;  // how far bounds are relaxed, all together, and soft caps
};

}  // namespace taktwerk::axes
