#pragma once
// The ends of the travel where they are the drive's own: software limits (SV33-E 3.4.4(2), 607Dh) in all modes, and limit switches outside
// CSP of a drive that only warns of them (5.5, A.220, A.221). How it stops there is an option of the drive (P04.15). Its way back is a
// command that points back. Homing looks at switches by itself; what it does at a software limit is not stated, and it takes no notice.

#include "axes/sim/axis_objects.hpp"
#include "axes/sim/plant.hpp"

namespace taktwerk::axes::sim {

class TravelEnds {
public:
    /// `warns`: a limit switch is a warning to this drive.
    explicit TravelEnds(bool warns) noexcept : warns_(warns) {}

    [[nodiscard]] static bool limits_count(const AxisInputs& in, bool homed) noexcept;
    /// In the position modes a target [counts of the drive] beyond 607Dh is moved to the limit, and nothing else happens.
    double within_limits(double wanted, const AxisInputs& in, bool homed) noexcept;

    /// -1, 1: past the negative or positive switch. With both at once it decides (SV33-E 3.4.4(2)).
    [[nodiscard]] int past_switch(const Plant& plant) const noexcept;
    /// "The actual position, 6064h": not the target.
    [[nodiscard]] static int past_limit(double actual, const AxisInputs& in, bool homed) noexcept;

    /// Stopped behind this end, 0: behind none; false: it was so before.
    bool stop_at(int end) noexcept;
    void leave() noexcept { stopped_ = 0; }
    [[nodiscard]] bool stopped() const noexcept { return stopped_ != 0; }

    /// Status word bit 11: a target was clipped, or the motor is past a software limit.
    void limited(bool is) noexcept { limited_ = is; }
    [[nodiscard]] bool limited() const noexcept { return limited_; }

private:
    bool warns_;
    bool limited_ = false;
    int stopped_ = 0;  ///< -1, 1: behind the negative or positive end
};

}  // namespace taktwerk::axes::sim
