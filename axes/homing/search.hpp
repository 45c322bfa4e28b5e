#pragma once
// What every search for a reference is told and what it answers. A search is pure: it sees levels, latches and places of one instant and
// says which way the axis shall move. Ramps, speeds, limits of time and way are not its business (step_run.hpp).

#include <cstdint>

#include "core/time.hpp"

namespace taktwerk::axes {

struct SearchInput {
    bool signal = false;  ///< the reference, where it is a level
    bool negative_limit = false, positive_limit = false;
    std::int64_t position = 0;  ///< counts, of the same instant as the levels
    bool latched = false;       ///< the drive's latch has caught an edge since the last input
    std::int64_t latch = 0;     ///< counts, exact; only when latched
    double set_velocity = 0;    ///< u/s
    double velocity = 0;        ///< u/s, actual
    double torque = 0;          ///< actual, fraction of rated, in the axis' sense
    Instant now{};
};

struct SearchMove {
    enum class Kind : std::uint8_t { move, found, failed } kind = Kind::move;
    int sense = 1;              ///< move: +1 or -1
    bool fine = false;          ///< move: the edge is taken on this way: slowly, where there are two speeds
    std::int64_t place = 0;     ///< found: counts
    std::int64_t absolute = 0;  ///< found by distance-coded marks: counts from the scale's zero to `place`

    static constexpr SearchMove along(int sense, bool fine = false) noexcept { return {.sense = sense, .fine = fine}; }
    static constexpr SearchMove found(std::int64_t place, std::int64_t absolute = 0) noexcept {
        return {.kind = Kind::found, .place = place, .absolute = absolute};
    }
    static constexpr SearchMove failed() noexcept { return {.kind = Kind::failed}; }
};

/// Edges of a level that is sampled: an edge lies between two samples, so its place is taken half way.
class EdgeWatch {
public:
    void see(bool level, std::int64_t position) noexcept {
        rising_ = begun_ && level && !level_;
        falling_ = begun_ && !level && level_;
        place_ = begun_ ? position_ + (position - position_) / 2 : position;
        level_ = level;
        position_ = position;
        begun_ = true;
    }
    [[nodiscard]] bool level() const noexcept { return level_; }
    [[nodiscard]] bool rising() const noexcept { return rising_; }
    [[nodiscard]] bool falling() const noexcept { return falling_; }
    /// counts; of the edge when there is one, else half way since the last sample.
    [[nodiscard]] std::int64_t place() const noexcept { return place_; }

private:
    bool begun_ = false, level_ = false, rising_ = false, falling_ = false;
    std::int64_t position_ = 0, place_ = 0;
};

}  // namespace taktwerk::axes
