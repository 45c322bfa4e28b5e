#pragma once
// Profile position mode of a simulated drive: the handshake of set-points and the profile between them. Sources: CiA 402-2 (PP: control word
// bits 4 new set-point, 5 change set immediately, 6 relative; status word bit 12 acknowledge), SV33-E 3.4.3(5), SV-DA200 3.2.7, SE-808X 3.2.4.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "axes/sim/trapezoid.hpp"

namespace taktwerk::axes::sim {

/// What the master wrote when bit 4 rose.
struct ProfileTarget {
    double position = 0;  ///< counts, plant coordinates; relative: a distance
    bool relative = false;
    double lowest = -HUGE_VAL, highest = HUGE_VAL;  ///< what lies beyond is moved to it (SV33-E 3.4.4(2))
    TrapezoidLimits limits;
};

/// What bit 5 = 1 makes of the running set-point.
enum class BitFive : std::uint8_t {
    replaces,  ///< the new one takes over at once (CiA 402-2)
    blends,    ///< the running one is reached at full speed and the new one follows (SE-808X 3.2.4)
};

class ProfilePosition {
public:
    static constexpr std::size_t most_waiting = 64;

    /// `room`: set-points behind the running one.
    ProfilePosition(std::size_t room, BitFive meaning) noexcept : room_(room < most_waiting ? room : most_waiting), meaning_(meaning) {}

    /// No set-point; the demand rests at `position`.
    void reset(double position) noexcept;
    /// Each exchange: the level of bit 4, bit 5 and what belongs to them. A rising edge while the buffer is full is lost.
    void exchange(bool new_setpoint, bool bit_five, const ProfileTarget& target) noexcept;
    /// The master was told that the running set-point is reached; one that waited for that starts.
    void reached_was_told() noexcept;
    /// One inner step of `dt` seconds.
    Demand step(double dt) noexcept;
    /// After a stop by something else: goes on from `from` to the running target.
    void resume(const Demand& from) noexcept;
    /// Whatever was on its way is gone; the demand rests at `position`. Unlike reset() an acknowledged bit 4 stays acknowledged.
    void forget(double position) noexcept;

    /// Status word bit 12.
    [[nodiscard]] bool acknowledges() const noexcept { return acknowledged_; }
    /// The demand has arrived and nothing waits, or what waits is not yet to start.
    [[nodiscard]] bool arrived() const noexcept { return !running_; }
    [[nodiscard]] double target() const noexcept { return target_; }
    /// Where the demand has arrived.
    [[nodiscard]] double reached_target() const noexcept { return waiting_ > 0 ? active_.target : target_; }
    /// The newest set-point was moved to a limit.
    [[nodiscard]] bool clipped() const noexcept { return clipped_; }

private:
    struct Setpoint {
        double target = 0;
        TrapezoidLimits limits;
        bool blends = false;
    };
    void start(const Setpoint& setpoint) noexcept;
    void start_next() noexcept;
    /// A set-point of a series follows at once, a single one only after the master has the signal of the one before (SE-808X 3.2.4, figure 2).
    [[nodiscard]] bool next_may_start() const noexcept { return meaning_ != BitFive::blends || buffer_[first_].blends; }
    void plan(const Demand& from) noexcept;

    std::size_t room_;
    BitFive meaning_;
    std::array<Setpoint, most_waiting> buffer_{};
    std::size_t first_ = 0, waiting_ = 0;
    Setpoint active_;
    Trapezoid profile_;
    Demand now_;
    double elapsed_ = 0;
    double target_ = 0;  // of the newest set-point: relative ones count from it
    bool running_ = false, acknowledged_ = false, edge_ = false, clipped_ = false;
};

}  // namespace taktwerk::axes::sim
