#pragma once
// The planner's side of a path's time: keeps the cycle supplied with stretches, as the path grows, as the override changes, as somebody wants to
// stand. Steps on the service side; never waits.

#include <cstdint>
#include <span>
#include <vector>

#include "axes/path_time/curve.hpp"
#include "axes/path_time/run_plan.hpp"
#include "axes/path_time/stretch_exchange.hpp"

namespace taktwerk::axes {

/// What somebody wants of the motion along the path. Halt, interrupt and stop all are `stand`; continue is `go`.
struct PathWish {
    enum class Motion : std::uint8_t { stand, go };
    Motion motion = Motion::go;
    double velocity_factor = 1;  ///< [0, 1]; below a millionth it stands
    std::uint32_t revision = 0;  ///< another one: the curve's limits have changed, what runs is planned anew
};

enum class PathAnswer : std::uint8_t {
    nothing_new,  ///< what runs is what is wanted
    waiting,      ///< the last stretch was not taken yet
    offered,      ///< a new stretch is on its way
    kept,         ///< nothing better was found from there: what runs goes on to its stop
    stuck,        ///< at rest, and no motion was found from there: it comes to none by itself
    late,         ///< the last stretch came too late; the next step tries from further on
};

class PathService {
public:
    /// `limits` of the axes; `lead` [s]: a stretch begins at the earliest so long after the end of the piece that the cycle is on: at least what a plan takes
    /// and the way to the cycle. Each that comes too late doubles it, up to most_lead.
    PathService(std::vector<PathAxisLimits> limits, StretchExchange& exchange, double lead)
        : limits_(std::move(limits)), exchange_(exchange), lead_(lead) {}

    /// `final_end`: up to there the curve will not change any more. A curve that ends there has to be the one of the step before as far as
    /// that one's final end.
    PathAnswer step(const TimedCurve& curve, double final_end, const PathWish& wish);

    /// The end at rest of what runs or is on its way.
    [[nodiscard]] double end() const noexcept { return active_.to; }
    [[nodiscard]] std::uint32_t late() const noexcept { return late_; }
    [[nodiscard]] const RunPlan& last_plan() const noexcept { return plan_; }

    /// Plans tried so far, found or not: what it costs.
    [[nodiscard]] std::uint32_t tries() const noexcept { return tries_; }

    static constexpr double most_lead = 0.5;  // s
    [[nodiscard]] double lead() const noexcept { return lead_; }

private:
    struct Sent {
        std::uint32_t id = 0;
        int at_piece = 0;
        double to = 0;
        double factor = 1;
        std::uint32_t revision = 0;
        bool stands = false;  // because somebody wanted to
        RunPlan plan;
    };

    /// What was asked for where nothing was found: as long as it is the same, planning again from there finds the same.
    struct Failed {
        bool any = false;
        bool stand = false;
        std::uint32_t stretch = 0, revision = 0;
        int times = 0;   // one after the other, of the same wish
        int border = 0;  // the furthest one tried
        double to = 0, factor = 1;
    };

    [[nodiscard]] int border(const StretchProgress& at, int tried) const;
    [[nodiscard]] int failed_times(const Failed& now) const noexcept;
    PathAnswer nothing_found(const Failed& now, bool at_rest) noexcept;
    PathAnswer shorten(const TimedCurve& curve, std::size_t begin, const RunTask& task);
    bool plan_halt(const TimedCurve& curve, RunTask task, double furthest, const RunShape* former);
    [[nodiscard]] bool found() const noexcept { return plan_.found && plan_.pieces.size() <= TimeStretch::most_pieces; }
    [[nodiscard]] bool brake_instead(const TimedCurve& curve, const RunTask& task, const RunShape* former);
    void send(int at_piece, const RunTask& task, bool stands, std::uint32_t revision);

    std::vector<PathAxisLimits> limits_;
    StretchExchange& exchange_;
    double lead_;
    RunPlanner planner_;
    RunPlan plan_;
    Sent active_, sent_;
    bool pending_ = false;
    Failed failed_;
    std::uint32_t tries_ = 0;
    std::uint32_t ids_ = 0;
    std::uint32_t late_ = 0;
};

}  // namespace taktwerk::axes
