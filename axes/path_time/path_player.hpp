#pragma once
// The cycle's side of a path's time: s, v, a, j of every cycle. Real-time safe: no search but over pieces that begin and end within the cycle.

#include <cstdint>

#include "axes/path_time/stretch_exchange.hpp"

namespace taktwerk::axes {

class PathPlayer {
public:
    /// Stands at `begin` until a stretch comes.
    explicit PathPlayer(StretchExchange& exchange, double begin = 0) noexcept : exchange_(exchange) { now_.s = begin; }

    /// `period` [s] later: where on the path, how fast.
    const PathMotion& step(double period) noexcept;

    [[nodiscard]] const PathMotion& now() const noexcept { return now_; }
    /// The part of the curve that now().s lies on (TimedCurve::part_at).
    [[nodiscard]] std::uint32_t part() const noexcept { return part_; }
    [[nodiscard]] bool standing() const noexcept { return stretch_ == nullptr || piece_ >= stretch_->count; }
    /// Until the end of the stretch that runs, where it stands: s. And where that is.
    [[nodiscard]] double time_left() const noexcept;
    [[nodiscard]] double stretch_end() const noexcept;
    /// Stretches that came after their place had been passed: the planner was late. It cost speed.
    [[nodiscard]] std::uint32_t late() const noexcept { return late_; }

private:
    void take_offer() noexcept;

    StretchExchange& exchange_;
    const TimeStretch* stretch_ = nullptr;
    int piece_ = 0;
    double time_ = 0;      // in the piece
    bool border_ = false;  // between two pieces
    std::uint32_t late_ = 0;
    std::uint32_t part_ = 0;
    PathMotion now_{};
};

}  // namespace taktwerk::axes
