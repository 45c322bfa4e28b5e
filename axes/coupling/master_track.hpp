#pragma once
// A master as its slave may follow it: smooth, at the instant for which the slave is planned, or lost. Real-time safe.
//
// Set-points come as they are. Measured positions are filtered (a critically damped tracking filter: no lag at constant velocity, noise
// damped, time constant `settling_cycles` periods), extrapolated with the velocity over the dead time between their latch and the instant at
// which the slave's set-point acts, and bridged with it while no fresh one arrives. The velocity given out
// is that of the place given out.

#include "axes/coupling/endless.hpp"
#include "core/time.hpp"

namespace taktwerk::axes {

class MasterTrack {
public:
    static constexpr double settling_cycles = 8;

    /// What an axis gives of itself in a cycle.
    struct Reading {
        EndlessMotion motion{};
        bool usable = false;          ///< the axis has a position that means something now
        bool fresh = true;            ///< it is new in this cycle
        bool planned = true;          ///< comes from a profile: velocity and acceleration belong to it exactly
        Instant taken{};              ///< when it was there
        double age = 0;               ///< s to extrapolate, from `taken` on
        double feed = 1;              ///< u
        double largest_velocity = 0;  ///< u/s that the axis can have: a step beyond twice of it in a cycle is no motion
    };

    void forget() noexcept { known_ = false; }

    /// The next cycle, `period` [s] on. False: there is no master any more (no usable position, or it jumped: its zero was changed).
    [[nodiscard]] bool next(const Reading& reading, double period) noexcept;
    [[nodiscard]] const EndlessMotion& motion() const noexcept { return out_; }

private:
    bool known_ = false;
    int gap_ = 0;              // cycles since the last fresh one
    EndlessPlace last_;        // as read
    EndlessMotion filter_;     // of measured positions, at their latch
    double acceleration_ = 0;  // of the filter, smoothed once more
    EndlessMotion out_;
};

}  // namespace taktwerk::axes
