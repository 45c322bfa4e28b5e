#pragma once
// The straight way through a cycle of an axis about which nothing unusual is under way: power is on, the drive says nothing new, and the axis
// stands, runs along a profile, or follows a master. To the last bit what the whole way (axis.cpp) makes of the same cycle, which the axis takes
// wherever this page does not know better (tests/axes/axis/plain_cycle_property.cpp goes both).
//
// One word says which steps may go straight. look() writes it at the end of a cycle planned the whole way; whoever asks anything of the axis
// takes it away (disturb). So between two looks nothing changes but time, the drive's actual values, the masters, and the set-point.

#include <cstdint>

#include "axes/axis/axis_view.hpp"
#include "axes/port/drive_port.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

class AxisCore;

class PlainCycle {
public:
    explicit PlainCycle(AxisView& view) noexcept : view_(view) {}

    /// What is under way from here on, once the cycle is planned and the view shows it.
    void look(const AxisCore& axis) noexcept;
    /// Something was asked of the axis, or happened to it: the next steps look at everything.
    void disturb() noexcept { straight_ = 0; }

    /// With power, its drive well, and no search, probe, reset, alarm or mode of its own: update() and supervise() may go straight.
    [[nodiscard]] bool calm() const noexcept { return (straight_ & with_drive) != 0; }
    /// It has no master and none in its queue.
    [[nodiscard]] bool follows_nobody() const noexcept { return (straight_ & without_master) != 0; }
    /// It follows the masters of the coupling that runs, and none in its queue.
    [[nodiscard]] bool coupled() const noexcept { return (straight_ & in_coupling) != 0; }
    /// So may plan(), unless something comes up in it.
    [[nodiscard]] bool plans() const noexcept { return (straight_ & (along_profile | in_coupling)) != 0; }
    /// The drive has been told everything but the set-point: so may encode().
    [[nodiscard]] bool told() const noexcept { return (straight_ & told_drive) != 0; }
    /// encode() has gone the whole way.
    void tell() noexcept {
        if (calm()) straight_ |= told_drive;
    }

    /// False: the drive says something new, and nothing has been done.
    [[nodiscard]] inline bool update(AxisCore& axis, const DriveFeedback& from_drive) noexcept;

    /// How far plan() has come; the whole way takes over there.
    enum class Planned : std::uint8_t {
        nothing,
        masters,  ///< the masters have been read, and the coupling is not what it was
        motion,   ///< the set-point is made, and something has come to its end
        all,
    };
    [[nodiscard]] inline Planned plan(AxisCore& axis, Duration period) noexcept;

private:
    enum : std::uint8_t { with_drive = 1, along_profile = 2, in_coupling = 4, without_master = 8, told_drive = 16 };

    void fall_behind(AxisCore& axis, double actual) noexcept;
    [[nodiscard]] Planned follow(AxisCore& axis, Duration period) noexcept;
    [[nodiscard]] inline Planned go_along(AxisCore& axis, Duration period) noexcept;
    inline void show_setpoint(AxisCore& axis) noexcept;

    AxisView& view_;
    std::uint8_t straight_ = 0;
    bool guarded_ = false;  // a limit may lie ahead
    bool ends_ = false;     // the end of the profile is the end of something
    bool drifts_ = false;   // at a velocity for ever: the anchor has to follow
    VelocityLimiter limiter_in_motion_ = VelocityLimiter::none;
};

}  // namespace taktwerk::axes
