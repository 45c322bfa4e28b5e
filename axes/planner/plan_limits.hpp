#pragma once
// What the planner accepts and how much work it may do.

namespace taktwerk::axes {

/// What the planner accepts. Inside these bounds no plan fails.
struct PlanBounds {
    static constexpr double largest = 1e30;          ///< any number handed in, in its unit (limits may also be infinity)
    static constexpr double smallest_limit = 1e-30;  ///< any limit, in its unit
    static constexpr double negligible = 1e-150;     ///< a smaller way, velocity or acceleration counts as 0: its square would vanish
};

/// Evaluations in one search for a root in the worst case; usually four to eight.
inline constexpr int max_root_steps = 100;

/// Searches in one plan in the worst case: two families of peaks with one root, four families of troughs with a turning point to look for
/// and a root (mathematics.md).
inline constexpr int max_roots = 2 * 1 + 4 * 2;

}  // namespace taktwerk::axes
