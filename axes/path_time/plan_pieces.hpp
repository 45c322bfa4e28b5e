#pragma once
// v2(s) as it was found, as pieces of s(t). Service side.
//
// Who wants to stand, or another override, waits for the end of the piece under way: so pieces are short where the cycle comes soon. A run of hours
// would be a million of those. Behind the first seconds its pieces are as long as there is room for, and before the cycle comes to them the rest of the
// plan is cut anew: the same motion.

#include "axes/path_time/curve.hpp"
#include "axes/path_time/run_plan.hpp"

namespace taktwerk::axes {

/// s: no piece that begins sooner than short_for behind the plan's beginning lasts longer.
inline constexpr double longest_piece = 0.02;
inline constexpr double short_for = 3;

/// `found`: cells, and what it was made for. In front of them a piece at constant jerk out of rest from `begin` on, over begin_length (0: there is none, it
/// moves), behind them one to rest over end_length. Fills pieces, shape and duration. False: it would last too long to be a motion.
[[nodiscard]] bool cut_into_pieces(const TimedCurve& curve, double begin, double begin_length, double end_length, const RunShape& found,
                                   RunPlan& out);

/// Whether one of its pieces that begin within `soon` [s] behind the border in front of `piece` lasts longer.
[[nodiscard]] bool has_long_pieces(const RunPlan& plan, std::size_t piece, double soon) noexcept;

/// What `plan` does from that border on, in pieces that are short there. `piece`: neither its first nor its last one.
[[nodiscard]] bool cut_anew(const TimedCurve& curve, const RunPlan& plan, std::size_t piece, RunPlan& out);

}  // namespace taktwerk::axes
