#pragma once
// One searching step of homing from start to standstill: the search itself, what bounds it (time, way, torque), the stop at its end and, after
// pressing against a block, the way back to where the axis really is. Says what the axis shall do; the axis plans the ramps. Real-time safe.

#include <variant>

#include "axes/homing/block_search.hpp"
#include "axes/homing/coded_marks.hpp"
#include "axes/homing/limit_search.hpp"
#include "axes/homing/pulse_search.hpp"
#include "axes/homing/search.hpp"
#include "axes/homing/switch_search.hpp"

namespace taktwerk::axes {

struct StepSettings {
    std::variant<SwitchSearch, LimitSearch, BlockSearch, PulseSearch, CodedSearch> search{};
    double velocity = 0;       ///< u/s, > 0
    double fine_velocity = 0;  ///< u/s, where the edge is taken; 0 = velocity
    // 0 = no limit
    Duration time_limit{};
    std::int64_t distance_limit = 0;  ///< counts from the start, either way
    double torque_limit = 0;          ///< fraction of rated torque; for a block the search's own
};

class StepRun {
public:
    enum class End : std::uint8_t { none, found, failed, time_limit, distance_limit, torque_limit, not_permitted };
    enum class Demand : std::uint8_t { stop, velocity, place };

    void start(const StepSettings& settings, Instant now, std::int64_t position) noexcept;
    void cancel() noexcept { phase_ = Phase::idle; }
    /// Ends the search early: the axis stops first.
    void end(End how) noexcept;
    /// Once per cycle while busy; afterwards demand() holds. `standing`: the set-point is at rest and has reached what was demanded.
    /// Without `fresh` feedback only the time goes on.
    void step(const SearchInput& in, bool fresh, bool standing) noexcept;

    [[nodiscard]] bool busy() const noexcept { return phase_ != Phase::idle && phase_ != Phase::over; }
    /// Not `none` once it is over.
    [[nodiscard]] End result() const noexcept { return phase_ == Phase::over ? end_ : End::none; }
    [[nodiscard]] Demand demand() const noexcept { return demand_; }
    [[nodiscard]] double velocity() const noexcept { return velocity_; }  ///< u/s, signed; Demand::velocity
    [[nodiscard]] std::int64_t place() const noexcept { return place_; }  ///< counts: of the reference, or to go back to (Demand::place)
    [[nodiscard]] std::int64_t absolute() const noexcept { return absolute_; }
    /// The set-point may be far ahead of an axis that cannot follow.
    [[nodiscard]] bool presses() const noexcept { return busy() && std::holds_alternative<BlockSearch>(settings_.search); }

private:
    enum class Phase : std::uint8_t { idle, searching, stopping, returning, over };

    [[nodiscard]] End limit_hit(const SearchInput& in) const noexcept;

    StepSettings settings_;
    Phase phase_ = Phase::idle;
    End end_ = End::none;
    Demand demand_ = Demand::stop;
    double velocity_ = 0;
    Instant start_{};
    std::int64_t from_ = 0, last_ = 0, place_ = 0, absolute_ = 0;
};

}  // namespace taktwerk::axes
