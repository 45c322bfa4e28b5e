#pragma once
// Homing by the master on the home switch: search the switch, stop, back off slowly, take the position at the edge. Says only how fast
// the axis shall move; the axis plans the ramps. Real-time safe.
//
//   search    in the configured direction at search velocity until the switch is on
//   back off  the other way at latch velocity until it is off: the place of that edge is the reference. A switch shorter than the
//             stopping distance was overrun: then it must come on again first
//   leave     first of all, when it starts on the switch: the other way until it is off, then search
//   pass      when a limit switch comes first: the other way over the whole switch, then search again; once only
// Between two directions the axis stands.
//
// Of two sides that move together (a portal) each has a switch: what ends a way is the later of the two on the way on, and on the way off; both edges
// are taken on the same way back.

#include <array>
#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::axes {

struct SwitchHomingSettings {
    double search_velocity = 0, latch_velocity = 0;  ///< u/s, > 0
    bool negative = true;                            ///< direction of the search
    bool two_sides = false;                          ///< the follower's switch counts as well
    Duration timeout{};
};

struct SwitchHomingInput {
    bool fresh = false;  ///< the three switches and the position are new
    bool home_switch = false;
    bool follower_switch = false;     ///< where there are two sides
    std::int64_t follower_ahead = 0;  ///< counts, of the same instant
    bool negative_limit = false, positive_limit = false;
    std::int64_t position = 0;  ///< counts, of the same instant as the switches
    bool standing = false;      ///< the set-point is at rest
    Instant now{};
};

class SwitchHoming {
public:
    enum class Phase : std::uint8_t { idle, leave, search, back_off, pass_on, pass_off, finished, failed, timed_out };

    void start(const SwitchHomingSettings& settings, Instant now) noexcept;
    void cancel() noexcept { phase_ = Phase::idle; }
    /// Once per cycle while busy; afterwards velocity() holds for this cycle.
    void step(const SwitchHomingInput& in) noexcept;

    /// u/s, signed; 0 = stop.
    [[nodiscard]] double velocity() const noexcept { return velocity_; }
    [[nodiscard]] bool busy() const noexcept { return phase_ != Phase::idle && phase_ < Phase::finished; }
    [[nodiscard]] Phase phase() const noexcept { return phase_; }
    /// The phase in which it failed or ran out of time.
    [[nodiscard]] Phase failed_in() const noexcept { return failed_in_; }
    /// counts at the edge; only when finished.
    [[nodiscard]] std::int64_t reference() const noexcept { return edges_[0].place; }
    /// counts that the follower has to go from where it was beside the leader until both edges are side by side; only when finished.
    [[nodiscard]] std::int64_t follower_behind() const noexcept { return edges_[1].place - edges_[0].place; }

private:
    void stop_then(Phase next) noexcept {
        velocity_ = 0;
        next_ = next;
        stopping_ = true;
    }
    void begin(Phase phase) noexcept;
    void take_edges(const SwitchHomingInput& in) noexcept;
    void fail(Phase how) noexcept {
        failed_in_ = phase_;
        stop_then(how);
    }

    SwitchHomingSettings settings_;
    Phase phase_ = Phase::idle, next_ = Phase::idle, failed_in_ = Phase::idle;
    bool stopping_ = false, begun_ = false, reversed_ = false;
    double velocity_ = 0;
    struct Edge {
        bool was_on = false, taken = false;
        std::int64_t place = 0;
        void see(bool on, std::int64_t at) noexcept;
    };
    std::array<Edge, 2> edges_{};
    Instant start_{};
};

}  // namespace taktwerk::axes
